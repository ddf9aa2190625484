"""The tables of first drafts on disk: part by part while a run is at work, so that a killed one goes on and memory stays flat; then one table each.

Each part is a row group of the tables, in the order of homes, so that who finishes some homes reads their rows only.
"""

import json
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq

from pipeline import tables
from pipeline.manifest import replacing, write_json
from pipeline.shards import scene_id
from schemas import OBJECTS, OPENINGS, REJECTS, ROOMS, SCENES

Row = dict[str, Any]
DRAFT_TABLES = (SCENES, ROOMS, OPENINGS, OBJECTS, REJECTS)
PARTS, SECONDS = ".parts", "seconds.json"


class DraftStore:
    """Drafts that lie in `folder`, being made: parts of anything else than `made_of` (a digest) are removed."""

    def __init__(self, folder: Path, made_of: str) -> None:
        self.folder, self._parts = folder, folder / PARTS / made_of[:16]
        for other in (folder / PARTS).glob("*"):
            if other != self._parts:
                shutil.rmtree(other)
        self._parts.mkdir(parents=True, exist_ok=True)

    def has(self, first: int) -> bool:
        """Tell whether the part is there that begins with home `first`."""
        return self._place(first).exists()

    def put(self, first: int, rows: Mapping[str, Iterable[Row]], seconds: Mapping[str, float]) -> None:
        """Put a part aside: its rows by table, and the CPU seconds that it took."""
        place = self._place(first)
        new = place.with_name(f"{place.name}.new")
        shutil.rmtree(new, ignore_errors=True)
        for table in DRAFT_TABLES:
            tables.write(new / f"{table.name}.parquet", table, rows[table.name])
        write_json(new / SECONDS, dict(seconds))
        new.rename(place)

    def seconds(self) -> dict[str, float]:
        """Return the CPU seconds of all parts."""
        spent: dict[str, float] = {}
        for place in self._all():
            for part, value in json.loads((place / SECONDS).read_text()).items():
                spent[part] = spent.get(part, 0.0) + value
        return spent

    def join(self) -> None:
        """Make the tables of the parts, which go."""
        for table in DRAFT_TABLES:
            path = self.folder / f"{table.name}.parquet"
            with replacing(path) as temporary, pq.ParquetWriter(temporary, table.schema(), compression="zstd", store_schema=True) as writer:
                for place in self._all():
                    writer.write_table(tables.read_arrow(place / path.name, table))
        shutil.rmtree(self.folder / PARTS)

    def _place(self, first: int) -> Path:
        return self._parts / f"{first:08d}"

    def _all(self) -> list[Path]:
        return sorted(place for place in self._parts.iterdir() if place.name.isdigit())


def read_drafts(folder: Path, seed: int, indices: Iterable[int]) -> dict[str, list[Row]]:
    """Read the rows of some homes by table. Raises ContentError as `tables.read_arrow` does."""
    scenes = {scene_id(seed, index) for index in indices}
    rows = {table.name: tables.read(folder / f"{table.name}.parquet", table, scenes) for table in DRAFT_TABLES[:-1]}
    rejects = tables.read(folder / f"{REJECTS.name}.parquet", REJECTS)
    return rows | {REJECTS.name: [row for row in rejects if row["where"].partition("/")[0] in scenes]}
