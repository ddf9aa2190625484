"""The groups of a room find their places: first those that are free where they belong, then the rest, the largest first."""

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.bonds import KEPT, TURNED, Bond, Group, at_anchor, group_of, groups, nearest
from pipeline.arrange.candidates import ALONE, at_anchor_poses, cheapest_first, everywhere, hides, near_by, round_walls, steps_to_walls
from pipeline.arrange.item import wrap_yaw
from pipeline.arrange.learnt_relations import LearntRelations
from pipeline.arrange.occupancy import Occupancy, Place
from pipeline.arrange.walls import Edge
from pipeline.arrange.world import FREE, conflicts, put
from pipeline.arrays import Floats

Ranked = tuple[Floats, Floats]  # poses (C, 4) and their costs (C,), the cheapest first
Led = tuple[Group, Sequence[Edge]]  # a group, and the walls at one of which its first member is to stand

SHIFT = 1.0  # a group goes no farther as one before it is tried without its members [m]
STEPS = (0.0, -0.3, 0.3, -0.6, 0.6, -0.9, 0.9)  # what leads a group is tried so much farther from it [m]
OPENS = 1.5  # what opens is placed as if it were so many times as large


@dataclass(slots=True)
class Settling:
    """Groups of a room on the way from their exact `poses` (N, 4) to where they come to stand, held by `bonds` and kitchen `runs`.

    `led` are those who did not come to stand at their anchors: the two are sought a place together. `careful`: the floor must hang
    together with each group that is added.
    """

    occupancy: Occupancy
    poses: Floats
    bonds: Sequence[Bond | None]
    runs: Sequence[Sequence[int]]
    learnt: LearntRelations
    led: Collection[int] = ()
    careful: bool = True

    def settle_all(self, first: Sequence[int], *, bulk: bool) -> None:
        """Find a place for every group, those that hold one of `first` before the others; who finds none stands nowhere.

        `bulk`: those that are free where they belong come first, all at once.
        """
        occupancy, items, touch = self.occupancy, self.occupancy.items, self.occupancy.settings.touch
        pairs, near, alone = conflicts(occupancy.world, self.poses, touch)
        own_groups, strays, poses = self._resolve_overlaps(groups(items, self.poses, self.bonds, self.runs), pairs)
        if not np.array_equal(poses, self.poses):
            self.poses = poses
            pairs, near, alone = conflicts(occupancy.world, poses, touch)
        leading = self._leading_groups(own_groups)
        at_fault = (alone != FREE) | np.array([hides(i, p, occupancy.site) for i, p in zip(items, poses, strict=True)], np.bool_)
        member = np.full(len(items), -1)
        for number, group in enumerate(own_groups):
            member[group.members] = number
        clash = (pairs | near) & (member[:, None] != member[None]) & (member >= 0)[:, None] & (member >= 0)[None]
        order = sorted(own_groups, key=lambda group: self._rank(group, first))
        bound = {i for led in leading.values() for group, _ in led for i in group.members.tolist()}
        stays = [group for group in order if bound.isdisjoint(group.members.tolist())]
        free = [group for group in stays if bulk and not (at_fault[group.members].any() or clash[group.members].any())]
        for group in free:
            occupancy.stand(group, poses[group.first])
        if self.careful and free and occupancy.out_of_reach() != frozenset():
            for group in free:
                occupancy.leave(group)
            free = []
        waiting, runs = [group for group in order if group not in free], {run[0] for run in self.runs}
        for group in waiting:
            if group.first in runs:
                strays += self._settle_group(group)
        for led in leading.values():
            any(self._put_at_walls(*way) for way in led)
        for group in waiting:
            if group.first not in runs:
                left = [i for i in group.members.tolist() if not occupancy.there[i]]
                strays += self._settle_group(group) if len(left) == len(group.members) else left
        for i in sorted(strays, key=lambda i: (-items[i].area, i)):
            self._settle_one(i)

    def _leading_groups(self, own_groups: Sequence[Group]) -> dict[int, list[Led]]:
        """Return, by the number of its anchor's group, as what and at which walls that group is sought a place for each who is `led`: what is to be tried first comes first.

        Who belongs to a wall across from the anchor leads it: a sofa goes where there is a wall for its screen. A screen that goes by the
        coffee table takes along the sofa, to which that belongs.
        """
        items = self.occupancy.items
        number = {i: k for k, group in enumerate(own_groups) for i in group.members.tolist()}
        across = {
            number[bond.anchor]: (i, bond)
            for i, bond in enumerate(self.bonds)
            if bond is not None and not bond.rigid and items[i].habit.must and bond.anchor in number
        }
        leading: dict[int, list[Led]] = {}
        for i in sorted(self.led):
            bond = self.bonds[i]
            at = None if bond is None else number.get(bond.anchor)
            if bond is None or at is None or at in leading:
                continue
            group, lead = own_groups[at], across.get(at)
            if lead is not None and not items[group.first].habit.must and (i == lead[0] or bond.anchor == group.first):
                leading[at] = self._led_by(*lead, group)
            elif bond.anchor == group.first and items[group.first].habit.wants:
                leading[at] = [(group, self.occupancy.site.walls)]
        return leading

    def _led_by(self, lead: int, bond: Bond, group: Group) -> list[Led]:
        """Return a group behind who stands across from one of its members, at each distance at which he may stand; then the same of its anchor and that member alone.

        Before all others come those whose anchor has its back at a wall then, where such things would rather be: nobody puts a sofa into mid-room before a free wall.
        """
        items, walls = self.occupancy.items, self.occupancy.site.walls
        own, anchor = items[lead], items[bond.anchor]
        relation = self.learnt.modes(anchor.placement.category, own.placement.category)
        way = bond.local[:2] / max(float(np.linalg.norm(bond.local[:2])), 1e-6)
        members, core = group.members.tolist(), list(dict.fromkeys((group.first, bond.anchor)))
        sets, together = [members, core] if len(core) < len(members) else [core], self.poses.copy()

        def led(step: float, of: Sequence[int]) -> Group | None:
            local = np.array([*(bond.local[:2] + step * way), bond.local[2]])
            near = None if relation is None else nearest(relation[0], np.zeros(3), anchor.half, local, own.half)
            if step != 0.0 and (near is None or near[0] > KEPT or near[1] > TURNED):
                return None
            together[lead, [0, 1, 3]] = at_anchor(self.poses[bond.anchor], local)
            return group_of([lead, *of], together)

        free = led(0.0, [group.first])
        backed = [] if free is None else steps_to_walls(own, items[group.first], free.offsets[1], walls)
        ways: list[tuple[float, Sequence[int], Sequence[Edge]]] = [(step, of, [edge]) for of in sets for step, edge in backed]
        ways += [(step, of, walls) for of in sets for step in STEPS]
        return [(moved, at) for step, of, at in ways if (moved := led(step, of)) is not None]

    def _rank(self, group: Group, first: Sequence[int]) -> tuple[int, int, int, float, int]:
        """Order of placing: who found nothing before, kitchen runs, what leans on none, large before small, what opens before what does not."""
        items, members = self.occupancy.items, group.members.tolist()
        again = min((first.index(i) for i in members if i in first), default=len(first))
        area = sum(items[i].area for i in members) * (OPENS if items[group.first].shape.opens else 1.0)
        run = group.first in {run[0] for run in self.runs}
        return again, 0 if run else 1, int(self.bonds[group.first] is not None), -area, group.first

    def _resolve_overlaps(self, whole: Sequence[Group], pairs: NDArray[np.bool_]) -> tuple[list[Group], list[int], Floats]:
        """Move each member that is in another of its group to the next place at its anchor where it is not: a chair out from under the table.

        Return the groups, the strays, who found none, and the poses (N, 4).
        """
        poses, apart, strays = self.poses.copy(), [], []
        for group in whole:
            kept = [group.first]
            for i in group.members[1:].tolist():
                if pairs[i, kept].any():
                    place = self._beside(i, group, poses)
                    if place is None:
                        strays.append(i)
                        continue
                    poses[i] = place
                kept.append(i)
            apart.append(group_of(kept, poses))
        return apart, strays, poses

    def _beside(self, i: int, group: Group, poses: Floats) -> Floats | None:
        """Return the nearest pose of a member at its anchor that is free of the other members, and place it there."""
        bond, occupancy = self.bonds[i], self.occupancy
        if bond is None or bond.over:
            return None
        candidates = self._at_anchor(i, bond, poses[i], poses[bond.anchor])
        others = np.zeros(len(occupancy.items), np.bool_)
        others[group.members[group.members != i]] = True
        best = occupancy.nearest(group_of([i], poses), *candidates, others)
        put(occupancy.world, i, poses[i] if best is None else best[0])
        return None if best is None else best[0]

    def _settle_group(self, group: Group) -> list[int]:
        """Place a group as one near its target; else its anchor alone. Return the members that are then still to be placed.

        A group that would keep a robot from something goes to another part of the room, or its anchor does without it where that is cheaper.
        """
        first, alone, occupancy = group.first, group_of([group.first], self.poses), self.occupancy
        if len(group.members) == 1:
            self._settle_one(first)
            return []
        near, rest = self._near(first), [int(i) for i in group.members[1:]]
        ways = [lambda: self._close(first, *near), lambda: self._anywhere(first)][: 1 + self.careful]
        place = self._find(group, ways)
        if place is None:
            self._settle_one(first, near)
            return rest
        if not place.unreached <= occupancy.unreached:
            lone = self._find(alone, ways)
            if lone is not None and lone.cost + ALONE * len(rest) < place.cost:
                occupancy.settle(alone, lone)
                return rest
        occupancy.settle(group, place)
        return []

    def _settle_one(self, i: int, near: Ranked | None = None) -> None:
        """Place one object: near its target or elsewhere at its anchor, which is `near`, else all over the room."""
        alone = group_of([i], self.poses)
        place = self._find(alone, [lambda: near or self._near(i), lambda: self._anywhere(i)])
        if place is not None:
            self.occupancy.settle(alone, place)

    def _put_at_walls(self, group: Group, walls: Sequence[Edge]) -> bool:
        """Let a group stand where its first member has its back at one of these walls; tell whether there is such a place."""
        first, occupancy = group.first, self.occupancy
        ranked = round_walls(occupancy.items[first], self.poses[first], walls, occupancy.site, occupancy.settings)
        place = self._find(group, [lambda: ranked])
        if place is not None:
            occupancy.settle(group, place)
        return place is not None

    def _find(self, group: Group, ways: Sequence[Callable[[], Ranked]]) -> Place | None:
        """Return the best place of a group by the first of several ways of looking for poses; by the next too where none is found, or it would keep a robot from what is worth more than SHIFT."""
        place: Place | None = None
        occupancy = self.occupancy
        for way in ways:
            poses, costs = way()
            if self.careful:
                place = occupancy.place(group, poses, costs, place)
            elif (best := occupancy.nearest(group, poses, costs)) is not None:
                place = Place(*best, occupancy.unreached)
            if place is not None and (place.cost <= SHIFT or place.unreached <= occupancy.unreached):
                break
        return place

    def _close(self, first: int, poses: Floats, costs: Floats) -> Ranked:
        """Return those of the poses near the target of its first member to which a group goes as one, of what stands free the same with a quarter turn too."""
        poses, costs = poses[costs <= SHIFT], costs[costs <= SHIFT]
        if self.occupancy.items[first].habit.wants or not len(poses):
            return poses, costs
        turns = [np.array([0.0, 0.0, 0.0, side * math.pi / 2]) for side in (1, -1)]
        poses = np.concatenate([poses, *(poses + turn for turn in turns)])
        costs = np.concatenate([costs, *(costs + self.occupancy.settings.turn_cost * math.pi / 2 for _ in turns)])
        return cheapest_first(poses, costs)

    def _anywhere(self, i: int) -> Ranked:
        """Return poses of an object all over the room; none for what belongs to a wall."""
        return everywhere(self.occupancy.items[i], self._target(i), self.occupancy.site, self.occupancy.settings)

    def _target(self, i: int) -> Floats:
        """Return the exact pose of an object; where its anchor has moved, it goes along."""
        bond, target = self.bonds[i], np.array(self.poses[i])
        if (
            bond is None or not bond.rigid or not self.occupancy.there[bond.anchor]
        ):  # its own wall is as good as any other across from there
            return target
        now = self.occupancy.poses[bond.anchor]
        if not np.allclose(now, self.poses[bond.anchor], atol=1e-3):
            x, y, yaw = at_anchor(now, bond.local)
            target[[0, 1, 3]] = x, y, wrap_yaw(float(yaw))
        return target

    def _at_anchor(self, i: int, bond: Bond, target: Floats, at: Floats) -> Ranked:
        """Return poses of a bound object at its anchor, which stands `at` (4,)."""
        items, occupancy = self.occupancy.items, self.occupancy
        return at_anchor_poses(items[i], target, items[bond.anchor], at, occupancy.site, self.learnt, occupancy.settings)

    def _near(self, i: int) -> Ranked:
        """Return poses near the target of an object, and at its anchor if it has one, the cheapest first."""
        occupancy, target = self.occupancy, self._target(i)
        there = np.flatnonzero(occupancy.there).tolist()
        neighbours = np.array([occupancy.outline(k) for k in there]).reshape(-1, 4, 2)
        poses, costs = near_by(occupancy.items[i], target, neighbours, occupancy.site, occupancy.settings)
        bond = self.bonds[i]
        if bond is None or bond.over or not occupancy.there[bond.anchor]:
            return poses, costs
        beside, cost = self._at_anchor(i, bond, target, occupancy.poses[bond.anchor])
        if not len(beside):
            return poses, costs
        poses, costs = np.concatenate([beside, poses]), np.concatenate([cost, np.where(costs > 0.05, costs + ALONE, costs)])
        return cheapest_first(poses, costs)
