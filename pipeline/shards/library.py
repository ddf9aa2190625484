"""The asset library of a dataset: the assets that its homes use, hard-linked from a cache that all datasets of a machine share.

It grows with the shards: a shard's assets are there before the shard is. When all shards are, it is fixed: held against the cache
to the last byte, described by its tables, and committed.
"""

import shutil
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

import pyarrow.parquet as pq

from pipeline.manifest import text_of
from pipeline.shards.commits import Commit, Entry, flush_all, record
from pipeline.shards.disk import link, sync, write_durably
from pipeline.shards.layout import ASSETS, commit_path
from schemas.table import Table


class AssetSource(Protocol):
    """Where a dataset's assets come from."""

    def entry(self, asset_id: str) -> Path:
        """Return a folder with the files of an asset, which nobody changes."""

    def tables(self, asset_ids: Sequence[str]) -> Mapping[Table, Iterable[Mapping[str, Any]]]:
        """Return the tables that describe assets."""


def add_assets(folder: Path, source: AssetSource, staging: Path, asset_ids: Iterable[str]) -> None:
    """Bring the assets that are not there yet into the library of the dataset in `folder`."""
    missing = [a for a in sorted(asset_ids) if not (folder / ASSETS / a).exists()]
    (folder / ASSETS).mkdir(exist_ok=True)
    for asset_id in missing:
        place = staging / ASSETS / asset_id
        shutil.rmtree(place, ignore_errors=True)
        shutil.copytree(source.entry(asset_id), place, copy_function=link)
    if missing:
        flush_all(staging / ASSETS)
    for asset_id in missing:
        place = staging / ASSETS / asset_id
        try:
            place.rename(folder / ASSETS / asset_id)
        except OSError:
            if not (folder / ASSETS / asset_id).exists():
                raise
            shutil.rmtree(place)  # another command was faster
    if missing:
        sync(folder / ASSETS)
        sync(folder)


def commit_library(folder: Path, source: AssetSource, staging: Path, asset_ids: set[str]) -> None:
    """Make the library exactly these assets, as the cache has them, and commit it."""
    (folder / ASSETS).mkdir(exist_ok=True)
    files: dict[str, Entry] = {}
    for asset_id in sorted(asset_ids):
        place = folder / ASSETS / asset_id
        wanted = record(source.entry(asset_id), asset_id, {}, flush=False)
        there = {p.relative_to(place).as_posix() for p in place.rglob("*") if p.is_file()}
        if place.exists() and (there != wanted.files.keys() or wanted.first_change(place)):
            shutil.rmtree(place)
        add_assets(folder, source, staging, [asset_id])
        files |= {f"{ASSETS}/{asset_id}/{path}": entry for path, entry in wanted.files.items()}
    for table, rows in source.tables(sorted(asset_ids)).items():
        path = staging / "tables" / f"{table.name}.parquet"
        path.parent.mkdir(parents=True, exist_ok=True)
        pq.write_table(table.from_rows(rows), path, compression="zstd", store_schema=True)
        files |= {f"{ASSETS}/{p}": entry for p, entry in record(path.parent, ASSETS, {}).files.items()}
        path.replace(folder / ASSETS / path.name)
    for path in sorted((folder / ASSETS).iterdir()):
        if path.name not in asset_ids and f"{ASSETS}/{path.name}" not in files:
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    sync(folder / ASSETS)
    write_durably(folder / commit_path(ASSETS), text_of(Commit(ASSETS, files, {}).to_json()), staging)
