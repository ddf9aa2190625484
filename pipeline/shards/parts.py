"""Homes of shards that are not whole yet: what workers bring is on disk at once, so memory stays flat and a killed run loses little.

A part is one home, or the rejects of one that stays empty: a folder with its rows (one file, an Arrow stream a table), its files and a
commit file. It gets its name when all of that is there, and once it has it, it is never written again.
"""

import errno
import os
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa

from pipeline.errors import ContentError
from pipeline.manifest import sha256, text_of, write_bytes
from pipeline.shards.commits import Commit, read_file, record
from pipeline.shards.layout import EMPTY, PARTS, TABLES, index_of, shard_name

COMMIT = "part.json"
ROWS, FILES = "rows.arrow", "files"

Row = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class HomeContent:
    """One home of a shard, in memory: rows by table name, and files by path relative to the dataset (`usd/shard-00000/...`)."""

    rows: Mapping[str, Sequence[Row]]
    files: Mapping[str, bytes]

    @property
    def index(self) -> int:
        """Which home of the dataset it is: that of its scenes row, or of the rejects row that says why there is none."""
        if self.rows["scenes"]:
            return int(self.rows["scenes"][0]["index"])
        return next(index_of(row["where"]) for row in self.rows["rejects"] if row["what"] == EMPTY)


def gather(number: int, rows: Mapping[str, Sequence[Row]], files: Mapping[str, bytes]) -> HomeContent:
    """Return a home as part of shard `number`, from its rows by table and its files, which are named `<family>/<file>`.

    Files move into the shard's folder of their family, and the scenes row's `usd` and `usd_sha256` follow.
    """
    moved = {path: path.replace("/", f"/{shard_name(number)}/", 1) for path in files}
    scenes = [
        {**row, "usd": moved[row["usd"]], "usd_sha256": sha256(files[row["usd"]])} if row["usd"] else row for row in rows.get("scenes", ())
    ]
    tables = {table: rows.get(table, ()) for table in TABLES}
    return HomeContent({**tables, "scenes": scenes}, {moved[path]: data for path, data in files.items()})


@dataclass(frozen=True, slots=True)
class Part:
    """One home of a shard, put aside: where it lies."""

    folder: Path

    def rows(self) -> dict[str, pa.Table]:
        """Read its rows, by table."""
        with pa.OSFile(str(self.folder / ROWS)) as file:
            return {table: pa.ipc.open_stream(file).read_all() for table in TABLES}

    def commit(self) -> Commit:
        """Return what was written. Raises FileNotFoundError where it is gone, ContentError where it is torn."""
        commit = read_file(self.folder / COMMIT)
        if commit is None:
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(self.folder))
        return commit

    def whole(self) -> bool:
        """Tell whether it is as it was written; a power cut may have torn it."""
        try:
            return not self.commit().first_change(self.folder)
        except (ContentError, FileNotFoundError):
            return False


def part_place(folder: Path, number: int, index: int) -> Path:
    """Return where home `index` of shard `number` is put aside."""
    return folder / PARTS / shard_name(number) / f"{index:08d}"


def parts_there(folder: Path, number: int) -> set[int]:
    """Return the indices of a shard of which there are parts."""
    try:
        return {int(place.name) for place in (folder / PARTS / shard_name(number)).iterdir() if place.name.isdigit()}
    except FileNotFoundError:
        return set()


def write_part(folder: Path, staging: Path, number: int, home: HomeContent) -> None:
    """Put one home of shard `number` aside; where it is there already, that stays."""
    target = part_place(folder, number, home.index)
    place = staging / target.name
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    counts = {}
    with pa.OSFile(str(place / ROWS), "wb") as rows:
        for table, schema in TABLES.items():
            data = schema.from_rows(home.rows[table])
            counts[table] = data.num_rows
            with pa.ipc.new_stream(rows, data.schema) as writer:
                writer.write_table(data)
    for file, content in home.files.items():
        path = place / FILES / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    commit = record(place, target.name, counts, flush=False)
    write_bytes(place / COMMIT, text_of(commit.to_json()), flush=False)  # what a power cut tears is found by its digest, and made again
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        place.rename(target)
    except OSError:
        if not target.is_dir():
            raise
        shutil.rmtree(place)  # another was given up and came back: the same bytes


def join(parts: list[Part]) -> dict[str, pa.Table]:
    """Return the rows of several parts by table, as if they had been made together."""
    rows = [part.rows() for part in parts]
    return {table: pa.concat_tables([some[table] for some in rows]).combine_chunks() for table in TABLES}
