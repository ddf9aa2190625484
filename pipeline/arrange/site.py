"""A room as the arranger sees it: walls, the space that its doors need, the floor that must hang together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pipeline.arrange.walls import Edge, edges_of
from pipeline.arrays import Floats
from pipeline.entities.plan import Plan
from pipeline.geometry.door_sweeps import leaf_sweep, shut_leaf
from pipeline.geometry.free_space import PASSABLE, Floor, FreeSpace, bare_floor, free_space
from pipeline.geometry.prisms import Prisms, join_prisms
from pipeline.geometry.robot import Robot
from pipeline.geometry.walls import leaves

PASS_WIDTH = 0.9  # of a wide opening, this much about its middle is kept passable [m]
NEAR_DOOR = 0.15  # the robot must find a place this near to the middle of each opening, so that it gets through [m]


@dataclass(frozen=True, slots=True)
class Site:
    """One room.

    `polygon` (n, 2) [m]; floor at `elevation`, ceiling at `ceiling` [m]; `swung` are the prisms that room doors sweep, `shut` those of closed ones;
    `doors` (D, 2) [m] the middles of the openings that one walks through; `bare` is where the robot can stand on the empty floor.
    """

    room_id: str
    polygon: Floats
    elevation: float
    ceiling: float
    swung: Prisms
    shut: Prisms
    doors: Floats
    walls: list[Edge]
    floor: Floor
    bare: FreeSpace
    robot: Robot

    @classmethod
    def of(cls, plan: Plan, room_id: str, robot: Robot, cell: float) -> Site:
        """Take one room out of a plan, with a raster of that cell [m] for the robot's ways."""
        room = plan.room(room_id)
        openings = [o for o in plan.openings if room_id in o.rooms and o.level == room.level]
        elevation = plan.elevation(room_id)
        own = {o.opening_id for o in openings}
        # Beyond each opening lies floor on which the robot can stand whole: one passes through, not up to the wall.
        # Wide openings must be free in the middle, seen from both of their rooms: so both agree on where to pass.
        floor = bare_floor([room], openings, 2 * robot.radius + cell, cell, PASS_WIDTH)
        doors = [leaf for leaf in leaves(plan) if leaf.opening_id in own]
        return cls(
            room_id,
            np.ascontiguousarray(room.polygon, np.float64),
            elevation,
            elevation + room.height,
            join_prisms([leaf_sweep(leaf, elevation).prisms for leaf in doors]),
            join_prisms([shut_leaf(leaf, elevation) for leaf in doors]),
            np.array([o.segment.mean(0) for o in openings if o.kind in PASSABLE]).reshape(-1, 2),
            edges_of(room.polygon, openings),
            floor,
            free_space(floor, join_prisms([]), robot.radius, robot.band(elevation)),
            robot,
        )

    def free_space(self, obstacles: Prisms) -> FreeSpace:
        """Find where the robot can stand with these obstacles in the room."""
        return free_space(self.floor, obstacles, self.robot.radius, self.robot.band(self.elevation))

    def gate(self, space: FreeSpace) -> tuple[int, int]:
        """Return the label of the free part that most doors open to (the largest of equals), and how many do.

        Without doors it is the largest part; (0, 0) when the robot gets in by no door.
        """
        if not len(self.doors):
            return space.largest_label(self.floor.room >= 0), 0
        near = [space.label_near(door, NEAR_DOOR) for door in self.doors]  # 0 where the robot cannot stand in it
        votes = sorted({label for label in near if label}, key=lambda label: (-near.count(label), label))
        if not votes:
            return 0, 0
        tied = [label for label in votes if near.count(label) == near.count(votes[0])]
        best = max(tied, key=lambda label: (np.count_nonzero(space.labels == label), -label)) if len(tied) > 1 else tied[0]
        return best, near.count(best)

    def free_share(self, space: FreeSpace) -> float:
        """Return the true walkable ratio: what the robot covers, moving about from the doors, over the floor."""
        return float(space.shares(space.swept_floor(self.gate(space)[0]), 1)[0])
