"""Separation: every object gets the nearest pose at which nothing touches, doors open and the floor hangs together.

Objects are placed one after the other, those that others lean on first, each at the cheapest of its candidate poses that
is free; whoever finds none is tried first in the next round, then as a smaller asset, then left out with a reason.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.candidates import candidates
from pipeline.arrange.crowd import ALOOF, Crowd
from pipeline.arrange.item import Item, make_item
from pipeline.arrange.settings import SeparateSettings
from pipeline.arrange.site import Site
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


ALOOF_ROUNDS = 2  # rounds that are spent on objects whose only fault is that their handles are out of reach
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
    settings: SeparateSettings | None = None,
    smaller: Smaller | None = None,
    *,
    keep_count: bool = False,
) -> Separated:
    """Separate the objects of one room.

    `smaller` finds smaller assets for what does not fit; with `keep_count` a room that loses an object has failed.
    """
    settings = settings or SeparateSettings()
    asked = [make_item(p, assets, settings.access_depth) for p in placements]
    items = list(asked)
    order = sorted(range(len(items)), key=lambda i: (*_rank(items[i]), i))
    losses = [0] * len(items)
    best: dict[int, Item] = {}
    least: tuple[float, float] | None = None
    for number in range(max(1, settings.rounds)):
        placed, aloof = _place(site, items, order, settings)
        score = _score(placed, aloof, items)
        if least is None or score < least:
            best, least = placed, score
        lost = [i for i in order if i not in placed]
        if not lost and (not aloof or number >= ALOOF_ROUNDS):
            break
        for i in lost:
            losses[i] += 1
            # To be the first and still find no place is to be too large.
            if losses[i] > 1 and smaller is not None:
                items[i] = _exchanged(items[i], assets, settings, smaller) or items[i]
        first = [i for i in order if i not in placed or i in aloof]
        order = first + [i for i in order if i not in first]
    rejects: list[Reject] = []
    for i, item in enumerate(asked):
        what = item.placement
        if i not in best:
            rejects.append(Reject(what.object_id, "unplaceable", f"no free place for {what.category}"))
        elif best[i].placement.asset_id != what.asset_id:
            rejects.append(Reject(what.object_id, "shrunk_to_fit", f"{what.asset_id} gave way to {best[i].placement.asset_id}"))
    kept = sorted(best)
    moved = tuple(float(np.linalg.norm(best[i].placement.position[:2] - asked[i].wished[:2])) for i in kept)
    return Separated(tuple(best[i].placement for i in kept), tuple(rejects), moved, keep_count and len(kept) < len(asked))


def _rank(item: Item) -> tuple[int, float]:
    """Order of placing: by what leans on what, large before small, what opens before what does not."""
    area = float(item.placement.size[0] * item.placement.size[1])
    return item.trait.order, -area * (1.5 if item.shape.opens else 1.0)


def _score(placed: Mapping[int, Item], aloof: Collection[int], items: Sequence[Item]) -> tuple[float, float]:
    """Return (what is left out or out of reach, total displacement): less is better. Beds weigh more than plants."""
    lost = sum(1.0 + float(np.prod(items[i].placement.size[:2])) for i in range(len(items)) if i not in placed)
    moved = sum(float(np.linalg.norm(item.placement.position[:2] - item.wished[:2])) for item in placed.values())
    return round(lost + 0.5 * len(aloof), 6), round(moved, 6)


def _place(site: Site, items: Sequence[Item], order: Sequence[int], settings: SeparateSettings) -> tuple[dict[int, Item], set[int]]:
    """Place the items in the given order; what finds no pose is missing. Also return those whose handles nobody reaches."""
    crowd = Crowd(site, settings)
    placed: dict[int, Item] = {}
    aloof: set[int] = set()
    for i in order:
        found, verdict = crowd.settle(items[i], *candidates(items[i], site, list(placed.values()), settings))
        if found is not None:
            placed[i] = found
        if verdict == ALOOF:
            aloof.add(i)
    return placed, aloof


def _exchanged(item: Item, assets: Mapping[str, Asset], settings: SeparateSettings, smaller: Smaller) -> Item | None:
    """Return the item as a smaller asset of its category, by at least a tenth, wished where it was; None if there is none."""
    now = item.placement
    match = smaller(now.asset_id, 0.9 * float(now.size[0] * now.size[1]))
    if match is None:
        return None
    size = assets[match.asset_id].size * match.scale
    now = replace(now, asset_id=match.asset_id, size=size, scale=match.scale, retrieval_distance=match.distance)
    return replace(make_item(now, assets, settings.access_depth), wished=item.wished)
