"""Where a dataset lies: a folder of this machine, or of any file system that fsspec knows (s3://, gs://, memory:// ...)."""

from pathlib import Path
from typing import Any, BinaryIO

import pyarrow as pa
import pyarrow.parquet as pq


class DatasetError(ValueError):
    """A folder that is no dataset, or one with a file missing or broken; the message says which and what to do."""

    exit_code = 1  # of a command that it ends


class Place:
    """A folder, and the files below it by their names relative to it."""

    def __init__(self, path: str | Path) -> None:
        self.name = str(path)
        self._system: Any = None
        if "://" in self.name:
            try:
                from fsspec.core import url_to_fs

                self._system, self._root = url_to_fs(self.name)
            except (ImportError, ValueError) as error:
                reason = str(error).splitlines()[0]
                msg = f"{self.name} cannot be reached ({reason}); install 'sfgen[remote]' and the package of its kind of place: s3fs, gcsfs, adlfs"
                raise DatasetError(msg) from error

    def open(self, name: str) -> BinaryIO:
        """Open a file to read. Raises OSError."""
        file: BinaryIO = self._system.open(f"{self._root}/{name}", "rb") if self._system else (Path(self.name) / name).open("rb")
        return file

    def read(self, name: str) -> bytes:
        """Return a file's bytes. Raises OSError."""
        with self.open(name) as file:
            return file.read()

    def table(self, name: str, columns: list[str] | None = None) -> pa.Table:
        """Return the rows of a Parquet file, or some of its columns. Raises OSError and ArrowException.

        In this thread alone: Arrow's own threads now and then abort a process that ends while they do (apache/arrow 34314, 50482).
        """
        with self.open(name) as file:
            return pq.ParquetFile(file, pre_buffer=False).read(columns, use_threads=False)

    def names(self, folder: str) -> list[str]:
        """Return the names of what lies in a folder, sorted; none where there is no such folder."""
        try:
            if self._system:
                return sorted(p.rstrip("/").rpartition("/")[2] for p in self._system.ls(f"{self._root}/{folder}", detail=False))
            return sorted(p.name for p in (Path(self.name) / folder).iterdir())
        except FileNotFoundError:
            return []

    def files(self) -> dict[str, int]:
        """Return the length in bytes of every file, by name; -1 of a link that leads nowhere."""
        if self._system:
            entries = self._system.find(self._root, detail=True)
            return {path[len(self._root) :].lstrip("/"): entry["size"] for path, entry in entries.items()}
        root = Path(self.name)
        paths = [path for path in root.rglob("*") if path.is_symlink() or not path.is_dir()]
        return {path.relative_to(root).as_posix(): path.stat().st_size if path.exists() else -1 for path in paths}

    def exists(self, name: str) -> bool:
        """Tell whether a file or folder is there."""
        return bool(self._system.exists(f"{self._root}/{name}")) if self._system else (Path(self.name) / name).exists()

    def path(self, name: str) -> Path | str:
        """Return the path of a file, or its address where it is not on this machine."""
        return f"{self.name.rstrip('/')}/{name}" if self._system else Path(self.name) / name
