"""What a house of the embedded corpus is: a plan, the furniture in it, and which rooms were left empty."""

import math
from dataclasses import dataclass

from pipeline.corpus.furniture.catalogue import Model
from pipeline.entities.plan import Plan

Rect = tuple[float, float, float, float]
"""An axis-aligned rectangle (x0, y0, x1, y1) in plan [m, world]."""


@dataclass(frozen=True, slots=True)
class Item:
    """A placed model. `room` indexes the plan's rooms (-1: none); `position` is its bottom centre [m, world]; yaw in (-pi, pi].

    `scale` multiplies the model's own (w, d, h); a negative first factor mirrors it. `support` is the index, among the house's
    items, of what it stands on or in; -1: floor, wall or ceiling.
    """

    model: Model
    room: int
    position: tuple[float, float, float]
    yaw: float
    scale: tuple[float, float, float] = (1.0, 1.0, 1.0)
    support: int = -1

    @property
    def size(self) -> tuple[float, float, float]:
        """Full extents as placed [m], object frame."""
        w, d, h = self.model.size
        return (w * abs(self.scale[0]), d * abs(self.scale[1]), h * abs(self.scale[2]))

    def corners(self) -> tuple[tuple[float, float], ...]:
        """Return the four corners of the footprint, counter-clockwise [m, world]."""
        w, d = self.size[0] / 2, self.size[1] / 2
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        x, y = self.position[0], self.position[1]
        return tuple((x + c * u - s * v, y + s * u + c * v) for u, v in ((-w, -d), (w, -d), (w, d), (-w, d)))

    def rect(self) -> Rect:
        """Return the axis-aligned bounds of the footprint [m, world]."""
        xs, ys = zip(*self.corners(), strict=True)
        return (min(xs), min(ys), max(xs), max(ys))


@dataclass(frozen=True, slots=True)
class House:
    """One furnished house. `plan.rooms[i].type` is a 3D-FRONT room type; `empty` marks rooms that stay unfurnished."""

    uid: str
    index: int
    plan: Plan
    items: tuple[Item, ...]
    empty: tuple[bool, ...]


def wrap(yaw: float) -> float:
    """Return `yaw` in (-pi, pi]."""
    turned = math.remainder(yaw, 2 * math.pi)
    return math.pi if turned <= -math.pi + 1e-9 else turned
