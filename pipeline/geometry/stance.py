"""Where a robot can stand to take hold of a handle, clear of the part that it opens."""

import functools
import math

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Floats, Ints
from pipeline.geometry.compiled import compiled
from pipeline.geometry.convex import distance_to
from pipeline.geometry.free_space import FreeSpace
from pipeline.geometry.prisms import Prisms
from pipeline.geometry.robot import Robot

DISTANCES = 11  # distances to the handle that are tried
TURN = 15.0  # between the sides that are tried [deg]


def stand_pose(
    grip: Floats, heading: Floats, swept: Prisms, floor: float, space: FreeSpace, label: int, robot: Robot
) -> tuple[float, float] | None:
    """Return (x, y) [m] at which the robot, within one connected part of the floor, reaches the grip; None if nowhere.

    `grip` (2,) [m] and `heading` (2,), the way in which the handle sets off, are in plan; `swept` are the moving part's
    prisms, of which those that the robot is high enough to meet, standing at `floor` [m], must stay its radius away; its reach
    bounds the distance to the grip, its cone the angle to the heading. Straight ahead is tried before the sides, middle distances before near and far.
    """
    distances, turns = _search_grid(robot.reach, robot.cone)
    low = np.flatnonzero(swept.z[:, 0] < robot.band(floor)[1])
    raster = space.floor.raster
    corners, count = np.ascontiguousarray(swept.corners[low]), swept.count[low]
    x, y, angle = float(grip[0]), float(grip[1]), math.atan2(float(heading[1]), float(heading[0]))
    x, y, stands = _search(x, y, angle, distances, turns, space.labels, label, raster.origin, raster.cell, corners, count, robot.radius)
    return (x, y) if stands else None


@functools.lru_cache(maxsize=16)
def _search_grid(reach: tuple[float, float], cone: float) -> tuple[Floats, Floats]:
    """Return the distances [m] to the handle and the turns [rad] from its heading that are tried, in their order."""
    near, far = reach
    distances = np.linspace(near, far, DISTANCES)
    distances = distances[np.argsort(np.round(np.abs(distances - (near + far) / 2), 9), kind="stable")]
    return distances, np.radians([k * side * TURN for k in range(int(cone // TURN) + 1) for side in ((1, -1) if k else (1,))])


@compiled
def _search(
    x: float,
    y: float,
    heading: float,
    distances: Floats,
    turns: Floats,
    labels: NDArray[np.int32],
    label: int,
    origin: Floats,
    cell: float,
    corners: Floats,
    count: Ints,
    radius: float,
) -> tuple[float, float, bool]:
    if label == 0:
        return 0.0, 0.0, False
    for turn in turns:
        c, s = math.cos(heading + turn), math.sin(heading + turn)
        for distance in distances:
            px, py = x + c * distance, y + s * distance
            i, j = math.floor((px - origin[0]) / cell), math.floor((py - origin[1]) / cell)
            if i < 0 or j < 0 or i >= labels.shape[0] or j >= labels.shape[1] or labels[i, j] != label:
                continue
            clear = True
            for k in range(count.shape[0]):
                if distance_to(px, py, corners[k, : count[k]]) < radius - 1e-9:
                    clear = False
                    break
            if clear:
                return px, py, True
    return 0.0, 0.0, False
