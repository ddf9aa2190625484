"""First drafts as table rows and back, and on disk: what stage `sample` hands to stage `postopt`."""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from pipeline import tables
from pipeline.entities.asset import Asset
from pipeline.entities.home import Home
from pipeline.floorplan.program.floor_program import FloorProgram
from pipeline.homes.furnish import Draft, taste_of
from pipeline.homes.planning import PlannedHome, room_jobs
from pipeline.homes.request import Request
from pipeline.homes.resources import Resources
from pipeline.homes.rows import Row, homes_of, reject_row, unjudged_rows
from pipeline.shards import scene_id
from schemas import OBJECTS, OPENINGS, REJECTS, ROOMS, SCENES

DRAFT_TABLES = (SCENES, ROOMS, OPENINGS, OBJECTS, REJECTS)
NO_ASSET = "no_asset"


def draft_rows(drafts: Iterable[PlannedHome], seed: int, assets: Mapping[str, Asset]) -> dict[str, list[Row]]:
    """Return the rows of scenes, rooms, openings, objects and rejects of first drafts."""
    rows: dict[str, list[Row]] = {table.name: [] for table in DRAFT_TABLES}
    for home_draft in drafts:
        name = scene_id(seed, home_draft.request.index)
        placed = tuple(p for draft in home_draft.drafts for p in draft.placements)
        home = Home(name, seed, home_draft.request.index, home_draft.prompt, home_draft.program, home_draft.plan, placed)
        for table, own in unjudged_rows(home, {draft.job.room_id: draft for draft in home_draft.drafts}, assets).items():
            rows[table] += own
        for draft in home_draft.drafts:
            rows["rejects"] += [reject_row(name, draft.job.room_id, draft.job.attempt, ("object", NO_ASSET, lost)) for lost in draft.lost]
    return rows


def drafts_of(rows: Mapping[str, list[Row]], requests: Sequence[Request], resources: Resources) -> list[PlannedHome]:
    """Rebuild the first drafts of those of `requests` that have rows."""
    homes = {home.index: home for home in homes_of(rows)}
    lost: dict[str, list[str]] = {}
    for row in rows["rejects"]:
        if row["reason"] == NO_ASSET:
            lost.setdefault(row["where"], []).append(row["detail"])
    home_drafts = []
    for request in requests:
        if request.index not in homes:
            continue
        home = homes[request.index]
        program = FloorProgram.model_validate_json(home.program)
        served = {room.id: room.functions for room in program.rooms}
        plan = replace(home.plan, rooms=tuple(replace(room, functions=served.get(room.room_id, ())) for room in home.plan.rooms))
        jobs = room_jobs(resources, plan, request.index, 0, {room.id: room.furniture for room in program.rooms})
        taken = (tuple(lost.get(f"{home.scene_id}/{job.room_id}#0", ())) for job in jobs)
        drafts = tuple(
            Draft(job, home.in_room(job.room_id), none, taste_of(job, resources.seed, resources.index))
            for job, none in zip(jobs, taken, strict=True)
        )
        home_drafts.append(PlannedHome(request, home.prompt, home.program, plan, tuple(jobs), drafts))
    return home_drafts


def write_drafts(folder: Path, parts: Iterable[tuple[Sequence[Request], Mapping[str, Iterable[Row]]]]) -> None:
    """Write the tables of first drafts in the order of homes; `parts` are the rows of consecutive ones, which may come in any order."""
    waiting: dict[int, tuple[int, Mapping[str, Iterable[Row]]]] = {}
    following = 0
    with ExitStack() as files:
        streams = {t.name: files.enter_context(tables.stream(folder / f"{t.name}.parquet", t)) for t in DRAFT_TABLES}
        for requests, rows in parts:
            waiting[requests[0].index] = len(requests), rows
            while following in waiting:
                count, own = waiting.pop(following)
                following += count
                for name, stream in streams.items():
                    stream.add(own[name])


def read_drafts(folder: Path, seed: int, indices: Iterable[int]) -> dict[str, list[Row]]:
    """Read the rows of some homes by table. Raises ContentError as `tables.read_arrow` does."""
    scenes = {scene_id(seed, index) for index in indices}
    rows = {table.name: tables.read(folder / f"{table.name}.parquet", table, scenes) for table in DRAFT_TABLES[:-1]}
    rejects = tables.read(folder / f"{REJECTS.name}.parquet", REJECTS)
    return rows | {REJECTS.name: [row for row in rejects if row["where"].partition("/")[0] in scenes]}
