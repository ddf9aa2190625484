"""One draft of a room made good: walkable area, separation, and what is still wrong with it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from pipeline.arrange import LearntRelations, PostoptSettings, Site, post_optimise
from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement
from pipeline.floorplan.program.furniture import matching_categories
from pipeline.homes.furnish import Draft
from pipeline.homes.request import RoomJob
from pipeline.homes.rounding import round_placement
from pipeline.homes.violations import Violation
from pipeline.retrieval.index import AssetIndex
from pipeline.taxonomy import Taxonomy
from pipeline.verify import VerifySettings

MARGIN = 0.03  # by which the arranger's robot is wider than the judge's, whose raster lies differently [m]
KEPT = 0.6  # share of what was drafted that a room must keep
Reject = tuple[str, str, str]  # what, reason code, detail


@dataclass(frozen=True, slots=True)
class RoomResult:
    """A room as it could ship.

    `failure` is the reason code of what is not good enough, "" when all is well; `binding` tells that a stated wish is
    unmet, so that the home may not ship with it.
    """

    draft: Draft
    placements: tuple[Placement, ...]
    rejects: tuple[Reject, ...] = ()
    failure: str = ""
    detail: str = ""
    binding: bool = False
    free: float = 1.0  # measured free floor where a share is asked for, else 1
    openers: frozenset[str] = frozenset()  # assets of its objects that open
    unreached: frozenset[str] = frozenset()  # ids of objects that a robot cannot use where they stand

    def rank(self) -> tuple[bool, bool, int]:
        """Order results of one room: without failure first, then wishes met, then the number of objects."""
        return not self.failure, not self.binding, len(self.placements)

    def without(self, violating: Mapping[str, Violation], taxonomy: Taxonomy) -> RoomResult:
        """Return the result less the objects of these ids, judged again."""
        left = tuple(p for p in self.placements if p.object_id not in violating)
        failure, detail, binding = shortcoming(self.draft, left, taxonomy, self.openers, self.free, self.unreached)
        return replace(self, placements=left, failure=failure, detail=detail, binding=binding)


def shortcoming(
    draft: Draft,
    placements: tuple[Placement, ...],
    taxonomy: Taxonomy,
    openers: frozenset[str] = frozenset(),
    free: float = 1.0,
    unreached: frozenset[str] = frozenset(),
) -> tuple[str, str, bool]:
    """Return (reason code, detail, binding) of what a room lacks, ("", "", False) when nothing.

    `openers` are the assets of the draft that open, `free` is the room's free floor, `unreached` are the ids of what a robot cannot use.
    """
    job = draft.job
    unmet = _unmet(job, placements, openers, free)
    if unmet:
        return *unmet, True
    there, usable = {p.category for p in placements}, {p.category for p in placements if p.object_id not in unreached}
    for group in job.essentials(taxonomy):
        if not there.intersection(group):
            return "lacks_essential", f"none of {', '.join(group[:3])}", False
        if not usable.intersection(group):
            return "out_of_reach", f"{', '.join(sorted(there.intersection(group)))} cannot be used where it stands", False
    if len(placements) < KEPT * len(draft.placements):
        return "too_few_left", f"{len(placements)} of {len(draft.placements)} objects", False
    return "", "", False


def _unmet(job: RoomJob, placements: tuple[Placement, ...], openers: frozenset[str], free: float) -> tuple[str, str] | None:
    """Return (reason code, detail) of the first wish that is not met."""
    least, most = job.bounds
    if len(placements) < (least or 0) or (most is not None and len(placements) > most):
        return "count_missed", f"{len(placements)} objects, asked for {_bounds_in_words(least or 0, most)}"
    for wish in job.furniture.counts:
        have = sum(p.category in matching_categories(wish, job.room.type) for p in placements)
        if have < wish.min or (wish.max is not None and have > wish.max):
            return "category_missed", f"{have} {wish.category}, asked for {_bounds_in_words(wish.min, wish.max)}"
    opening = sum(p.asset_id in openers for p in placements)
    if opening < (job.furniture.openable or 0):
        return "openable_missed", f"{opening} objects open, asked for {job.furniture.openable}"
    if job.walkable is not None and free < job.walkable:
        return "walkable_missed", f"{free:.3f} of the floor is free, asked for {job.walkable:.3f}"
    return None


def finish(
    draft: Draft,
    assets: Mapping[str, Asset],
    index: AssetIndex,
    learnt: LearntRelations,
    settings: PostoptSettings,
    verify: VerifySettings,
    taxonomy: Taxonomy,
) -> RoomResult:
    """Take one draft through algorithm 2 (where a share of free floor is asked for) and separation."""
    job, placements = draft.job, draft.placements
    site = Site.of(job.plan, job.room_id, replace(verify.robot, radius=verify.robot.radius + MARGIN), verify.cell)
    rejects: list[Reject] = [("object", "no_asset", category) for category in draft.lost]
    smaller = index.favouring(draft.taste.style, wished=draft.taste.wished).smaller
    counted = job.bounds[0] is not None or bool(job.furniture.counts)
    arranged = post_optimise(site, placements, assets, learnt, settings, smaller, target=job.walkable, keep_count=counted)
    placements = tuple(round_placement(p) for p in arranged.placements)
    rejects += [("object", r.reason, f"{r.object_id}: {r.detail}") for r in arranged.rejects]
    free = arranged.ratio
    openers = frozenset(p.asset_id for p in placements if assets[p.asset_id].openable)
    failure, detail, binding = shortcoming(draft, placements, taxonomy, openers, free, arranged.unreached)
    return RoomResult(draft, placements, tuple(rejects), failure, detail, binding, free, openers, arranged.unreached)


def _bounds_in_words(least: int, most: int | None) -> str:
    """Return bounds in words."""
    if most is None:
        return f"at least {least}"
    return str(least) if least == most else f"at most {most}" if not least else f"{least} to {most}"
