"""What of furniture nobody feels piece by piece: feet of handles, rows of like things, what it stands on, bars that nothing is above.

Feet hold the bar of a handle before its front: a hand takes hold of the bar and comes behind it. Between the things of a row, bottles on a rack or
grates of a hob, no hand comes: a block each. So are legs and plinths close above the floor.
"""

from collections.abc import Sequence

import numpy as np
import shapely
from scipy.spatial import ConvexHull
from shapely.geometry import MultiPoint
from shapely.geometry.base import BaseGeometry

from pipeline.arrays import Bools, Floats
from pipeline.sources.meshes.mesh_solids import Part, combine_parts, distances_outside

FOOT = (0.045, 0.018)  # [m] a foot is no longer, no wider
MEET = 0.001  # [m] between pieces that meet
APART = 0.016  # [m] from what it stands between no point of it is further
SLIGHT = 3  # times as long are both of those
GAP = (0.002, 0.045)  # [m] between neighbours of a row: what touches is of one thing, a basin of four quarters
LIKE = 0.005  # [m] within which sizes and places are one
UNDER = 0.2  # [m] above the floor below which furniture's legs and plinths are one block: no hand comes there
LOW, LEG = 0.55, 0.12  # [m] and under a table too low for a seat to be drawn up to it; how wide a leg of that is at most, or a stretcher
BAR = 0.03  # [m] how wide a bar is at most
SEAM = 0.005  # [m] between heights that are one
BESIDE = 0.02  # [m] how far a block may come out from under what one sees


def without_feet(pieces: Sequence[Part]) -> list[Part]:
    """Return convex pieces without the feet among them."""
    extents = [np.sort(np.ptp(p.hull, axis=0)) for p in pieces]
    slight = [k for k, extent in enumerate(extents) if extent[2] <= FOOT[0] and extent[1] <= FOOT[1]]
    planes = [ConvexHull(p.hull).equations for p in pieces] if slight else []
    feet = set()
    for k in slight:
        corners = pieces[k].hull
        larger = [i for i, extent in enumerate(extents) if extent[2] >= SLIGHT * extents[k][2]]
        ends = [i for i in larger if distances_outside(corners, planes[i]).min() < MEET]
        edges = (corners[:, None] + corners[None]).reshape(-1, 3) / 2  # their middles too, and points within
        if len(ends) > 1 and np.min([distances_outside(edges, planes[i]) for i in ends], axis=0).max() <= APART:
            feet.add(k)
    return [p for k, p in enumerate(pieces) if k not in feet]


def rows_as_blocks(pieces: Sequence[Part]) -> list[Part]:
    """Return convex pieces [m] with rows of like ones as one: along x, then along y, so that a grid is one block as well."""
    for along in (0, 1):
        pieces = [combine_parts(row) if len(row) > 1 else row[0] for row in _rows(pieces, along)]
    return list(pieces)


def _rows(pieces: Sequence[Part], along: int) -> list[list[Part]]:
    """Return the pieces in rows along an axis, each of one piece at least."""
    across = 1 - along
    rows: list[list[Part]] = []
    last: list[tuple[Floats, Floats]] = []  # box of the last of each row
    for piece in sorted(pieces, key=lambda p: round(float(p.hull[:, along].min()), 6)):
        low, high = piece.hull.min(axis=0), piece.hull.max(axis=0)
        width = high[along] - low[along]
        for k, (low0, high0) in enumerate(last):
            gap = low[along] - high0[along]
            beside = np.abs(np.stack([low - low0, high - high0])[:, [across, 2]]).max() < LIKE
            close = GAP[0] < gap <= min(GAP[1], width)  # two thin boards hold something between them
            if beside and close and abs(width - (high0 - low0)[along]) < LIKE:
                rows[k].append(piece)
                last[k] = low, high
                break
        else:
            rows.append([piece])
            last.append((low, high))
    return rows


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
