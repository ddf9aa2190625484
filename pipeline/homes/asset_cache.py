"""Assets as USD, written once on a machine and linked into every dataset that uses them.

An entry is a folder named after the asset and the digest of its file, beside a commit file that vouches for its bytes. What the
bytes depend on besides (the code that writes, its libraries) names the folder above; the oldest of those go when there is too much.
"""

import fcntl
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from typing import Any

from pipeline.homes.library import Library
from pipeline.manifest import digest, write_json
from pipeline.shards import code_digest
from pipeline.shards.commits import read_file, record
from pipeline.usd.library import write_asset
from schemas import ASSET_JOINTS, ASSETS
from schemas.table import Table

MOST = 2 << 30  # bytes of all versions together
WRITERS = ("usd-core", "numpy", "pillow", "numba")  # packages that an asset's bytes pass through
ROOT = Path(__file__).resolve().parents[2]
CODE = (  # what `write_asset` runs and reads of the checkout: no other change of it writes all assets again
    *(f"pipeline/{name}" for name in ("entities", "geometry", "rendering", "usd", "__init__.py")),
    *(f"pipeline/{name}.py" for name in ("arrays", "card", "errors", "params", "style", "taxonomy", "yaml_text")),
    *(f"manifests/{name}" for name in ("categories", "materials.yaml", "rooms.yaml", "styles.yaml")),
)


class AssetCache:
    """The cached files of a library, in `folder` or where this machine keeps them."""

    def __init__(self, library: Library, folder: Path | None = None) -> None:
        self.library = library
        self.folder = (folder or cache_folder()) / "assets" / digest([code_digest(ROOT, CODE), *map(version, WRITERS)])[:16]
        self._stocked: set[str] = set()

    def entry(self, asset_id: str) -> Path:
        """Return the folder of an asset's files, after writing it where it is missing or broken."""
        place = self.folder / f"{asset_id}-{self.library.rows[asset_id]['sha256'][:16]}"
        seal = place.with_suffix(".json")
        if not whole(place, seal):
            if not self.folder.exists():
                self.folder.mkdir(parents=True, exist_ok=True)
                make_room(self.folder)
            with alone(place.with_suffix(".lock")):
                if not whole(place, seal):  # another process may have written it meanwhile
                    self._write(asset_id, place, seal)
        return place

    def stock(self, asset_ids: Iterable[str]) -> None:
        """See that assets have their entries; each is looked at once, since that costs as much as reading it."""
        for asset_id in sorted(set(asset_ids) - self._stocked):
            self.entry(asset_id)
            self._stocked.add(asset_id)

    def tables(self, asset_ids: Sequence[str]) -> Mapping[Table, Iterable[Mapping[str, Any]]]:
        """Return the rows of assets and asset_joints that describe these assets, files as they lie in a dataset."""
        kept = set(asset_ids)
        return {
            ASSETS: [{**self.library.rows[a], "file": f"{a}/{a}.usda"} for a in asset_ids],
            ASSET_JOINTS: [row for row in self.library.joints if row["asset_id"] in kept],
        }

    def _write(self, asset_id: str, place: Path, seal: Path) -> None:
        """Write an asset under another name and exchange it with what is there: others may be reading."""
        with tempfile.TemporaryDirectory(prefix=".tmp-", dir=self.folder) as scratch:
            asset_folder = Path(scratch) / "made"
            write_asset(self.library[asset_id], asset_folder)
            commit = record(asset_folder, asset_id, {}, flush=False)
            for path in commit.files:
                (asset_folder / path).chmod(0o444)  # datasets share the file: what edits it in one would change it in all
            seal.unlink(missing_ok=True)
            if place.exists():
                place.rename(Path(scratch) / "old")
            asset_folder.rename(place)
            write_json(seal, commit.to_json())


def whole(place: Path, seal: Path) -> bool:
    """Tell whether an entry is there, and as its commit file says."""
    commit = read_file(seal) if seal.is_file() else None
    return commit is not None and not commit.first_change(place)


@contextmanager
def alone(path: Path) -> Iterator[None]:
    """Hold a file's lock: of the processes that would write one entry, one does, and the others wait."""
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def cache_folder() -> Path:
    """Return where this machine keeps what can be made again: SFGEN_CACHE, or `sfgen` in the user's cache folder."""
    named = os.environ.get("SFGEN_CACHE")
    return Path(named) if named else Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "sfgen"


def make_room(newest: Path, most: int = MOST) -> None:
    """Remove the oldest versions beside `newest` until all take `most` bytes or less."""
    versions = sorted((p for p in newest.parent.iterdir() if p.is_dir()), key=lambda p: p.stat().st_mtime, reverse=True)
    total = 0
    for folder in (newest, *(p for p in versions if p != newest)):
        total += sum(p.stat().st_size for p in folder.rglob("*") if p.is_file())
        if total > most and folder != newest:
            shutil.rmtree(folder, ignore_errors=True)
