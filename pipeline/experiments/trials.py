"""Conditions of an experiment: rooms of the test split drafted, judged as they come, finished and judged again; as table rows."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from pipeline.diffusion.settings import Articulation
from pipeline.entities.home import Home, Placement
from pipeline.errors import ContentError
from pipeline.homes.factory import Factory
from pipeline.homes.furnish import Draft, draft_rooms
from pipeline.homes.life import RoomTries
from pipeline.homes.request import RoomJob
from pipeline.homes.room_finishing import RoomResult, finish
from pipeline.homes.rows import Row, object_row, plan_of, room_row
from pipeline.homes.violations import violations
from pipeline.verify import verify_home

FIRST = 10_000_000  # home index of the first room: keys that no dataset of homes will ever use


@dataclass(frozen=True, slots=True)
class Condition:
    """What is asked of each room, and what guides: nothing at all with articulation "none". `finished`: whether rooms are taken to the end."""

    name: str
    articulation: Articulation = "joints"
    count: int | None = None
    walkable: float | None = None
    finished: bool = True


@dataclass(frozen=True, slots=True)
class Trial:
    """Rows of rooms, objects and joints.

    `drafted`: all first attempts as they come from the layout model. `first`: the same after post-optimisation, whether
    they are good enough or not. `shipped`: the rooms that a home could ship with, after as many tries as a room has.
    """

    drafted: dict[str, list[Row]]
    first: dict[str, list[Row]]
    shipped: dict[str, list[Row]]


class Drafts:
    """What the layout model draws for rooms under one guidance, each draw made once.

    Draws are keyed by room, attempt and count alone, so conditions that differ only in what is done afterwards share them.
    """

    def __init__(self, factory: Factory, articulation: Articulation) -> None:
        sampler = factory.sampler.baseline()
        if articulation != "none":
            sampler = replace(factory.sampler, settings=replace(factory.sampler.settings, articulation=articulation))
        self._factory = replace(factory, sampler=sampler)
        self._made: dict[tuple[int, int, int, int | None], Draft] = {}

    def of(self, jobs: Sequence[RoomJob]) -> list[Draft]:
        """Return a draft of each job."""
        fresh = [job for job in jobs if _key(job) not in self._made]
        if fresh:
            self._made |= zip(map(_key, fresh), draft_rooms(self._factory, fresh), strict=True)
        return [replace(self._made[_key(job)], job=job) for job in jobs]


def _key(job: RoomJob) -> tuple[int, int, int, int | None]:
    return job.index, job.number, job.attempt, job.count


def trial(factory: Factory, jobs: Sequence[RoomJob], condition: Condition, drafts: Drafts) -> Trial:
    """Run one condition over rooms. Same rooms, same noise in every condition: only what is named differs."""
    asked = drafts.of([replace(job, count=condition.count, walkable=condition.walkable) for job in jobs])
    drafted = _rows(factory, [(draft, draft.placements) for draft in asked])
    if not condition.finished:
        return Trial(drafted, _rows(factory, []), _rows(factory, []))
    first, best = _finish_rooms(factory, asked, drafts)
    shipped = [(r.draft, r.placements) for r in best if not r.binding]
    return Trial(drafted, _rows(factory, [(r.draft, r.placements) for r in first]), _rows(factory, shipped))


def _finish_rooms(factory: Factory, asked: Sequence[Draft], drafts: Drafts) -> tuple[list[RoomResult], list[RoomResult]]:
    """Take rooms to the end: return the first try of each, and the best of as many tries as a room of a home has."""
    rooms = [RoomTries(draft.job) for draft in asked]
    first: dict[int, RoomResult] = {}
    best: dict[int, RoomResult] = {}
    pending = list(enumerate(asked))
    while pending:
        for i, draft in pending:
            result = finish(draft, factory)
            best[i] = rooms[i].keep(_drop_violations(factory, result))
            first.setdefault(i, best[i])
        failed = [i for i, _ in pending if best[i].failure and rooms[i].again(factory.shard.room_attempts)]
        pending = list(zip(failed, drafts.of([rooms[i].job for i in failed]), strict=True))
    return [first[i] for i in range(len(asked))], [best[i] for i in range(len(asked))]


def _drop_violations(factory: Factory, result: RoomResult) -> RoomResult:
    """Take out of a finished room what the judge faults, as the factory does with homes."""
    while True:
        home = room_home(result.draft.job, result.placements)
        violating = violations(home, verify_home(home, factory.library, factory.verify))
        if not violating:
            return result
        result = result.without(violating)


def _rows(factory: Factory, rooms: Sequence[tuple[Draft, Sequence[Placement]]]) -> dict[str, list[Row]]:
    rows: dict[str, list[Row]] = {"rooms": [], "objects": [], "joints": []}
    for draft, placements in rooms:
        job = draft.job
        home = room_home(job, placements)
        certificate = verify_home(home, factory.library, factory.verify)
        openable = [factory.library[p.asset_id].openable for p in placements]
        figures = {"objects": len(placements), "openable": sum(openable), "asked_objects": job.count, "walkable_target": job.walkable}
        sampled = sum(factory.library[p.asset_id].openable for p in draft.placements)
        row = room_row(home.scene_id, job.room, job.layout_type) | certificate.room_figures()[job.room_id]
        rows["rooms"].append(row | figures | {"openable_sampled": sampled})
        rows["objects"] += [object_row(home.scene_id, p, openable=o) for p, o in zip(placements, openable, strict=True)]
        rows["joints"] += certificate.joint_rows()
    return rows


def test_rooms(tables: Mapping[str, Sequence[Row]], split: str, layout_types: Sequence[str]) -> list[RoomJob]:
    """Return one job per room of the split, each with a plan of that room alone, in the order of the tables.

    Raises ContentError when the split holds no room of these types.
    """
    scenes = {row["scene_id"]: row for row in tables["scenes"] if row["split"] == split}
    openings: dict[str, list[Row]] = {}
    for row in tables["openings"]:
        openings.setdefault(row["scene_id"], []).append(row)
    jobs = []
    for number, room in enumerate(tables["rooms"]):
        scene = scenes.get(room["scene_id"])
        if scene is None or room["layout_type"] not in layout_types:
            continue
        own = [o for o in openings.get(room["scene_id"], []) if room["room_id"] in o["rooms"]]
        plan = plan_of({**scene, "entrance": room["room_id"]}, [{**room, "level": 0}], [{**o, "level": 0} for o in own])
        jobs.append(RoomJob(plan, room["room_id"], room["layout_type"], FIRST + number, 0))
    if not jobs:
        raise ContentError(f"the split {split!r} holds no furnished room", "raise corpus.houses in params.yaml")
    return jobs


def room_home(job: RoomJob, placements: Sequence[Placement]) -> Home:
    """Return the home that consists of this one room."""
    return Home(f"room_{job.index}", 0, job.index, "", "", job.plan, tuple(placements))
