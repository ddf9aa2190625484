"""From cells to polygons: the walls' centre lines, and the rooms' inner faces beside them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pipeline.floorplan.search.grid import Halves, Labels

Corners = list[tuple[int, int]]


class Wall(NamedTuple):
    """A straight stretch of wall between two rooms (`b` = -1: the outside), on the line `at` from `start` to `end` [cells].

    `vertical`: the line is x = at, else y = at. `a` lies on the side of smaller coordinates if `a_low`.
    """

    a: int
    b: int
    vertical: bool
    at: int
    start: int
    end: int
    a_low: bool


def outline(grid: Labels, room: int) -> Corners:
    """Return the corners (x, y) [cells] of a simple room, counter-clockwise (y up), without collinear ones."""
    first = int(np.argmax(grid == room))
    y, x = divmod(first, grid.shape[1])
    cells = grid.tolist()  # bordered indices: the cell spans (x-1, y-1) to (x, y)
    start = (x - 1, y - 1)
    y, dx, dy = y - 1, 1, 0  # at the end of its lower side
    ring = [start]
    while (x, y) != start:
        # the cells ahead, to the left and to the right; the room lies to the left of the walk
        right = cells[y + (dy + 1) // 2 + (dx < 0)][x + (dx + 1) // 2 + (dy > 0)] == room
        left = cells[y + (dy + 1) // 2 + (dx > 0)][x + (dx + 1) // 2 + (dy < 0)] == room
        if right or not left:
            ring.append((x, y))
            dx, dy = (dy, -dx) if right else (-dy, dx)
        x, y = x + dx, y + dy
    return ring


def walls(grid: Labels, n: int) -> list[Wall]:
    """Return every straight stretch of wall, in a fixed order; `a` is a room, `b` a room or -1 for the outside."""
    segments: list[Wall] = []
    body = grid[:, 1:-1], grid[1:-1, :].T
    for vertical, cells in ((True, body[1]), (False, body[0])):
        low, high = cells[:-1], cells[1:]
        wall = low != high
        on = wall[:, 1:] & (low[:, 1:] == low[:, :-1]) & (high[:, 1:] == high[:, :-1])  # goes on from the cell before
        begins, ends = wall.copy(), wall.copy()
        begins[:, 1:] &= ~on
        ends[:, :-1] &= ~on
        for (at, start), end in zip(np.argwhere(begins).tolist(), np.nonzero(ends)[1].tolist(), strict=True):
            one, two = int(low[at, start]), int(high[at, start])
            if max(one, two) < n:
                segments.append(Wall(one, two, vertical, at, start, end + 1, True))
            else:
                segments.append(Wall(two if one == n else one, -1, vertical, at, start, end + 1, two == n))
    return segments


def insets(corners: Corners, inner_sides: list[bool], half: Halves) -> NDArray[np.float64]:
    """Return how far each corner of a room's inner faces lies from the walls' lines (k, 2) [m]: half a wall inward from both its sides.

    `inner_sides[i]` tells whether side i (corner i to i+1) has a room behind any part of it.
    """
    result = np.zeros((len(corners), 2))
    for i, (x, y) in enumerate(corners):
        x1, y1 = corners[(i + 1) % len(corners)]
        offset = half.inner if inner_sides[i] else half.outer
        # the inside lies to the left of a counter-clockwise walk
        axis, way = (1, 1.0 if x1 > x else -1.0) if y == y1 else (0, -1.0 if y1 > y else 1.0)
        result[i, axis] = result[(i + 1) % len(corners), axis] = offset * way
    return result
