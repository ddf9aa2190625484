"""Separation: relations are made exact, then every group gets the nearest pose at which nothing touches and the floor hangs together.

All objects are first taken to where they would stand exactly. Whoever is free there stays; the others move, a group as one
where that goes, else its anchor and then each member to another place at it. The floor is looked at once, at the end; a room that fails
is started over with an eye on the floor at every step, those first that found no place, later as smaller assets, or not at all.
"""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from pipeline.arrange.bonds import REACH, Bond, broken
from pipeline.arrange.item import Item, make_item
from pipeline.arrange.learnt_relations import LearntRelations
from pipeline.arrange.occupancy import Occupancy
from pipeline.arrange.runs import bare_units, base_units, lay_runs, stray_units
from pipeline.arrange.settings import SeparateSettings
from pipeline.arrange.settling import Settling
from pipeline.arrange.site import Site
from pipeline.arrange.snapping import exact_poses
from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement
from pipeline.retrieval.index import Match

BROKEN = 0.6  # a broken relation, beside 1 for its object if that were lost
UNREACHED = 0.3  # what a robot cannot use at its anchor, beside 1 for a lost object of no size; elsewhere it is as good as lost
ALWAYS = 0.95  # share of the training examples from which on nothing else is known of a category than that it is there
HIDDEN_ROUNDS = 3  # rounds that are spent on what a robot cannot open and no relation holds there
Smaller = Callable[[str, float], Match | None]  # (asset_id, area [m2]) -> the closest asset with a smaller footprint


@dataclass(frozen=True, slots=True)
class Reject:
    """An object that was left out or exchanged, with a reason code: `unplaceable` or `shrunk_to_fit`."""

    object_id: str
    reason: str
    detail: str


@dataclass(frozen=True, slots=True)
class Separated:
    """The outcome for one room: `placements` in the order they came, `rejects`, and `unreached`, the ids of what a robot cannot use where it stands."""

    placements: tuple[Placement, ...]
    rejects: tuple[Reject, ...]
    unreached: frozenset[str]


def separate(
    site: Site,
    placements: Sequence[Placement],
    assets: Mapping[str, Asset],
    learnt: LearntRelations,
    settings: SeparateSettings | None = None,
    smaller: Smaller | None = None,
    *,
    keep_count: bool = False,
) -> Separated:
    """Separate the objects of one room; `learnt` is what the training tables know of relations.

    `smaller` finds smaller assets for what does not fit; with `keep_count` nothing that has a place is left out for standing astray.
    """
    settings = settings or SeparateSettings()
    make = partial(make_item, assets=assets, learnt=learnt, access_depth=settings.access_depth)
    shrink = partial(_smaller_item, assets=assets, make=make, smaller=smaller or (lambda _asset_id, _area: None))
    items = [make(p) for p in placements]
    distances = learnt.distances([item.placement.category for item in items])
    first, losses = list[int](), [0] * len(items)
    led = unreached = frozenset[int]()
    best, astray = dict[int, Placement](), set[int]()
    least: tuple[float, float] | None = None
    for number in range(max(1, settings.rounds)):
        runs, laid = lay_runs(items, site)
        poses, bonds = exact_poses(items, site, learnt, settings, laid)
        occupancy = Occupancy(site, items, settings, distances, [i for i, bond in enumerate(bonds) if bond is not None])
        Settling(occupancy, poses, bonds, runs, learnt, led, careful=number > 0).settle_all(first, bulk=number <= 1)
        sound = number > 0 or _look_at_floor(occupancy)  # later it has been looked at for each group
        apart = broken(bonds, items, occupancy.poses, occupancy.there, learnt)
        there = {i: items[i].at(occupancy.poses[i]) for i in np.flatnonzero(occupancy.there).tolist()}
        lost = [i for i in range(len(items)) if i not in there]
        strays = stray_units(runs, items, occupancy.poses, occupancy.there)
        bare = bare_units(items, occupancy.poses, occupancy.there, site)
        faults = BROKEN * _weight(items, (*apart, *strays)) + _weight(items, bare) + _useless(items, bonds, occupancy.unreached)
        score = _score(there, items, faults)
        if (sound or number == settings.rounds - 1) and (least is None or score < least):
            best, least, unreached = there, score, occupancy.unreached
            far = broken(bonds, items, occupancy.poses, occupancy.there, learnt, REACH)
            astray = {*bare, *(i for i in far if _only_there(items, bonds[i], i, learnt))}
        hidden = [i for i in occupancy.unreached if number == 0 or (bonds[i] is None and number < HIDDEN_ROUNDS)]
        if sound and not (lost or apart or hidden or strays or bare):
            break
        led = frozenset(apart)
        if strays or bare:  # no order of placing makes a wall longer: its cabinets get narrower
            _exchange(items, [*bare, *(i for i in base_units(items) if strays and items[i].habit.kind == "kitchen")], shrink)
        if number and smaller is not None:
            for i in (*lost, *apart):
                losses[i] += 1
            # To be the first and still find no place, or none at the anchor, is to be too large.
            crowded = [i for i in (*lost, *apart) if losses[i] > (i in lost)]
            changed = _exchange(items, crowded, shrink)
            if not (lost or changed or hidden or strays or bare):
                break
        waiting = [i for i in lost if items[i].mount != "wall"]  # a wall unit in the way of the run below it waits
        unseen = [i for i in hidden if number and i not in lost]
        first = [*waiting, *sorted(led), *unseen, *(i for i in first if i not in (*lost, *led, *hidden))]
    for i in () if keep_count else astray:
        del best[i]
    return _outcome(placements, best, unreached)


def _look_at_floor(occupancy: Occupancy) -> bool:
    """Note whom a robot does not get to; tell whether the floor hangs together."""
    missed = occupancy.out_of_reach()
    occupancy.unreached = missed or frozenset()
    return missed is not None


def _only_there(items: Sequence[Item], bond: Bond | None, i: int, learnt: LearntRelations) -> bool:
    """Whether things like item `i` stand nowhere else than beside their anchors: one at the foot of its bed is better left out."""
    if bond is None or not bond.rigid:
        return False
    pair = learnt.known.pair(items[bond.anchor].placement.category, items[i].placement.category)
    return pair is not None and pair.share >= ALWAYS


def _outcome(asked: Sequence[Placement], best: Mapping[int, Placement], unreached: Collection[int]) -> Separated:
    rejects: list[Reject] = []
    for i, what in enumerate(asked):
        if i not in best:
            rejects.append(Reject(what.object_id, "unplaceable", f"no free place for {what.category}"))
        elif best[i].asset_id != what.asset_id:
            rejects.append(Reject(what.object_id, "shrunk_to_fit", f"{what.asset_id} gave way to {best[i].asset_id}"))
    kept = sorted(best)
    return Separated(tuple(best[i] for i in kept), tuple(rejects), frozenset(best[i].object_id for i in kept if i in unreached))


def _weight(items: Sequence[Item], which: Iterable[int]) -> float:
    """Return what objects weigh against each other, be they lost or astray: beds more than plants, a TV stand more than a chair."""
    return sum(1.0 + float(np.prod(items[i].placement.size[:2])) for i in which)


def _useless(items: Sequence[Item], bonds: Sequence[Bond | None], unreached: Collection[int]) -> float:
    """Return what counts for those whom a robot cannot use: UNREACHED at an anchor; elsewhere they are as good as lost."""
    alone = [i for i in unreached if bonds[i] is None]
    return _weight(items, alone) + UNREACHED * (len(unreached) - len(alone))


def _score(placed: Mapping[int, Placement], items: Sequence[Item], faults: float) -> tuple[float, float]:
    """Return (faults and what is left out, total displacement): less is better."""
    lost = _weight(items, (i for i in range(len(items)) if i not in placed))
    moved = sum(float(np.linalg.norm(p.position[:2] - items[i].wished[:2])) for i, p in placed.items())
    return round(lost + faults, 6), round(moved, 6)


def _exchange(items: list[Item], crowded: Sequence[int], shrink: Callable[[Item], Item | None]) -> bool:
    """Exchange objects for smaller assets, and with each all that are of one model with it; tell whether any was."""
    changed = False
    for name in sorted({items[i].placement.asset_id for i in crowded}):
        for i in [i for i, item in enumerate(items) if item.placement.asset_id == name]:
            if (smaller := shrink(items[i])) is not None:
                items[i], changed = smaller, True
    return changed


def _smaller_item(item: Item, assets: Mapping[str, Asset], make: Callable[[Placement], Item], smaller: Smaller) -> Item | None:
    """Return the item as a smaller asset of its category, by at least a tenth, wished where it was; None if there is none."""
    now = item.placement
    match = smaller(now.asset_id, 0.9 * float(now.size[0] * now.size[1]))
    if match is None:
        return None
    size = assets[match.asset_id].size * match.scale
    return replace(
        make(replace(now, asset_id=match.asset_id, size=size, scale=match.scale, retrieval_distance=match.distance)), wished=item.wished
    )
