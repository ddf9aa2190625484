"""From cells to polygons: the walls' centre lines, and the rooms' inner faces beside them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pipeline.floorplan.grid import Halves, Labels

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
    mask = grid == room
    onward: dict[tuple[int, int], tuple[int, int]] = {}
    for y, x in np.argwhere(mask).tolist():  # bordered indices: the cell spans (x-1, y-1) to (x, y)
        if not mask[y - 1, x]:
            onward[x - 1, y - 1] = (x, y - 1)
        if not mask[y, x + 1]:
            onward[x, y - 1] = (x, y)
        if not mask[y + 1, x]:
            onward[x, y] = (x - 1, y)
        if not mask[y, x - 1]:
            onward[x - 1, y] = (x - 1, y - 1)
    start = min(onward, key=lambda p: (p[1], p[0]))
    ring = [start]
    while (ahead := onward[ring[-1]]) != start:
        ring.append(ahead)
    count = len(ring)
    return [p for i, p in enumerate(ring) if not _collinear(ring[i - 1], p, ring[(i + 1) % count])]


def _collinear(p: tuple[int, int], q: tuple[int, int], r: tuple[int, int]) -> bool:
    return (p[0] == q[0] == r[0]) or (p[1] == q[1] == r[1])


def walls(grid: Labels, n: int) -> list[Wall]:
    """Return every straight stretch of wall, in a fixed order; `a` is a room, `b` a room or -1 for the outside."""
    found: list[Wall] = []
    height, width = grid.shape[0] - 2, grid.shape[1] - 2
    for vertical in (True, False):
        lines, along = (width, height) if vertical else (height, width)
        for at in range(lines + 1):
            low = grid[1:-1, at] if vertical else grid[at, 1:-1]
            high = grid[1:-1, at + 1] if vertical else grid[at + 1, 1:-1]
            start = 0
            for k in range(1, along + 1):
                if k < along and low[k] == low[start] and high[k] == high[start]:
                    continue
                one, two = int(low[start]), int(high[start])
                if one != two:
                    if max(one, two) < n:
                        found.append(Wall(one, two, vertical, at, start, k, True))
                    else:
                        found.append(Wall(two if one == n else one, -1, vertical, at, start, k, two == n))
                start = k
    return found


def faces(corners: Corners, lines: NDArray[np.float64], inner_sides: list[bool], half: Halves) -> NDArray[np.float64]:
    """Shift each side of a polygon inward by half its wall.

    `lines` (k, 2) are the corners in metres, `inner_sides[i]` whether side i (corner i to i+1) has a room behind any part of it.
    """
    count = len(corners)
    result = np.empty((count, 2))
    for i in range(count):
        before, here = (i - 1) % count, i
        for side in (before, here):
            p, q = lines[side], lines[(side + 1) % count]
            offset = half.inner if inner_sides[side] else half.outer
            # the inside lies to the left of a counter-clockwise walk
            if corners[side][1] == corners[(side + 1) % count][1]:  # horizontal side: it fixes y
                result[i, 1] = lines[i, 1] + offset * np.sign(q[0] - p[0])
            else:
                result[i, 0] = lines[i, 0] - offset * np.sign(q[1] - p[1])
    return result
