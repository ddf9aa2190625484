"""A retrieved asset is rarely as large as what was asked for: keep the side that stood at a wall where it was."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pipeline.geometry.compiled import compiled


def keep_at_walls(
    position: NDArray[np.float64],
    yaw: float,
    asked: NDArray[np.float64],
    size: NDArray[np.float64],
    polygon: NDArray[np.float64],
    reach: float = 0.12,
) -> NDArray[np.float64]:
    """Return the position (3,) [m] at which a box of `size` keeps the asked box's sides that lie at walls.

    `position` is the asked bottom centre, `asked` and `size` (3,) are full extents [m], `polygon` (n, 2) the room in the
    same frame. Along each horizontal axis of the object, the side that is within `reach` of a wall parallel to it stays;
    with a wall at both sides or none the centre stays. A gap left by the model below `reach` is thus kept as it is.
    """
    u = np.array([np.cos(yaw), np.sin(yaw)])
    v = np.array([-np.sin(yaw), np.cos(yaw)])
    moved = np.array(position, float)
    for axis, extent in ((u, 0), (v, 1)):
        near = [_wall_within(position[:2] + sign * axis * asked[extent] / 2, sign * axis, polygon, reach) for sign in (1, -1)]
        shift = (asked[extent] - size[extent]) / 2
        moved[:2] += axis * shift * (int(near[0]) - int(near[1]))
    return moved


@compiled
def _wall_within(point: NDArray[np.float64], outward: NDArray[np.float64], polygon: NDArray[np.float64], reach: float) -> bool:
    """Whether a wall of a counter-clockwise polygon that faces `outward` squarely passes within `reach` of the point."""
    for k in range(len(polygon)):
        start, end = polygon[k], polygon[(k + 1) % len(polygon)]
        length = max(np.hypot(end[0] - start[0], end[1] - start[1]), 1e-9)
        x, y = (end[0] - start[0]) / length, (end[1] - start[1]) / length
        place = (point[0] - start[0]) * x + (point[1] - start[1]) * y
        offset = (start[0] - point[0]) * y - (start[1] - point[1]) * x
        if y * outward[0] - x * outward[1] > 0.98 and abs(offset) < reach and -0.1 < place < length + 0.1:
            return True
    return False
