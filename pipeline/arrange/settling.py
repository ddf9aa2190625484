"""The groups of a room find their places: first those that are free where they belong, then the rest, the largest first."""

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.bonds import KEPT, TURNED, Bond, at_anchor, nearest
from pipeline.arrange.candidates import ALONE, at_anchor_poses, cheapest_first, everywhere, hides, near_by, round_walls, steps_to_walls
from pipeline.arrange.edges import Edge
from pipeline.arrange.groups import Group, group_of, groups
from pipeline.arrange.item import Item, wrap_yaw
from pipeline.arrange.learnt_relations import LearntRelations
from pipeline.arrange.occupancy import Occupancy, Place
from pipeline.arrange.world import FREE, conflicts, put

Floats = NDArray[np.float64]
Led = tuple[Group, Sequence[Edge]]  # a group, and the walls at one of which its first member is to stand

SHIFT = 1.0  # a group goes no farther as one before it is tried without its members [m]
STEPS = (0.0, -0.3, 0.3, -0.6, 0.6, -0.9, 0.9)  # what leads a group is tried so much farther from it [m]
OPENS = 1.5  # what opens is placed as if it were so many times as large


@dataclass(frozen=True, slots=True)
class Draft:
    """The exact `poses` (N, 4) of a room's objects, their `bonds`, the kitchen `runs`, the room's walls, what is known of relations.

    `led` are those who did not come to stand at their anchors: the two are sought a place together.
    """

    poses: Floats
    bonds: Sequence[Bond | None]
    runs: Sequence[Sequence[int]]
    walls: Sequence[Edge]
    learnt: LearntRelations
    led: Collection[int] = ()

    def pose(self, i: int) -> Floats:
        """Return the exact pose of an object."""
        exact_pose: Floats = self.poses[i]
        return exact_pose


def settle_all(occupancy: Occupancy, draft: Draft, first: Sequence[int], *, careful: bool, bulk: bool) -> None:
    """Find a place for every group, those that hold one of `first` before the others; who finds none stands nowhere.

    `careful`: the floor must hang together with each group that is added. `bulk`: those that are free where they belong come first, all at once.
    """
    pairs, near, alone = conflicts(occupancy.world, draft.poses, occupancy.settings.touch)
    fitted_groups, strays, poses = _resolve_overlaps(occupancy, draft, groups(occupancy.items, draft.poses, draft.bonds, draft.runs), pairs)
    leading = _leading_groups(occupancy.items, draft, fitted_groups, poses)
    if not np.array_equal(poses, draft.poses):
        draft = replace(draft, poses=poses)
        pairs, near, alone = conflicts(occupancy.world, poses, occupancy.settings.touch)
    at_fault = (alone != FREE) | np.array([hides(i, p, draft.walls) for i, p in zip(occupancy.items, draft.poses, strict=True)], np.bool_)
    member = np.full(len(occupancy.items), -1)
    for number, group in enumerate(fitted_groups):
        member[group.members] = number
    clash = (pairs | near) & (member[:, None] != member[None]) & (member >= 0)[:, None] & (member >= 0)[None]
    order = sorted(range(len(fitted_groups)), key=lambda k: _rank(occupancy, fitted_groups[k], draft, first))
    bound = {i for led in leading.values() for group, _ in led for i in group.members.tolist()}
    stays = [k for k in order if bound.isdisjoint(fitted_groups[k].members.tolist())]
    free = [k for k in stays if bulk and not (at_fault[fitted_groups[k].members].any() or clash[fitted_groups[k].members].any())]
    for k in free:
        occupancy.stand(fitted_groups[k], draft.poses[fitted_groups[k].first])
    if careful and free and occupancy.out_of_reach() != frozenset():
        for k in free:
            occupancy.leave(fitted_groups[k])
        free = []
    runs = {run[0] for run in draft.runs}
    for k in (k for k in order if fitted_groups[k].first in runs and k not in free):
        strays += _settle_group(occupancy, draft, fitted_groups[k], careful=careful)
    for led in leading.values():
        any(_put_at_walls(occupancy, draft, *way, careful=careful) for way in led)
    for k in (k for k in order if k not in free and fitted_groups[k].first not in runs):
        left = [i for i in fitted_groups[k].members.tolist() if not occupancy.there[i]]
        whole = len(left) == len(fitted_groups[k].members)
        strays += _settle_group(occupancy, draft, fitted_groups[k], careful=careful) if whole else left
    for i in sorted(strays, key=lambda i: (-occupancy.items[i].area, i)):
        _settle_one(occupancy, draft, i, careful=careful)


def _leading_groups(items: Sequence[Item], draft: Draft, fitted_groups: Sequence[Group], poses: Floats) -> dict[int, list[Led]]:
    """Return, by the number of its anchor's group, as what and at which walls that group is sought a place for each who is `led`: what is to be tried first comes first.

    Who belongs to a wall across from the anchor leads it: a sofa goes where there is a wall for its screen. A screen that goes by the
    coffee table takes along the sofa, to which that belongs.
    """
    number = {i: k for k, group in enumerate(fitted_groups) for i in group.members.tolist()}
    across = {
        number[bond.anchor]: (i, bond)
        for i, bond in enumerate(draft.bonds)
        if bond is not None and not bond.rigid and items[i].habit.must and bond.anchor in number
    }
    leading: dict[int, list[Led]] = {}
    for i in sorted(draft.led):
        bond = draft.bonds[i]
        at = None if bond is None else number.get(bond.anchor)
        if bond is None or at is None or at in leading:
            continue
        group = fitted_groups[at]
        lead = across.get(at)
        if lead is not None and not items[group.first].habit.must and (i == lead[0] or bond.anchor == group.first):
            leading[at] = _led_by(*lead, group, draft, poses, items)
        elif bond.anchor == group.first and items[group.first].habit.wants:
            leading[at] = [(group, draft.walls)]
    return leading


def _led_by(lead: int, bond: Bond, group: Group, draft: Draft, poses: Floats, items: Sequence[Item]) -> list[Led]:
    """Return a group behind who stands across from one of its members, at each distance at which he may stand; then the same of its anchor and that member alone.

    Before all others come those whose anchor has its back at a wall then, where such things would rather be: nobody puts a sofa into mid-room before a free wall.
    """
    own, anchor = items[lead], items[bond.anchor]
    relation = draft.learnt.modes(anchor.placement.category, own.placement.category)
    way = bond.local[:2] / max(float(np.linalg.norm(bond.local[:2])), 1e-6)
    members, core = group.members.tolist(), list(dict.fromkeys((group.first, bond.anchor)))
    sets, together = [members, core] if len(core) < len(members) else [core], poses.copy()

    def led(step: float, of: Sequence[int]) -> Group | None:
        local = np.array([*(bond.local[:2] + step * way), bond.local[2]])
        near = None if relation is None else nearest(relation[0], np.zeros(3), anchor.half, local, own.half)
        if step != 0.0 and (near is None or near[0] > KEPT or near[1] > TURNED):
            return None
        together[lead, [0, 1, 3]] = at_anchor(poses[bond.anchor], local)
        return group_of([lead, *of], together)

    free = led(0.0, [group.first])
    backed = [] if free is None else steps_to_walls(own, items[group.first], free.offsets[1], draft.walls)
    ways: list[tuple[float, Sequence[int], Sequence[Edge]]] = [(step, of, [edge]) for of in sets for step, edge in backed]
    ways += [(step, of, draft.walls) for of in sets for step in STEPS]
    return [(moved, walls) for step, of, walls in ways if (moved := led(step, of)) is not None]


def _rank(occupancy: Occupancy, group: Group, draft: Draft, first: Sequence[int]) -> tuple[int, int, int, float, int]:
    """Order of placing: who found nothing before, kitchen runs, what leans on none, large before small, what opens before what does not."""
    lead = occupancy.items[group.first]
    waits = draft.bonds[group.first] is not None
    again = min((first.index(i) for i in group.members.tolist() if i in first), default=len(first))
    area = sum(occupancy.items[i].area for i in group.members.tolist())
    run = group.first in {run[0] for run in draft.runs}
    return again, 0 if run else 1, int(waits), -area * (OPENS if lead.shape.opens else 1.0), group.first


def _resolve_overlaps(
    occupancy: Occupancy, draft: Draft, whole: Sequence[Group], pairs: NDArray[np.bool_]
) -> tuple[list[Group], list[int], Floats]:
    """Move each member that is in another of its group to the next place at its anchor where it is not: a chair out from under the table.

    Return the groups, the strays, who found none, and the poses (N, 4).
    """
    poses, fitted_groups, strays = draft.poses.copy(), [], []
    for group in whole:
        kept = [group.first]
        for i in group.members[1:].tolist():
            if pairs[i, kept].any():
                place = _beside(occupancy, draft, i, group, poses)
                if place is None:
                    strays.append(i)
                    continue
                poses[i] = place
            kept.append(i)
        fitted_groups.append(group_of(kept, poses))
    return fitted_groups, strays, poses


def _beside(occupancy: Occupancy, draft: Draft, i: int, group: Group, poses: Floats) -> Floats | None:
    """Return the nearest pose of a member at its anchor that is free of the other members, and place it there."""
    bond = draft.bonds[i]
    if bond is None or bond.over:
        return None
    candidates, costs = at_anchor_poses(
        occupancy.items[i], poses[i], occupancy.items[bond.anchor], poses[bond.anchor], draft.walls, draft.learnt, occupancy.settings
    )
    others = np.zeros(len(occupancy.items), np.bool_)
    others[group.members[group.members != i]] = True
    best = occupancy.nearest(group_of([i], poses), candidates, costs, others)
    put(occupancy.world, i, poses[i] if best is None else best[0])
    return None if best is None else best[0]


def _settle_group(occupancy: Occupancy, draft: Draft, group: Group, *, careful: bool) -> list[int]:
    """Place a group as one near its target; else its anchor alone. Return the members that are then still to be placed.

    A group that would keep a robot from something goes to another part of the room, or its anchor does without it where that is cheaper.
    """
    first, alone = group.first, group_of([group.first], draft.poses)
    if len(group.members) == 1:
        _settle_one(occupancy, draft, first, careful=careful)
        return []
    near = _near(occupancy, draft, first)
    rest = [int(i) for i in group.members[1:]]
    ways = [lambda: _close(occupancy, first, *near), lambda: _anywhere(occupancy, draft, first)][: 1 + careful]
    place = _find(occupancy, group, ways, careful=careful)
    if place is None:
        _settle_one(occupancy, draft, first, near, careful=careful)
        return rest
    if not place.unreached <= occupancy.unreached:
        lone = _find(occupancy, alone, ways, careful=careful)
        if lone is not None and lone.cost + ALONE * len(rest) < place.cost:
            occupancy.settle(alone, lone)
            return rest
    occupancy.settle(group, place)
    return []


def _settle_one(occupancy: Occupancy, draft: Draft, i: int, near: tuple[Floats, Floats] | None = None, *, careful: bool) -> None:
    """Place one object: near its target or elsewhere at its anchor, which is `near`, else all over the room."""
    ways = [lambda: near or _near(occupancy, draft, i), lambda: _anywhere(occupancy, draft, i)]
    alone = group_of([i], draft.poses)
    place = _find(occupancy, alone, ways, careful=careful)
    if place is not None:
        occupancy.settle(alone, place)


def _put_at_walls(occupancy: Occupancy, draft: Draft, group: Group, walls: Sequence[Edge], *, careful: bool) -> bool:
    """Let a group stand where its first member has its back at one of these walls; tell whether there is such a place."""
    first = group.first
    poses, costs = round_walls(occupancy.items[first], draft.pose(first), walls, occupancy.site, occupancy.settings)
    place = _find(occupancy, group, [lambda: (poses, costs)], careful=careful)
    if place is not None:
        occupancy.settle(group, place)
    return place is not None


def _find(occupancy: Occupancy, group: Group, ways: Sequence[Callable[[], tuple[Floats, Floats]]], *, careful: bool) -> Place | None:
    """Return the best place of a group by the first of several ways of looking for poses; by the next too where none is found, or it would keep a robot from what is worth more than SHIFT."""
    place: Place | None = None
    for way in ways:
        poses, costs = way()
        if careful:
            place = occupancy.place(group, poses, costs, place)
        elif (best := occupancy.nearest(group, poses, costs)) is not None:
            place = Place(*best, occupancy.unreached)
        if place is not None and (place.cost <= SHIFT or place.unreached <= occupancy.unreached):
            break
    return place


def _close(occupancy: Occupancy, first: int, poses: Floats, costs: Floats) -> tuple[Floats, Floats]:
    """Return those of the poses near the target of its first member to which a group goes as one, of what stands free the same with a quarter turn too."""
    poses, costs = poses[costs <= SHIFT], costs[costs <= SHIFT]
    if occupancy.items[first].habit.wants or not len(poses):
        return poses, costs
    turns = [np.array([0.0, 0.0, 0.0, side * math.pi / 2]) for side in (1, -1)]
    poses = np.concatenate([poses, *(poses + turn for turn in turns)])
    costs = np.concatenate([costs, *(costs + occupancy.settings.turn_cost * math.pi / 2 for _ in turns)])
    return cheapest_first(poses, costs)


def _anywhere(occupancy: Occupancy, draft: Draft, i: int) -> tuple[Floats, Floats]:
    """Return poses of an object all over the room; none for what belongs to a wall."""
    return everywhere(occupancy.items[i], _target(occupancy, draft, i), draft.walls, occupancy.site, occupancy.settings)


def _target(occupancy: Occupancy, draft: Draft, i: int) -> Floats:
    """Return the exact pose of an object; where its anchor has moved, it goes along."""
    bond = draft.bonds[i]
    if bond is None or not occupancy.there[bond.anchor]:
        return draft.pose(i)
    now, then = occupancy.poses[bond.anchor], draft.poses[bond.anchor]
    if np.allclose(now, then, atol=1e-3):
        return draft.pose(i)
    if not bond.rigid:  # its own wall is as good as any other across from there
        return draft.pose(i)
    x, y, yaw = at_anchor(now, bond.local)
    return np.array([x, y, draft.poses[i, 2], wrap_yaw(float(yaw))])


def _near(occupancy: Occupancy, draft: Draft, i: int) -> tuple[Floats, Floats]:
    """Return poses near the target of an object, and at its anchor if it has one, the cheapest first."""
    item, target = occupancy.items[i], _target(occupancy, draft, i)
    there = np.flatnonzero(occupancy.there).tolist()
    neighbours = np.array([occupancy.outline(k) for k in there]).reshape(-1, 4, 2)
    poses, costs = near_by(item, target, draft.walls, neighbours, occupancy.site, occupancy.settings)
    bond = draft.bonds[i]
    if bond is None or bond.over or not occupancy.there[bond.anchor]:
        return poses, costs
    anchor = occupancy.items[bond.anchor]
    beside, cost = at_anchor_poses(item, target, anchor, occupancy.poses[bond.anchor], draft.walls, draft.learnt, occupancy.settings)
    if not len(beside):
        return poses, costs
    poses, costs = np.concatenate([beside, poses]), np.concatenate([cost, np.where(costs > 0.05, costs + ALONE, costs)])
    return cheapest_first(poses, costs)
