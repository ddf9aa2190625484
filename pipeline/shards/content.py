"""What a shard holds, in memory: rows by table, files by path; gathered from the homes in it."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from pipeline.manifest import sha256
from pipeline.shards.layout import TABLES, file_path

Row = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class ShardContent:
    """Rows by table name, and files by path relative to the dataset (`usd/shard-00000/...`)."""

    rows: Mapping[str, Sequence[Row]]
    files: Mapping[str, bytes] = field(default_factory=dict)


def gather(number: int, homes: Iterable[tuple[Mapping[str, Sequence[Row]], Mapping[str, bytes]]]) -> ShardContent:
    """Gather the homes of shard `number`: each brings rows by table and files named `<family>/<file>`.

    Files move into the shard's folder of their family, and the scenes rows' `usd` and `usd_sha256` follow.
    """
    rows: dict[str, list[Row]] = {table: [] for table in TABLES}
    files: dict[str, bytes] = {}
    for brought, named in homes:
        moved = {path: file_path(*_split(path, number)) for path in named}
        files |= {moved[path]: data for path, data in named.items()}
        for table, some in brought.items():
            rows.setdefault(table, []).extend(_with_usd_path(row, moved, named) if table == "scenes" else row for row in some)
    return ShardContent(rows, files)


def _split(path: str, number: int) -> tuple[str, int, str]:
    family, _, name = path.partition("/")
    return family, number, name


def _with_usd_path(scene: Row, moved: Mapping[str, str], files: Mapping[str, bytes]) -> Row:
    usd = scene["usd"]
    return {**scene, "usd": moved[usd], "usd_sha256": sha256(files[usd])} if usd else scene
