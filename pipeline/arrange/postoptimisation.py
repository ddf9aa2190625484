"""Post-optimisation of one room: algorithm 2 and separation in turn, until both are content."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from pipeline.arrange.learnt_relations import LearntRelations
from pipeline.arrange.separate import Reject, Separated, Smaller, separate
from pipeline.arrange.settings import PostoptSettings
from pipeline.arrange.site import Site
from pipeline.arrange.walkable_area import control_walkable, free_ratio
from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement

PASSES = 4  # times that sizes are controlled again after objects have moved


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
