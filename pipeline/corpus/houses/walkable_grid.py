"""Where one can walk in a furnished room, on a grid: whether all doors are joined, and what it can get near."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from pipeline.corpus.houses.records import Item, Rect
from pipeline.corpus.houses.room_occupancy import LOW, Space

CELL = 0.1
WAY = 0.3
"""Half the width that people leave for the ways through their rooms [m]."""


def free_floor(space: Space, items: Sequence[Item]) -> NDArray[np.bool_]:
    """Return the cells (nx, ny) of the room's bounds whose centres are on the floor and under nothing that stands there."""
    x0, y0, x1, y1 = space.bounds
    xs = np.arange(x0 + CELL / 2, x1, CELL)
    ys = np.arange(y0 + CELL / 2, y1, CELL)
    free = np.ones((len(xs), len(ys)), bool)
    walls = [r for r, low, _ in space.solids if low < -1.0]
    for box in [*walls, *(i.rect() for i in items if i.position[2] < LOW)]:
        free[_cells(xs, box[0], box[2]), _cells(ys, box[1], box[3])] = False
    return free


def _cells(centres: NDArray[np.float64], low: float, high: float) -> slice:
    return slice(int(np.searchsorted(centres, low)), int(np.searchsorted(centres, high)))


def problems(space: Space) -> tuple[int, list[int]]:
    """Return how many doors are cut off from the main floor, and which items cannot be approached within arm's length."""
    free = free_floor(space, space.items)
    distance = ndimage.distance_transform_edt(np.pad(free, 1), sampling=CELL)[1:-1, 1:-1]
    labels, count = ndimage.label(distance >= WAY - CELL / 2)
    if count == 0:
        return len(space.doors), []
    main = 1 + int(np.argmax(np.bincount(labels.ravel())[1:]))
    reach = ndimage.distance_transform_edt(labels != main, sampling=CELL)
    x0, y0 = space.bounds[:2]

    def away(x: float, y: float) -> float:
        i, j = int((x - x0) / CELL), int((y - y0) / CELL)
        return float(reach[min(max(i, 0), reach.shape[0] - 1), min(max(j, 0), reach.shape[1] - 1)])

    cut_off = sum(away(x, y) > 0.25 for x, y in space.doors)
    far = [k for k, i in enumerate(space.items) if i.position[2] < LOW and _nearest(reach, i.rect(), (x0, y0)) > _arm(i)]
    return cut_off, far


def _arm(item: Item) -> float:
    """Return how far from the walkable floor a piece may be [m]: chairs are pulled out, and stand around tables."""
    if item.model.category == "dining_table":
        return 1.5
    return 0.9 if item.model.category.endswith(("chair", "stool")) else 0.55


def _nearest(reach: NDArray[np.float64], box: Rect, origin: tuple[float, float]) -> float:
    """Distance from the main floor to the nearest cell of a footprint [m]."""
    i0, j0 = int((box[0] - origin[0]) / CELL), int((box[1] - origin[1]) / CELL)
    i1, j1 = int((box[2] - origin[0]) / CELL) + 1, int((box[3] - origin[1]) / CELL) + 1
    part = reach[max(i0, 0) : i1, max(j0, 0) : j1]
    return float(part.min()) if part.size else 0.0
