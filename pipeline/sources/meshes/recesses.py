"""Upright boards whose faces are seen at two depths, a door with a frame about a panel: one box whose faces stand midway.

A box over the frame would be the frame's whole thickness off at the panel, one at the panel as much at the frame; midway it is half
of that off at both. Where a recess is so deep that neither would be within what a finger feels, the larger of the two is.
"""

import numpy as np

from pipeline.arrays import Floats

BOARD, WIDE = 0.06, 0.08  # [m] a board is no thicker, and at least so wide and high
LEAST = 0.004  # [m] that is left of it
MOST = 0.0055  # [m] behind what is proudest that a face may stand
FELT = 0.0048  # [m] from what is seen over half of a face and more that it may stand
GRID = 16  # rays along a side of a board, each way
QUARTERS = (0.25, 0.75)  # of a face's rays: what less than a quarter of it has is a detail
SAME = 1e-4  # [m] between corners that are one; and to a face that rays may pass on either side


def stand_midway(hull: Floats, triangles: Floats) -> Floats:
    """Return the corners (V, 3) [m] of a convex piece, those of an upright board moved to where its faces are seen by triangles (F, 3, 3)."""
    low, high = hull.min(axis=0), hull.max(axis=0)
    extent = high - low
    across = int(np.argmin(extent))
    along = [k for k in range(3) if k != across]
    upright_board = len(hull) == 8 and across != 2 and extent[across] <= BOARD and extent[along].min() >= WIDE
    if not upright_board or np.minimum(np.abs(hull - low), np.abs(hull - high)).max() > SAME:
        return hull
    first, last = _depths(triangles, along, across, low, high)
    if not len(first):
        return hull
    near, far = (min(_midway(depths), MOST) for depths in (first - low[across], high[across] - last))
    if extent[across] - near - far < LEAST:
        return hull
    moved = hull.copy()
    at_low = np.abs(hull[:, across] - low[across]) < SAME
    moved[:, across] = np.where(at_low, low[across] + max(near, 0.0), high[across] - max(far, 0.0))
    return moved


def _midway(depths: Floats) -> float:
    """Return the depth [m] midway between those (R,) of two parts of a face, no farther than FELT from that of the larger one."""
    most = float(np.median(depths))
    return min(max(float(np.quantile(depths, QUARTERS).mean()), most - FELT), most + FELT)


def _depths(triangles: Floats, along: list[int], across: int, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Return where rays through a box along one axis first and last meet triangles (F, 3, 3) in it, of those that do."""
    steps = (np.arange(GRID) + 0.5) / GRID
    u, v = (k.ravel() for k in np.meshgrid(*(low[k] + steps * (high[k] - low[k]) for k in along), indexing="ij"))
    a, b, c = (triangles[:, k] for k in range(3))
    au, av = a[:, along[0]], a[:, along[1]]
    bu, bv, cu, cv = b[:, along[0]] - au, b[:, along[1]] - av, c[:, along[0]] - au, c[:, along[1]] - av
    double = bu * cv - bv * cu
    facing = np.abs(double) > 1e-12
    au, av, bu, bv, cu, cv, double = (k[facing] for k in (au, av, bu, bv, cu, cv, double))
    a, b, c = (k[facing][:, across] for k in (a, b, c))
    du, dv = u[:, None] - au, v[:, None] - av
    second, third = (du * cv - dv * cu) / double, (bu * dv - bv * du) / double
    depth = a + second * (b - a) + third * (c - a)
    meets = (second >= 0) & (third >= 0) & (second + third <= 1) & (depth > low[across] - SAME) & (depth < high[across] + SAME)
    some = meets.any(axis=1)
    return np.where(meets, depth, np.inf).min(axis=1)[some], np.where(meets, depth, -np.inf).max(axis=1)[some]
