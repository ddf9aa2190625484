"""commits/dataset.json: written when a dataset is whole; vouches for the header, for every commit file, and for itself."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pipeline.errors import ContentError
from pipeline.manifest import digest, text_of
from pipeline.shards.commits import Commit, entry_of, read_commit
from pipeline.shards.disk import put
from pipeline.shards.header import Header
from pipeline.shards.layout import ASSETS, HEADER, commit_path, shard_name

SEAL = "dataset"


def seal(folder: Path, header: Header, staging: Path) -> None:
    """Write the seal of a dataset whose shards are all committed."""
    put(folder / commit_path(SEAL), text_of(_content(folder, header)), staging)


def is_sealed(folder: Path, header: Header) -> bool:
    """Tell whether the seal is there and says what the header and the commit files are."""
    path = folder / commit_path(SEAL)
    return path.is_file() and (folder / commit_path(ASSETS)).is_file() and path.read_bytes() == text_of(_content(folder, header))


def check_seal(folder: Path, header: Header, remedy: str, again: str) -> None:
    """Raise ContentError for a seal that is missing or broken, or a header or commit file that is not what it says."""
    path = folder / commit_path(SEAL)
    if not path.is_file():
        raise ContentError(f"{path} is missing", again)
    commit = read_commit(folder, SEAL)
    assert commit is not None
    for name in sorted({*_names(folder, header), *commit.files}):
        if name not in commit.files or not (folder / name).is_file() or entry_of(folder / name) != commit.files[name]:
            raise ContentError(f"{folder / name} is not what was written ({path.name} in commits/ says otherwise)", remedy)
    if path.read_bytes() != text_of(_content(folder, header)):
        raise ContentError(f"{path} is not what was written", remedy)


def _names(folder: Path, header: Header) -> list[str]:
    library = [commit_path(ASSETS)] if (folder / commit_path(ASSETS)).is_file() else []
    return [HEADER, *library, *(commit_path(shard_name(n)) for n in range(header.shards))]


def _content(folder: Path, header: Header) -> dict[str, Any]:
    told = Commit(SEAL, {name: entry_of(folder / name) for name in _names(folder, header)}, {}).to_json()
    return {**told, "sha256": digest(told)}
