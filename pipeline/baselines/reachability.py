"""PhyScene's third term: where the ways of a robot go through furniture, a robot stands there and pushes the furniture off.

A raster per room. Ways lead from the largest part of the free floor to the next one, and to the handle of everything that
opens; they are the cheapest over a map that is hot where boxes are.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, sparse
from scipy.sparse import csgraph

from pipeline.arrays import Floats
from pipeline.geometry.boxes import footprints
from pipeline.geometry.floor_raster import Mask, Raster

CELL = 0.05  # [m]
WIDTH, HEIGHT = 0.2, 1.5  # [m] of PhyScene's robot
SECOND = 0.03  # [m2] below which a second part of the floor is none
BASE = 0.01  # cost of a cell of free floor; of a cell amid boxes it is 1 more
EVERYWHERE = np.ones((3, 3), np.int64)  # cells hang together over corners too


class Boxes(NamedTuple):
    """Boxes (n): `centre` (n, 3), `size` (n, 3) full extents [m], `yaw` (n,), `opens` (n,)."""

    centre: Floats
    size: Floats
    yaw: Floats
    opens: Mask

    @property
    def front(self) -> Floats:
        """Unit direction (n, 2) of the front."""
        return np.stack([np.sin(self.yaw), -np.cos(self.yaw)], 1)


def robots(polygon: Floats, boxes: Boxes) -> Floats:
    """Return the places (k, 2) [m] at which a robot would stand in furniture on its ways, one per robot's width of way."""
    kept = boxes.centre[:, 2] < HEIGHT
    low = Boxes(boxes.centre[kept], boxes.size[kept], boxes.yaw[kept], boxes.opens[kept])
    if not len(low.yaw):
        return np.zeros((0, 2))
    raster = Raster.around([polygon], CELL)
    floor = raster.fill(raster.empty(), [polygon])
    filled = raster.fill(raster.empty(), list(open_footprints(low)))
    side = round(WIDTH / CELL) | 1
    stand = ndimage.binary_erosion(floor, np.ones((side, side)))
    free = stand & ~ndimage.binary_dilation(filled, np.ones((side, side)))
    labels, count = ndimage.label(free, EVERYWHERE)
    if not count:
        return np.zeros((0, 2))
    area = np.bincount(labels.ravel())[1:] * CELL**2
    ranked = np.argsort(-area, kind="stable") + 1
    start = middle_of(labels == ranked[0])
    goals = [middle_of(labels == ranked[1])] if count > 1 and area[ranked[1] - 1] > SECOND else []
    goals += [tuple(cell) for cell in raster.index(handles(low)).tolist()]
    heat = ndimage.gaussian_filter(filled.astype(float), WIDTH / CELL)
    crossings = []
    for way in ways(np.where(stand, BASE + heat, BASE + 1.0), start, goals):
        through = way[filled[way[:, 0], way[:, 1]]]
        crossings.append(through[:: max(1, round(WIDTH / CELL))])
    cells = np.concatenate([*crossings, np.zeros((0, 2), np.int64)])
    return np.asarray(raster.origin + (cells + 0.5) * CELL, float)


def open_footprints(boxes: Boxes) -> Floats:
    """Return the plan corners (n, 4, 2) of boxes, those that open with a third more depth at the front."""
    more = np.where(boxes.opens, boxes.size[:, 1] / 3, 0.0)
    size = boxes.size[:, :2] + np.stack([np.zeros_like(more), more], 1)
    return footprints(boxes.centre[:, :2] + boxes.front * more[:, None] / 2, boxes.yaw, size)


def handles(boxes: Boxes) -> Floats:
    """Return where a robot stands (k, 2) [m] to use each of the k boxes that open: before the opened front."""
    ahead = boxes.size[:, 1] * (1 / 2 + 1 / 3) + WIDTH / 2 + CELL
    return np.asarray((boxes.centre[:, :2] + boxes.front * ahead[:, None])[boxes.opens], float)


def middle_of(part: Mask) -> tuple[int, int]:
    """Return the cell of a part of the floor that is farthest from its edge."""
    i, j = np.unravel_index(int(ndimage.distance_transform_edt(np.pad(part, 1))[1:-1, 1:-1].argmax()), part.shape)
    return int(i), int(j)


def ways(cost: Floats, start: tuple[int, int], goals: list[tuple[int, int]]) -> list[NDArray[np.int64]]:
    """Return the cheapest ways (length, 2) over a cost map (x, y) from the start to each goal, by Dijkstra's algorithm.

    A step to a neighbour, diagonals included, costs its length times the mean of the two cells. (PhyScene runs A* with
    a bound on its steps; the ways are the same where that suffices.)
    """
    if not goals:
        return []
    wide = cost.shape[1]
    cells = np.arange(cost.size).reshape(cost.shape)
    one, other, price = [], [], []
    for dx, dy in ((1, 0), (0, 1), (1, 1), (1, -1)):
        a = (slice(0, cost.shape[0] - dx), slice(max(0, -dy), wide - max(0, dy)))
        b = (slice(dx, None), slice(max(0, dy), wide - max(0, -dy)))
        one.append(cells[a].ravel())
        other.append(cells[b].ravel())
        price.append((np.hypot(dx, dy) * (cost[a] + cost[b]) / 2).ravel())
    graph = sparse.coo_array((np.concatenate(price), (np.concatenate(one), np.concatenate(other))), shape=(cost.size, cost.size)).tocsr()
    _, before = csgraph.dijkstra(graph, directed=False, indices=int(cells[start]), return_predecessors=True)
    paths = []
    for goal in goals:
        way = [int(cells[goal])]
        while before[way[-1]] >= 0:
            way.append(int(before[way[-1]]))
        paths.append(np.stack(np.divmod(np.array(way, np.int64), wide), 1))
    return paths
