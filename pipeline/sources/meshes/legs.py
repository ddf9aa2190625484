"""Blocks in place of what furniture stands on, and bars that nothing is above."""

from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry import MultiPoint
from shapely.geometry.base import BaseGeometry

from pipeline.arrays import Bools, Floats
from pipeline.sources.meshes.mesh_solids import Part, combine_parts

UNDER = 0.2  # [m] above the floor below which furniture's legs and plinths are one block: no hand comes there
LOW, LEG = 0.55, 0.12  # [m] and under a table too low for a seat to be drawn up to it; how wide a leg of that is at most, or a stretcher
BAR = 0.03  # [m] how wide a bar is at most
SEAM = 0.005  # [m] between heights that are one
BESIDE = 0.02  # [m] how far a block may come out from under what one sees


def blocks_under(pieces: Sequence[Part], top: float) -> list[Part]:
    """Return the pieces with those no higher than `top` [m] as one block, or one under each of the others: no block stands where one sees the floor.

    Under an L-shaped sofa are two blocks: a common one would fill its corner.
    """
    plans = [MultiPoint(p.hull[:, :2]).convex_hull for p in pieces]
    below = [k for k, p in enumerate(pieces) if p.hull[:, 2].max() <= top]
    above = [k for k in range(len(pieces)) if k not in below]
    seen = shapely.union_all(plans).buffer(BESIDE)
    groups = [below]
    if above and not _hides_no_floor([plans[k] for k in below], seen):
        owners = [max(above, key=lambda i: (round(plans[k].intersection(plans[i]).area, 6), -i)) for k in below]
        groups = [[k for k, owner in zip(below, owners, strict=True) if owner == i] for i in above]
    blocks = [group for group in groups if len(group) > 1 and _hides_no_floor([plans[k] for k in group], seen)]
    alone = [p for k, p in enumerate(pieces) if not any(k in block for block in blocks)]
    return [*alone, *(combine_parts([pieces[k] for k in block]) for block in blocks)]


def _hides_no_floor(plans: Sequence[BaseGeometry], seen: BaseGeometry) -> bool:
    return bool(seen.covers(shapely.union_all(plans).convex_hull))


def legs_under(pieces: Sequence[Part], low: float, most: float) -> list[Part]:
    """Return what is under the lowest thing wider than LEG that ends above UNDER, where that is no higher than LOW and no leg than `most` [m]."""
    tops, bottoms = np.array([[p.hull[:, 2].max(), p.hull[:, 2].min()] for p in pieces]).T - low
    wide = np.array([np.sort(np.ptp(p.hull, axis=0))[1] > LEG for p in pieces])  # a board, whichever way it stands
    deck = float(bottoms[wide & (tops > UNDER)].min(initial=np.inf))
    legs = tops <= deck + SEAM
    if deck > LOW or not UNDER < tops[legs].max(initial=0.0) <= most + SEAM:
        return []
    return [p for p, is_leg in zip(pieces, legs, strict=True) if is_leg]


def narrow_bars(boxes: Floats) -> Bools:
    """Return which of pieces, by their boxes (P, 2, 3), are narrow and have no other above them."""
    over = (boxes[:, None, 0, 2] >= boxes[None, :, 1, 2] - SEAM) & (boxes[:, None, 0] < boxes[None, :, 1])[:, :, :2].all(axis=2)
    over &= (boxes[:, None, 1] > boxes[None, :, 0])[:, :, :2].all(axis=2)
    np.fill_diagonal(over, val=False)
    return np.asarray((np.ptp(boxes[:, :, :2], axis=1).min(axis=1) <= BAR) & ~over.any(axis=0))
