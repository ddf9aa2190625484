"""A retrieved asset is rarely as large as what was asked for: keep the side that stood at a wall where it was, and all of it in the room."""

import numpy as np
from numpy.typing import NDArray

from pipeline.geometry.compiled import compiled

REACH = 0.12  # a side so near to a wall stands at it [m]
BEYOND = 0.1  # past its ends a wall goes on for what is beside it [m]
OVERLAP = 0.05  # a wall that is beside no more than this of a side does not bear on it [m]
CLEAR = 0.002  # of what is put before a wall [m]


def keep_at_walls(
    position: NDArray[np.float64],
    yaw: float,
    asked: NDArray[np.float64],
    size: NDArray[np.float64],
    polygon: NDArray[np.float64],
    reach: float = REACH,
) -> NDArray[np.float64]:
    """Return the position (3,) [m] at which a box of `size` keeps the asked box's sides that lie at walls.

    `position` is the asked bottom centre, `asked` and `size` (3,) are full extents [m], `polygon` (n, 2) the room in the
    same frame. Along each horizontal axis of the object, the side that is within `reach` of a wall parallel to it stays;
    with a wall at both sides or none the centre stays. A gap left by the model below `reach` is thus kept as it is.
    """
    moved = np.array(position, float)
    for extent, axis in enumerate(_axes(yaw)):
        near = [abs(gap_to_wall(position[:2] + sign * axis * asked[extent] / 2, sign * axis, polygon, BEYOND)) < reach for sign in (1, -1)]
        moved[:2] += axis * (asked[extent] - size[extent]) / 2 * (int(near[0]) - int(near[1]))
    return moved


def put_before_walls(
    position: NDArray[np.float64], yaw: float, size: NDArray[np.float64], polygon: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the position (3,) [m] of a box moved out of walls that it sticks into by less than REACH, where the room is wide enough for it."""
    moved = np.array(position, float)
    for extent, axis in enumerate(_axes(yaw)):
        past = size[1 - extent] / 2 - OVERLAP
        ahead, behind = (gap_to_wall(moved[:2] + sign * axis * size[extent] / 2, sign * axis, polygon, past) for sign in (1, -1))
        if -REACH < min(ahead, behind) < 0.0 <= ahead + behind:
            moved[:2] += axis * (ahead - CLEAR if ahead < behind else CLEAR - behind)
    return moved


def _axes(yaw: float) -> NDArray[np.float64]:
    """Return the unit vectors (2, 2) along the width and the depth of a box."""
    return np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])


@compiled
def gap_to_wall(point: NDArray[np.float64], outward: NDArray[np.float64], polygon: NDArray[np.float64], past: float) -> float:
    """Return how far [m] before the point the nearest wall is that faces `outward` squarely and ends no more than `past` beside it; infinite where none is.

    `polygon` (n, 2) goes counter-clockwise; the gap is negative where the point is beyond the wall.
    """
    nearest = np.inf
    for k in range(len(polygon)):
        start, end = polygon[k], polygon[(k + 1) % len(polygon)]
        length = max(np.hypot(end[0] - start[0], end[1] - start[1]), 1e-9)
        x, y = (end[0] - start[0]) / length, (end[1] - start[1]) / length
        place = (point[0] - start[0]) * x + (point[1] - start[1]) * y
        offset = (start[0] - point[0]) * y - (start[1] - point[1]) * x
        if y * outward[0] - x * outward[1] > 0.98 and -past < place < length + past and abs(offset) < abs(nearest):
            nearest = offset
    return nearest
