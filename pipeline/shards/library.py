"""The asset library of a dataset: the assets that its homes use, hard-linked from a shelf that all datasets of a machine share.

It grows with the shards: a shard's assets are there, and committed, before the shard is.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import Any, Protocol

import pyarrow.parquet as pq

from pipeline import tables
from pipeline.errors import ContentError
from pipeline.manifest import write_json
from pipeline.shards.commits import Commit, entry_of, read_commit, record
from pipeline.shards.dataset import Dataset, committed
from pipeline.shards.disk import link, sync
from pipeline.shards.layout import ASSETS, COMMITS, STAGING, commit_path, table_path
from schemas.table import Table


class Shelf(Protocol):
    """Where a dataset's assets come from."""

    def entry(self, asset_id: str) -> Path:
        """Return a folder with the files of an asset, which nobody changes."""

    def tables(self, asset_ids: Sequence[str]) -> Mapping[Table, Iterable[Mapping[str, Any]]]:
        """Return the tables that describe assets."""


def extend_library(dataset: Dataset, asset_ids: Iterable[str], shelf: Shelf) -> None:
    """Put the assets into the dataset's library, beside those that are there; a library with a broken file is put together anew."""
    there = _read(dataset)
    held = {PurePosixPath(path).parts[1] for path in there.files if len(PurePosixPath(path).parts) > 2} if there else set()
    if there is None:
        shutil.rmtree(dataset.folder / ASSETS, ignore_errors=True)
    wanted = held | set(asset_ids)
    if there is None:  # shards that were committed before it broke need their assets too
        wanted |= {a for n in range(dataset.header.shards) if committed(dataset, n) for a in assets_of(dataset, n)}
    if there is not None and wanted == held:
        return
    files = dict(there.files) if there else {}
    for asset_id in sorted(wanted - held):
        files |= _adopt(dataset, asset_id, shelf.entry(asset_id))
    for table, rows in shelf.tables(sorted(wanted)).items():
        path = f"{ASSETS}/{table.name}.parquet"
        tables.write(dataset.folder / path, table, rows)
        files[path] = entry_of(dataset.folder / path)
    sync(dataset.folder / ASSETS)
    sync(dataset.folder)
    write_json(dataset.folder / commit_path(ASSETS), Commit(ASSETS, files, {}).to_json())
    sync(dataset.folder / COMMITS)


def _read(dataset: Dataset) -> Commit | None:
    """Return the library's commit, None when there is none or a file is not as it says."""
    try:
        commit = read_commit(dataset.folder, ASSETS)
    except ContentError:
        return None
    tops = {p: entry for p, entry in commit.files.items() if len(PurePosixPath(p).parts) == 2} if commit else {}
    if commit is None or commit.damaged(dataset.folder) or Commit(ASSETS, tops, {}).altered(dataset.folder):
        return None
    return commit


def assets_of(dataset: Dataset, number: int) -> set[str]:
    """Return the assets that the homes of a shard use, as far as they are made."""
    if number in dataset.parts:
        return {a for part in dataset.parts[number] for a in part.rows("objects")["asset_id"].to_pylist()}
    return set(pq.ParquetFile(dataset.folder / table_path("objects", number)).read(["asset_id"])["asset_id"].to_pylist())


def _adopt(dataset: Dataset, asset_id: str, entry: Path) -> dict[str, Any]:
    """Bring one asset into the library; returns its part of the commit."""
    staging = dataset.folder / STAGING / ASSETS
    shutil.rmtree(staging, ignore_errors=True)
    shutil.copytree(entry, staging / ASSETS / asset_id, copy_function=link)
    commit = record(staging, ASSETS, {})
    target = dataset.folder / ASSETS / asset_id
    shutil.rmtree(target, ignore_errors=True)  # left by a run that was killed before the commit
    target.parent.mkdir(exist_ok=True)
    (staging / ASSETS / asset_id).rename(target)
    return dict(commit.files)
