"""Rooms as painted rectangles on a lattice of wall lines: their outlines, and the walls that they share.

Coordinates are integer centimetres, so that equal lines are equal. A room's region is bounded by wall lines; its inner
faces lie `INSET` inside them. Walls between rooms are 2 INSET thick; walls to the outside grow outwards.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

OUTSIDE = -1
INSET = 6
OUTER_WALL = 24

Patch = tuple[int, int, int, int, int]
"""(room, x0, y0, x1, y1): paints a rectangle with a room's number; a later patch covers an earlier one [cm]."""


@dataclass(frozen=True, slots=True)
class Wall:
    """A straight stretch of wall line between room `a` and room `b` (OUTSIDE: none) [cm].

    `vertical`: x = `at` and y runs from `low` to `high`; else y = `at` and x runs. `a` lies on the smaller side of `at`.
    """

    a: int
    b: int
    vertical: bool
    at: int
    low: int
    high: int

    @property
    def length(self) -> int:
        """Length of the stretch [cm]."""
        return self.high - self.low


def paint(patches: Sequence[Patch]) -> tuple[NDArray[np.int64], list[int], list[int]]:
    """Paint the patches on the coarsest grid that holds their lines; return labels (nx, ny) and the lines in x and y."""
    xs = sorted({v for p in patches for v in (p[1], p[3])})
    ys = sorted({v for p in patches for v in (p[2], p[4])})
    column, row = {v: i for i, v in enumerate(xs)}, {v: i for i, v in enumerate(ys)}
    grid = np.full((len(xs) - 1, len(ys) - 1), OUTSIDE)
    for room, x0, y0, x1, y1 in patches:
        grid[column[x0] : column[x1], row[y0] : row[y1]] = room
    return grid, xs, ys


def walls(grid: NDArray[np.int64], xs: Sequence[int], ys: Sequence[int]) -> tuple[Wall, ...]:
    """Return the maximal straight stretches between cells of different rooms."""
    padded = np.full((grid.shape[0] + 2, grid.shape[1] + 2), OUTSIDE)
    padded[1:-1, 1:-1] = grid
    stretches: list[Wall] = []
    for i, x in enumerate(xs):
        stretches += _stretches(padded[i, 1:-1].tolist(), padded[i + 1, 1:-1].tolist(), ys, x, vertical=True)
    for j, y in enumerate(ys):
        stretches += _stretches(padded[1:-1, j].tolist(), padded[1:-1, j + 1].tolist(), xs, y, vertical=False)
    return tuple(stretches)


def _stretches(before: list[int], after: list[int], lines: Sequence[int], at: int, *, vertical: bool) -> list[Wall]:
    stretches: list[Wall] = []
    start = 0
    for k in range(1, len(before) + 1):
        if k < len(before) and (before[k], after[k]) == (before[start], after[start]):
            continue
        if before[start] != after[start]:
            stretches.append(Wall(before[start], after[start], vertical, at, lines[start], lines[k]))
        start = k
    return stretches


def outline(room: int, stretches: Sequence[Wall]) -> list[tuple[int, int]] | None:
    """Chain a room's stretches into its outline, counter-clockwise [cm, wall lines].

    None where the room is in several pieces, has a hole, or touches itself in a point.
    """
    following: dict[tuple[int, int], tuple[int, int]] = {}
    for wall in stretches:
        if room not in (wall.a, wall.b):
            continue
        low, high = ((wall.at, wall.low), (wall.at, wall.high)) if wall.vertical else ((wall.low, wall.at), (wall.high, wall.at))
        # Interior on the left: the room below/left of a vertical line sees it as its right side, walked upwards.
        upwards = (room == wall.a) == wall.vertical
        first, last = (low, high) if upwards else (high, low)
        if first in following:
            return None
        following[first] = last
    if not following:
        return None
    start = min(following)
    loop = [start]
    while (point := following[loop[-1]]) != start:
        loop.append(point)
    if len(loop) != len(following):
        return None
    return _corners(loop)


def _corners(loop: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Drop the vertices at which the outline does not turn."""
    n = len(loop)
    kept = []
    for i, (x, y) in enumerate(loop):
        (px, py), (qx, qy) = loop[i - 1], loop[(i + 1) % n]
        if not (px == x == qx or py == y == qy):
            kept.append((x, y))
    return kept


def inset(loop: Sequence[tuple[int, int]], by: int = INSET) -> NDArray[np.float64]:
    """Move each edge of a rectilinear, counter-clockwise outline [cm] inwards by `by` and return (n, 2) metres."""
    n = len(loop)
    moved = np.empty((n, 2))
    for i, (x, y) in enumerate(loop):
        px, py = loop[i - 1]
        qx, qy = loop[(i + 1) % n]
        # The inward normal is the left one: of an edge in +x it is +y, of an edge in +y it is -x.
        if py == y:  # arrives horizontally, leaves vertically
            moved[i] = (x - _sign(qy - y) * by, y + _sign(x - px) * by)
        else:
            moved[i] = (x - _sign(y - py) * by, y + _sign(qx - x) * by)
    return moved / 100.0


def _sign(value: int) -> int:
    return (value > 0) - (value < 0)
