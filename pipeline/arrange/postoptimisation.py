"""Post-optimisation of one room: walkable area control (algorithm 2 of the paper) and separation in turn, until both are content.

Of algorithm 2 sizes change, placements stay: while the ratio is below its target, the k largest objects are each exchanged for the next closest asset of their
category that is smaller. The paper measures (A_room - sum A_i) / A_room; here it is the floor that the robot really
gets to, since overlapping footprints and cut-off corners make the paper's figure say nothing of walking.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import islice

import numpy as np

from pipeline import taxonomy
from pipeline.arrange.learnt_relations import LearntRelations
from pipeline.arrange.separate import Reject, Separated, Smaller, separate
from pipeline.arrange.settings import PostoptSettings, WalkableSettings
from pipeline.arrange.site import Site
from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement
from pipeline.geometry.prisms import join_prisms, solid

PASSES = 4  # times that sizes are controlled again after objects have moved
Ratio = Callable[[Sequence[Placement]], float]


def post_optimise(
    site: Site,
    placements: Sequence[Placement],
    assets: Mapping[str, Asset],
    learnt: LearntRelations,
    settings: PostoptSettings,
    smaller: Smaller,
    *,
    target: float | None = None,
    keep_count: bool = False,
) -> tuple[Separated, float]:
    """Control the walkable ratio to `target` (where one is asked for) and separate what collides; return the room, and its ratio then, else 1.

    Sizes are controlled first, placements kept, as the paper has it; separating may cost free floor again, so both take
    turns.
    """
    ratio, reached = free_ratio(site, assets), 1.0
    current, rejects = placements, list[Reject]()
    result: Separated | None = None
    for _ in range(PASSES):
        if target is not None:
            controlled, exchanges = control_walkable(current, target, ratio, smaller, assets, settings.walkable)
            if result is not None and not exchanges:
                break
            current = controlled
        result = separate(site, current, assets, learnt, settings.separate, smaller, keep_count=keep_count)
        rejects += result.rejects
        current = result.placements
        if target is None:
            break
        reached = ratio(current)
        if reached >= target:
            break
    assert result is not None
    return replace(result, rejects=tuple(rejects)), reached


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


def _by_area(placements: Sequence[Placement]) -> list[int]:
    """Return the indices of valid objects, the largest first; ties in their order."""
    known = taxonomy.load().categories
    valid = [i for i, p in enumerate(placements) if p.category not in known or known[p.category].mount == "floor"]
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
