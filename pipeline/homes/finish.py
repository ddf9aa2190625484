"""One draft of a room made good: walkable area, separation, and what is still wrong with it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from pipeline.arrange import PostoptSettings, Site, post_optimise
from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement
from pipeline.homes.furnish import Draft
from pipeline.homes.guilt import Guilt
from pipeline.homes.rounding import rounded
from pipeline.retrieval.index import AssetIndex
from pipeline.taxonomy import Taxonomy
from pipeline.verify import Robot

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

    def rank(self) -> tuple[bool, bool, int]:
        """Order results of one room: without failure first, then wishes met, then the number of objects."""
        return not self.failure, not self.binding, len(self.placements)

    def without(self, guilty: Mapping[str, Guilt], taxonomy: Taxonomy) -> RoomResult:
        """Return the result less the objects of these ids, judged again."""
        left = tuple(p for p in self.placements if p.object_id not in guilty)
        failure, detail, binding = shortcoming(self.draft, left, taxonomy, self.free)
        return replace(self, placements=left, failure=failure, detail=detail, binding=binding)


def shortcoming(draft: Draft, placements: tuple[Placement, ...], taxonomy: Taxonomy, free: float = 1.0) -> tuple[str, str, bool]:
    """Return (reason code, detail, binding) of what a room lacks, ("", "", False) when nothing; `free` is its free floor."""
    job = draft.job
    if job.count is not None and len(placements) != job.count:
        return "count_missed", f"{len(placements)} objects, asked for {job.count}", True
    if job.walkable is not None and free < job.walkable:
        return "walkable_missed", f"{free:.3f} of the floor is free, asked for {job.walkable:.3f}", True
    there = {p.category for p in placements}
    # A stated number of objects may be too small for what the room type would have.
    for group in taxonomy.essentials.get(job.layout_type, ()) if job.count is None else ():
        if not there.intersection(group):
            return "lacks_essential", f"none of {', '.join(group[:3])}", False
    if len(placements) < KEPT * len(draft.placements):
        return "too_few_left", f"{len(placements)} of {len(draft.placements)} objects", False
    return "", "", False


def finish(
    draft: Draft, assets: Mapping[str, Asset], index: AssetIndex, settings: PostoptSettings, robot: Robot, taxonomy: Taxonomy
) -> RoomResult:
    """Take one draft through algorithm 2 (where a share of free floor is asked for) and separation."""
    job, placements = draft.job, draft.placements
    site = Site.of(job.plan, job.room_id, radius=robot.radius + MARGIN, step=robot.step, height=robot.height)
    rejects: list[Reject] = [("object", "no_asset", category) for category in draft.lost]
    arranged = post_optimise(site, placements, assets, settings, index.smaller, target=job.walkable, keep_count=job.count is not None)
    placements = tuple(rounded(p) for p in arranged.placements)
    rejects += [("object", r.reason, f"{r.object_id}: {r.detail}") for r in arranged.rejects]
    free = arranged.ratio
    failure, detail, binding = shortcoming(draft, placements, taxonomy, free)
    return RoomResult(draft, placements, tuple(rejects), failure, detail, binding, free)
