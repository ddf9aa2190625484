"""The home as prisms in the world: one group per placement."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement
from pipeline.geometry.contact import group_boxes
from pipeline.geometry.prisms import Prisms, Solid, join_prisms, solid


@dataclass(frozen=True, slots=True)
class Bodies:
    """Objects at rest: `prisms` of placement g are `start[g]` .. `start[g + 1]`; `flat` (P, 4), `boxes` (G, 6) bound them."""

    prisms: Prisms
    start: NDArray[np.int64]
    flat: NDArray[np.float64]
    boxes: NDArray[np.float64]
    solids: tuple[Solid, ...]


def bodies(placements: Sequence[Placement], assets: Mapping[str, Asset]) -> Bodies:
    """Place every object's rest prisms in the world."""
    solids = tuple(solid(assets[p.asset_id]) for p in placements)
    placed = [s.rest.placed(p.position, p.yaw, p.scale) for s, p in zip(solids, placements, strict=True)]
    start = np.concatenate([[0], np.cumsum([len(p) for p in placed], dtype=np.int64)]).astype(np.int64)
    prisms = join_prisms(placed)
    return Bodies(prisms, start, prisms.boxes(), group_boxes(prisms, start), solids)
