"""Reach: R_reach as the peers code it."""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from pipeline.geometry.boxes import footprints
from pipeline.geometry.floor_raster import Raster
from pipeline.metrics.intervals import Mean, bootstrap
from pipeline.metrics.rows import Row, boxes, by_room

PIXELS = 256  # side of the raster
ROBOT = 0.3  # width of PhyScene's robot, by which R_reach is defined [m]
LIMIT = 1.5  # objects whose centre is higher are no obstacles [m]
MARGIN = 0.2  # of the raster around the room [m]


def room_reach(polygon: NDArray[np.float64], objects: Sequence[Row]) -> float:
    """Return R_reach of one room as PhyScene codes it; 1 for a room without objects.

    The floor is eroded by half the robot's width, boxes are grown by it; what is left falls into 8-connected parts k.
    Sum over k of (share of objects whose grown mask, widened by one pixel, meets part k) * (area_k / area of all parts).
    Closed footprints; no test of fronts or handles.
    """
    position, yaw, size = boxes(objects)
    low = position[:, 2] + size[:, 2] / 2 < LIMIT
    if not low.any():
        return 1.0
    centre = (polygon.min(0) + polygon.max(0)) / 2
    half = float(np.abs(polygon - centre).max()) + MARGIN
    raster = Raster(centre - half, 2 * half / PIXELS, (PIXELS, PIXELS))
    robot = max(1, int(ROBOT / raster.cell))
    floor = raster.fill(raster.empty(), [polygon])
    free = ndimage.binary_erosion(floor, np.ones((robot, robot)))
    masks = []
    for corners in footprints(position[low], yaw[low], size[low]):
        mask = raster.fill(raster.empty(), [corners])
        grown = ndimage.distance_transform_edt(~mask) <= robot / 2 if mask.any() else mask
        masks.append(grown)
        free &= ~grown
    labels, count = ndimage.label(free, np.ones((3, 3)))
    areas = np.bincount(labels.ravel(), minlength=count + 1)[1:]
    if not count:
        return 0.0
    touched = np.zeros((len(masks), count), np.bool_)
    for i, grown in enumerate(masks):
        met = np.unique(labels[ndimage.binary_dilation(grown, np.ones((3, 3)))])
        touched[i, met[met > 0] - 1] = True
    return float((touched.mean(0) * areas).sum() / areas.sum())


def reach(rng: np.random.Generator, rooms: Iterable[Row], objects: Iterable[Row]) -> Mean:
    """Return the mean R_reach over rooms with objects, on the ground, as the peers code it."""
    polygons = {(room["scene_id"], room["room_id"]): np.array(room["polygon"], float) for room in rooms}
    return bootstrap(rng, [room_reach(polygons[name], own) for name, own in by_room(objects).items() if name in polygons])
