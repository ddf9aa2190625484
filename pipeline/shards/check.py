"""Checks a dataset to the last byte: what `sfgen verify` runs. The first wrong thing is named."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

import pyarrow as pa

from pipeline import tables
from pipeline.errors import ContentError, UsageError
from pipeline.manifest import sha256_file
from pipeline.shards.commits import Commit, read_commit
from pipeline.shards.header import Header, read_header
from pipeline.shards.layout import ASSETS, COMMITS, PASSING, TABLES, scene_id, shard_name, table_path
from pipeline.shards.parts import indices_of
from pipeline.shards.seal import SEAL, check_seal

ID = re.compile(r"[a-z][a-z0-9_]*")
AGAIN = "run the command that made the dataset again: it resumes and makes what is missing"
COPY = "copy the dataset again, or let `sfgen repair` make again what is broken"

# (table, its id) and what its rows point to: (column, table that has the id)
IDS = (("scenes", "scene_id"), ("rooms", "room_id"), ("openings", "opening_id"), ("objects", "object_id"))


@dataclass(frozen=True, slots=True)
class Summary:
    """What a dataset that passed holds; `empty` counts the homes that could not be made."""

    homes: int
    empty: int
    shards: int
    files: int
    bytes: int
    rows: dict[str, int]


def check(folder: Path, progress: Callable[[int, int], object] = lambda _done, _all: None) -> Summary:
    """Check every digest, row count, id, reference and path of a dataset.

    Raises UsageError when `folder` is no folder, ContentError naming the first thing that is wrong.
    `progress` is called with (shards checked, shards).
    """
    if not folder.is_dir():
        raise UsageError(f"{folder} is {'not a folder' if folder.exists() else 'missing'}", "give the folder of a dataset")
    header = read_header(folder)
    commits = [_require_commit(folder, shard_name(n)) for n in range(header.shards)]
    check_seal(folder, header, COPY, AGAIN)
    library = read_commit(folder, ASSETS)
    everything = [*commits, *([library] if library else [])]
    _refuse_strangers(folder, everything, header)
    if library:
        _check_files(folder, library)
    assets = {PurePosixPath(p).parts[1] for p in library.files} if library else None
    rows = dict.fromkeys(TABLES, 0)
    for number, commit in enumerate(commits):
        _check_files(folder, commit)
        for table, count in _check_shard(folder, header, number, commit, assets).items():
            rows[table] += count
        progress(number + 1, header.shards)
    sizes = [entry.bytes for commit in everything for entry in commit.files.values()]
    return Summary(rows["scenes"], header.count - rows["scenes"], header.shards, len(sizes), sum(sizes), rows)


def _require_commit(folder: Path, name: str) -> Commit:
    commit = read_commit(folder, name)
    if commit is None:
        raise ContentError(f"{name} of {folder} is missing", AGAIN)
    if commit.name != name:
        raise ContentError(f"the commit file of {name} in {folder} is that of {commit.name}", COPY)
    for path in commit.files:
        parts = PurePosixPath(path).parts
        if path.startswith("/") or ".." in parts or "\\" in path or path != str(PurePosixPath(path)):
            raise ContentError(f"the commit file of {name} in {folder} names {path!r}, which is not a plain relative path", COPY)
    return commit


def _refuse_strangers(folder: Path, commits: list[Commit], header: Header) -> None:
    """Raise for a file in the dataset's folders that no commit vouches for; other files at the top are nobody's business."""
    known = {path for commit in commits for path in commit.files}
    known |= {f"{COMMITS}/{name}.json" for name in (*map(shard_name, range(header.shards)), ASSETS, SEAL)}
    families = {ASSETS, *(PurePosixPath(path).parts[0] for path in known)}
    for path in _files(folder):
        name = path.relative_to(folder).as_posix()
        first = PurePosixPath(name).parts[0]
        if first in PASSING:
            raise ContentError(f"{folder / name} belongs to a run that was killed, or is at work", AGAIN)
        if first in families and name not in known:
            raise ContentError(f"{folder / name} belongs to no shard", "move it out of the dataset")


def _files(folder: Path) -> Iterator[Path]:
    for path in sorted(folder.rglob("*")):
        if path.is_file() or path.is_symlink():
            yield path


def _check_files(folder: Path, commit: Commit) -> None:
    for path, entry in commit.files.items():
        full = folder / path
        if not full.is_file():
            raise ContentError(f"{full} is missing", COPY)
        size = full.stat().st_size
        if size != entry.bytes:
            raise ContentError(f"{full} has {size} bytes, not {entry.bytes}", COPY)
        if sha256_file(full) != entry.sha256:
            raise ContentError(f"{full} is not what was written (its sha256 differs)", COPY)


def _check_shard(folder: Path, header: Header, number: int, commit: Commit, assets: set[str] | None) -> dict[str, int]:
    read: dict[str, pa.Table] = {}
    for table, schema in TABLES.items():
        path = table_path(table, number)
        if path not in commit.files:
            raise ContentError(f"the commit file of {commit.name} in {folder} does not list {path}", COPY)
        read[table] = tables.read_arrow(folder / path, schema)
        if read[table].num_rows != commit.rows.get(table):
            raise ContentError(f"{folder / path} has {read[table].num_rows} rows, not {commit.rows.get(table)}", COPY)
    _check_homes(read, header, number, folder)
    places = {table: folder / table_path(table, number) for table in TABLES}
    ids = {table: _ids(read[table], column, places[table]) for table, column in IDS}
    _check_references(read, ids, places, assets)
    _check_stages(read["scenes"], commit, places["scenes"])
    return {table: data.num_rows for table, data in read.items()}


def _check_homes(read: dict[str, pa.Table], header: Header, number: int, folder: Path) -> None:
    """Check that every index of the shard has its home, or a rejects row that says why it has none."""
    indices = header.indices(number)
    try:
        made, empty = indices_of(read["scenes"], read["rejects"])
    except ValueError as error:
        raise ContentError(f"{folder / table_path('rejects', number)} names a home that cannot be", COPY) from error
    named = [scene_id(header.seed, i) for i in made]
    if list(made) != sorted(made) or sorted((*made, *empty)) != list(indices) or read["scenes"]["scene_id"].to_pylist() != named:
        first, last = scene_id(header.seed, indices[0]), scene_id(header.seed, indices[-1])
        raise ContentError(f"{folder / table_path('scenes', number)} does not hold the homes {first} ... {last}", COPY)


def _ids(data: pa.Table, column: str, place: Path) -> set[tuple[str, str]]:
    """Return the (scene, id) pairs of a table after checking that they are unique and well formed."""
    pairs = list(zip(data["scene_id"].to_pylist(), data[column].to_pylist(), strict=True))
    seen: set[tuple[str, str]] = set()
    for pair in pairs:
        if not ID.fullmatch(pair[1] or ""):
            raise ContentError(f"{place}: {column} {pair[1]!r} is not a valid id", COPY)
        if pair in seen:
            raise ContentError(f"{place}: {column} {pair[1]!r} stands twice in {pair[0]}", COPY)
        seen.add(pair)
    return seen


def _check_references(
    read: dict[str, pa.Table], ids: dict[str, set[tuple[str, str]]], places: dict[str, Path], assets: set[str] | None
) -> None:
    """Check that every row points to things that are there."""
    for table in ("rooms", "openings", "objects", "joints"):
        for scene in set(read[table]["scene_id"].to_pylist()):
            if (scene, scene) not in ids["scenes"]:
                raise ContentError(f"{places[table]}: there is no home {scene!r}", COPY)
    movers = ids["objects"] | ids["openings"]
    for table, column, known in (("objects", "room_id", ids["rooms"]), ("joints", "object_id", movers)):
        for pair in zip(read[table]["scene_id"].to_pylist(), read[table][column].to_pylist(), strict=True):
            if pair not in known:
                raise ContentError(f"{places[table]}: {column} {pair[1]!r} of {pair[0]} does not exist", COPY)
    for scene, rooms in zip(read["openings"]["scene_id"].to_pylist(), read["openings"]["rooms"].to_pylist(), strict=True):
        for room in rooms:
            if (scene, room) not in ids["rooms"]:
                raise ContentError(f"{places['openings']}: room {room!r} of {scene} does not exist", COPY)
    for asset in sorted(set(read["objects"]["asset_id"].to_pylist())):
        if assets is not None and asset not in assets:
            raise ContentError(f"{places['objects']}: asset {asset!r} is not in the library", COPY)


def _check_stages(scenes: pa.Table, commit: Commit, place: Path) -> None:
    """Check that each home's stage is a file of the shard, with the digest that the row states."""
    rows: list[dict[str, Any]] = scenes.select(["scene_id", "usd", "usd_sha256"]).to_pylist()
    for row in rows:
        if not row["usd"]:
            continue
        entry = commit.files.get(row["usd"])
        if entry is None:
            raise ContentError(f"{place}: the stage {row['usd']!r} of {row['scene_id']} is not a file of the shard", COPY)
        if entry.sha256 != row["usd_sha256"]:
            raise ContentError(f"{place}: the digest of {row['usd']} is not that of the file", COPY)
