"""A furnished room as plain data: what relations are learnt from and metrics judge, whoever made it."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pyarrow.compute as pc

from pipeline import tables, taxonomy
from pipeline.arrays import Floats
from schemas import OBJECTS, OPENINGS, ROOMS, SCENES

COLUMNS = {
    ROOMS: ["scene_id", "room_id", "layout_type", "polygon"],
    OBJECTS: ["scene_id", "room_id", "category", "position", "yaw", "size", "support"],
    OPENINGS: ["scene_id", "kind", "rooms", "segment"],
}


class RoomOpening(NamedTuple):
    """An opening of the room: kind (door, window, ...) and clear width as a segment (2, 2) [m]."""

    kind: str
    segment: Floats


@dataclass(frozen=True, slots=True)
class Arrangement:
    """A room and its N things. `polygon` (n, 2): inner wall faces, counter-clockwise; position (N, 3), yaw (N,), size (N, 3) [m, rad]."""

    name: str
    layout_type: str
    polygon: Floats
    categories: tuple[str, ...]
    position: Floats
    yaw: Floats
    size: Floats
    openings: tuple[RoomOpening, ...] = ()

    @property
    def area(self) -> float:
        """Area of the polygon [m2]."""
        x, y = self.polygon.T
        return float(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def make_arrangement(
    name: str, layout_type: str, polygon: Any, things: Iterable[tuple[str, Any, float, Any]], openings: Iterable[RoomOpening] = ()
) -> Arrangement:
    """Return the arrangement of things (category, position (3,), yaw, size (3,))."""
    listed = list(things)
    position = np.array([p for _, p, _, _ in listed], float).reshape(-1, 3)
    size = np.array([s for _, _, _, s in listed], float).reshape(-1, 3)
    yaw = np.array([y for _, _, y, _ in listed], float)
    return Arrangement(
        name, layout_type, np.asarray(polygon, float), tuple(c for c, _, _, _ in listed), position, yaw, size, tuple(openings)
    )


def from_rows(
    rooms: Iterable[Mapping[str, Any]], objects: Iterable[Mapping[str, Any]], openings: Iterable[Mapping[str, Any]] = ()
) -> list[Arrangement]:
    """Return the rooms of table rows, in their order, things in theirs.

    Small things on furniture are left out: they follow what they lie on. A coffee table on a rug is furniture all the same.
    """
    small = taxonomy.load().small
    inside: dict[tuple[str, str], list[tuple[str, Any, float, Any]]] = {}
    for row in objects:
        if not (row["support"] and row["category"] in small):
            thing = (row["category"], row["position"], row["yaw"], row["size"])
            inside.setdefault((row["scene_id"], row["room_id"]), []).append(thing)
    holes: dict[tuple[str, str], list[RoomOpening]] = {}
    for row in openings:
        for room in row["rooms"]:
            holes.setdefault((row["scene_id"], room), []).append(RoomOpening(row["kind"], np.asarray(row["segment"], float)))
    arrangements = []
    for row in rooms:
        key = row["scene_id"], row["room_id"]
        name = f"{key[0]}/{key[1]}"
        arrangements.append(make_arrangement(name, row["layout_type"], row["polygon"], inside.get(key, ()), holes.get(key, ())))
    return arrangements


def rooms_of(folder: Path, split: str) -> list[Arrangement]:
    """Return the rooms of a split from the tables in a folder, in their order. Raises ContentError for a table that cannot be read."""
    scenes = tables.read_arrow(folder / f"{SCENES.name}.parquet", SCENES)
    known = scenes.filter(pc.equal(scenes["split"], split))["scene_id"]
    records = (tables.read_arrow(folder / f"{table.name}.parquet", table).select(names) for table, names in COLUMNS.items())
    return from_rows(*(part.filter(pc.is_in(part["scene_id"], known)).to_pylist() for part in records))
