"""Convex polygons in plan, compiled: separating axes, distance to a point, hulls; rectangles inside them.

A polygon is (V, 2) [m], counter-clockwise; repeated vertices are allowed (they pad batches of unequal polygons).
"""

import math

import numpy as np

from pipeline.arrays import Floats
from pipeline.geometry.compiled import borrowing, compiled

SHARES = (1.0, 0.96, 0.9, 0.8, 0.7, 0.6)  # what share of a polygon's bounds is tried: all of a board, two thirds of a disc


@borrowing
def gap(a: Floats, b: Floats) -> float:
    """Return the largest gap [m] over the edge normals of both polygons; negative: they overlap by that depth."""
    best = -np.inf
    for turn in range(2):
        p, q = (a, b) if turn == 0 else (b, a)
        n = p.shape[0]
        for k in range(n):
            dx = p[(k + 1) % n, 0] - p[k, 0]
            dy = p[(k + 1) % n, 1] - p[k, 1]
            length = math.sqrt(dx * dx + dy * dy)
            if length < 1e-9:
                continue
            nx, ny = dy / length, -dx / length
            nearest = np.inf
            for i in range(q.shape[0]):
                along = nx * (q[i, 0] - p[k, 0]) + ny * (q[i, 1] - p[k, 1])
                nearest = min(nearest, along)
            best = max(best, nearest)
    return best


@borrowing
def segment_square(x: float, y: float, x0: float, y0: float, dx: float, dy: float) -> float:
    """Return the squared distance [m2] from a point to the segment from (x0, y0) to (x0 + dx, y0 + dy)."""
    square = dx * dx + dy * dy
    t = 0.0 if square < 1e-18 else min(1.0, max(0.0, (dx * (x - x0) + dy * (y - y0)) / square))
    ex, ey = x - x0 - t * dx, y - y0 - t * dy
    return ex * ex + ey * ey


@borrowing
def distance_to(x: float, y: float, polygon: Floats) -> float:
    """Return the distance [m] from a point to a convex polygon, 0 inside."""
    n = polygon.shape[0]
    inside = True
    best = np.inf
    for k in range(n):
        x0, y0 = polygon[k, 0], polygon[k, 1]
        dx, dy = polygon[(k + 1) % n, 0] - x0, polygon[(k + 1) % n, 1] - y0
        if dx * dx + dy * dy > 1e-18 and dx * (y - y0) - dy * (x - x0) < 0.0:
            inside = False
        best = min(best, segment_square(x, y, x0, y0, dx, dy))
    return 0.0 if inside else math.sqrt(best)


@compiled
def _chain(ordered: Floats) -> Floats:
    n = ordered.shape[0]
    chain = np.empty((2 * n, 2))
    size = 0
    for turn in range(2):
        floor = 2 if turn == 0 else size + 1
        for step in range(turn, n):
            i = step if turn == 0 else n - 1 - step
            while size >= floor:
                ax, ay = chain[size - 2, 0], chain[size - 2, 1]
                bx, by = chain[size - 1, 0], chain[size - 1, 1]
                if (bx - ax) * (ordered[i, 1] - ay) - (by - ay) * (ordered[i, 0] - ax) > 1e-10:
                    break
                size -= 1
            chain[size, 0], chain[size, 1] = ordered[i, 0], ordered[i, 1]
            size += 1
    return chain[: size - 1].copy()


@compiled
def hull(points: Floats) -> Floats:
    """Return the convex hull (H, 2) of points (N, 2), counter-clockwise (Andrew 1979); fewer than 3 if degenerate."""
    by_y = points[np.argsort(points[:, 1], kind="mergesort")]
    return _chain(by_y[np.argsort(by_y[:, 0], kind="mergesort")])


def rectangle_in(outline: Floats, least: float) -> tuple[float, float, float, float] | None:
    """Return the largest (x0, y0, x1, y1) of some rectangles, square to the axes, inside a polygon (V, 2); None if it is narrower than `least` [m]."""
    low, high = outline.min(0), outline.max(0)
    middle, half = (low + high) / 2, (high - low) / 2
    edges = np.roll(outline, -1, 0) - outline
    signs = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    for share in SHARES:
        if 2 * share * half.min() < least:
            return None
        off = (middle + signs * half * share)[:, None] - outline[None]
        if (edges[None, :, 0] * off[..., 1] - edges[None, :, 1] * off[..., 0]).min() >= -1e-6:
            (x0, y0), (x1, y1) = (middle - half * share).tolist(), (middle + half * share).tolist()
            return x0, y0, x1, y1
    return None
