"""Room polygons: points inside, how far a convex shape leaves them, insides shared with boxes.

A room polygon is (n, 2) [m], counter-clockwise, simple, not closed, not necessarily convex.
"""

import math

import numpy as np

from pipeline.arrays import Floats
from pipeline.geometry.compiled import borrowing, compiled
from pipeline.geometry.convex import gap, segment_square

SKIN = 0.05  # thickness given to walls where a shape's crossing is tested [m]; thinner than any wall


@borrowing
def contains(x: float, y: float, polygon: Floats) -> bool:
    """Tell whether a point is in a polygon (even-odd rule)."""
    inside = False
    n = polygon.shape[0]
    for k in range(n):
        x0, y0 = polygon[k, 0], polygon[k, 1]
        x1, y1 = polygon[(k + 1) % n, 0], polygon[(k + 1) % n, 1]
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0) * (x1 - x0) / (y1 - y0):
            inside = not inside
    return inside


@borrowing
def boundary_distance(x: float, y: float, polygon: Floats) -> float:
    """Return the distance [m] from a point to a polygon's boundary."""
    best = np.inf
    n = polygon.shape[0]
    for k in range(n):
        x0, y0 = polygon[k, 0], polygon[k, 1]
        best = min(best, segment_square(x, y, x0, y0, polygon[(k + 1) % n, 0] - x0, polygon[(k + 1) % n, 1] - y0))
    return math.sqrt(best)


@compiled
def excess(shape: Floats, polygon: Floats) -> float:
    """Return how far [m] a convex shape (V, 2) sticks out of a polygon: 0 when it is inside.

    The farthest vertex outside, or, where a reflex corner pokes into the shape, the depth to which it does.
    """
    return beyond(shape, polygon, np.empty((4, 2)))


@borrowing
def beyond(shape: Floats, polygon: Floats, wall: Floats) -> float:
    """Return `excess`; `wall` (4, 2) is scratch."""
    worst = 0.0
    low_x, low_y, high_x, high_y = np.inf, np.inf, -np.inf, -np.inf
    for i in range(shape.shape[0]):
        x, y = shape[i, 0], shape[i, 1]
        low_x, low_y, high_x, high_y = min(low_x, x), min(low_y, y), max(high_x, x), max(high_y, y)
        if not contains(x, y, polygon):
            worst = max(worst, boundary_distance(x, y, polygon))
    n = polygon.shape[0]
    for k in range(n):
        x0, y0 = polygon[k, 0], polygon[k, 1]
        x1, y1 = polygon[(k + 1) % n, 0], polygon[(k + 1) % n, 1]
        if max(x0, x1) + SKIN < low_x or min(x0, x1) - SKIN > high_x or max(y0, y1) + SKIN < low_y or min(y0, y1) - SKIN > high_y:
            continue
        length = math.sqrt((x1 - x0) ** 2 + (y1 - y0) ** 2)
        if length < 1e-9:
            continue
        nx, ny = (y1 - y0) / length * SKIN, (x0 - x1) / length * SKIN
        wall[0, 0], wall[0, 1] = x1, y1
        wall[1, 0], wall[1, 1] = x0, y0
        wall[2, 0], wall[2, 1] = x0 + nx, y0 + ny
        wall[3, 0], wall[3, 1] = x1 + nx, y1 + ny
        worst = max(worst, -gap(shape, wall))
    return worst
