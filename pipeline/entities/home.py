"""A home: a plan and the things placed in it."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.plan import Plan


def rectangle(half: NDArray[np.float64], middle: NDArray[np.float64], yaw: float) -> NDArray[np.float64]:
    """Return the corners (4, 2) of a rectangle of half extents (2,) about its middle (2,), counter-clockwise from its lower left at yaw 0."""
    c, s = np.cos(yaw), np.sin(yaw)
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * half
    return np.ascontiguousarray(corners @ np.array([[c, s], [-s, c]]) + middle)


@dataclass(frozen=True, slots=True)
class Placement:
    """A placed asset.

    `position` (3,) [m]: world position of the bottom centre of the asset's box with all joints at 0, storey
    elevation included; `yaw` [rad] in (-pi, pi]; `size` (3,) [m] full extents (w, d, h) in the object frame, equal to
    asset size * `scale`; `scale` (3,) is 1 for articulated assets. `latent` (32,) and `retrieval_distance` are what
    the layout model asked for and how far the match is. `support` is the object that it stands on or in, "" for the floor,
    a wall or the ceiling.
    """

    object_id: str
    room_id: str
    category: str
    asset_id: str
    position: NDArray[np.float64]
    yaw: float
    size: NDArray[np.float64]
    scale: NDArray[np.float64] = field(default_factory=lambda: np.ones(3))
    latent: NDArray[np.float32] = field(default_factory=lambda: np.zeros(32, np.float32))
    retrieval_distance: float = 0.0
    support: str = ""

    def footprint(self) -> NDArray[np.float64]:
        """Return the corners (4, 2) of the box in plan, counter-clockwise [m, world]."""
        return rectangle(self.size[:2] / 2, self.position[:2], self.yaw)


@dataclass(frozen=True, slots=True)
class Home:
    """One home of a dataset. `scene_id` is `s<seed>_<index:08d>`; `program` is the typed request as JSON."""

    scene_id: str
    seed: int
    index: int
    prompt: str
    program: str
    plan: Plan
    placements: tuple[Placement, ...]

    def in_room(self, room_id: str) -> tuple[Placement, ...]:
        """Return the placements of one room."""
        return tuple(p for p in self.placements if p.room_id == room_id)
