"""One object while it is being arranged: its placement, what it takes of the room, what is known of its category."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from pipeline.arrange.learnt_relations import Habit, LearntRelations
from pipeline.arrange.shapes import Grip, Shape, shape
from pipeline.arrays import Floats
from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement
from pipeline.geometry.prisms import join_prisms

FIXTURES = frozenset({"kitchen", "appliance", "bath"})  # super-categories of what one stands before to use it
FORWARD, NOTHING = np.array([0.0, -1.0]), join_prisms([])
OTHER_WALL = 0.8  # turn from which two things stand at different walls [rad]


@dataclass(frozen=True, slots=True, eq=False)
class Item:
    """An object: `wished` (x, y, z, yaw) is where the layout model wants it, `half` (2,) are its half extents in plan [m].

    `grips` are the handles of which a robot must reach one; of a fixture that has none the middle of its front.
    """

    placement: Placement
    shape: Shape
    habit: Habit
    wished: Floats
    half: Floats
    grips: tuple[Grip, ...]

    @property
    def mount(self) -> str:
        """Where it is fixed."""
        return self.habit.mount

    @property
    def width(self) -> float:
        """Its full extent across its front [m]."""
        return 2 * float(self.half[0])

    @property
    def depth(self) -> float:
        """Its full extent from front to back [m]."""
        return 2 * float(self.half[1])

    @property
    def area(self) -> float:
        """The area of its box in plan [m2]; what hangs takes none."""
        return 4.0 * float(self.half[0] * self.half[1]) if self.habit.mount == "floor" else 0.0

    def at(self, pose: Floats) -> Placement:
        """Return its placement at a pose."""
        return replace(self.placement, position=np.round(pose[:3], 4) + 0.0, yaw=wrap_yaw(float(pose[3])))


def make_item(placement: Placement, assets: Mapping[str, Asset], learnt: LearntRelations, access_depth: float) -> Item:
    """Prepare a placement."""
    wished = np.array([*placement.position, placement.yaw])
    habit = learnt.habit(placement.category)
    asset_shape = shape(assets[placement.asset_id], placement.scale, access_depth, habit.access)
    half, grips = np.asarray(placement.size[:2]) / 2, asset_shape.grips
    if not grips and habit.access == "front" and habit.kind in FIXTURES:
        grips = (Grip(np.array([0.0, -half[1]]), FORWARD, NOTHING),)
    return Item(placement, asset_shape, habit, wished, half, grips)


def wrap_yaw(yaw: float) -> float:
    """Return a yaw in (-pi, pi], rounded as poses are (1e-5 rad)."""
    angle = round(math.remainder(yaw, 2 * math.pi), 5)
    return 3.14159 if angle <= -3.14159 else angle


def yaw_difference(a: Floats | float, b: float) -> Floats:
    """Return the absolute difference of yaws [rad], at most pi."""
    difference = np.abs(np.asarray(a, float) - b) % (2 * math.pi)
    smaller: Floats = np.minimum(difference, 2 * math.pi - difference)
    return smaller


def other_wall(turn: float) -> bool:
    """Whether two things that are turned so far from each other [rad] stand at different walls."""
    return bool(yaw_difference(turn, 0.0) > OTHER_WALL)
