"""The library of assets on disk: files are read when first asked for, and kept."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from pipeline import tables
from pipeline.entities.asset import Asset
from pipeline.entities.files import load_asset
from pipeline.errors import ContentError
from pipeline.manifest import digest
from schemas.assets import ASSET_JOINTS, ASSETS

KEPT = 128 << 20  # bytes of asset files that stay in memory, read


class Library(Mapping[str, Asset]):
    """Assets by id. `rows` are the assets table's rows by id, `joints` those of asset_joints.

    What is read stays in memory up to `kept` bytes of files; then what was not asked for the longest goes.
    """

    def __init__(self, folder: Path, rows: list[dict[str, Any]], joints: list[dict[str, Any]], kept: int = KEPT) -> None:
        self.folder = folder
        self.joints = joints
        self.rows = {row["asset_id"]: row for row in rows}
        self.kept = kept
        self._loaded: OrderedDict[str, tuple[Asset, int]] = OrderedDict()
        self._bytes = 0
        self._shelves: dict[str, list[str]] = {}
        for asset_id in sorted(self.rows):
            self._shelves.setdefault(self.rows[asset_id]["category"], []).append(asset_id)

    @classmethod
    def read(cls, folder: Path, files: Path) -> Library:
        """Read the tables assets and asset_joints of `folder`; the asset files lie in `files`."""
        return cls(files, tables.read(folder / "assets.parquet", ASSETS), tables.read(folder / "asset_joints.parquet", ASSET_JOINTS))

    def __getitem__(self, asset_id: str) -> Asset:
        if asset_id in self._loaded:
            self._loaded.move_to_end(asset_id)
            return self._loaded[asset_id][0]
        if asset_id not in self.rows:
            raise KeyError(asset_id)
        path = self.folder / self.rows[asset_id]["file"]
        if not path.is_file():
            raise ContentError(f"asset file {path} is missing", "run `dvc repro preprocess`")
        asset, size = load_asset(path), path.stat().st_size
        self._loaded[asset_id] = asset, size
        self._bytes += size
        while self._bytes > self.kept and len(self._loaded) > 1:
            self._bytes -= self._loaded.popitem(last=False)[1][1]
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
