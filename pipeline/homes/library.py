"""The library of assets on disk: files are read when first asked for; meshes and textures are let go before the rest, and read again when somebody looks at them."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from pipeline import tables
from pipeline.entities.asset import Asset, Link
from pipeline.entities.files import load_asset
from pipeline.errors import ContentError
from pipeline.manifest import digest
from schemas import ASSET_JOINTS, ASSETS

MEMORY = 700  # of a process that makes homes [MiB]
BESIDE = 690  # of that, what modules, models, tables and the homes in the making take at their peaks, measured [MiB]
READ = 1.5  # bytes in memory for a byte of an asset file, and what is derived from it, measured
LEAN = 8  # assets that are kept without meshes, for each that is kept whole: with what was derived they are a quarter as large, and are asked for all the time


class Library(Mapping[str, Asset]):
    """Assets by id. `rows` are the assets table's rows by id, `joints` those of asset_joints.

    Meshes and textures stay in memory up to `kept` bytes of files; then those that were not looked at the longest go, and later the rest of an asset
    with what was derived from it.
    """

    def __init__(self, folder: Path, rows: list[dict[str, Any]], joints: list[dict[str, Any]], kept: int = 0) -> None:
        self.folder = folder
        self.joints = joints
        self.rows = {row["asset_id"]: row for row in rows}
        self.kept = kept or kept_within(MEMORY)
        self._whole: OrderedDict[str, tuple[Asset, int]] = OrderedDict()  # as read, and the bytes of its file
        self._bytes = 0
        self._lean: OrderedDict[str, Asset] = OrderedDict()
        self._shelves: dict[str, list[str]] = {}
        for asset_id in sorted(self.rows):
            self._shelves.setdefault(self.rows[asset_id]["category"], []).append(asset_id)

    @classmethod
    def read(cls, folder: Path, files: Path) -> Library:
        """Read the tables assets and asset_joints of `folder`; the asset files lie in `files`."""
        return cls(files, tables.read(folder / "assets.parquet", ASSETS), tables.read(folder / "asset_joints.parquet", ASSET_JOINTS))

    def __getitem__(self, asset_id: str) -> Asset:
        if asset_id in self._lean:
            self._lean.move_to_end(asset_id)
            return self._lean[asset_id]
        read = partial(self._read, asset_id)
        asset = self._lean[asset_id] = replace(read(), links=_Links(lambda: read().links), textures=_Textures(lambda: read().textures))
        while len(self._lean) > LEAN * len(self._whole):
            self._lean.popitem(last=False)
        return asset

    def _read(self, asset_id: str) -> Asset:
        """Return an asset with its meshes, from the file unless it is still there."""
        if asset_id in self._whole:
            self._whole.move_to_end(asset_id)
            return self._whole[asset_id][0]
        path = self.folder / self.rows[asset_id]["file"]
        if not path.is_file():
            raise ContentError(f"asset file {path} is missing", "run `dvc repro preprocess`")
        asset, size = load_asset(path), path.stat().st_size
        self._whole[asset_id] = asset, size
        self._bytes += size
        while self._bytes > self.kept and len(self._whole) > 1:
            self._bytes -= self._whole.popitem(last=False)[1][1]
        return asset

    def __iter__(self) -> Iterator[str]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def of(self, category: str) -> list[str]:
        """Return the ids of a category's assets, sorted."""
        return self._shelves.get(category, [])

    def digest(self) -> str:
        """Return the digest of all asset files, from the sums in the table."""
        return digest({row["asset_id"]: row["sha256"] for row in self.rows.values()})


def kept_within(memory: int) -> int:
    """Return the bytes of asset files that a process of `memory` [MiB] may keep, read; a few at least."""
    return max(8 << 20, int((memory - BESIDE) * (1 << 20) / READ))


class _Later:
    """What an asset holds by key, as `read` gives it whenever somebody looks."""

    def __init__(self, read: Callable[[], Any]) -> None:
        self._read = read

    def __getitem__(self, key: Any) -> Any:
        return self._read()[key]

    def __iter__(self) -> Iterator[Any]:
        return iter(self._read())

    def __len__(self) -> int:
        return len(self._read())


class _Links(_Later, Sequence[Link]):
    """An asset's links."""


class _Textures(_Later, Mapping[str, bytes]):
    """An asset's textures."""
