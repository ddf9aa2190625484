"""A dataset folder that is being filled: opened or created, locked, resumed; shards are written whole or not at all.

One process writes; workers return homes, which it puts aside as parts until a shard has all of its own. So no two writers
ever meet, workers need no shared disk, and what a killed run leaves behind is told apart by one question: is there a commit file?
"""

from __future__ import annotations

import fcntl
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

import pyarrow.parquet as pq

from pipeline.errors import ContentError, UsageError
from pipeline.manifest import write_json
from pipeline.shards.commits import Commit, read_commit, record
from pipeline.shards.content import ShardContent
from pipeline.shards.disk import link, sync
from pipeline.shards.header import Header, read_header
from pipeline.shards.layout import ASSETS, COMMITS, HEADER, PARTS, STAGING, TABLES, TEMPORARY, commit_path, shard_name, table_path
from pipeline.shards.parts import FILES, Part, join, read_parts, remove_parts, write_part
from pipeline.shards.seal import seal


@dataclass(frozen=True, slots=True)
class Dataset:
    """An open dataset: where it lies, what it is, and the parts of shards that are not whole yet."""

    folder: Path
    header: Header
    parts: dict[int, list[Part]] = field(default_factory=dict)

    def missing(self) -> list[int]:
        """Return the numbers of the shards that are still to be made."""
        return [n for n in range(self.header.shards) if not committed(self, n)]

    def todo(self, number: int) -> list[int]:
        """Return the indices of a shard that is not committed which no part answers for."""
        there = {i for part in self.parts.get(number, ()) for i in part.indices}
        return [i for i in self.header.indices(number) if i not in there]


@contextmanager
def open_or_create(folder: Path, header: Header, *, discard: bool = False) -> Iterator[Dataset]:
    """Open a dataset for writing: create it, or resume an equal one; the folder is locked meanwhile.

    A dataset of full shards may grow: the same header with a larger count resumes it. With `discard`, an unequal
    dataset is deleted first (for folders that DVC owns). Raises UsageError for a folder that holds another dataset or
    other files, or that another run is writing; ContentError when dataset.json is broken. Nothing is touched then.
    """
    if header.count < 1 or header.shard_size < 1:
        raise UsageError(f"a dataset of {header.count} homes in shards of {header.shard_size} cannot be", "give numbers from 1 on")
    if folder.exists() and not folder.is_dir():
        raise UsageError(f"{folder} is not a folder", "give a folder that is new, empty, or holds this very dataset")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"cannot make the folder {folder} ({error.strerror})", "give a place that you may write to") from error
    with _locked(folder):
        if (folder / HEADER).exists():
            if not _resumes(folder, header, discard=discard):
                _wipe(folder)
        elif any(not p.name.startswith((TEMPORARY, STAGING)) for p in folder.iterdir()):
            raise UsageError(f"{folder} holds other files", "give a folder that is new or empty")
        dataset = Dataset(folder, header)
        _clean(dataset)
        if not (folder / HEADER).exists() or read_header(folder) != header:
            write_json(folder / HEADER, header.to_json())
        try:
            dataset.parts.update(read_parts(folder, {n: header.indices(n) for n in dataset.missing()}))
            yield dataset
            if not dataset.missing():
                seal(folder, header)
        finally:
            shutil.rmtree(folder / STAGING, ignore_errors=True)


def committed(dataset: Dataset, number: int) -> bool:
    """Tell whether shard `number` is there, with every file of its commit at its full length."""
    commit = read_commit(dataset.folder, shard_name(number))
    return commit is not None and not commit.damaged(dataset.folder)


def forget_altered(dataset: Dataset) -> list[str]:
    """Remove shards and library of which a file is not what was written, so that they are made again; returns their names."""
    names = [*map(shard_name, range(dataset.header.shards)), ASSETS]
    broken = []
    for name in names:
        try:
            commit = read_commit(dataset.folder, name)
        except ContentError:
            commit = Commit(name, {}, {})
        if commit is not None and (not commit.files or commit.altered(dataset.folder)):
            _forget(dataset.folder, name)
            broken.append(name)
    return broken


def add_part(dataset: Dataset, number: int, content: ShardContent) -> Part:
    """Put homes of shard `number` aside until it is whole; they survive the end of this process.

    Raises ContentError for a table or file that has no place in the shard, and for homes that are not to be made.
    """
    part = write_part(dataset.folder, number, content)
    if not set(part.indices) <= set(dataset.todo(number)):
        shutil.rmtree(part.folder)
        wanted = list(dataset.header.indices(number))
        raise ContentError(f"{shard_name(number)} brings homes {part.indices}, not some of {wanted}", "one scenes row per index, in order")
    dataset.parts[number] = sorted([*dataset.parts.get(number, ()), part], key=lambda p: p.indices)
    return part


def commit_shard(dataset: Dataset, number: int) -> Commit:
    """Write shard `number` from its parts: stage, fsync, rename, commit file last. A committed shard is never rewritten.

    Raises ContentError when a home is missing that no rejects row accounts for.
    """
    name = shard_name(number)
    if committed(dataset, number):
        raise ContentError(f"{name} of {dataset.folder} is committed already", "a committed shard is never rewritten")
    parts = dataset.parts.get(number, [])
    there = [i for part in parts for i in part.indices]
    if there != list(dataset.header.indices(number)):
        raise ContentError(f"{name} brings homes {there}, not {list(dataset.header.indices(number))}", "one scenes row per index, in order")
    staging = dataset.folder / STAGING / name
    shutil.rmtree(staging, ignore_errors=True)
    rows = {}
    for table in TABLES:
        data = join(parts, table)
        rows[table] = data.num_rows
        path = staging / table_path(table, number)
        path.parent.mkdir(parents=True)
        pq.write_table(data, path, compression="zstd", store_schema=True)
    for part in parts:
        for family in sorted((part.folder / FILES).glob("*")):
            place = staging / family.name / name
            place.mkdir(parents=True, exist_ok=True)
            for file in sorted((family / name).iterdir()):
                link(file, place / file.name)  # the part stays whole until the shard is
    commit = record(staging, name, rows)
    _forget(dataset.folder, name)
    for family in sorted(staging.iterdir()):
        (dataset.folder / family.name).mkdir(exist_ok=True)
        for item in sorted(family.iterdir()):
            item.rename(dataset.folder / family.name / item.name)
        sync(dataset.folder / family.name)
    sync(dataset.folder)
    write_json(dataset.folder / commit_path(name), commit.to_json())
    sync(dataset.folder / COMMITS)
    shutil.rmtree(staging)
    remove_parts(dataset.folder, number)
    dataset.parts.pop(number, None)
    return commit


def _resumes(folder: Path, header: Header, *, discard: bool) -> bool:
    """Tell whether the dataset in `folder` is an equal or a smaller one (True) or is to be discarded (False)."""
    try:
        there = read_header(folder)
    except ContentError:
        if discard:
            return False
        raise
    grown = replace(there, count=header.count)
    full = there.count % there.shard_size == 0
    if grown == header and (header.count == there.count or (header.count > there.count and full)):
        return True
    if discard:
        return False
    what = "; ".join(there.differences(header))
    remedy = "give another --out, or the options of the run that made it"
    if grown == header and header.count > there.count:
        remedy = f"its last shard is not full, and committed shards are never rewritten: give another --out, or --count {there.count}"
    raise UsageError(f"{folder} holds another dataset ({what})", remedy)


def _clean(dataset: Dataset) -> None:
    """Remove what a killed run left: staging, temporary files, shards without (or that do not fit) a commit. Parts are looked at later."""
    folder = dataset.folder
    shutil.rmtree(folder / STAGING, ignore_errors=True)
    for place in (folder, folder / COMMITS):
        for left in place.glob(f"{TEMPORARY}*"):
            left.unlink()
    seen = {p.name.removesuffix(".parquet") for p in folder.glob("*/shard-*") if p.parent.name != PARTS}
    for name in sorted(n for n in seen if "." not in n):
        commit = read_commit(folder, name)
        if commit is None or commit.damaged(folder):
            _forget(folder, name)


def _forget(folder: Path, name: str) -> None:
    """Remove a shard: its commit first, so that no commit ever vouches for files that are gone."""
    (folder / commit_path(name)).unlink(missing_ok=True)
    for item in sorted([*folder.glob(f"*/{name}"), *folder.glob(f"*/{name}.parquet")]):
        if item.parent.name in {STAGING, PARTS, ASSETS}:
            continue
        if item.is_dir() and not item.is_symlink():
            shutil.rmtree(item)
        else:
            item.unlink()


def _wipe(folder: Path) -> None:
    """Remove a whole dataset, its header first; files and folders that are no dataset's stay."""
    (folder / HEADER).unlink()
    ours = {*TABLES, COMMITS, ASSETS, STAGING, PARTS, *(p.parent.name for p in folder.glob("*/shard-*"))}
    for name in sorted(ours):
        shutil.rmtree(folder / name, ignore_errors=True)


@contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Hold the folder's lock; the kernel frees it when the process dies."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise UsageError(f"another run is writing {folder}", "wait for it, or give another --out") from error
        yield
    finally:
        os.close(descriptor)
