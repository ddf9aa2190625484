"""Free floor as a raster: what a round robot can stand on, and what of it hangs together.

A raster covers a box in plan; cell (i, j) has its centre at origin + cell * (i + 0.5, j + 0.5).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pipeline.arrays import Bools, Floats, Ints
from pipeline.geometry.compiled import compiled

Mask = Bools

FAR = 1 << 20  # cells: more than any raster has


@dataclass(frozen=True, slots=True)
class Raster:
    """A grid in plan: `origin` (2,) [m] is its lower corner, `cell` [m] the side of a cell, `shape` the counts (x, y)."""

    origin: Floats
    cell: float
    shape: tuple[int, int]

    @classmethod
    def around(cls, polygons: Sequence[Floats], cell: float, margin: float = 0.3) -> Raster:
        """Return the raster over polygons and a margin [m]. Its origin hangs on their corner, so it moves with them."""
        points = np.concatenate(polygons)
        low, high = points.min(0) - margin, points.max(0) + margin
        counts = np.maximum(np.ceil((high - low) / cell - 1e-9), 1).astype(int)
        return cls(low, cell, (int(counts[0]), int(counts[1])))

    def empty(self) -> Mask:
        """Return a mask of False."""
        return np.zeros(self.shape, np.bool_)

    def index(self, points: Floats) -> Ints:
        """Return the cells (N, 2) in which points (N, 2) lie, clipped to the raster."""
        cells = np.floor((points - self.origin) / self.cell).astype(np.int64)
        return np.clip(cells, 0, np.array(self.shape) - 1)

    def fill(self, mask: Mask, polygons: Sequence[Floats], *, value: bool = True) -> Mask:
        """Set the cells whose centre lies in any of the (simple) polygons; returns the same mask."""
        for polygon in polygons:
            fill(mask, np.ascontiguousarray((polygon - self.origin) / self.cell, np.float64), value)
        return mask

    def area(self, mask: Mask) -> float:
        """Return the area of a mask [m2]."""
        return float(np.count_nonzero(mask)) * self.cell**2


@compiled
def fill(mask: Mask, polygon: Floats, value: bool) -> None:
    """Set the cells whose centre lies in a simple polygon (n, 2) given in cells (even-odd rule, column by column)."""
    n = polygon.shape[0]
    first = max(0, int(np.floor(polygon[:, 0].min() - 0.5)))
    last = min(mask.shape[0] - 1, int(np.ceil(polygon[:, 0].max() - 0.5)))
    crossings = np.empty(n)
    for i in range(first, last + 1):
        x = i + 0.5
        count = 0
        for k in range(n):
            x0, y0 = polygon[k, 0], polygon[k, 1]
            x1, y1 = polygon[(k + 1) % n, 0], polygon[(k + 1) % n, 1]
            if (x0 > x) != (x1 > x):
                crossings[count] = y0 + (x - x0) * (y1 - y0) / (x1 - x0)
                count += 1
        ordered = crossings[:count]
        if count > 2:
            ordered = np.sort(ordered)
        elif count == 2 and ordered[0] > ordered[1]:  # most polygons are convex
            ordered[0], ordered[1] = ordered[1], ordered[0]
        for k in range(0, count - 1, 2):
            # A centre j + 0.5 lies in [start, end); the small slack keeps shapes that meet edge to edge without a seam.
            j0 = max(0, int(np.ceil(ordered[k] - 0.5 - 1e-9)))
            j1 = min(mask.shape[1], int(np.ceil(ordered[k + 1] - 0.5 - 1e-9)))
            for j in range(j0, j1):
                mask[i, j] = value


@compiled
def fill_all(mask: Mask, corners: Floats, count: Ints, which: Ints, origin: Floats, cell: float, value: bool) -> None:
    """Set the cells whose centre lies in any of the polygons `which` of a batch (P, V, 2) [m], of whose corners `count` (P,) are used."""
    for k in which:
        fill(mask, (corners[k, : count[k]] - origin) / cell, value)


@compiled
def standing_cells(free: Mask, radius_cells: float) -> Mask:
    """Return the cells at which the centre of a disc of that radius can stand: all of it is free floor.

    No blocked cell, nor one beyond the raster, has its centre nearer than the radius and half a cell.
    """
    rows, columns = free.shape
    least = (radius_cells + 0.5 - 1e-9) ** 2
    reach = int(np.ceil(radius_cells + 0.5))
    apart = _apart(~free, 1)
    cells = np.zeros((rows, columns), np.bool_)
    for i in range(rows):
        if min(i + 1, rows - i) ** 2 < least:
            continue
        for j in range(columns):
            cells[i, j] = True
        for k in range(max(0, i - reach), min(rows, i + reach + 1)):  # row by row, many cells at once
            for j in range(columns):
                cells[i, j] &= (k - i) ** 2 + apart[k, j] >= least
    return cells


@compiled
def dilate(centres: Mask, radius_cells: float) -> Mask:
    """Return the cells that a disc covers while its centre runs over `centres`: a centre is no farther than the radius and half a cell."""
    rows, columns = centres.shape
    most = (radius_cells + 0.5 + 1e-9) ** 2
    reach = int(np.ceil(radius_cells + 0.5))
    apart = _apart(centres, FAR)
    cells = np.zeros((rows, columns), np.bool_)
    for i in range(rows):
        for k in range(max(0, i - reach), min(rows, i + reach + 1)):
            for j in range(columns):
                cells[i, j] |= (k - i) ** 2 + apart[k, j] <= most
    return cells


@compiled
def _apart(there: Mask, margin: int) -> Floats:
    """Return the squared distances to the nearest cell of a mask in the same row; so do cells count that lie `margin` past its ends."""
    rows, columns = there.shape
    apart = np.empty((rows, columns))
    for i in range(rows):
        last = -margin
        for j in range(columns):
            last = j if there[i, j] else last
            apart[i, j] = (j - last) ** 2
        last = columns - 1 + margin
        for j in range(columns - 1, -1, -1):
            last = j if there[i, j] else last
            apart[i, j] = min(apart[i, j], (last - j) ** 2)
    return apart
