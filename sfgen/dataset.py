"""Reads a dataset folder: homes one by one, tables whole. Shards are read when they are needed."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, overload

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from sfgen.homes import Home, Joint, Opening, PlacedObject, Record, Room, record

FORMAT = "sfgen-dataset-1"
TABLES = ("scenes", "rooms", "openings", "objects", "joints", "rejects")


class DatasetError(ValueError):
    """A folder that is no dataset, or one with a file missing or broken; the message says which and what to do."""


def load(path: str | Path, split: str | None = None) -> Dataset:
    """Open the dataset in folder `path`; with `split`, only its homes of that split (train, val or test).

    Raises DatasetError when there is none. Shards that are not committed (a run still at work) are not seen.
    """
    folder = Path(path)
    try:
        header = json.loads((folder / "dataset.json").read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        msg = f"{folder} is not a dataset (cannot read its dataset.json); give the folder that `sfgen shard` or `make run` filled"
        raise DatasetError(msg) from error
    if not isinstance(header, dict) or header.get("format") != FORMAT:
        msg = f"{folder}/dataset.json is not of format {FORMAT}; use the release of sfgen that made it"
        raise DatasetError(msg)
    numbers = _committed(folder)
    counts = [_read_json(folder / "commits" / f"shard-{n:05d}.json")["rows"]["scenes"] for n in numbers]
    whole = [np.column_stack([np.full(c, n), np.arange(c)]) for n, c in zip(numbers, counts, strict=True)]
    places = np.concatenate(whole) if whole else np.empty((0, 2), np.int64)
    dataset = Dataset(folder, header, places)
    return dataset if split is None else dataset.split(split)


class Dataset(Sequence[Home]):
    """A sequence of homes. `header` is dataset.json: seed, count, digests, licence."""

    def __init__(self, folder: Path, header: dict[str, Any], places: NDArray[np.int64]) -> None:
        self.folder = folder
        self.header = header
        self._places = places  # (n, 2): shard, row in its scenes table
        self._kept: tuple[int, list[Home]] | None = None  # the shard that was read last

    def __len__(self) -> int:
        return len(self._places)

    @overload
    def __getitem__(self, item: int) -> Home: ...
    @overload
    def __getitem__(self, item: slice) -> Dataset: ...
    def __getitem__(self, item: int | slice) -> Home | Dataset:
        if isinstance(item, slice):
            return Dataset(self.folder, self.header, self._places[item])
        shard, row = self._places[item]
        return self._shard(int(shard))[int(row)]

    def __iter__(self) -> Iterator[Home]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        return f"Dataset({str(self.folder)!r}, {len(self)} homes)"

    def split(self, name: str) -> Dataset:
        """Return the homes of one split: train, val or test."""
        splits = {n: self._column("scenes", n, "split") for n in self._shards()}
        kept = [splits[int(shard)][int(row)] == name for shard, row in self._places]
        return Dataset(self.folder, self.header, self._places[np.array(kept, bool)])

    def table(self, name: str) -> pa.Table:
        """Return a whole table (scenes, rooms, openings, objects, joints or rejects) of all committed shards."""
        if name not in TABLES:
            msg = f"no table {name!r}; tables are {', '.join(TABLES)}"
            raise DatasetError(msg)
        parts = [self._read(name, n) for n in self._shards()]
        return pa.concat_tables(parts) if parts else pa.table({})

    def categories(self) -> tuple[str, ...]:
        """Return the object categories that occur, sorted."""
        return tuple(sorted({c for n in self._shards() for c in self._column("objects", n, "category")}))

    def empty(self) -> dict[int, str]:
        """Return the indices whose homes could not be made, each with the code of its reason (docs/reasons.md)."""
        rows = [row for n in _committed(self.folder) for row in self._read("rejects", n, ["what", "where", "reason"]).to_pylist()]
        return {int(row["where"].rpartition("_")[2]): row["reason"] for row in rows if row["what"] == "index"}

    def _shards(self) -> list[int]:
        return [int(n) for n in np.unique(self._places[:, 0])]

    def _shard(self, number: int) -> list[Home]:
        if self._kept is None or self._kept[0] != number:
            self._kept = (number, self._homes(number))
        return self._kept[1]

    def _homes(self, number: int) -> list[Home]:
        rooms, openings = self._grouped("rooms", number, Room), self._grouped("openings", number, Opening)
        objects, joints = self._grouped("objects", number, PlacedObject), self._grouped("joints", number, Joint)
        homes = []
        for scene in self._read("scenes", number).to_pylist():
            name = scene["scene_id"]
            homes.append(
                Home(
                    name,
                    scene["index"],
                    scene["split"],
                    scene["prompt"],
                    scene,
                    tuple(rooms.get(name, ())),
                    tuple(openings.get(name, ())),
                    tuple(objects.get(name, ())),
                    tuple(joints.get(name, ())),
                    self.folder / scene["usd"] if scene["usd"] else None,
                )
            )
        return homes

    def _grouped(self, table: str, number: int, cls: type[Record]) -> dict[str, list[Record]]:
        grouped: dict[str, list[Record]] = {}
        for row in self._read(table, number).to_pylist():
            grouped.setdefault(row["scene_id"], []).append(record(cls, row))
        return grouped

    def _column(self, table: str, number: int, column: str) -> list[Any]:
        values: list[Any] = self._read(table, number, [column])[column].to_pylist()
        return values

    def _read(self, table: str, number: int, columns: list[str] | None = None) -> pa.Table:
        path = self.folder / table / f"shard-{number:05d}.parquet"
        try:
            return pq.ParquetFile(path).read(columns)
        except (OSError, pa.ArrowException) as error:
            msg = f"cannot read {path} ({str(error).splitlines()[0]}); copy the dataset again, or run `sfgen verify {self.folder}`"
            raise DatasetError(msg) from error


def _committed(folder: Path) -> list[int]:
    return sorted(int(p.stem.removeprefix("shard-")) for p in (folder / "commits").glob("shard-*.json"))


def _read_json(path: Path) -> Any:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        msg = f"cannot read {path}; copy the dataset again"
        raise DatasetError(msg) from error
