"""Walkable area control: algorithm 2 of the paper. Sizes change, placements stay.

While the ratio is below its target, the k largest objects are each exchanged for the next closest asset of their
category that is smaller. The paper measures (A_room - sum A_i) / A_room; here it is the floor that the robot really
gets to, since overlapping footprints and cut-off corners make the paper's figure say nothing of walking.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import islice

import numpy as np

from pipeline import taxonomy
from pipeline.arrange.separate import Smaller
from pipeline.arrange.settings import WalkableSettings
from pipeline.arrange.site import Site
from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement
from pipeline.geometry.prisms import join_prisms, solid

Ratio = Callable[[Sequence[Placement]], float]


def control_walkable(
    placements: Sequence[Placement], target: float, ratio: Ratio, smaller: Smaller, assets: Mapping[str, Asset], settings: WalkableSettings
) -> tuple[list[Placement], int]:
    """Run algorithm 2 on one room, as long as its `ratio` is below `target`; return the placements, and how often one was exchanged.

    `smaller(asset_id, area)` returns the closest asset of the category whose footprint is below `area` [m2], or None: who has none is
    passed over. Objects that take no floor are not valid.
    """
    current, count = list(placements), 0
    for _ in range(settings.iterations):
        if ratio(current) >= target:
            break
        exchanges = ((i, _next_smaller(current[i], smaller, assets)) for i in _by_area(current))
        changed = list(islice(((i, replacement) for i, replacement in exchanges if replacement is not None), settings.top))
        if not changed:
            break
        for i, replacement in changed:
            current[i] = replacement
        count += len(changed)
    return current, count


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
