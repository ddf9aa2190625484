"""Reads a dataset folder: homes one by one, tables whole. Shards are read when they are needed, and the last few are kept."""

from __future__ import annotations

import json
import re
from collections import OrderedDict
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, overload

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from sfgen.homes import Home, Joint, Opening, PlacedObject, Room, records, require_columns
from sfgen.place import DatasetError, Place

FORMAT = "sfgen-dataset-3"
SCHEMA_VERSION = "2"
TABLES = ("scenes", "rooms", "openings", "objects", "joints", "rejects")
RECORDS = {"rooms": Room, "openings": Opening, "objects": PlacedObject, "joints": Joint}
KEPT = 16  # shards whose tables stay in memory, some 3 MB each
AGAIN = "copy the dataset again, or run `sfgen verify` on it"

Shard = dict[str, tuple[pa.Table, dict[str, tuple[int, int]]]]  # by table: its rows, and which of them are of each home


def load(path: str | Path, split: str | None = None) -> Dataset:
    """Open the dataset in folder `path` (or at an address that fsspec knows: s3://...); with `split`, only its train, val or test homes.

    Raises DatasetError when there is none. Shards that are not committed (a run still at work) are not seen.
    """
    place = Place(path)
    header = read_header(place)
    numbers = committed_shards(place, header)
    counts = [_read_json(place, f"commits/shard-{n:05d}.json")["rows"]["scenes"] for n in numbers]
    whole = [np.column_stack([np.full(c, n), np.arange(c)]) for n, c in zip(numbers, counts, strict=True)]
    places = np.concatenate(whole) if whole else np.empty((0, 2), np.int64)
    dataset = Dataset(place, header, places)
    return dataset if split is None else dataset.split(split)


def read_header(place: Place) -> dict[str, Any]:
    """Read dataset.json. Raises DatasetError for what is none, or is of another format or version."""
    try:
        header = json.loads(place.read("dataset.json"))
    except (OSError, ValueError) as error:
        msg = f"{place.name} is not a dataset (cannot read its dataset.json); give the folder that `sfgen shard` or `make run` filled"
        raise DatasetError(msg) from error
    if not isinstance(header, dict) or header.get("format") != FORMAT:
        msg = f"{place.name}/dataset.json is not of format {FORMAT}; use the release of sfgen that made it"
        raise DatasetError(msg)
    if header.get("schema_version") != SCHEMA_VERSION:
        mismatch = f"{place.name} has tables of version {header.get('schema_version')}, and this release of sfgen reads {SCHEMA_VERSION}"
        msg = f"{mismatch}; use the release of sfgen that made it"
        raise DatasetError(msg)
    numbers: list[Any] = [header.get(name) for name in ("seed", "count", "shard_size")]
    if not all(type(n) is int for n in numbers) or min(numbers[1:]) < 1 or not isinstance(header.get("vocabulary"), dict):
        msg = f"{place.path('dataset.json')} holds numbers that cannot be (seed, count, shard_size = {numbers}); {AGAIN}"
        raise DatasetError(msg)
    return header


def committed_shards(place: Place, header: dict[str, Any]) -> list[int]:
    """Return the numbers of the shards that are there. Raises DatasetError for a commit file that cannot be of this dataset."""
    numbers = []
    for name in place.names("commits"):
        match = re.fullmatch(r"shard-(\d{5,})\.json", name)
        if match and int(match[1]) * header["shard_size"] < header["count"]:
            numbers.append(int(match[1]))
        elif name not in {"assets.json", "dataset.json"}:
            msg = f"{place.path(f'commits/{name}')} does not belong to this dataset; move it away, or {AGAIN}"
            raise DatasetError(msg)
    return numbers


class Dataset(Sequence[Home]):
    """A sequence of homes. `header` is dataset.json: seed, count, digests, licence, vocabulary."""

    def __init__(self, place: Place, header: dict[str, Any], places: NDArray[np.int64]) -> None:
        self.place = place
        self.header = header
        self._places = places  # (n, 2): shard, row in its scenes table
        self._kept: OrderedDict[int, Shard] = OrderedDict()  # the shards that were read last

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what can be read again: processes of a DataLoader start faster."""
        return {**self.__dict__, "_kept": OrderedDict()}

    def __len__(self) -> int:
        return len(self._places)

    @overload
    def __getitem__(self, item: int) -> Home: ...
    @overload
    def __getitem__(self, item: slice) -> Dataset: ...
    def __getitem__(self, item: int | slice) -> Home | Dataset:
        if isinstance(item, slice):
            return Dataset(self.place, self.header, self._places[item])
        shard, row = self._places[item]
        return self._home(int(shard), int(row))

    def __iter__(self) -> Iterator[Home]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        return f"Dataset({self.place.name!r}, {len(self)} homes)"

    @property
    def shards(self) -> NDArray[np.int64]:
        """The shard of each home (n,): who reads homes of one shard together reads it once."""
        return self._places[:, 0]

    def split(self, name: str) -> Dataset:
        """Return the homes of one split: train, val or test."""
        splits = {n: self._column("scenes", n, "split") for n in self._shards()}
        kept = [splits[int(shard)][int(row)] == name for shard, row in self._places]
        return Dataset(self.place, self.header, self._places[np.array(kept, bool)])

    def table(self, name: str) -> pa.Table:
        """Return a whole table (scenes, rooms, openings, objects, joints or rejects) of all committed shards."""
        if name not in TABLES:
            msg = f"no table {name!r}; tables are {', '.join(TABLES)}"
            raise DatasetError(msg)
        parts = [self._read(name, n) for n in self._shards()]
        return pa.concat_tables(parts) if parts else pa.table({})

    def categories(self) -> tuple[str, ...]:
        """Return the object categories that homes of this dataset may hold; a class number is a place in it, whatever is split or added."""
        return tuple(self.header["vocabulary"]["categories"])

    def room_types(self) -> tuple[str, ...]:
        """Return the room types that homes of this dataset may have, as `categories`."""
        return tuple(self.header["vocabulary"]["room_types"])

    def empty(self) -> dict[int, str]:
        """Return the indices whose homes could not be made, each with the code of its reason (docs/reasons.md)."""
        numbers = committed_shards(self.place, self.header)
        rows = [row for n in numbers for row in self._read("rejects", n, ["what", "where", "reason"]).to_pylist()]
        return {int(row["where"].rpartition("_")[2]): row["reason"] for row in rows if row["what"] == "index"}

    def _shards(self) -> list[int]:
        return [int(n) for n in np.unique(self._places[:, 0])]

    def _home(self, number: int, row: int) -> Home:
        shard = self._shard(number)
        (scene,) = shard["scenes"][0].slice(row, 1).to_pylist()
        name = scene["scene_id"]
        parts: dict[str, Any] = {}
        for table, cls in RECORDS.items():
            data, rows = shard[table]
            start, end = rows.get(name, (0, 0))
            parts[table] = tuple(records(cls, data.slice(start, end - start)))
        usd = self.place.path(scene["usd"]) if scene["usd"] else None
        return Home(name, scene["index"], scene["split"], scene["prompt"], scene, **parts, usd=usd, place=self.place)

    def _shard(self, number: int) -> Shard:
        if number not in self._kept:
            while len(self._kept) >= KEPT:
                self._kept.popitem(last=False)
            self._kept[number] = {table: self._rows_by_home(table, number) for table in ("scenes", *RECORDS)}
        self._kept.move_to_end(number)
        return self._kept[number]

    def _rows_by_home(self, table: str, number: int) -> tuple[pa.Table, dict[str, tuple[int, int]]]:
        data = self._read(table, number).combine_chunks()
        require_columns(data, RECORDS.get(table, Home), f"{self.place.path(table)}/shard-{number:05d}.parquet")
        names = data["scene_id"].to_pylist()
        starts = [i for i, name in enumerate(names) if i == 0 or name != names[i - 1]]
        return data, {names[start]: (start, end) for start, end in zip(starts, [*starts[1:], len(names)], strict=True)}

    def _column(self, table: str, number: int, column: str) -> list[Any]:
        values: list[Any] = self._read(table, number, [column])[column].to_pylist()
        return values

    def _read(self, table: str, number: int, columns: list[str] | None = None) -> pa.Table:
        path = f"{table}/shard-{number:05d}.parquet"
        try:
            return self.place.table(path, columns)
        except (OSError, pa.ArrowException) as error:
            msg = f"cannot read {self.place.path(path)} ({str(error).splitlines()[0]}); {AGAIN}"
            raise DatasetError(msg) from error


def _read_json(place: Place, name: str) -> Any:
    try:
        return json.loads(place.read(name))
    except (OSError, ValueError) as error:
        msg = f"cannot read {place.path(name)}; {AGAIN}"
        raise DatasetError(msg) from error
