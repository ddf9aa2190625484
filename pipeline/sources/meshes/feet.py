"""Feet that hold the bar of a handle before its front: seen, not felt. A hand takes hold of the bar and comes behind it."""

from collections.abc import Sequence

import numpy as np
from scipy.spatial import ConvexHull

from pipeline.sources.meshes.mesh_solids import Part, outside

FOOT = (0.045, 0.018)  # [m] a foot is no longer, no wider
SEAM = 0.001  # [m] between pieces that meet
APART = 0.016  # [m] from what it stands between no point of it is further
SLIGHT = 3  # times as long are both of those


def without_feet(pieces: Sequence[Part]) -> list[Part]:
    """Return convex pieces without the feet among them."""
    extents = [np.sort(np.ptp(p.hull, axis=0)) for p in pieces]
    slight = [k for k, extent in enumerate(extents) if extent[2] <= FOOT[0] and extent[1] <= FOOT[1]]
    planes = [ConvexHull(p.hull).equations for p in pieces] if slight else []
    feet = set()
    for k in slight:
        corners = pieces[k].hull
        larger = [i for i, extent in enumerate(extents) if extent[2] >= SLIGHT * extents[k][2]]
        ends = [i for i in larger if outside(corners, planes[i]).min() < SEAM]
        edges = (corners[:, None] + corners[None]).reshape(-1, 3) / 2  # their middles too, and points within
        if len(ends) > 1 and np.min([outside(edges, planes[i]) for i in ends], axis=0).max() <= APART:
            feet.add(k)
    return [p for k, p in enumerate(pieces) if k not in feet]
