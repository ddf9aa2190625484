"""Walls as they stand on the grid, and as movable lines: they leave the raster by a few centimetres until the rooms have the areas asked for.

Every maximal connected straight wall is one line with one coordinate. A room's inner area is bilinear in the coordinates of its
sides; a few bounded, regularised least-squares steps bring all areas near their targets while no wall crosses another.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Floats, Ints
from pipeline.floorplan.search.grid import Halves, Labels

Corners = list[tuple[int, int]]

FARTHEST, AT_JOG = 0.10, 0.03  # how far lines may move [m]; beside a jog of one cell
RIDGE = 0.02  # weight of moving one line by FARTHEST, against the squared relative error of one area
ROUNDS = 3


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


def insets(corners: Corners, inner_sides: list[bool], half: Halves) -> Floats:
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


class Lines(NamedTuple):
    """Lines of a grid. `upright` and `level` give each unit wall's line (-1: no wall); `at` (k,) are coordinates [m]."""

    upright: Ints  # (rows, columns+1)
    level: Ints  # (rows+1, columns)
    at: Floats


def find_lines(grid: Labels, unit: float) -> Lines:
    """Find the lines of a bordered grid."""
    height, width = grid.shape[0] - 2, grid.shape[1] - 2
    body = grid[1:-1, :], grid[:, 1:-1]
    upright, up_at = _number(body[0][:, :-1] != body[0][:, 1:], 0)
    level, level_at = _number((body[1][:-1, :] != body[1][1:, :]).T, len(up_at))
    assert upright.shape == (height, width + 1)
    return Lines(upright, np.ascontiguousarray(level.T), np.array(up_at + level_at) * unit)


def _number(walls: NDArray[np.bool_], first: int) -> tuple[Ints, list[float]]:
    """Give each run of unit walls down a column a number from `first` on; return them with their columns."""
    across = walls.T
    begins = across.copy()
    begins[:, 1:] &= ~across[:, :-1]
    ids = np.where(across, first - 1 + np.cumsum(begins).reshape(begins.shape), -1)
    return np.ascontiguousarray(ids.T), np.nonzero(begins)[0].astype(float).tolist()


def corner_lines(lines: Lines, corners: Corners) -> Ints:
    """Return for each corner (x, y) of an outline the numbers of the lines that fix it (count, 2)."""
    count = len(corners)
    ids = np.empty((count, 2), np.int64)
    for i, (x, y) in enumerate(corners):
        for x1, y1 in (corners[i - 1], corners[(i + 1) % count]):
            if x1 == x:
                ids[i, 0] = lines.upright[min(y, y1), x]
            else:
                ids[i, 1] = lines.level[y, min(x, x1)]
    return ids


def outer(lines: Lines, grid: Labels, n: int) -> NDArray[np.bool_]:
    """Whether each line has the outside on any part of it (k,)."""
    outside = np.zeros(lines.at.size, dtype=bool)
    beside = (grid[1:-1, :-1] == n) ^ (grid[1:-1, 1:] == n)
    outside[lines.upright[beside]] = True
    above = (grid[:-1, 1:-1] == n) ^ (grid[1:, 1:-1] == n)
    outside[lines.level[above]] = True
    return outside


def fit_lines(
    lines: Lines,
    outlines: list[Corners],
    sides: list[list[bool]],
    target: Floats,
    trust: Floats,
    slack: Floats,
    fixed: NDArray[np.bool_],
    share: float,
    half: Halves,
) -> Floats:
    """Return moved coordinates [m], rounded to 1 mm.

    `target` (n,) areas [m2], `trust` (n,) their weights, `slack` (n,) how far the lines of each room may move [m],
    `fixed` (k,) lines that stay, `share` scales all bounds (0: nothing moves), `half` are the walls.
    """
    at = lines.at.copy()
    ids = [corner_lines(lines, c) for c in outlines]
    shape = _shape(outlines, ids, sides, half)
    bound = np.full(at.size, FARTHEST)
    for corners, own, most in zip(outlines, ids, slack, strict=True):
        bound[own] = np.minimum(bound[own], most)
        for i, (x, y) in enumerate(corners):
            x1, y1 = corners[(i + 1) % len(corners)]
            if abs(x1 - x) + abs(y1 - y) == 1:  # a jog of one cell: the lines at both its ends stay near
                axis = 0 if y1 == y else 1
                for k in (own[i, axis], own[(i + 1) % len(corners), axis]):
                    bound[k] = min(bound[k], AT_JOG)
    bound *= np.where(fixed, 0.0, share)
    for _ in range(ROUNDS):
        error, slope = _areas(at, shape, target)
        weight = np.sqrt(trust) / target
        ridge = np.sqrt(RIDGE) / FARTHEST
        left = np.vstack([slope * weight[:, None], np.eye(at.size) * ridge])
        right = np.concatenate([-error * weight, -(at - lines.at) * ridge])
        step = np.linalg.solve(left.T @ left, left.T @ right)
        at = np.clip(at + step, lines.at - bound, lines.at + bound)
    return np.round(at, 3)


class Shape(NamedTuple):
    """All corners of all rooms, one room after the other."""

    first: Ints  # (n,) each room's first corner
    room: Ints  # (c,) whose it is
    next: Ints  # (c,) the corner after it
    ids: Ints  # (c, 2) the lines that fix it
    inset: Floats  # (c, 2) from the lines to the room's faces [m]
    flat: NDArray[np.bool_]  # (c,) whether the side from it runs along x


def _shape(outlines: list[Corners], ids: list[Ints], sides: list[list[bool]], half: Halves) -> Shape:
    counts = np.array([len(c) for c in outlines])
    first = np.cumsum(counts) - counts
    after = np.arange(counts.sum()) + 1
    after[first + counts - 1] = first
    whole = np.vstack(ids)
    inset = np.vstack([insets(c, inner, half) for c, inner in zip(outlines, sides, strict=True)])
    return Shape(first, np.repeat(np.arange(counts.size), counts), after, whole, inset, whole[:, 1] == whole[after, 1])


def _areas(at: Floats, shape: Shape, target: Floats) -> tuple[Floats, Floats]:
    """Return inner areas minus targets (n,) and their derivatives by the lines' coordinates (n, k)."""
    p = at[shape.ids] + shape.inset
    q = p[shape.next]
    error = 0.5 * np.add.reduceat(p[:, 0] * q[:, 1] - q[:, 0] * p[:, 1], shape.first) - target
    # moving a side along its outward normal by 1 adds its length
    line = np.where(shape.flat, shape.ids[:, 1], shape.ids[:, 0])
    slope = np.zeros((target.size, at.size))
    np.add.at(slope, (shape.room, line), np.where(shape.flat, p[:, 0] - q[:, 0], q[:, 1] - p[:, 1]))
    return error, slope
