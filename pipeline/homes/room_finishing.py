"""One draft of a room made good: walkable area, separation, and what is still wrong with it."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass, replace

from pipeline import taxonomy
from pipeline.arrange import Site, post_optimise
from pipeline.entities.home import Placement
from pipeline.floorplan.program.furniture import arranged, matching_categories
from pipeline.homes.furnish import Draft, round_placement
from pipeline.homes.resources import Resources
from pipeline.homes.violations import Violation

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

    def without(self, violating: Mapping[str, Violation]) -> RoomResult:
        """Return the result less the objects of these ids, judged again."""
        return replace(self, placements=tuple(p for p in self.placements if p.object_id not in violating)).judged()

    def judged(self) -> RoomResult:
        """Return the result with what it lacks."""
        unmet = self._unmet()
        failure, detail = unmet or self._lacking()
        return replace(self, failure=failure, detail=detail, binding=unmet is not None)

    def _lacking(self) -> tuple[str, str]:
        """Return (reason code, detail) of what a room of its type should have, whatever was wished for; ("", "") when nothing is missing."""
        there, usable = {p.category for p in self.placements}, {p.category for p in self.placements if p.object_id not in self.unreached}
        for group in self.draft.job.essentials(taxonomy.load()):
            if not there.intersection(group):
                return "lacks_essential", f"none of {', '.join(group[:3])}"
            if not usable.intersection(group):
                return "out_of_reach", f"{', '.join(sorted(there.intersection(group)))} cannot be used where it stands"
        if len(self.placements) < KEPT * len(self.draft.placements):
            return "too_few_left", f"{len(self.placements)} of {len(self.draft.placements)} objects"
        return "", ""

    def _unmet(self) -> tuple[str, str] | None:
        """Return (reason code, detail) of the first wish that is not met."""
        job, placements = self.draft.job, self.placements
        least, most = job.bounds
        if len(placements) < (least or 0) or (most is not None and len(placements) > most):
            return "count_missed", f"{len(placements)} objects, asked for {bounds_in_words(least or 0, most)}"
        for wish in arranged(job.furniture):
            have = sum(p.category in matching_categories(wish, job.room.type) for p in placements)
            if have < wish.min or (wish.max is not None and have > wish.max):
                return "category_missed", f"{have} {wish.category}, asked for {bounds_in_words(wish.min, wish.max)}"
        opening = sum(p.asset_id in self.openers for p in placements)
        if opening < (job.furniture.openable or 0):
            return "openable_missed", f"{opening} objects open, asked for {job.furniture.openable}"
        if job.walkable is not None and self.free < job.walkable:
            return "walkable_missed", f"{self.free:.3f} of the floor is free, asked for {job.walkable:.3f}"
        return None


def finish(draft: Draft, resources: Resources) -> RoomResult:
    """Take one draft through algorithm 2 (where a share of free floor is asked for) and separation."""
    job, r, robot = draft.job, resources, resources.verify.robot
    site = Site.of(job.plan, job.room_id, replace(robot, radius=robot.radius + MARGIN), r.verify.cell)
    rejects: list[Reject] = [("object", "no_asset", category) for category in draft.lost]
    smaller = functools.partial(r.index.smaller, draft.taste)
    counted = job.bounds[0] is not None or bool(arranged(job.furniture))
    stands, free = post_optimise(site, draft.placements, r.library, r.learnt, r.postopt, smaller, target=job.walkable, keep_count=counted)
    placements = tuple(round_placement(p) for p in stands.placements)
    rejects += [("object", r.reason, f"{r.object_id}: {r.detail}") for r in stands.rejects]
    openers = frozenset(p.asset_id for p in placements if r.library[p.asset_id].openable)
    result = RoomResult(draft, placements, tuple(rejects), free=free, openers=openers, unreached=stands.unreached)
    return result.judged()


def bounds_in_words(least: int, most: int | None) -> str:
    """Return bounds in words."""
    if most is None:
        return f"at least {least}"
    if most == 0:
        return "none"
    return str(least) if least == most else f"{least} to {most}" if least else f"at most {most}"
