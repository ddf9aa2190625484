"""Folders and names on disk: flushed, linked."""

from __future__ import annotations

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
