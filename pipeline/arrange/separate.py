"""Separation: relations are made exact, then every group gets the nearest pose at which nothing touches and the floor hangs together.

All objects are first taken to where they would stand exactly. Whoever is free there stays; the others move, a group as one
where that goes, else its anchor and then each member to another place at it. The floor is looked at once, at the end; a room that fails
is started over with an eye on the floor at every step, those first that found no place, later as smaller assets, or not at all.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.crowd import FINE, Crowd
from pipeline.arrange.exact import exact_poses
from pipeline.arrange.item import Item, make_item
from pipeline.arrange.lore import Lore
from pipeline.arrange.runs import lay_runs
from pipeline.arrange.settings import SeparateSettings
from pipeline.arrange.settling import Draft, settle_all
from pipeline.arrange.site import Site
from pipeline.arrange.walls import edges
from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement


class Found(Protocol):
    """What a search of the library returns."""

    @property
    def asset_id(self) -> str:
        """The asset."""

    @property
    def distance(self) -> float:
        """How far it is from what is replaced."""

    @property
    def scale(self) -> NDArray[np.float64]:
        """Factor (3,) on the asset's own size."""


ALOOF_ROUNDS = 3  # rounds that are spent on objects whose only fault is that their handles are out of reach
Smaller = Callable[[str, float], Found | None]  # (asset_id, area [m2]) -> the closest asset with a smaller footprint


@dataclass(frozen=True, slots=True)
class Reject:
    """An object that was left out or exchanged, with a reason code: `unplaceable` or `shrunk_to_fit`."""

    object_id: str
    reason: str
    detail: str


@dataclass(frozen=True, slots=True)
class Separated:
    """The outcome for one room: `placements` in the order they came, `rejects`, how far each moved [m], and `failed`.

    `failed` is set when an object had to be left out although the count was to be kept.
    """

    placements: tuple[Placement, ...]
    rejects: tuple[Reject, ...]
    moved: tuple[float, ...]
    failed: bool


def separate(
    site: Site,
    placements: Sequence[Placement],
    assets: Mapping[str, Asset],
    lore: Lore,
    settings: SeparateSettings | None = None,
    smaller: Smaller | None = None,
    *,
    keep_count: bool = False,
) -> Separated:
    """Separate the objects of one room; `lore` is what the training tables know of relations.

    `smaller` finds smaller assets for what does not fit; with `keep_count` a room that loses an object has failed.
    """
    settings = settings or SeparateSettings()
    asked = [make_item(p, assets, lore, settings.access_depth) for p in placements]
    items = list(asked)
    losses = [0] * len(items)
    first: list[int] = []
    best: dict[int, Placement] = {}
    least: tuple[float, float] | None = None
    for number in range(max(1, settings.rounds)):
        crowd, sound = _arranged(site, items, first, lore, settings, number)
        there = {i: items[i].at(crowd.poses[i]) for i in np.flatnonzero(crowd.there).tolist()}
        lost = [i for i in range(len(items)) if i not in there]
        score = _score(there, crowd.aloof, items)
        if (sound or number == settings.rounds - 1) and (least is None or score < least):
            best, least = there, score
        if sound and not lost and (not crowd.aloof or number >= ALOOF_ROUNDS):
            break
        for i in lost if number else ():
            losses[i] += 1
            # To be the first and still find no place is to be too large.
            if losses[i] > 1 and smaller is not None:
                items[i] = _exchanged(items[i], assets, lore, settings, smaller) or items[i]
        first = [*lost, *(i for i in crowd.aloof if i not in lost), *(i for i in first if i not in lost and i not in crowd.aloof)]
    return _separated(asked, best, keep_count=keep_count)


def _arranged(
    site: Site, items: list[Item], first: Sequence[int], lore: Lore, settings: SeparateSettings, number: int
) -> tuple[Crowd, bool]:
    """Arrange a room once; return who stands where, and whether the floor is sound: after round 0 it is looked at for each group."""
    walls = edges(site)
    runs, laid = lay_runs(items, walls, site)
    poses, bonds = exact_poses(items, site, walls, lore, settings, laid)
    crowd = Crowd(site, items, settings)
    settle_all(crowd, Draft(poses, bonds, runs, walls, lore), first, careful=number > 0, bulk=number <= 1)
    if number > 0:
        return crowd, True
    verdict = crowd.verdict(np.flatnonzero(crowd.there))
    return crowd, verdict == FINE


def _separated(asked: Sequence[Item], best: Mapping[int, Placement], *, keep_count: bool) -> Separated:
    rejects: list[Reject] = []
    for i, item in enumerate(asked):
        what = item.placement
        if i not in best:
            rejects.append(Reject(what.object_id, "unplaceable", f"no free place for {what.category}"))
        elif best[i].asset_id != what.asset_id:
            rejects.append(Reject(what.object_id, "shrunk_to_fit", f"{what.asset_id} gave way to {best[i].asset_id}"))
    kept = sorted(best)
    moved = tuple(float(np.linalg.norm(best[i].position[:2] - asked[i].wished[:2])) for i in kept)
    return Separated(tuple(best[i] for i in kept), tuple(rejects), moved, keep_count and len(kept) < len(asked))


def _score(placed: Mapping[int, Placement], aloof: Collection[int], items: Sequence[Item]) -> tuple[float, float]:
    """Return (what is left out or out of reach, total displacement): less is better. Beds weigh more than plants."""
    lost = sum(1.0 + float(np.prod(items[i].placement.size[:2])) for i in range(len(items)) if i not in placed)
    moved = sum(float(np.linalg.norm(p.position[:2] - items[i].wished[:2])) for i, p in placed.items())
    return round(lost + 0.5 * len(aloof), 6), round(moved, 6)


def _exchanged(item: Item, assets: Mapping[str, Asset], lore: Lore, settings: SeparateSettings, smaller: Smaller) -> Item | None:
    """Return the item as a smaller asset of its category, by at least a tenth, wished where it was; None if there is none."""
    now = item.placement
    match = smaller(now.asset_id, 0.9 * float(now.size[0] * now.size[1]))
    if match is None:
        return None
    size = assets[match.asset_id].size * match.scale
    now = replace(now, asset_id=match.asset_id, size=size, scale=match.scale, retrieval_distance=match.distance)
    return replace(make_item(now, assets, lore, settings.access_depth), wished=item.wished)
