"""Post-optimisation of one room: algorithm 2 and separation in turn, until both are content."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from pipeline.arrange.learnt_relations import LearntRelations
from pipeline.arrange.separate import Reject, Separated, Smaller, separate
from pipeline.arrange.settings import PostoptSettings
from pipeline.arrange.site import Site
from pipeline.arrange.walkable_area import Controlled, control_walkable, free_ratio, paper_ratio
from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement

PASSES = 4  # times that sizes are controlled again after objects have moved


@dataclass(frozen=True, slots=True)
class Arranged:
    """A finished room.

    `ratio_sampled` is the controlled ratio of what the layout model placed, `ratio` that of `placements`, both 1 where none is asked for;
    `exchanges` counts the replacements of algorithm 2; `unreached` are the ids of what a robot cannot use where it stands. `failed`: a count that was to be kept is not, or the target is not reached.
    """

    placements: tuple[Placement, ...]
    rejects: tuple[Reject, ...]
    moved: tuple[float, ...]
    ratio_sampled: float
    ratio: float
    exchanges: int
    unreached: frozenset[str]
    failed: str


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
) -> Arranged:
    """Control the walkable ratio to `target` (where one is asked for) and separate what collides.

    Sizes are controlled first, placements kept, as the paper has it; separating may cost free floor again, so both take
    turns. `failed` is "" or a reason code: `count_missed`, `walkable_missed`.
    """
    area = site.area
    ratio = free_ratio(site, assets) if settings.walkable.ratio == "free" else paper_ratio(area, site.elevation)
    sampled = ratio(placements) if target is not None else 1.0
    current: Sequence[Placement] = placements
    rejects: list[Reject] = []
    exchanges = 0
    unreached: frozenset[str] = frozenset()
    result: Separated | None = None
    reached = sampled
    for _ in range(PASSES):
        if target is not None:
            controlled: Controlled = control_walkable(current, target, ratio, smaller, assets, settings.walkable)
            if result is not None and not controlled.exchanges:
                break
            exchanges += len(controlled.exchanges)
            current = controlled.placements
        result = separate(site, current, assets, learnt, settings.separate, smaller, keep_count=keep_count)
        rejects += result.rejects
        current, unreached = result.placements, result.unreached
        if target is None:
            break
        reached = ratio(current)
        if reached >= target:
            break
    kept = {p.object_id: p for p in current}
    moved = tuple(_distance(p, kept[p.object_id]) for p in placements if p.object_id in kept)
    failed = "count_missed" if keep_count and len(kept) < len(placements) else ""
    if not failed and target is not None and reached < target:
        failed = "walkable_missed"
    return Arranged(tuple(current), tuple(rejects), moved, sampled, reached, exchanges, unreached, failed)


def _distance(a: Placement, b: Placement) -> float:
    return float(((a.position[:2] - b.position[:2]) ** 2).sum() ** 0.5)
