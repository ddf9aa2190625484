"""Reading files that others wrote: never outside their folder, never more than a limit, always with a typed error."""

from __future__ import annotations

import json
import re
import stat
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any, NoReturn

import defusedxml
import numpy as np
from defusedxml import ElementTree

from pipeline.arrays import Floats
from pipeline.sources.reasons import SourceError

MIB = 1 << 20
MAX_JSON = 64 * MIB
LARGEST = 1e6  # number of a box, an axis or a limit, in any unit
# What a parsed document may cost: a list or object takes up to 250 bytes, any other value about 32. The limits keep
# the whole below 256 MiB; a house of 2 MB has 0.2 million values.
MAX_CONTAINERS = 300_000
MAX_VALUES = 3_000_000
_SCHEME = re.compile(r"^[A-Za-z][A-Za-z0-9+.-]+:")
DRIVE = re.compile(r"^[A-Za-z]:[\\/]")


@dataclass(frozen=True, slots=True)
class Folder:
    """A folder of a source; `root` is resolved. Paths are given relative to it, with forward slashes."""

    root: Path

    @classmethod
    def at(cls, path: Path) -> Folder:
        """Return the folder at `path`."""
        return cls(path.resolve())

    def sub(self, name: str) -> Folder:
        """Return a sub-folder. Raises SourceError when it leads out of this one."""
        return Folder(self._inside(name, name))

    def path(self, relative: str, base: str = "") -> Path:
        """Return the resolved path of a regular file; `base` is the folder (in this one) that the path is relative to.

        Raises SourceError `unsafe_path` for anything that leads out of the folder, `missing_file` when it is not there.
        """
        path = self._inside(relative, relative if not base else f"{base}/{relative}")
        try:
            mode = path.stat().st_mode
        except OSError as error:
            raise SourceError("missing_file", relative, "is not there") from error
        if not stat.S_ISREG(mode):  # a pipe or a device would hang or never end
            raise SourceError("missing_file", relative, "is no regular file")
        return path

    def read(self, relative: str, limit: int, base: str = "") -> bytes:
        """Return the content of a file of at most `limit` bytes."""
        path = self.path(relative, base)
        try:
            size = path.stat().st_size
            if size > limit:
                raise SourceError("too_large", relative, f"{size} bytes, the limit is {limit}")
            with path.open("rb") as handle:
                data = handle.read(limit + 1)
        except OSError as error:
            raise SourceError("missing_file", relative, f"cannot be read ({error.strerror})") from error
        if len(data) > limit:
            raise SourceError("too_large", relative, f"grew beyond {limit} bytes")
        return data

    def has(self, relative: str, base: str = "") -> bool:
        """Return whether a regular file lies there. Raises SourceError `unsafe_path` where a link leads out of the folder."""
        try:
            self.path(relative, base)
        except SourceError as error:
            if error.code != "missing_file":
                raise
            return False
        return True

    def _inside(self, shown: str, joined: str) -> Path:
        if not shown or len(joined) > 1024 or any(ord(c) < 32 for c in joined):
            raise SourceError("unsafe_path", shown[:80], "is no path")
        tail = shown.replace("\\", "/")
        if _SCHEME.match(tail) or DRIVE.match(tail) or tail.startswith(("/", "~")):
            raise SourceError("unsafe_path", shown[:80], "is an absolute path or has a scheme")
        depth = 0
        for part in PurePosixPath(joined.replace("\\", "/")).parts:
            depth += -1 if part == ".." else 1
            if depth < 0:
                raise SourceError("unsafe_path", shown[:80], "leads out of its folder")
        try:
            path = (self.root / joined.replace("\\", "/")).resolve()
        except (OSError, RuntimeError, ValueError) as error:  # loops of links
            raise SourceError("unsafe_path", shown[:80], "cannot be resolved") from error
        if not path.is_relative_to(self.root):
            raise SourceError("unsafe_path", shown[:80], "leads out of its folder through a link")
        return path


def read_json(folder: Folder, relative: str, limit: int = MAX_JSON) -> Any:
    """Read a JSON file strictly: UTF-8, no NaN or Infinity, bounded in depth and in the number of values.

    A number like 1e400 reads as infinity; whoever uses it checks (`floats`). Of duplicate keys the last wins.
    """
    return parse_json(folder.read(relative, limit), relative)


def finite_array(value: Any, *shape: int) -> Floats | None:
    """Return nested lists of numbers as an array of that shape; None for anything else, and for what is not finite or beyond a million."""
    try:
        numbers = np.asarray(value)
    except (ValueError, OverflowError):  # of unlike lengths
        return None
    if numbers.dtype.kind not in "iuf" or numbers.shape != shape or not np.isfinite(numbers).all() or np.abs(numbers).max() > LARGEST:
        return None
    return numbers.astype(np.float64)


def parse_json(data: bytes, where: str, lines: int = 0, characters: int = 0) -> Any:
    """Parse JSON bytes as `read_json` does; `lines` and `characters` of the file come before them, for messages to count in it."""
    head = data[:64].lstrip(b"\xef\xbb\xbf \t\r\n")
    if not head:
        raise SourceError("not_json", where, "is empty")
    if head[:2] == b"\x1f\x8b":
        raise SourceError("not_json", where, "is gzip data; unpack it")
    if head[:1] == b"<":
        raise SourceError("not_json", where, "is HTML or XML, a failed download perhaps")
    if data.count(b"[") + data.count(b"{") > MAX_CONTAINERS or data.count(b",") > MAX_VALUES:
        raise SourceError("too_large", where, "has too many values")

    def constant(name: str) -> NoReturn:
        raise SourceError("not_json", where, f"contains {name}")

    try:
        text = data.decode("utf-8-sig")
        del data  # one copy of a large file is enough
        return json.loads(text, parse_constant=constant)
    except RecursionError as error:
        raise SourceError("not_json", where, "is nested too deeply") from error
    except json.JSONDecodeError as error:
        place = f"line {lines + error.lineno}, column {error.colno}, character {characters + error.pos}"
        raise SourceError("not_json", where, f"cannot be parsed ({error.msg[:60]}: {place})") from error
    except ValueError as error:
        raise SourceError("not_json", where, f"cannot be parsed ({str(error)[:80]})") from error


def xml_root(data: bytes, code: str, where: str, most: int) -> Any:
    """Return the root element of a document of at most `most` opening brackets.

    Raises SourceError `too_large`, or `code` for what is not XML or holds a DTD, an entity or an external reference, naming `where`.
    """
    if data.count(b"<") > most:
        raise SourceError("too_large", where, "has too many elements")
    try:
        return ElementTree.fromstring(data, forbid_dtd=True)
    except defusedxml.DefusedXmlException as error:
        raise SourceError(code, where, "has a DTD, an entity or an external reference") from error
    except (ElementTree.ParseError, ValueError, LookupError, RecursionError) as error:
        raise SourceError(code, where, f"is not XML ({str(error)[:80]})") from error
