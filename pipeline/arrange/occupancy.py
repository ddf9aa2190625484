"""What already stands in a room, whether a group can join it, and whether the floor still hangs together."""

import math
from collections.abc import Collection
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.bonds import Group
from pipeline.arrange.item import Item
from pipeline.arrange.settings import SeparateSettings
from pipeline.arrange.site import Site
from pipeline.arrange.world import compose_pose, free_poses, make_world, put
from pipeline.arrays import Floats
from pipeline.entities.home import rectangle
from pipeline.geometry.free_space import FreeSpace
from pipeline.geometry.prisms import Prisms
from pipeline.geometry.stance import stand_pose

SPREAD = 0.12  # when a pose cuts the floor, poses nearer to it than this are not tried [m]; more after every try
TRIES = 24  # poses whose floor is looked at per group
UNIT = np.ones(3)
OUT_OF_REACH = (2.0, 0.7)  # cost of what a robot cannot use where it stands [m]; at its anchor: less than to leave it


class Place(NamedTuple):
    """Where a group could stand: the pose (4,) of its first member, what that costs [m], and whom a robot does not get to then."""

    pose: Floats
    cost: float
    unreached: frozenset[int]


class Occupancy:
    """The objects of a room, of which those of `there` (N,) stand at `poses` (N, 4); a relation holds those of `bound` where they are.

    `distances` (N, N) is how far each keeps from each [m].
    """

    def __init__(self, site: Site, items: list[Item], settings: SeparateSettings, distances: Floats, bound: Collection[int] = ()) -> None:
        self.site, self.items, self.settings, self.bound = site, items, settings, frozenset(bound)
        self.world = make_world([item.shape for item in items], site.swung, site.shut, site.polygon, site.ceiling, distances)
        self.poses = np.array([item.wished for item in items]).reshape(-1, 4)
        self.there = np.zeros(len(items), np.bool_)
        self.unreached: frozenset[int] = frozenset()
        self.handles: dict[tuple[int, int], tuple[bytes, tuple[Floats, Floats, Prisms]]] = {}
        label, self.doors = site.gate(site.bare)
        self.enters = self._enters(site.bare, label)

    def stand(self, group: Group, pose: Floats) -> None:
        """Let a group stand with its first member at a pose."""
        for i, offset in zip(group.members, group.offsets, strict=True):
            compose_pose(pose, offset, self.poses[i])
            put(self.world, i, self.poses[i])
            self.there[i] = True

    def leave(self, group: Group) -> None:
        """Take a group out."""
        self.there[group.members] = False

    def outline(self, i: int) -> Floats:
        """Return the corners (4, 2) of the box of an object that stands [m]."""
        return rectangle(self.items[i].half, self.poses[i, :2], self.poses[i, 3])

    def nearest(self, group: Group, poses: Floats, costs: Floats, among: NDArray[np.bool_] | None = None) -> tuple[Floats, float] | None:
        """Return the cheapest free pose of a group and its cost, whatever becomes of the floor; poses come cheapest first.

        Free of what stands, or of the objects of `among` (N,), at which they were placed last.
        """
        others = self.there if among is None else among
        start, best, least = 0, None, np.inf
        while start < len(poses) and costs[start] < least:
            totals, start = self._totals(group, poses, costs, start, others)
            k = int(np.argmin(np.round(totals, 9)))
            if totals[k] < least:
                best, least = poses[k], float(totals[k])
        return None if best is None else (best, least)

    def place(self, group: Group, poses: Floats, costs: Floats, best: Place | None = None) -> Place | None:
        """Return the cheapest place of a group that is free and leaves the floor in one piece, where there is one that is cheaper than `best`; else that.

        What a robot does not get to any more then, the group itself or others, costs `OUT_OF_REACH` each.
        """
        start, tries = 0, 0
        failed: list[list[float]] = []
        while start < len(poses) and tries < TRIES and (best is None or costs[start] < best.cost):
            totals, start = self._totals(group, poses, costs, start, self.there)
            for k in np.argsort(np.round(totals, 9), kind="stable")[: int(np.isfinite(totals).sum())]:
                if tries >= TRIES or (best is not None and totals[k] >= best.cost):
                    break
                apart = SPREAD * (1.0 + 0.15 * tries)
                x, y, _, yaw = poses[k].tolist()
                if any(math.hypot(x - f[0], y - f[1]) < apart and abs(math.remainder(yaw - f[2], math.tau)) < 0.3 for f in failed):
                    continue
                self.stand(group, poses[k])
                unreached = self.out_of_reach()
                self.leave(group)
                if unreached is not None:
                    total = float(totals[k]) + sum(OUT_OF_REACH[i in self.bound] for i in unreached - self.unreached)
                    if best is None or total < best.cost:
                        best = Place(poses[k], total, unreached)
                if unreached == self.unreached:
                    break
                failed.append([x, y, yaw])
                tries += 1
        return best

    def settle(self, group: Group, place: Place) -> None:
        """Let a group stand at a place."""
        self.stand(group, place.pose)
        self.unreached = place.unreached

    def out_of_reach(self) -> frozenset[int] | None:
        """Return the objects that stand, and have no handle or front within a robot's reach; None where the floor falls apart.

        It does when doors are no longer joined, or the robot does not get from them into the room. Nothing is out of reach where it gets into the
        empty room by no door.
        """
        space = self.site.free_space(self._bodies())
        label, doors = self.site.gate(space)
        if doors < self.doors or (self.enters and not self._enters(space, label)):
            return None
        if not self.enters:
            return frozenset()
        there = np.flatnonzero(self.there).tolist()
        return frozenset(i for i in there if i in self.unreached or not self._usable(i, space, label))

    def _totals(self, group: Group, poses: Floats, costs: Floats, start: int, others: NDArray[np.bool_]) -> tuple[Floats, int]:
        s = self.settings
        soft = s.access_cost, s.nearness_cost
        return free_poses(self.world, group.members, group.offsets, poses, costs, start, s.candidates, others, s.touch, soft)

    def _bodies(self) -> Prisms:
        """Return the bodies of what stands."""
        start = self.world.start
        rows = np.concatenate([np.arange(start[i, 0], start[i, 1]) for i in np.flatnonzero(self.there)] or [np.zeros(0, np.int64)])
        return Prisms(self.world.at[rows], self.world.corner_count[rows], self.world.at_z[rows], rows)

    def _enters(self, space: FreeSpace, label: int) -> bool:
        """Whether the robot gets from the doors into the room itself."""
        return label > 0 and bool((space.labels[self.site.floor.room >= 0] == label).any())

    def _usable(self, i: int, space: FreeSpace, label: int) -> bool:
        """Whether a robot can stand at one of an item's handles, or before its front, where that matters."""
        grips = self.items[i].grips
        site = self.site
        return not grips or any(
            stand_pose(*self._placed(i, k), site.elevation, space, label, site.robot) is not None for k in range(len(grips))
        )

    def _placed(self, i: int, k: int) -> tuple[Floats, Floats, Prisms]:
        """Return handle `k` of an item where it stands: point, heading and what the part sweeps; what has not moved since is not placed again."""
        pose = self.poses[i]
        key = pose.tobytes()
        kept = self.handles.get((i, k))
        if kept is None or kept[0] != key:
            grip = self.items[i].grips[k]
            c, s = np.cos(pose[3]), np.sin(pose[3])
            T = np.array([[c, s], [-s, c]])
            kept = self.handles[i, k] = (
                key,
                (grip.point @ T + pose[:2], grip.heading @ T, grip.swept.placed(pose[:3], float(pose[3]), UNIT)),
            )
        return kept[1]
