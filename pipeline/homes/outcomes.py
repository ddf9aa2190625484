"""What becomes of a request: a home that ships, with its rows and files, or an index that stays empty with its reason."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from pipeline.entities.asset import Asset
from pipeline.entities.home import Home
from pipeline.errors import SfgenError
from pipeline.homes.rows import REASONS, Row
from pipeline.preview.top import top_view
from pipeline.rendering.png import png
from pipeline.shards import EMPTY, scene_id
from pipeline.usd.home import home_layer
from pipeline.usd.layer import crate
from pipeline.usd.mujoco import home_overlay
from pipeline.verify import Certificate

LIBRARY = "../../assets"  # as seen from usd/shard-00000/


@dataclass(frozen=True, slots=True)
class Outcome:
    """A home that ships. `rows` by table, `files` by `<family>/<name>`."""

    home: Home
    certificate: Certificate
    rows: dict[str, list[Row]]
    files: dict[str, bytes]


@dataclass(frozen=True, slots=True)
class Empty:
    """A home that could not be made: the reason code, what a user is told, and the rows of what was tried."""

    index: int
    reason: str
    error: SfgenError
    rejects: list[Row] = field(default_factory=list)

    def rows(self, seed: int) -> dict[str, list[Row]]:
        """Return the rows of rejects. Raises KeyError for a code that REASONS lacks."""
        REASONS[self.reason]  # a typo must not reach the table
        detail = " ".join(str(self.error).split())[:400]
        return {"rejects": [*self.rejects, {"what": EMPTY, "where": scene_id(seed, self.index), "reason": self.reason, "detail": detail}]}


def files_of(home: Home, assets: Mapping[str, Asset], preview: int) -> dict[str, bytes]:
    """Return the USD stage, its MuJoCo overlay and the preview of a home by `<family>/<name>`; `preview` is the side of the top view [px], 0 for none."""
    stage, name = home_layer(home, assets, LIBRARY), f"usd/{home.scene_id}"
    overlay = home_overlay(stage, f"{home.scene_id}.usdc")
    files = {f"{name}.usdc": crate(stage), f"{name}.mujoco.usda": overlay.ExportToString().encode()}
    if preview:
        files[f"previews/{home.scene_id}.png"] = png(top_view(home, assets, preview))
    return files
