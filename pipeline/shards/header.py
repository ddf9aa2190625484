"""dataset.json: what a dataset is, so that a run resumes an equal one and leaves every other alone."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from pipeline import taxonomy
from pipeline.errors import ContentError, UsageError
from pipeline.manifest import digest, sha256
from pipeline.shards.layout import HEADER
from schemas.table import SCHEMA_VERSION

FORMAT = "sfgen-dataset-3"
REMEDY = "give a folder that `sfgen shard`, `sfgen generate` or `dvc repro` made"


def everything() -> dict[str, list[str]]:
    """Return what homes may hold: every category and every room type, in an order that a dataset keeps."""
    known = taxonomy.load()
    return {"categories": list(known.categories), "room_types": sorted({*known.types, *known.layout_types})}


@dataclass(frozen=True, slots=True)
class Header:
    """The identity of a dataset.

    Homes have the indices 0 ... count - 1; shard k holds those from k * `shard_size` on. `digests` names everything
    else that a home depends on: params, weights, library, code, prompts. `licence` is the one that binds the whole.
    `versions` are those of what computes: the last bits of a number hang on packages and on the processor's instructions.
    `preview` is the side of the top views [px], 0 where there are none. `vocabulary` lists all `categories` and `room_types` that may occur, so that class numbers do not hang on what does.
    """

    seed: int
    count: int
    shard_size: int
    licence: str
    digests: Mapping[str, str] = field(default_factory=dict)
    versions: Mapping[str, str] = field(default_factory=dict)
    preview: int = 0
    vocabulary: Mapping[str, list[str]] = field(default_factory=everything)
    schema_version: str = SCHEMA_VERSION
    format: str = FORMAT

    @property
    def shards(self) -> int:
        """Number of shards."""
        return -(-self.count // self.shard_size)

    def indices(self, number: int) -> range:
        """Return the indices of the homes of shard `number`."""
        return range(number * self.shard_size, min(self.count, (number + 1) * self.shard_size))

    def to_json(self) -> dict[str, Any]:
        """Return the JSON object of dataset.json."""
        return {**asdict(self), "digests": dict(self.digests)}

    def differences(self, other: Header) -> list[str]:
        """Return what differs, in words: `seed 1, not 2`."""
        long = {"digests", "versions", "vocabulary"}
        mine, theirs = (
            {**{k: v for k, v in h.to_json().items() if k not in long}, **h.versions}
            | {f"digest of {k}": v[:12] for k, v in {**h.digests, "vocabulary": digest(h.vocabulary)}.items()}
            for h in (self, other)
        )
        names = [n for n in {**mine, **theirs} if mine.get(n) != theirs.get(n)]
        return [f"{name} {mine.get(name)}, not {theirs.get(name)}" for name in names]

    def grows_to(self, header: Header) -> bool:
        """Tell whether a dataset of this header may become one of `header`: equal, or larger where the last shard is full."""
        full = self.count % self.shard_size == 0
        return replace(self, count=header.count) == header and (header.count == self.count or (header.count > self.count and full))

    def require_resumable(self, header: Header, place: Path | str) -> None:
        """Raise UsageError where the dataset in `place`, which has this header, cannot become one of `header`."""
        if self.grows_to(header):
            return
        remedy = "give another --out, or the options of the run that made it"
        if replace(self, count=header.count) == header and header.count > self.count:
            remedy = f"its last shard is not full, and committed shards are never rewritten: give another --out, or --count {self.count}"
        raise UsageError(f"{place} holds another dataset ({'; '.join(self.differences(header))})", remedy)


def read_header(folder: Path) -> Header:
    """Read a dataset's header. Raises ContentError when it is missing, broken, or of another format or schema version."""
    path = folder / HEADER
    try:
        return parse_header(path.read_bytes(), path)
    except FileNotFoundError as error:
        raise ContentError(f"{folder} holds no dataset ({HEADER} is missing)", REMEDY) from error
    except OSError as error:
        raise ContentError(f"cannot read {path} ({error.strerror})", REMEDY) from error


def parse_header(text: bytes, path: Path | str) -> Header:
    """Return the header that was read from `path`. Raises ContentError when it is broken, or of another format or schema version."""
    try:
        data = json.loads(text.decode("utf-8"))
    except ValueError as error:
        raise ContentError(f"cannot read {path} ({str(error).splitlines()[0]})", REMEDY) from error
    names = {f.name for f in fields(Header)}
    if not isinstance(data, dict) or data.get("format") != FORMAT or data.keys() != names:
        raise ContentError(f"{path} does not describe a dataset of format {FORMAT}", REMEDY)
    header = Header(**data)
    if header.schema_version != SCHEMA_VERSION:
        versions = f"version {header.schema_version}, and this release of sfgen reads {SCHEMA_VERSION}"
        raise ContentError(f"{path} is of tables of {versions}", "use the release that made it")
    numbers = (header.seed, header.count, header.shard_size)
    counted = all(type(n) is int for n in numbers) and min(numbers[1:]) >= 1
    if not counted or not isinstance(header.digests, dict) or not isinstance(header.vocabulary, dict):
        raise ContentError(f"{path} holds numbers that cannot be (seed, count, shard_size = {numbers})", REMEDY)
    return header


def code_digest(root: Path, parts: Iterable[str] = ("schemas", "pipeline", "manifests")) -> str:
    """Return the digest of code by the folders and files of the checkout at `root` that hold it; by default of all that homes depend on."""
    files = [p for part in parts for p in (root / part, *(root / part).rglob("*")) if p.is_file()]
    kept = sorted((p.relative_to(root).as_posix(), p) for p in files if "__pycache__" not in p.parts)
    return sha256("\n".join(f"{name} {sha256(path.read_bytes())}" for name, path in kept).encode())
