"""Folders and names on disk: flushed, linked, put."""

import os
import shutil
from pathlib import Path


def sync(path: Path) -> None:
    """Flush a file's content, or a folder's entries, to disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def link(source: str | Path, target: str | Path) -> None:
    """Give a file a second name; copy it where that cannot be (another file system, too many names)."""
    try:
        os.link(source, target)
    except OSError:
        shutil.copyfile(source, target)


def write_durably(path: Path, data: bytes, staging: Path) -> None:
    """Write a file whole or not at all, by way of a folder that nobody else writes in; it is on disk, and so is its name."""
    staging.mkdir(parents=True, exist_ok=True)
    path.parent.mkdir(exist_ok=True)
    temporary = staging / path.name
    temporary.write_bytes(data)
    sync(temporary)
    temporary.replace(path)
    sync(path.parent)
    sync(path.parent.parent)
