"""Rugs: flat weaves on the floor, under a group of seats or a bed, before a basin, in the middle of a room."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.home import Placement
from pipeline.geometry.convex import gap
from pipeline.geometry.polygons import excess

Floats = NDArray[np.float64]

THICK = 0.004  # a flat weave: furniture stands on it without being lifted, robots and doors pass over it [m]
EDGE = 0.08  # least distance of a rug from the walls [m]
SHARES = (1.15, 1.0, 0.85, 0.7)  # shares of its size in which a rug is tried


def lay_rug(
    polygon: Floats, size: Floats, places: Sequence[tuple[float, float, float]], clear: Sequence[Placement]
) -> tuple[Floats, float, Floats] | None:
    """Return position (2,) [m], yaw [rad] and scale (3,) of a rug of `size` (3,) [m] at the first place that takes it, there as large as it can; None for none.

    `places` are middles and directions (x, y, yaw); the rug stays within the room and off the furniture `clear`.
    """
    blocked = [p.footprint() for p in clear]
    for x, y, yaw in places:
        for share in SHARES:
            c, s = math.cos(yaw), math.sin(yaw)
            half = share * size[:2] / 2
            corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * half
            outline = np.ascontiguousarray(corners @ np.array([[c, s], [-s, c]]) + (x, y))
            wider = np.ascontiguousarray((corners + np.sign(corners) * EDGE) @ np.array([[c, s], [-s, c]]) + (x, y))
            if excess(wider, polygon) <= 1e-6 and all(gap(outline, other) > 0 for other in blocked):
                return np.array([x, y]), yaw, np.array([share, share, THICK / size[2]])
    return None
