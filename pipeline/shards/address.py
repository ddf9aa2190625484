"""A dataset at an address (s3://, gs://, memory:// ...): filled shard by shard from a folder of this machine, each commit file after what it names.

An object store has no rename, but an object is there whole or not at all: who reads meanwhile sees whole shards only, and a run that
was killed, here or on another machine, goes on with the shards that are committed there.
"""

import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from pipeline.errors import ContentError, UsageError
from pipeline.manifest import text_of
from pipeline.shards.commits import Commit, parse_commit, read_commit
from pipeline.shards.disk import write_durably
from pipeline.shards.header import Header, parse_header
from pipeline.shards.layout import ASSETS, HEADER, commit_path, shard_name
from pipeline.shards.seal import SEAL


class Address:
    """Where a dataset is to lie that is made in a folder here. Raises UsageError for an address that cannot be read as one."""

    def __init__(self, name: str) -> None:
        self.name = name.rstrip("/")
        try:
            from fsspec.core import url_to_fs

            folders = {"auto_mkdir": True} if self.name.startswith(("file://", "local://")) else {}
            self._system, self._root = url_to_fs(self.name, **folders)
        except (ImportError, ValueError) as error:
            remedy = "install 'sfgen[remote]' and the package of its kind of place: s3fs, gcsfs, adlfs"
            raise UsageError(f"{name} cannot be reached ({str(error).splitlines()[0]})", remedy) from error
        self._sent: set[tuple[str, int, int]] = set()  # files of the library that this run has sent: path, length, time of change

    def header(self) -> Header | None:
        """Return the header of the dataset that is there; None where nothing is. Raises UsageError where other files are."""
        with self._reaching():
            if self._system.exists(self._at(HEADER)):
                return parse_header(self._system.cat_file(self._at(HEADER)), f"{self.name}/{HEADER}")
            others = self._system.exists(self._root) and self._system.find(self._root, maxdepth=1)
        if others:
            raise UsageError(f"{self.name} holds other files", "give an address that is new or empty")
        return None

    def begin(self, folder: Path, header: Header, staging: Path) -> None:
        """Fetch the shards that are committed there and not here, and write the header there."""
        there = self.header()
        for number in range(there.shards if there else 0):
            self._fetch(folder, shard_name(number), staging)
        if there != header:
            with self._reaching():
                if self._system.exists(self._at(commit_path(SEAL))):
                    self._system.rm_file(self._at(commit_path(SEAL)))
                self._system.pipe_file(self._at(HEADER), text_of(header.to_json()))

    def send(self, folder: Path, name: str) -> None:
        """Send what a commit names, with the assets that are here, and then the commit; nothing is sent twice."""
        commit = read_commit(folder, name)
        assert commit is not None
        with self._reaching():
            if self._commit(name) == commit:
                return
            if name != SEAL:
                assets = [p.relative_to(folder).as_posix() for p in (folder / ASSETS).rglob("*") if p.is_file()]
                self._put(folder, sorted({*commit.files, *assets}))
            self._system.pipe_file(self._at(commit_path(name)), (folder / commit_path(name)).read_bytes())

    def _put(self, folder: Path, paths: Sequence[str]) -> None:
        known = {path: (path, (folder / path).stat().st_size, (folder / path).stat().st_mtime_ns) for path in paths}
        missing = [path for path in paths if known[path] not in self._sent]
        self._system.put([str(folder / path) for path in missing], [self._at(path) for path in missing])
        self._sent |= {known[path] for path in missing if path.startswith(f"{ASSETS}/")}

    def send_all(self, folder: Path, header: Header) -> None:
        """Send what is not there yet of a dataset that is sealed; the seal last."""
        for name in (*map(shard_name, range(header.shards)), ASSETS, SEAL):
            self.send(folder, name)

    def _fetch(self, folder: Path, name: str, staging: Path) -> None:
        with self._reaching():
            commit = self._commit(name)
            if commit is None or read_commit(folder, name) is not None:
                return
            place = staging / name
            shutil.rmtree(place, ignore_errors=True)
            for path in commit.files:
                (place / path).parent.mkdir(parents=True, exist_ok=True)
                self._system.get_file(self._at(path), str(place / path))
        if commit.first_change(place):  # it is made and sent again
            with self._reaching():
                self._system.rm_file(self._at(commit_path(name)))
            return
        for path in commit.files:
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (place / path).replace(folder / path)
        write_durably(folder / commit_path(name), text_of(commit.to_json()), staging)

    def _commit(self, name: str) -> Commit | None:
        path = self._at(commit_path(name))
        try:
            return parse_commit(self._system.cat_file(path), path)
        except (FileNotFoundError, ContentError):
            return None

    def _at(self, path: str) -> str:
        return f"{self._root}/{path}"

    @contextmanager
    def _reaching(self) -> Iterator[Any]:
        try:
            yield
        except (ContentError, UsageError):
            raise
        except Exception as error:  # each kind of place has errors of its own
            lines = str(error).strip().splitlines() or [type(error).__name__]
            message = f"{self.name} cannot be read or written ({lines[0][:200]})"
            raise ContentError(message, "mend that and start it again: it resumes") from error
