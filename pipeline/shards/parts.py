"""Homes of shards that are not whole yet: what workers bring is on disk at once, so memory stays flat and a killed run loses little.

A part is one home, or the rejects of one that stays empty: a folder with its rows (one file, an Arrow stream a table), its files and a
commit file. It gets its name when all of that is there, and once it has it, it is never written again.
"""

import errno
import os
import shutil
from dataclasses import dataclass
from pathlib import Path

import pyarrow as pa

from pipeline.errors import ContentError
from pipeline.manifest import text_of, write_bytes
from pipeline.shards.commits import Commit, read_file, record
from pipeline.shards.content import ShardContent
from pipeline.shards.layout import EMPTY, PARTS, TABLES, index_of, require_inside, shard_name

COMMIT = "part.json"
ROWS, FILES = "rows.arrow", "files"


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


def write_part(folder: Path, staging: Path, number: int, content: ShardContent, wanted: range) -> int:
    """Put one home of shard `number` aside and return its index; where it is there already, that stays.

    Raises ContentError for a table or file that has no place in the shard, for more or less than one home, and for one that is not `wanted`.
    """
    name = shard_name(number)
    unknown = sorted(content.rows.keys() - TABLES.keys())
    if unknown:
        raise ContentError(f"{name} brings unknown tables {', '.join(unknown)}", f"tables are {', '.join(TABLES)}")
    for file in content.files:
        require_inside(file, name)
    tables = {table: schema.from_rows(content.rows.get(table, ())) for table, schema in TABLES.items()}
    homes, empty = indices_of(tables["scenes"], tables["rejects"])
    if len(homes + empty) != 1:
        raise ContentError(
            f"a part of {name} brings homes {[*homes, *empty]}", "one scenes row, or a rejects row that says why there is none"
        )
    (index,) = homes + empty
    if index not in wanted:
        raise ContentError(f"{name} brings home {index}, which is not one of its own", f"it has {wanted.start} to {wanted.stop - 1}")
    place = staging / f"{index:08d}"
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    with pa.OSFile(str(place / ROWS), "wb") as rows:
        for data in tables.values():
            with pa.ipc.new_stream(rows, data.schema) as writer:
                writer.write_table(data)
    for file, data in content.files.items():
        path = place / FILES / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    commit = record(place, f"{index:08d}", {t: data.num_rows for t, data in tables.items()}, flush=False)
    write_bytes(place / COMMIT, text_of(commit.to_json()), flush=False)  # what a power cut tears is found by its digest, and made again
    target = part_place(folder, number, index)
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        place.rename(target)
    except OSError:
        if not target.is_dir():
            raise
        shutil.rmtree(place)  # another was given up and came back: the same bytes
    return index


def indices_of(scenes: pa.Table, rejects: pa.Table) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return the indices of the homes in a scenes table, and those that its rejects table says stay empty."""
    empty = [index_of(row["where"]) for row in rejects.select(["what", "where"]).to_pylist() if row["what"] == EMPTY]
    return tuple(scenes["index"].to_pylist()), tuple(empty)


def join(parts: list[Part]) -> dict[str, pa.Table]:
    """Return the rows of several parts by table, as if they had been made together."""
    rows = [part.rows() for part in parts]
    return {table: pa.concat_tables([some[table] for some in rows]).combine_chunks() for table in TABLES}
