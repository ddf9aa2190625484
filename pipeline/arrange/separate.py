"""Separation: every object gets the nearest pose at which nothing touches, doors open and the floor hangs together.

Objects are placed one after the other, those that others lean on first, each at the cheapest of its candidate poses that
is free; whoever finds none is tried first in the next round, then as a smaller asset, then left out with a reason.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.candidates import candidates
from pipeline.arrange.crowd import Crowd
from pipeline.arrange.item import Item, make_item
from pipeline.arrange.settings import SeparateSettings
from pipeline.arrange.site import Site
from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement


class Found(Protocol):
    """What a search of the library returns."""

    asset_id: str
    distance: float
    scale: NDArray[np.float64]


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
    items = [make_item(p, assets, settings.access_depth) for p in placements]
    order = sorted(range(len(items)), key=lambda i: (*_rank(items[i]), i))
    best: dict[int, Item] = {}
    for _ in range(max(1, settings.rounds)):
        placed = _place(site, items, order, settings)
        if not best or _score(placed, items) < _score(best, items):
            best = placed
        lost = [i for i in order if i not in placed]
        if not lost:
            break
        order = lost + [i for i in order if i in placed]
    rejects: list[Reject] = []
    for i in (i for i in order if i not in best):
        shrunk = _shrunk(site, items[i], list(best.values()), assets, settings, smaller)
        if shrunk is not None:
            best[i] = shrunk
            was, now = items[i].placement.asset_id, shrunk.placement.asset_id
            rejects.append(Reject(items[i].placement.object_id, "shrunk_to_fit", f"{was} gave way to {now}"))
        else:
            rejects.append(Reject(items[i].placement.object_id, "unplaceable", f"no free place for {items[i].placement.category}"))
    kept = sorted(best)
    moved = tuple(float(np.linalg.norm(best[i].placement.position[:2] - items[i].wished[:2])) for i in kept)
    return Separated(tuple(best[i].placement for i in kept), tuple(rejects), moved, keep_count and len(kept) < len(items))


def _rank(item: Item) -> tuple[int, float]:
    """Order of placing: by what leans on what, large before small, what opens before what does not."""
    area = float(item.placement.size[0] * item.placement.size[1])
    return item.trait.order, -area * (1.5 if len(item.shape.access) else 1.0)


def _score(placed: Mapping[int, Item], items: Sequence[Item]) -> tuple[int, float]:
    """Return (objects left out, total displacement): less is better."""
    moved = sum(float(np.linalg.norm(item.placement.position[:2] - item.wished[:2])) for item in placed.values())
    return len(items) - len(placed), round(moved, 6)


def _place(site: Site, items: Sequence[Item], order: Sequence[int], settings: SeparateSettings) -> dict[int, Item]:
    """Place the items in the given order; what finds no pose is missing in the result."""
    crowd = Crowd(site, settings)
    placed: dict[int, Item] = {}
    for i in order:
        found = crowd.settle(items[i], *candidates(items[i], site, list(placed.values()), settings))
        if found is not None:
            placed[i] = found
    return placed


def _shrunk(
    site: Site, item: Item, others: Sequence[Item], assets: Mapping[str, Asset], settings: SeparateSettings, smaller: Smaller | None
) -> Item | None:
    """Try smaller assets of the category, each by at least a tenth, among what stands."""
    if smaller is None:
        return None
    crowd = Crowd(site, settings)
    for other in others:
        crowd.add(other)
    now = item.placement
    for _ in range(settings.shrink):
        match = smaller(now.asset_id, 0.9 * float(now.size[0] * now.size[1]))
        if match is None:
            return None
        size = assets[match.asset_id].size * match.scale
        now = replace(now, asset_id=match.asset_id, size=size, scale=match.scale, retrieval_distance=match.distance)
        made = replace(make_item(now, assets, settings.access_depth), wished=item.wished)
        found = crowd.settle(made, *candidates(made, site, others, settings))
        if found is not None:
            return found
    return None
