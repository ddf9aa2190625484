"""A finished home as files: the USD stage, its MuJoCo overlay, the plan, the preview."""

from __future__ import annotations

import io
import tempfile
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from pipeline import tables
from pipeline.entities.asset import Asset
from pipeline.entities.home import Home
from pipeline.execution import map_shards
from pipeline.homes.library import Library
from pipeline.preview import top_view
from pipeline.usd.home import write_home
from pipeline.usd.library import write_asset
from pipeline.usd.mujoco import write_mujoco_overlay
from schemas.assets import ASSET_JOINTS, ASSETS

PART = 32  # assets that one worker writes at a time
WORTH = 200  # assets: a worker takes longer to start than to write fewer
LIBRARY = "../../assets"  # as seen from usd/shard-00000/


def files_of(home: Home, assets: Mapping[str, Asset], preview: int) -> dict[str, bytes]:
    """Return the home's files by `<family>/<name>`; `preview` is the side of the top view [px], 0 for none."""
    files: dict[str, bytes] = {}
    # pxr writes to paths only; the bytes do not depend on where.
    with tempfile.TemporaryDirectory() as folder:
        stage = write_home(home, assets, Path(folder) / f"{home.scene_id}.usdc", LIBRARY)
        for path in (stage, write_mujoco_overlay(stage)):
            files[f"usd/{path.name}"] = path.read_bytes()
    if preview:
        buffer = io.BytesIO()
        top_view(home, assets, preview).save(buffer, format="PNG")
        files[f"previews/{home.scene_id}.png"] = buffer.getvalue()
    return files


def write_assets(library: Library, folder: Path, asset_ids: Sequence[str], workers: int = 1) -> None:
    """Write those assets as USD with a thumbnail each, and beside them their rows of assets and asset_joints."""
    parts = [(n, tuple(asset_ids[start : start + PART])) for n, start in enumerate(range(0, len(asset_ids), PART))]
    workers = min(workers, len(asset_ids) // WORTH)
    for _ in map_shards(partial(_write_part, library.unread(), folder), parts, workers=workers):
        pass
    kept = set(asset_ids)
    tables.write(folder / "assets.parquet", ASSETS, [{**library.rows[a], "file": f"{a}/{a}.usda"} for a in asset_ids])
    tables.write(folder / "asset_joints.parquet", ASSET_JOINTS, [row for row in library.joints if row["asset_id"] in kept])


def _write_part(library: Library, folder: Path, asset_ids: tuple[str, ...]) -> None:
    for asset_id in asset_ids:
        asset = library[asset_id]
        write_asset(asset, folder / asset_id)
