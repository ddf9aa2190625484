"""Upright boxes (position of the bottom centre, yaw, full extents): corners, overlaps, intersection over union.

Boxes turn about +Z only. Footprint corners are counter-clockwise from the object's lower left (-w/2, -d/2).
"""

import numpy as np
import shapely

from pipeline.arrays import Floats


def footprints(position: Floats, yaw: Floats, size: Floats) -> Floats:
    """Return the plan corners (N, 4, 2) [m] of boxes: `position` (N, 2 or 3), `yaw` (N,) [rad], `size` (N, 2 or 3)."""
    half = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]) * np.asarray(size)[:, None, :2]
    c, s = np.cos(yaw)[:, None], np.sin(yaw)[:, None]
    x, y = half[..., 0], half[..., 1]
    return np.stack([c * x - s * y, s * x + c * y], -1) + np.asarray(position)[:, None, :2]


def overlap_areas(a: Floats, b: Floats) -> Floats:
    """Return the area (P,) [m2] shared by P pairs of polygons (P, V, 2)."""
    areas = np.zeros(len(a))
    near = np.flatnonzero(((a.min(axis=1) < b.max(axis=1)) & (b.min(axis=1) < a.max(axis=1))).all(axis=1))
    areas[near] = shapely.area(shapely.intersection(shapely.polygons(a[near]), shapely.polygons(b[near])))
    return areas


def iou_3d(position_a: Floats, yaw_a: Floats, size_a: Floats, position_b: Floats, yaw_b: Floats, size_b: Floats) -> Floats:
    """Return the 3-D intersection over union (P,) of P pairs of boxes; positions (P, 3) are bottom centres."""
    shared = overlap_areas(footprints(position_a, yaw_a, size_a), footprints(position_b, yaw_b, size_b))
    top = np.minimum(position_a[:, 2] + size_a[:, 2], position_b[:, 2] + size_b[:, 2])
    height = np.maximum(top - np.maximum(position_a[:, 2], position_b[:, 2]), 0.0)
    inter = shared * height
    union = size_a.prod(axis=-1) + size_b.prod(axis=-1) - inter
    return np.where(union > 0, inter / np.maximum(union, 1e-12), 0.0)


def iou_matrix(position: Floats, yaw: Floats, size: Floats, other: tuple[Floats, Floats, Floats] | None = None) -> Floats:
    """Return the 3-D IoU (N, M) between N boxes and M others (themselves by default, 1 on the diagonal)."""
    p, y, s = (position, yaw, size) if other is None else other
    n, m = len(position), len(p)
    i, j = np.repeat(np.arange(n), m), np.tile(np.arange(m), n)
    return iou_3d(position[i], yaw[i], size[i], p[j], y[j], s[j]).reshape(n, m)
