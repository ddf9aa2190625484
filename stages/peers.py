"""`sfgen peers`: the training tables as the cached rooms of ATISS and DiffuScene, on exactly our split."""

import sys
from pathlib import Path

from pipeline import tables
from pipeline.errors import UsageError
from pipeline.sources.atiss.labels import KINDS
from pipeline.sources.atiss.writer import rooms_with_objects, write_kind
from pipeline.sources.reasons import Row
from schemas import OBJECTS, REJECTS, ROOMS, SCENES
from schemas.table import Table


def main(root: Path, *, out: Path, filtered: bool) -> None:
    """Write bedrooms, living rooms, dining rooms and libraries into the new or empty folder `out`."""
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise UsageError(f"--out {out} is not an empty folder", "name a new one")
    here = root / "data" / "tables"
    splits = {row["scene_id"]: row["split"] for row in columns(here, SCENES, "scene_id", "split")}
    rooms = columns(here, ROOMS, "scene_id", "room_id", "type", "polygon", "source_id")
    objects = columns(here, OBJECTS, "scene_id", "room_id", "category", "position", "yaw", "size", "source_id")
    furnished_rooms = rooms_with_objects(rooms, objects, splits)
    rejects: list[Row] = []
    for kind in KINDS.values():
        summary = write_kind(out, furnished_rooms, kind, filtered=filtered)
        rejects += summary.rejects
        counts = ", ".join(f"{n} {split}" for split, n in summary.rooms.items())
        dropped = sum(row["reason"] == "peers_filter" for row in summary.rejects)
        sys.stdout.write(f"{out / kind.name}: {sum(summary.rooms.values())} rooms ({counts}), {dropped} left out\n")
    tables.write(out / "rejects.parquet", REJECTS, rejects)


def columns(folder: Path, table: Table, *names: str) -> list[Row]:
    """Return some columns of a training table as rows."""
    rows: list[Row] = tables.read_arrow(folder / f"{table.name}.parquet", table).select(list(names)).to_pylist()
    return rows
