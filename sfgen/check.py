"""Checks a dataset to the last byte, wherever it lies and without the factory: what `sfgen verify` runs. The first wrong thing is named."""

import hashlib
import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

import pyarrow as pa

from sfgen.dataset import FORMAT, SCHEMA_VERSION, TABLES, read_header
from sfgen.place import DatasetError, Place

HEADER, SEAL, LIBRARY = "dataset.json", "commits/dataset.json", "commits/assets.json"
PASSING = (".claims", ".parts", ".staging")  # folders that are gone when a dataset is whole
ID = re.compile(r"[a-z][a-z0-9_]*")
AGAIN = "run the command that made the dataset again: it resumes and makes what is missing"
COPY = "copy the dataset again, or let `sfgen repair` make again what is broken"

# (table, its id) and what its rows point to: (column, table that has the id)
IDS = (("scenes", "scene_id"), ("rooms", "room_id"), ("openings", "opening_id"), ("objects", "object_id"))

Ids = dict[str, set[tuple[str, str]]]


@dataclass(frozen=True, slots=True)
class Summary:
    """What a dataset that passed holds; `empty` counts the homes that could not be made."""

    homes: int
    empty: int
    shards: int
    files: int
    bytes: int
    rows: dict[str, int]

    def line(self, dataset: str) -> str:
        """Return all that in words."""
        rows = ", ".join(f"{count} {table}" for table, count in self.rows.items() if table != "scenes")
        empty = f", {self.empty} stay empty (see rejects)" if self.empty else ""
        size = f"{self.files} files, {self.bytes / 1e6:.1f} MB"
        return f"{dataset} is whole: {self.homes} homes in {self.shards} shards{empty} ({rows}; {size})"


@dataclass(frozen=True, slots=True)
class _Commit:
    """A commit file: digest and length of each file that it vouches for, rows of each table."""

    name: str
    files: dict[str, tuple[str, int]]
    rows: dict[str, int]


def check(
    path: str | Path,
    progress: Callable[[int, int], object] = lambda _done, _all: None,
    schemas: Mapping[str, pa.Schema] | None = None,
) -> Summary:
    """Check every digest, row count, id, reference and path of a dataset; with `schemas` (by table), every column's type too.

    Raises DatasetError naming the first thing that is wrong. `progress` is called with (shards checked, shards).
    """
    place = Place(path)
    there, header = place.files(), read_header(place)
    shards = -(-header["count"] // header["shard_size"])
    sealed = _read_seal(place) if SEAL in there else {}
    _check_files(place, there, {HEADER: sealed[HEADER]} if HEADER in sealed else {})  # before what it says is believed
    commits = [_read_commit(place, there, f"commits/{_shard(n)}.json") for n in range(shards)]
    library = _read_commit(place, there, LIBRARY) if LIBRARY in there else None
    everything = [*commits, *([library] if library else [])]
    _check_seal(place, there, sealed, [HEADER, *(f"commits/{commit.name}.json" for commit in everything)])
    _refuse_strangers(place, there, everything)
    if library:
        _check_files(place, there, library.files)
    assets = {PurePosixPath(p).parts[1] for p in library.files} if library else None
    rows = dict.fromkeys(TABLES, 0)
    for number, commit in enumerate(commits):
        _check_files(place, there, commit.files)
        for table, count in _check_shard(place, header, number, commit, assets, schemas or {}).items():
            rows[table] += count
        progress(number + 1, shards)
    sizes = [size for commit in everything for _, size in commit.files.values()]
    return Summary(rows["scenes"], header["count"] - rows["scenes"], shards, len(sizes), sum(sizes), rows)


def _shard(number: int) -> str:
    return f"shard-{number:05d}"


def _wrong(what: object, remedy: str = COPY) -> DatasetError:
    return DatasetError(f"{what}; {remedy}")


# -- commits ---------------------------------------------------------------------------------------------------------------


def _read_commit(place: Place, there: Mapping[str, int], path: str) -> _Commit:
    name = PurePosixPath(path).stem
    if path not in there:
        raise _wrong(f"{name} of {place.name} is missing", AGAIN)
    commit = _parse(place, path, json.loads)
    if commit.name != name:
        raise _wrong(f"the commit file of {name} in {place.name} is that of {commit.name}")
    for file in commit.files:
        if file.startswith("/") or ".." in PurePosixPath(file).parts or "\\" in file or file != str(PurePosixPath(file)):
            raise _wrong(f"the commit file of {name} in {place.name} names {file!r}, which is not a plain relative path")
    return commit


def _read_seal(place: Place) -> dict[str, tuple[str, int]]:
    """Return digest and length of the header and of every commit file, as the seal says; it vouches for its own bytes."""

    def load(text: bytes) -> Any:
        data = json.loads(text)
        content = {key: value for key, value in data.items() if key != "sha256"}
        plain = json.dumps(content, sort_keys=True, separators=(",", ":"), ensure_ascii=False)
        written = json.dumps(data, sort_keys=True, indent=2, ensure_ascii=False) + "\n"
        if data["sha256"] != hashlib.sha256(plain.encode()).hexdigest() or written.encode() != text:
            raise ValueError
        return data

    return _parse(place, SEAL, load).files


def _parse(place: Place, path: str, load: Callable[[bytes], Any]) -> _Commit:
    try:
        data = load(place.read(path))
        files = {str(k): (str(v["sha256"]), int(v["bytes"])) for k, v in data["files"].items()}
        return _Commit(str(data["name"]), files, {str(k): int(v) for k, v in data["rows"].items()})
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise _wrong(f"{place.path(path)} is not what was written") from error


def _check_seal(place: Place, there: Mapping[str, int], sealed: Mapping[str, tuple[str, int]], names: list[str]) -> None:
    """Check that the seal is there, and that header and commit files are those that it names."""
    if not sealed:
        raise _wrong(f"{place.path(SEAL)} is missing", AGAIN)
    if odd := sorted(sealed.keys() ^ set(names)):
        raise _wrong(f"{place.path(odd[0])} is not what was written ({SEAL} says otherwise)")
    _check_files(place, there, sealed)


# -- files -----------------------------------------------------------------------------------------------------------------


def _check_files(place: Place, there: Mapping[str, int], files: Mapping[str, tuple[str, int]]) -> None:
    for path, (sha256, size) in files.items():
        if path not in there:
            raise _wrong(f"{place.path(path)} is missing")
        if there[path] != size:
            raise _wrong(f"{place.path(path)} has {there[path]} bytes, not {size}")
        try:
            with place.open(path) as file:
                digest = hashlib.file_digest(file, "sha256").hexdigest()  # type: ignore[arg-type]
        except OSError as error:
            raise _wrong(f"{place.path(path)} cannot be read ({error.strerror or error})") from error
        if digest != sha256:
            raise _wrong(f"{place.path(path)} is not what was written (its sha256 differs)")


def _refuse_strangers(place: Place, there: Iterable[str], commits: list[_Commit]) -> None:
    """Raise for a file in the dataset's folders that no commit vouches for; other files at the top are nobody's business."""
    known = {path for commit in commits for path in commit.files} | {f"commits/{commit.name}.json" for commit in commits} | {SEAL}
    families = {"assets", *(PurePosixPath(path).parts[0] for path in known)}
    for name in sorted(there):
        first = PurePosixPath(name).parts[0]
        if first in PASSING:
            raise _wrong(f"{place.path(name)} belongs to a run that was killed, or is at work", AGAIN)
        if first in families and name not in known:
            raise _wrong(f"{place.path(name)} belongs to no shard", "move it out of the dataset")


# -- rows ------------------------------------------------------------------------------------------------------------------


def _check_shard(
    place: Place, header: Mapping[str, Any], number: int, commit: _Commit, assets: set[str] | None, schemas: Mapping[str, pa.Schema]
) -> dict[str, int]:
    read: dict[str, pa.Table] = {}
    places = {table: place.path(f"{table}/{_shard(number)}.parquet") for table in TABLES}
    for table in TABLES:
        path = f"{table}/{_shard(number)}.parquet"
        if path not in commit.files:
            raise _wrong(f"the commit file of {commit.name} in {place.name} does not list {path}")
        read[table] = _read_table(place, path, schemas.get(table))
        if read[table].num_rows != commit.rows.get(table):
            raise _wrong(f"{places[table]} has {read[table].num_rows} rows, not {commit.rows.get(table)}")
    try:
        _check_homes(read, header, number, places)
        ids = {table: _ids(read[table], column, places[table]) for table, column in IDS}
        _check_references(read, ids, places, assets)
        _check_stages(read["scenes"], commit, places["scenes"])
    except KeyError as error:
        raise _wrong(f"a table of {commit.name} in {place.name} has no column {error}") from error
    return {table: data.num_rows for table, data in read.items()}


def _read_table(place: Place, path: str, schema: pa.Schema | None) -> pa.Table:
    try:
        data = place.table(path)
    except (OSError, pa.ArrowException) as error:
        raise _wrong(f"{place.path(path)} is not a readable Parquet file ({str(error).splitlines()[0]})") from error
    metadata = data.schema.metadata or {}
    if (metadata.get(b"sfgen.table"), metadata.get(b"sfgen.schema_version")) != (
        path.split("/", maxsplit=1)[0].encode(),
        SCHEMA_VERSION.encode(),
    ):
        raise _wrong(f"{place.path(path)} is not that table of a dataset of format {FORMAT}")
    if schema is not None and not data.schema.equals(schema):
        odd = sorted({str(field) for field in data.schema} ^ {str(field) for field in schema})
        raise _wrong(f"{place.path(path)} has other columns than its schema ({', '.join(odd)[:200]})")
    return data


def _check_homes(read: dict[str, pa.Table], header: Mapping[str, Any], number: int, places: Mapping[str, object]) -> None:
    """Check that every index of the shard has its home, or a rejects row that says why it has none."""
    size = header["shard_size"]
    indices = range(number * size, min(header["count"], (number + 1) * size))
    homes = read["scenes"]["index"].to_pylist()
    whats, wheres = (read["rejects"][column].to_pylist() for column in ("what", "where"))
    try:
        empty = [int(where.rpartition("_")[2]) for what, where in zip(whats, wheres, strict=True) if what == "index"]
    except ValueError as error:
        raise _wrong(f"{places['rejects']} names a home that cannot be") from error
    names = [f"s{header['seed']}_{i:08d}" for i in (*homes, indices[0], indices[-1])]
    if homes != sorted(homes) or sorted((*homes, *empty)) != list(indices) or read["scenes"]["scene_id"].to_pylist() != names[:-2]:
        raise _wrong(f"{places['scenes']} does not hold the homes {names[-2]} ... {names[-1]}")


def _ids(data: pa.Table, column: str, place: object) -> set[tuple[str, str]]:
    """Return the (scene, id) pairs of a table after checking that they are unique and well formed."""
    pairs: set[tuple[str, str]] = set()
    for pair in _pairs(data, column):
        if not ID.fullmatch(pair[1] or ""):
            raise _wrong(f"{place}: {column} {pair[1]!r} is not a valid id")
        if pair in pairs:
            raise _wrong(f"{place}: {column} {pair[1]!r} stands twice in {pair[0]}")
        pairs.add(pair)
    return pairs


def _pairs(data: pa.Table, column: str) -> Iterator[tuple[str, Any]]:
    return zip(data["scene_id"].to_pylist(), data[column].to_pylist(), strict=True)


def _check_references(read: dict[str, pa.Table], ids: Ids, places: Mapping[str, object], assets: set[str] | None) -> None:
    """Check that every row points to things that are there."""
    for table in ("rooms", "openings", "objects", "joints"):
        for scene in set(read[table]["scene_id"].to_pylist()):
            if (scene, scene) not in ids["scenes"]:
                raise _wrong(f"{places[table]}: there is no home {scene!r}")
    movers = ids["objects"] | ids["openings"]
    for table, column, known in (("objects", "room_id", ids["rooms"]), ("joints", "object_id", movers)):
        for pair in _pairs(read[table], column):
            if pair not in known:
                raise _wrong(f"{places[table]}: {column} {pair[1]!r} of {pair[0]} does not exist")
    for scene, rooms in _pairs(read["openings"], "rooms"):
        for room in rooms:
            if (scene, room) not in ids["rooms"]:
                raise _wrong(f"{places['openings']}: room {room!r} of {scene} does not exist")
    for asset in sorted(set(read["objects"]["asset_id"].to_pylist())):
        if assets is not None and asset not in assets:
            raise _wrong(f"{places['objects']}: asset {asset!r} is not in the library")


def _check_stages(scenes: pa.Table, commit: _Commit, place: object) -> None:
    """Check that each home's stage is a file of the shard, with the digest that the row states."""
    for row in scenes.select(["scene_id", "usd", "usd_sha256"]).to_pylist():
        if not row["usd"]:
            continue
        if row["usd"] not in commit.files:
            raise _wrong(f"{place}: the stage {row['usd']!r} of {row['scene_id']} is not a file of the shard")
        if commit.files[row["usd"]][0] != row["usd_sha256"]:
            raise _wrong(f"{place}: the digest of {row['usd']} is not that of the file")
