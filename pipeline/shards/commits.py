"""Commit files: the digest, length and number of rows of everything in a shard, or in the asset library."""

import json
import os
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from pipeline.errors import ContentError
from pipeline.manifest import sha256_file
from pipeline.shards.disk import sync
from pipeline.shards.layout import commit_path

FLUSHES = 16  # files that are flushed at the same time


@dataclass(frozen=True, slots=True)
class Entry:
    """One file of a commit: its digest and its length in bytes."""

    sha256: str
    bytes: int


@dataclass(frozen=True, slots=True)
class Commit:
    """What makes a shard exist: its `files` by path relative to the dataset, its `rows` by table."""

    name: str
    files: Mapping[str, Entry]
    rows: Mapping[str, int]

    def to_json(self) -> dict[str, Any]:
        """Return the JSON object of the commit file."""
        files = {path: {"sha256": e.sha256, "bytes": e.bytes} for path, e in sorted(self.files.items())}
        return {"name": self.name, "files": files, "rows": dict(self.rows)}

    def first_damage(self, folder: Path) -> str | None:
        """Return the first file that is missing or not of its length, None when all are well (digests are not read)."""
        for path, entry in self.files.items():
            try:
                if (folder / path).stat().st_size != entry.bytes:
                    return path
            except OSError:
                return path
        return None

    def first_change(self, folder: Path) -> str | None:
        """Return the first file that is not what was written, None when all are well."""
        return next((p for p, entry in self.files.items() if not (folder / p).is_file() or entry_of(folder / p) != entry), None)


def record(
    staging: Path, name: str, rows: Mapping[str, int], *, flush: bool = True, known: Mapping[str, Entry] = MappingProxyType({})
) -> Commit:
    """Digest every file below `staging` that is not `known` already, and (with `flush`) send it to disk as `flush_all` does."""
    paths = flush_all(staging) if flush else list(_below(staging))
    names = [path.relative_to(staging).as_posix() for path in paths]
    files = {file: known.get(file) or entry_of(path) for file, path in zip(names, paths, strict=True)}
    return Commit(name, dict(sorted(files.items())), rows)


def flush_all(folder: Path) -> list[Path]:
    """Send every file below a folder to disk, with the folders around it, and return the files.

    Many are flushed at once: the disk then writes its journal once for all that wait, not once for each.
    """
    paths = list(_below(folder))
    with ThreadPoolExecutor(FLUSHES) as pool:
        list(pool.map(sync, paths))
        list(pool.map(sync, [Path(place) for place, _, _ in os.walk(folder)]))  # after their files
    return paths


def _below(folder: Path) -> Iterator[Path]:
    for place, _, names in os.walk(folder):
        yield from (Path(place) / file for file in names)


def read_commit(folder: Path, name: str) -> Commit | None:
    """Read the commit file of a shard or of the library. Returns and raises as `read_file`."""
    return read_file(folder / commit_path(name))


def read_file(path: Path) -> Commit | None:
    """Read a commit file, or return None where there is none. Raises ContentError when it is broken."""
    try:
        return parse_commit(path.read_bytes(), path)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise ContentError(f"{path} cannot be read ({error.strerror})", "delete it: the next run makes the shard again") from error


def parse_commit(text: bytes, path: Path | str) -> Commit:
    """Return what a commit file says that was read from `path`. Raises ContentError when it is broken."""
    try:
        data = json.loads(text.decode("utf-8"))
        files = {k: Entry(str(v["sha256"]), int(v["bytes"])) for k, v in data["files"].items()}
        rows = {str(k): int(v) for k, v in data["rows"].items()}
        return Commit(str(data["name"]), files, rows)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise ContentError(f"{path} is not a commit file", "delete it: the next run makes the shard again") from error


def entry_of(path: Path) -> Entry:
    """Return the digest and the length of a file."""
    return Entry(sha256_file(path), path.stat().st_size)
