"""Rooms of the test split as jobs for the factory."""

from collections.abc import Mapping, Sequence
from typing import TypeVar

from pipeline.entities.home import Home, Placement
from pipeline.errors import ContentError
from pipeline.homes.request import RoomJob
from pipeline.homes.rows import Row, plan_of

T = TypeVar("T")
FIRST = 10_000_000  # home index of the first room: keys that no dataset of homes will ever use


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


def spread(items: Sequence[T], count: int) -> list[T]:
    """Return `count` of the items, evenly spread over the list."""
    taken = min(count, len(items))
    return [items[i * len(items) // taken] for i in range(taken)]


def room_home(job: RoomJob, placements: Sequence[Placement]) -> Home:
    """Return the home that consists of this one room."""
    return Home(f"room_{job.index}", 0, job.index, "", "", job.plan, tuple(placements))
