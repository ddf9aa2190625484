"""What low tables stand on, and bars that nothing is above."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pipeline.sources.meshes.mesh_solids import Part

Floats = NDArray[np.float64]

UNDER = 0.2  # [m] above the floor below which furniture's legs and plinths are one block: no hand comes there
LOW, LEG = 0.55, 0.12  # [m] and under a table too low for a seat to be drawn up to it; how wide a leg of that is at most, or a stretcher
BAR = 0.03  # [m] how wide a bar is at most
SEAM = 0.005  # [m] between heights that are one


def legs_under(pieces: Sequence[Part], low: float, most: float) -> list[Part]:
    """Return what is under the lowest thing wider than LEG that ends above UNDER, where that is no higher than LOW and no leg than `most` [m]."""
    tops, bottoms = np.array([[p.hull[:, 2].max(), p.hull[:, 2].min()] for p in pieces]).T - low
    wide = np.array([np.sort(np.ptp(p.hull, axis=0))[1] > LEG for p in pieces])  # a board, whichever way it stands
    deck = float(bottoms[wide & (tops > UNDER)].min(initial=np.inf))
    legs = tops <= deck + SEAM
    if deck > LOW or not UNDER < tops[legs].max(initial=0.0) <= most + SEAM:
        return []
    return [p for p, is_leg in zip(pieces, legs, strict=True) if is_leg]


def narrow_bars(boxes: Floats) -> NDArray[np.bool_]:
    """Return which of pieces, by their boxes (P, 2, 3), are narrow and have no other above them."""
    over = (boxes[:, None, 0, 2] >= boxes[None, :, 1, 2] - SEAM) & (boxes[:, None, 0] < boxes[None, :, 1])[:, :, :2].all(axis=2)
    over &= (boxes[:, None, 1] > boxes[None, :, 0])[:, :, :2].all(axis=2)
    np.fill_diagonal(over, val=False)
    return np.asarray((np.ptp(boxes[:, :, :2], axis=1).min(axis=1) <= BAR) & ~over.any(axis=0))
