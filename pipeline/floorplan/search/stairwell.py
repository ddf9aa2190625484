"""The staircase on the grids of the storeys that share it: a rectangle that stands above itself."""

import numpy as np

from pipeline.floorplan.search.grid import Labels


def rectangle(grid: Labels, room: int) -> tuple[int, int, int, int] | None:
    """Return a room's rectangle (x0, y0, x1, y1) [cells], or None when it is none."""
    ys, xs = np.nonzero(grid[1:-1, 1:-1] == room)
    box = (int(xs.min()), int(ys.min()), int(xs.max()) + 1, int(ys.max()) + 1)
    return box if xs.size == (box[2] - box[0]) * (box[3] - box[1]) else None


def stamp(grid: Labels, room: int, stair: tuple[int, ...], n: int) -> None:
    """Put the staircase where it stands on the other storeys; what it leaves goes to the rooms beside it, cell by cell."""
    x0, y0, x1, y1 = stair
    left = grid == room
    grid[y0 + 1 : y1 + 1, x0 + 1 : x1 + 1] = room
    left[y0 + 1 : y1 + 1, x0 + 1 : x1 + 1] = False
    while left.any():
        before = int(left.sum())
        for y, x in np.argwhere(left).tolist():
            beside = [int(grid[y + dy, x + dx]) for dy, dx in ((0, 1), (0, -1), (1, 0), (-1, 0)) if not left[y + dy, x + dx]]
            beside = [b for b in beside if b not in {n, room}]
            if beside:
                grid[y, x], left[y, x] = beside[0], False
        if int(left.sum()) == before:
            grid[left] = n
            return
