"""Inventories of real copies: what DVC depends on instead of hashing tens of gigabytes.

A CSV file with a header and a line per file: path (relative to the source's folder, forward slashes), size in bytes,
time of the last change in nanoseconds. Sorted by path, so that two of them can be compared line by line.
"""

import csv
import io
import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from pipeline.errors import ContentError
from pipeline.manifest import write_bytes
from pipeline.sources.source import Listing

FOLDER = Path("manifests/inventories")
HEADER = ("path", "size", "mtime_ns")
UNREAD = ("parts_render", "parts_render_after_merging", "point_sample")  # folders of PartNet objects that no reader opens
SHOWN = 3  # differences that a message names

Entry = tuple[str, int, int]


def scan(source: Listing) -> Iterator[Entry]:
    """Yield the files of a source that readers may open, sorted by path."""
    for part in sorted(source.parts):
        yield from _files(source.root, source.root / part)


def _files(root: Path, folder: Path) -> Iterator[Entry]:
    """Yield the files below a folder; its own files and folders in one order, links to folders not followed."""
    with os.scandir(folder) as listed:
        entries = sorted(listed, key=lambda e: e.name)
    for entry in entries:
        if entry.is_dir(follow_symlinks=False):
            if entry.name not in UNREAD:
                yield from _files(root, Path(entry.path))
        elif entry.is_file():
            stat = entry.stat()
            yield Path(entry.path).relative_to(root).as_posix(), stat.st_size, stat.st_mtime_ns


def write(path: Path, entries: Iterable[Entry]) -> int:
    """Write an inventory, whole or not at all; return how many files it lists."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(HEADER)
    count = 0
    for count, entry in enumerate(entries, 1):  # noqa: B007 - the count is what is left of it
        rows.writerow(entry)
    write_bytes(path, text.getvalue().encode("utf-8", "surrogateescape"))
    return count


def read(path: Path) -> list[Entry]:
    """Read an inventory. Raises ContentError when it is missing or none."""
    remedy = "write it with `sfgen doctor --use PATH`"
    try:
        lines = path.read_bytes().decode("utf-8", "surrogateescape").splitlines()
        header, *rows = csv.reader(lines)
        if tuple(header) != HEADER:
            raise ContentError(f"{path} is no inventory", remedy)
        return [(name, int(size), int(changed)) for name, size, changed in rows]
    except OSError as error:
        raise ContentError(f"the inventory {path} is missing", remedy) from error
    except (ValueError, csv.Error) as error:
        raise ContentError(f"{path} is no inventory ({error})", remedy) from error


def require_match(path: Path, source: Listing) -> None:
    """Raise ContentError, naming the first differences, when a source is not what its inventory lists."""
    changed = sorted({name for name, _, _ in set(read(path)) ^ set(scan(source))})
    if changed:
        more = f" and {len(changed) - SHOWN} more" if len(changed) > SHOWN else ""
        shown = ", ".join(changed[:SHOWN])
        raise ContentError(
            f"{source.root} is not what {path.name} lists: {shown}{more} changed",
            f"take it as it is with `sfgen doctor --use '{source.root}'`",
        )


def require_listed(root: Path, source: Listing) -> None:
    """Raise ContentError when a copy is not what its inventory in the checkout `root` lists.

    What stage corpus made, under data/raw, is DVC's to watch.
    """
    if not source.root.resolve().is_relative_to((root / "data" / "raw").resolve()):
        require_match(root / FOLDER / f"{source.key}.csv", source)
