"""Digests and atomic files: nothing half-written survives a kill."""

import hashlib
import json
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any


def sha256(data: bytes) -> str:
    """Return the hex digest of `data`."""
    return hashlib.sha256(data).hexdigest()


def sha256_file(path: Path) -> str:
    """Return the hex digest of a file's content."""
    with path.open("rb") as handle:
        return hashlib.file_digest(handle, "sha256").hexdigest()


def digest(value: Any) -> str:
    """Return the digest of a JSON-able value, independent of the order of keys."""
    return sha256(canonical(value))


def canonical(value: Any) -> bytes:
    """Serialise to JSON with sorted keys, no blanks, no NaN."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False, ensure_ascii=False).encode()


def write_bytes(path: Path, data: bytes, *, flush: bool = True) -> None:
    """Write a file whole or not at all: temporary name beside it, fsync, rename.

    Without `flush` it is whole after a kill, not after a power cut: for the many files of a stage, which runs again then.
    """
    with replacing(path, flush=flush) as temporary:
        temporary.write_bytes(data)


def write_json(path: Path, value: Any) -> None:
    """Write indented JSON with sorted keys, atomically."""
    write_bytes(path, text_of(value))


def text_of(value: Any) -> bytes:
    """Return the bytes that `write_json` writes."""
    return (json.dumps(value, sort_keys=True, indent=2, allow_nan=False, ensure_ascii=False) + "\n").encode()


def write_with(path: Path, writer: Callable[[Path], object]) -> None:
    """Let `writer` fill a temporary file with the suffix of `path`, then fsync and rename it to `path`."""
    with replacing(path) as temporary:
        writer(temporary)


@contextmanager
def replacing(path: Path, *, flush: bool = True) -> Iterator[Path]:
    """Give a temporary file with the suffix of `path` to fill; it becomes `path` when the block ends without an error."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".tmp-{os.getpid()}-{path.name}")
    try:
        yield temporary
        if flush:
            with temporary.open("rb") as handle:
                os.fsync(handle.fileno())
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
