"""A finished home as files: the USD stage, its MuJoCo overlay, the plan, the preview."""

from __future__ import annotations

import io
import tempfile
from collections.abc import Mapping
from pathlib import Path

from pipeline.entities.asset import Asset
from pipeline.entities.home import Home
from pipeline.preview import top_view
from pipeline.usd.home import write_home
from pipeline.usd.mujoco import write_mujoco_overlay

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
