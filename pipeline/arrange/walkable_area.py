"""Walkable area control: algorithm 2 of the paper. Sizes change, placements stay.

While the ratio is below its target, the k largest objects are each exchanged for the next closest asset of their
category that is smaller. The paper measures (A_room - sum A_i) / A_room; the default here is the floor that the robot
really gets to, since overlapping footprints and cut-off corners make the paper's figure say nothing of walking.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeline import taxonomy
from pipeline.arrange.separate import Smaller
from pipeline.arrange.settings import WalkableSettings
from pipeline.arrange.site import Site
from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement
from pipeline.geometry.prisms import join_prisms, solid

Ratio = Callable[[Sequence[Placement]], float]


@dataclass(frozen=True, slots=True)
class Exchange:
    """One replacement: in which iteration, what for what, and the footprints [m2]."""

    iteration: int
    object_id: str
    was: str
    now: str
    area_was: float
    area_now: float


@dataclass(frozen=True, slots=True)
class Controlled:
    """The outcome: `before` and `after` are the controlled ratio; `reached` whether it is at or above the target."""

    placements: tuple[Placement, ...]
    before: float
    after: float
    iterations: int
    exchanges: tuple[Exchange, ...]
    reached: bool


def control_walkable(
    placements: Sequence[Placement],
    target: float,
    ratio: Ratio,
    smaller: Smaller,
    assets: Mapping[str, Asset],
    settings: WalkableSettings | None = None,
) -> Controlled:
    """Run algorithm 2 on one room.

    `ratio` measures the room (see `free_ratio`, `paper_ratio`); `smaller(asset_id, area)` returns the closest asset of the
    category whose footprint is below `area` [m2], or None. Objects that take no floor are not valid.
    """
    settings = settings or WalkableSettings()
    current = list(placements)
    before = after = ratio(current)
    exchanges: list[Exchange] = []
    iteration = 0
    while after < target and iteration < settings.iterations:
        iteration += 1
        count = 0
        largest = _by_area(current)
        for i in largest if settings.skip_exhausted else largest[: settings.top]:
            replacement = _next_smaller(current[i], smaller, assets)
            if replacement is None:
                continue
            exchanges.append(
                Exchange(iteration, replacement.object_id, current[i].asset_id, replacement.asset_id, _area(current[i]), _area(replacement))
            )
            current[i] = replacement
            count += 1
            if count == settings.top:
                break
        if not count:
            break
        after = ratio(current)
    return Controlled(tuple(current), before, after, iteration, tuple(exchanges), after >= target)


def paper_ratio(area: float, elevation: float) -> Ratio:
    """Return the paper's ratio of a room of `area` [m2]: footprints are summed over what stands on the floor."""

    def ratio(placements: Sequence[Placement]) -> float:
        return (area - sum(_area(p) for p in placements if _stands(p, elevation))) / area

    return ratio


def free_ratio(site: Site, assets: Mapping[str, Asset]) -> Ratio:
    """Return the true ratio of a room: connected floor that the robot covers, coming from the doors, over all floor."""

    def ratio(placements: Sequence[Placement]) -> float:
        bodies = [solid(assets[p.asset_id]).rest.placed(p.position, p.yaw, p.scale) for p in placements]
        return site.free_share(site.free_space(join_prisms(bodies)))

    return ratio


def _area(placement: Placement) -> float:
    return float(placement.size[0] * placement.size[1])


def _mount(placement: Placement) -> str:
    known = taxonomy.load().categories.get(placement.category)
    return known.mount if known is not None else "floor"


def _stands(placement: Placement, elevation: float) -> bool:
    return _mount(placement) != "ceiling" and float(placement.position[2]) - elevation < 0.1


def _by_area(placements: Sequence[Placement]) -> list[int]:
    """Return the indices of valid objects, the largest first; ties in their order."""
    valid = [i for i, p in enumerate(placements) if _mount(p) == "floor"]
    return sorted(valid, key=lambda i: -round(_area(placements[i]), 9))


def _next_smaller(placement: Placement, smaller: Smaller, assets: Mapping[str, Asset]) -> Placement | None:
    """Return the placement with the next smaller asset, its bottom centre and yaw kept; None if there is none."""
    match = smaller(placement.asset_id, _area(placement))
    if match is None:
        return None
    size = np.round(assets[match.asset_id].size * match.scale, 4)
    if float(size[0] * size[1]) >= _area(placement) - 1e-9:
        return None
    return replace(placement, asset_id=match.asset_id, size=size, scale=match.scale, retrieval_distance=match.distance)
