"""A dataset folder that is being filled, by one command or by several at once: opened or created, resumed; shards are written whole or not at all.

Workers return homes, which their command puts aside as parts until a shard has all of its own. Every name in the folder has one content only
(the same home is the same bytes), is written elsewhere, and renamed to its place; so it is harmless when two write it, and claims see to it
that they seldom do. What a killed run leaves behind is told apart by one question: is there a commit file?
"""

import errno
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import pyarrow.parquet as pq

from pipeline.errors import ContentError, UsageError
from pipeline.manifest import text_of
from pipeline.shards.address import Address
from pipeline.shards.claims import Claims
from pipeline.shards.commits import Commit, read_commit, record
from pipeline.shards.disk import link, sync, write_durably
from pipeline.shards.header import Header, read_header
from pipeline.shards.layout import ASSETS, CLAIMS, COMMITS, HEADER, PARTS, PASSING, STAGING, TABLES, commit_path, shard_name, table_path
from pipeline.shards.library import AssetSource, add_assets, commit_library
from pipeline.shards.parts import FILES, HomeContent, Part, join, part_place, parts_there, write_part
from pipeline.shards.seal import SEAL, is_sealed, seal, vouches
from pipeline.tables import parquet


@dataclass(frozen=True, slots=True)
class Dataset:
    """An open dataset: where it lies, what it is, where its assets come from, and what this command has claimed of it."""

    folder: Path
    header: Header
    source: AssetSource
    claims: Claims
    address: Address | None = None  # where it is to lie as well
    done: set[int] = field(default_factory=set)  # shards that were seen to be committed

    @property
    def staging(self) -> Path:
        """Where this command, and no other, writes."""
        return self.folder / STAGING / self.claims.token

    def missing(self) -> list[int]:
        """Return the numbers of the shards that are still to be made."""
        self.done.update(n for n in range(self.header.shards) if n not in self.done and is_committed(self, n))
        return [n for n in range(self.header.shards) if n not in self.done]

    def todo(self, number: int) -> list[int]:
        """Return the indices of a shard that is not committed of which there are no parts, whoever may be at work at them."""
        there = parts_there(self.folder, number)
        return [i for i in self.header.indices(number) if i not in there]

    def take(self, number: int, index: int) -> bool:
        """Claim home `index`; False where it is there, or another is at work at it."""
        if not self.claims.take(f"{shard_name(number)}/{index:08d}"):
            return False
        return not (part_place(self.folder, number, index).exists() or is_committed(self, number))


@contextmanager
def open_or_create(
    folder: Path, header: Header, source: AssetSource, *, discard: bool = False, address: Address | None = None
) -> Iterator[Dataset]:
    """Open a dataset for writing: create it, or resume an equal one, beside others that do so. Once all shards are there it is sealed.

    A dataset of full shards may grow: the same header with a larger count resumes it. With `discard`, an unequal
    dataset is deleted first (for folders that DVC owns). With an `address`, what is committed goes there too, and what is committed
    there and not here is fetched. Raises UsageError for a folder that holds another dataset or
    other files; ContentError when dataset.json is broken. Nothing is touched then.
    """
    if header.count < 1 or header.shard_size < 1:
        raise UsageError(f"a dataset of {header.count} homes in shards of {header.shard_size} cannot be", "give numbers from 1 on")
    if folder.exists() and not folder.is_dir():
        raise UsageError(f"{folder} is not a folder", "give a folder that is new, empty, or holds this very dataset")
    if address and (there := address.header()):
        there.require_resumable(header, address.name)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        _resumes(folder, header, discard=discard)
        claims = Claims(folder / CLAIMS)
    except OSError as error:
        raise UsageError(f"cannot make the folder {folder} ({error.strerror})", "give a place that you may write to") from error
    dataset = Dataset(folder, header, source, claims, address)
    try:
        with claims.alone("open"):
            _prepare(dataset, discard=discard)
            if address:
                address.begin(folder, header, dataset.staging)
        yield dataset
        if not dataset.missing() and read_header(folder) == header and not is_sealed(folder, header):
            commit_library(folder, source, dataset.staging, assets_of_all(dataset))
            seal(folder, header, dataset.staging)
        if address and is_sealed(folder, header):
            address.send_all(folder, header)
    finally:
        shutil.rmtree(dataset.staging, ignore_errors=True)
        claims.leave(partial(_tidy, folder))


def is_committed(dataset: Dataset, number: int) -> bool:
    """Tell whether shard `number` is there: a commit that can be read, with every file at its full length."""
    return not _broken(dataset.folder, shard_name(number))


def assets_of_all(dataset: Dataset) -> set[str]:
    """Return the assets that the homes of a dataset use."""
    paths = [dataset.folder / table_path("objects", n) for n in range(dataset.header.shards)]
    return {a for path in paths for a in parquet(path, ["asset_id"])["asset_id"].to_pylist()}


def forget_altered(dataset: Dataset, retry: frozenset[str] = frozenset()) -> list[str]:
    """Make what is missing of a dataset of which a file is not what was written, or a home stays empty for a reason in `retry`; returns names.

    Raises UsageError while others are at work.
    """
    if dataset.claims.others():
        raise UsageError(f"another run is writing {dataset.folder}", "wait for it")
    names = [*map(shard_name, range(dataset.header.shards)), ASSETS]
    broken = [name for name in names if _broken(dataset.folder, name, digests=True) or _fails(dataset.folder, name, retry)]
    for name in broken:
        _forget(dataset.folder, name)
    dataset.done.clear()
    return broken


def _broken(folder: Path, name: str, *, digests: bool = False) -> bool:
    """Tell whether a commit is missing, cannot be read, or names a file that is gone, of another length, or (`digests`) not what was written."""
    try:
        commit = read_commit(folder, name)
    except ContentError:
        return True
    return commit is None or bool(commit.first_change(folder) if digests else commit.first_damage(folder))


def _fails(folder: Path, name: str, reasons: frozenset[str]) -> bool:
    """Tell whether homes of a shard stay empty for one of the reasons."""
    commit = read_commit(folder, name)
    assert commit is not None
    path = next((path for path in commit.files if path.startswith("rejects/")), None)
    rows = parquet(folder / path, ["what", "reason"]).to_pylist() if path and reasons else []
    return any(row["what"] == "index" and row["reason"] in reasons for row in rows)


def add_part(dataset: Dataset, number: int, home: HomeContent) -> None:
    """Put a home of shard `number` aside until the shard is whole; it survives the end of this process."""
    assert home.index in dataset.header.indices(number)
    write_part(dataset.folder, dataset.staging, number, home)


def commit_shard(dataset: Dataset, number: int) -> bool:
    """Write shard `number` from its parts: stage, fsync, rename, commit file last. A committed shard is never rewritten.

    False while homes are missing, while another command does so, and where parts turn out to be torn: those are to be made again.
    """
    name, left = shard_name(number), dataset.todo(number)
    if is_committed(dataset, number):  # asked after the parts were looked for: another command that commits removes them
        return True
    if left or not dataset.claims.take(f"{name}/commit"):
        return False
    try:
        if not _drop_torn(dataset, number):
            _commit(dataset, number)
    except OSError:
        if not is_committed(dataset, number):
            raise  # or else: this one was given up, and another has done it meanwhile
    if not is_committed(dataset, number):
        return False
    dataset.claims.forget(name)
    shutil.rmtree(dataset.folder / PARTS / name, ignore_errors=True)
    if dataset.address:
        dataset.address.send(dataset.folder, name)
    return True


def _drop_torn(dataset: Dataset, number: int) -> list[int]:
    """Remove the parts of a shard that are not what was written, and claim their homes."""
    torn = [i for i in dataset.header.indices(number) if not Part(part_place(dataset.folder, number, i)).whole()]
    for index in torn:
        dataset.claims.take(f"{shard_name(number)}/{index:08d}", by_force=True)
        shutil.rmtree(part_place(dataset.folder, number, index), ignore_errors=True)
    return torn


def _commit(dataset: Dataset, number: int) -> None:
    name, folder = shard_name(number), dataset.folder
    parts = [Part(part_place(folder, number, i)) for i in dataset.header.indices(number)]
    brought = [part.commit() for part in parts]
    staging = dataset.staging / name
    shutil.rmtree(staging, ignore_errors=True)
    rows = {}
    for table, data in join(parts).items():
        rows[table] = data.num_rows
        if data.num_rows != sum(commit.rows[table] for commit in brought):  # this one was given up, and who took over removes the parts
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(folder / PARTS / name))
        path = staging / table_path(table, number)
        path.parent.mkdir(parents=True)
        pq.write_table(data, path, compression="zstd", store_schema=True)
        if table == "objects":
            add_assets(folder, dataset.source, dataset.staging, set(data["asset_id"].to_pylist()))
    known = {}
    for part, part_commit in zip(parts, brought, strict=True):
        for inside, entry in part_commit.files.items():
            if inside.startswith(f"{FILES}/"):
                file = inside.removeprefix(f"{FILES}/")
                (staging / file).parent.mkdir(parents=True, exist_ok=True)
                link(part.folder / inside, staging / file)  # the part stays whole until the shard is
                known[file] = entry
    commit = record(staging, name, rows, known=known)
    _remove_strangers(folder, name, commit)
    places = {(folder / file).parent for file in commit.files}
    for place in places:
        place.mkdir(parents=True, exist_ok=True)
    for file in commit.files:
        (staging / file).replace(folder / file)
    for named in sorted({p for place in places for p in (place, *place.parents) if p.is_relative_to(folder)}, reverse=True):
        sync(named)  # a folder before the one that names it
    write_durably(folder / commit_path(name), text_of(commit.to_json()), dataset.staging)
    shutil.rmtree(staging)


def _remove_strangers(folder: Path, name: str, commit: Commit) -> None:
    """Remove what lies in a shard's places and is none of its files."""
    for path in [*folder.glob(f"*/{name}/**/*"), *folder.glob(f"*/{name}.parquet")]:
        relative = path.relative_to(folder)
        if relative.parts[0] not in {*PASSING, ASSETS} and not path.is_dir() and relative.as_posix() not in commit.files:
            path.unlink()


def _resumes(folder: Path, header: Header, *, discard: bool) -> bool:
    """Tell whether the dataset in `folder` is an equal or a smaller one (True), or there is none, or it is to be discarded (False)."""
    if vouches(folder, header):  # also when dataset.json is broken, or gone
        return True
    others = [path for path in folder.iterdir() if path.name not in PASSING]
    if not (folder / HEADER).exists():  # asked after the others were listed: another command may have made it just now
        if others:
            raise UsageError(f"{folder} holds other files", "give a folder that is new or empty")
        return False
    try:
        there = read_header(folder)
    except ContentError:
        if discard:
            return False
        raise
    if discard and not there.grows_to(header):
        return False
    there.require_resumable(header, folder)
    return True


def _prepare(dataset: Dataset, *, discard: bool) -> None:
    """Bring the folder to where work can begin: an equal header, and no commit of a shard or library that lost a file."""
    folder, header = dataset.folder, dataset.header
    if not _resumes(folder, header, discard=discard) and (folder / HEADER).exists():
        if dataset.claims.others():
            raise UsageError(f"another run is writing {folder}", "wait for it, or give another --out")
        _wipe(folder)
    text = text_of(header.to_json())
    if not (folder / HEADER).exists() or (folder / HEADER).read_bytes() != text:
        (folder / commit_path(SEAL)).unlink(missing_ok=True)
        write_durably(folder / HEADER, text, dataset.staging)
    for number in dataset.missing():
        if (folder / commit_path(shard_name(number))).exists():
            _forget(folder, shard_name(number))
    if (folder / commit_path(ASSETS)).exists() and _broken(folder, ASSETS):
        _forget(folder, ASSETS)


def _tidy(folder: Path) -> None:
    """Remove what was left by commands that were killed, when nobody is at work."""
    shutil.rmtree(folder / STAGING, ignore_errors=True)
    if (folder / commit_path(SEAL)).exists():
        shutil.rmtree(folder / PARTS, ignore_errors=True)


def _forget(folder: Path, name: str) -> None:
    """Let a shard, or the library, be made again; its commit goes, its files are written over."""
    for path in (commit_path(SEAL), commit_path(name)):
        (folder / path).unlink(missing_ok=True)
    sync(folder / COMMITS)


def _wipe(folder: Path) -> None:
    """Remove a whole dataset, its header first; files and folders that are no dataset's stay."""
    (folder / HEADER).unlink()
    sync(folder)
    ours = {*TABLES, COMMITS, ASSETS, STAGING, PARTS, *(p.parent.name for p in folder.glob("*/shard-*"))}
    for name in sorted(ours):
        shutil.rmtree(folder / name, ignore_errors=True)
