"""Homes of shards that are not whole yet: what workers bring is on disk at once, so memory stays flat and a killed run loses little.

A part is a folder with its rows (an Arrow file a table), its files and a commit file, and gets its name when all of that is there.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa

from pipeline.errors import ContentError
from pipeline.manifest import write_json
from pipeline.shards.commits import read_file, record
from pipeline.shards.content import ShardContent
from pipeline.shards.layout import EMPTY, PARTS, STAGING, TABLES, index_of, require_inside, shard_name

COMMIT = "part.json"
ROWS, FILES = "rows", "files"


@dataclass(frozen=True, slots=True)
class Part:
    """A part: where it lies, and the indices that it answers for, rising: `made`, and those that stay `empty`."""

    folder: Path
    made: tuple[int, ...]
    empty: tuple[int, ...]

    @property
    def indices(self) -> list[int]:
        """All indices, rising."""
        return sorted((*self.made, *self.empty))

    def rows(self, table: str) -> pa.Table:
        """Read the rows of a table."""
        with pa.ipc.open_file(self.folder / ROWS / f"{table}.arrow") as reader:
            return reader.read_all()


def write_part(folder: Path, number: int, content: ShardContent) -> Part:
    """Put homes of shard `number` aside. Raises ContentError for a table or file that has no place in the shard."""
    name = shard_name(number)
    unknown = sorted(content.rows.keys() - TABLES.keys())
    if unknown:
        raise ContentError(f"{name} brings unknown tables {', '.join(unknown)}", f"tables are {', '.join(TABLES)}")
    for file in content.files:
        require_inside(file, name)
    tables = {table: schema.from_rows(content.rows.get(table, ())) for table, schema in TABLES.items()}
    made, empty = indices_of(tables["scenes"], tables["rejects"])
    if not made + empty:
        raise ContentError(f"a part of {name} brings no home", "one scenes row per index, or a rejects row that says why not")
    first = f"{min(made + empty):08d}"
    staging = folder / STAGING / f"{name}-{first}"
    shutil.rmtree(staging, ignore_errors=True)
    (staging / ROWS).mkdir(parents=True)
    for table, data in tables.items():
        with pa.ipc.new_file(staging / ROWS / f"{table}.arrow", data.schema) as writer:
            writer.write_table(data)
    for file, data in content.files.items():
        path = staging / FILES / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    # Not flushed: what a power cut tears is found by its digest, and made again.
    write_json(staging / COMMIT, record(staging, first, {t: data.num_rows for t, data in tables.items()}, flush=False).to_json())
    target = folder / PARTS / name / first
    shutil.rmtree(target, ignore_errors=True)
    target.parent.mkdir(parents=True, exist_ok=True)
    staging.rename(target)
    return Part(target, made, empty)


def indices_of(scenes: pa.Table, rejects: pa.Table) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return the indices of the homes in a scenes table, and those that its rejects table says stay empty."""
    empty = [index_of(row["where"]) for row in rejects.select(["what", "where"]).to_pylist() if row["what"] == EMPTY]
    return tuple(scenes["index"].to_pylist()), tuple(empty)


def read_parts(folder: Path, wanted: Mapping[int, range]) -> dict[int, list[Part]]:
    """Return the parts of the shards in `wanted` (the indices of each shard), in order; whatever else lies there is removed."""
    kept: dict[int, list[Part]] = {}
    names = {shard_name(number): number for number in wanted}
    for place in sorted((folder / PARTS).glob("*")):
        number = names.get(place.name)
        found = list(_whole(place, wanted[number])) if number is not None else []
        for left in {*place.glob("*")} - {part.folder for part in found}:
            shutil.rmtree(left, ignore_errors=True)
        if number is not None and found:
            kept[number] = found
        else:
            shutil.rmtree(place, ignore_errors=True)
    return kept


def _whole(place: Path, indices: range) -> Iterator[Part]:
    """Yield the parts below `place` that are as they were written and answer for indices that no part before them does."""
    seen: set[int] = set()
    for folder in sorted(place.glob("*")):
        try:
            commit = read_file(folder / COMMIT)
            if commit is None or commit.altered(folder):
                continue
            part = Part(folder, (), ())
            part = Part(folder, *indices_of(part.rows("scenes"), part.rows("rejects")))
        except (ContentError, OSError, pa.ArrowException):
            continue
        if seen.isdisjoint(part.indices) and all(i in indices for i in part.indices):
            seen.update(part.indices)
            yield part


def remove_parts(folder: Path, number: int | None = None) -> None:
    """Remove the parts of a shard, or all."""
    place = folder / PARTS if number is None else folder / PARTS / shard_name(number)
    shutil.rmtree(place, ignore_errors=True)
    if number is not None and not any((folder / PARTS).glob("*")):
        shutil.rmtree(folder / PARTS, ignore_errors=True)


def join(parts: list[Part], table: str) -> pa.Table:
    """Return the rows of a table of several parts, as if they had been made together."""
    joined: Any = pa.concat_tables([part.rows(table) for part in parts])
    return joined.combine_chunks()
