"""commits/dataset.json: written when a dataset is whole; vouches for the header, for every commit file, and for itself."""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc

from pipeline.errors import ContentError
from pipeline.manifest import digest, sha256, text_of
from pipeline.shards.commits import Commit, Entry, entry_of, read_commit
from pipeline.shards.disk import write_durably
from pipeline.shards.header import Header, read_header
from pipeline.shards.layout import ASSETS, EMPTY, HEADER, commit_path, index_of, shard_name
from pipeline.tables import parquet

SEAL = "dataset"


def seal(folder: Path, header: Header, staging: Path) -> None:
    """Write the seal of a dataset whose shards are all committed."""
    write_durably(folder / commit_path(SEAL), text_of(_content(folder, header)), staging)


def is_sealed(folder: Path, header: Header) -> bool:
    """Tell whether the seal is there and says what the header and the commit files are."""
    path = folder / commit_path(SEAL)
    return path.is_file() and (folder / commit_path(ASSETS)).is_file() and path.read_bytes() == text_of(_content(folder, header))


def identity(folder: Path) -> tuple[int, int]:
    """Return seed and number of homes of a dataset: from its header or, where the seal says that it is not what was written, from its rows."""
    entry = _sealed_files(folder).get(HEADER)
    path = folder / HEADER
    if entry is None or (path.is_file() and entry_of(path) == entry):
        header = read_header(folder)
        return header.seed, header.count
    scenes = [scene for table in ("scenes", "rejects") for scene in _scenes(folder, table)]
    if not scenes:
        raise ContentError(f"{path} is not what was written, and no shard is left to say what it was", "copy the dataset again")
    return int(scenes[0].partition("_")[0][1:]), 1 + max(map(index_of, scenes))


def vouches(folder: Path, header: Header) -> bool:
    """Tell whether a dataset was sealed with this header, whatever has become of the file."""
    return _sealed_files(folder).get(HEADER) == Entry(sha256(text := text_of(header.to_json())), len(text))


def _sealed_files(folder: Path) -> Mapping[str, Entry]:
    with suppress(ContentError):
        if commit := read_commit(folder, SEAL):
            return commit.files
    return {}


def _scenes(folder: Path, table: str) -> Iterator[str]:
    """Yield the scene ids of homes that were made, or stay empty, of all shards that can be read."""
    for path in sorted((folder / table).glob("shard-*.parquet")):
        with suppress(OSError, pa.ArrowException):
            rows = parquet(path)
            ids = rows["scene_id"] if table == "scenes" else rows.filter(pc.equal(rows["what"], EMPTY))["where"]
            yield from ids.to_pylist()


def _content(folder: Path, header: Header) -> dict[str, Any]:
    library = [ASSETS] if (folder / commit_path(ASSETS)).is_file() else []
    names = [HEADER, *map(commit_path, [*library, *map(shard_name, range(header.shards))])]
    commit = Commit(SEAL, {name: entry_of(folder / name) for name in names}, {}).to_json()
    return {**commit, "sha256": digest(commit)}
