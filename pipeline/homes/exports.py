"""A finished home as files: the USD stage, its MuJoCo overlay, the plan, the preview."""

from collections.abc import Mapping

from pipeline.entities.asset import Asset
from pipeline.entities.home import Home
from pipeline.preview.top import top_view
from pipeline.rendering.png import png
from pipeline.usd.home import home_layer
from pipeline.usd.layer import crate
from pipeline.usd.mujoco import home_overlay

LIBRARY = "../../assets"  # as seen from usd/shard-00000/


def files_of(home: Home, assets: Mapping[str, Asset], preview: int) -> dict[str, bytes]:
    """Return the home's files by `<family>/<name>`; `preview` is the side of the top view [px], 0 for none."""
    files: dict[str, bytes] = {}
    stage = home_layer(home, assets, LIBRARY)
    files[f"usd/{home.scene_id}.usdc"] = crate(stage)
    overlay = home_overlay(stage, f"{home.scene_id}.usdc")
    files[f"usd/{home.scene_id}.mujoco.usda"] = overlay.ExportToString().encode()
    if preview:
        files[f"previews/{home.scene_id}.png"] = png(top_view(home, assets, preview))
    return files
