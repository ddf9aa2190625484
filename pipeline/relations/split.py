"""The rooms of one split, as the training tables hold them."""

from pathlib import Path

import pyarrow.compute as pc

from pipeline import tables
from pipeline.relations.arrangement import Arrangement, from_rows
from schemas import OBJECTS, OPENINGS, ROOMS, SCENES

COLUMNS = {
    ROOMS.name: ["scene_id", "room_id", "layout_type", "polygon"],
    OBJECTS.name: ["scene_id", "room_id", "category", "position", "yaw", "size", "support"],
    OPENINGS.name: ["scene_id", "kind", "rooms", "segment"],
}


def rooms_of(folder: Path, split: str) -> list[Arrangement]:
    """Return the rooms of a split from the tables in a folder, in their order. Raises ContentError for a table that cannot be read."""
    scenes = tables.read_arrow(folder / f"{SCENES.name}.parquet", SCENES)
    known = scenes.filter(pc.equal(scenes["split"], split))["scene_id"]
    rows = {}
    for table in (ROOMS, OBJECTS, OPENINGS):
        records = tables.read_arrow(folder / f"{table.name}.parquet", table).select(COLUMNS[table.name])
        rows[table.name] = records.filter(pc.is_in(records["scene_id"], known)).to_pylist()
    return from_rows(rows[ROOMS.name], rows[OBJECTS.name], rows[OPENINGS.name])
