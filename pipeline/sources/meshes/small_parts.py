"""What of furniture nobody feels piece by piece: feet of handles, what it stands on, bars that nothing is above; what is soft.

Feet hold the bar of a handle before its front: a hand takes hold of the bar and comes behind it. Legs and plinths close above the floor are a block.
"""

from collections.abc import Sequence

import numpy as np
import shapely
from scipy.spatial import ConvexHull
from shapely.geometry import MultiPoint
from shapely.geometry.base import BaseGeometry

from pipeline.arrays import Bools, Floats
from pipeline.sources.meshes.mesh_solids import MAX_HULL, Part, combine_parts, convex_part, distances_outside, extremes

CORNERS = 8  # of the outline on which a soft thing lies, and of a level top, at most
SOLE = 0.8  # share of its outline that a soft thing lies on
RISE = 0.12  # share of its height below which it has no other corners: PhysX tilts what all but lies on a rounded edge
FOOT = (0.045, 0.018)  # [m] a foot is no longer, no wider
MEET = 0.001  # [m] between pieces that meet
APART = 0.016  # [m] from what it stands between no point of it is further
SLIGHT = 3  # times as long are both of those
UNDER = 0.2  # [m] above the floor below which furniture's legs and plinths are one block: no hand comes there
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


def narrow_bars(boxes: Floats) -> Bools:
    """Return which of pieces, by their boxes (P, 2, 3), are narrow and have no other above them."""
    over = (boxes[:, None, 0, 2] >= boxes[None, :, 1, 2] - SEAM) & (boxes[:, None, 0] < boxes[None, :, 1])[:, :, :2].all(axis=2)
    over &= (boxes[:, None, 1] > boxes[None, :, 0])[:, :, :2].all(axis=2)
    np.fill_diagonal(over, val=False)
    return np.asarray((np.ptp(boxes[:, :, :2], axis=1).min(axis=1) <= BAR) & ~over.any(axis=0))


def level_top(part: Part, lift: float) -> Part:
    """Return a cushion with a level top: what lies on a swell rolls, where a real one gives way."""
    top = float(part.hull[:, 2].max())
    upper = _outline(part.hull[part.hull[:, 2] > top - lift])
    level = np.column_stack([upper[:, :2], np.full(len(upper), top)])  # all of its corners stay, however many the sides have
    return convex_part(np.concatenate([extremes(part.hull, MAX_HULL - len(level)), level]), part.volume) or part


def _outline(points: Floats) -> Floats:
    """Return those of points (N, 3) that are farthest out, seen from above, at most CORNERS."""
    turns = 2 * np.pi * np.arange(CORNERS) / CORNERS
    return np.asarray(points[np.unique(np.argmax(points[:, :2] @ [np.cos(turns), np.sin(turns)], axis=0))])


def lie_flat(part: Part) -> Part:
    """Return a soft thing as it lies: its outline, drawn in a little, on what bears it."""
    around = _outline(part.hull)
    middle = (part.hull.min(axis=0) + part.hull.max(axis=0)) / 2
    low, high = part.hull[:, 2].min(), part.hull[:, 2].max()
    sole = np.column_stack([middle[:2] + SOLE * (around[:, :2] - middle[:2]), np.full(len(around), low)])
    above = part.hull[part.hull[:, 2] > low + RISE * (high - low)]
    return convex_part(np.concatenate([extremes(above, MAX_HULL - len(sole)), sole]), part.volume) or part
