"""Measures of a plan on a grid of cells.

A plan is an integer array (rows, columns) of room indices with a border of `n`, the outside. Walls lie on the lines between
cells; row and column are y and x. One pass over the grid's vertices finds areas, walls, corners and common walls of all rooms.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Floats, Ints
from pipeline.geometry.compiled import borrowing, compiled

Labels = NDArray[np.int16]


class Halves(NamedTuple):
    """Half the thickness of inner and outer walls [m]: how far inner faces lie from the lines of the grid."""

    inner: float
    outer: float


class Measures(NamedTuple):
    """What `measure` finds, for n rooms. Lengths in cells; row n stands for the outside."""

    cells: Ints  # (n+1,) area
    box: Ints  # (n+1, 4) x0, y0, x1, y1
    corners: Ints  # (n+1, 2) convex, concave
    pinched: Ints  # (n+1,) vertices at which a room touches itself or another diagonally across
    walls: Ints  # (n+1, n+1) length of common walls
    run: Ints  # (n+1, n+1) longest straight common wall
    middle: Floats  # (n+1, n+1, 2) its middle (x, y)
    centre: Floats  # (n+1, 2) centroid (x, y)
    columns: Ints  # (columns+1,) whether a vertical wall lies there
    rows: Ints  # (rows+1,) whether a horizontal wall lies there
    outline_corners: Ints  # (n+1,) corners of the outline that a room owns
    stretches: Ints  # (2, columns+1) scratch: the vertical wall above each column line, and how long it is by now
    travel: Floats  # (n+1, 4) scratch: ways from the entrance


def empty(n: int, height: int, width: int) -> Measures:
    """Return scratch space for a grid of `height` x `width` cells (border not counted)."""
    m = n + 1
    cells, box, corners, pinched, walls, run = (np.zeros(shape, np.int64) for shape in (m, (m, 4), (m, 2), m, (m, m), (m, m)))
    columns, rows, outline_corners, stretches = (np.zeros(shape, np.int64) for shape in (width + 1, height + 1, m, (2, width + 1)))
    middle, centre, travel = np.zeros((m, m, 2)), np.zeros((m, 2)), np.zeros((m, 4))
    return Measures(cells, box, corners, pinched, walls, run, middle, centre, columns, rows, outline_corners, stretches, travel)


@borrowing
def _wall(out: Measures, a: int, b: int, more: int, length: int, x: float, y: float) -> None:
    """Record `more` cells of common wall of rooms a and b; the straight stretch is `length` by now, with middle (x, y)."""
    out.walls[a, b] += more
    out.walls[b, a] += more
    if length > out.run[a, b]:
        out.run[a, b] = length
        out.run[b, a] = length
        out.middle[a, b, 0] = x
        out.middle[a, b, 1] = y
        out.middle[b, a, 0] = x
        out.middle[b, a, 1] = y


@borrowing
def _clear(out: Measures, n: int, height: int, width: int) -> None:
    """Set all counts to zero (loops compile faster than slices)."""
    for i in range(n + 1):
        out.cells[i] = 0
        out.pinched[i] = 0
        out.outline_corners[i] = 0
        out.corners[i, 0] = 0
        out.corners[i, 1] = 0
        out.centre[i, 0] = 0.0
        out.centre[i, 1] = 0.0
        out.box[i, 0], out.box[i, 1], out.box[i, 2], out.box[i, 3] = width, height, 0, 0
        for j in range(n + 1):
            out.walls[i, j] = 0
            out.run[i, j] = 0
    for x in range(width + 1):
        out.columns[x] = 0
    for y in range(height + 1):
        out.rows[y] = 0


@borrowing
def _same_rows(grid: Labels, y: int) -> bool:
    """Whether rows y and y + 1 of the bordered grid are equal."""
    for x in range(1, grid.shape[1] - 1):  # noqa: SIM110 - compiled
        if grid[y, x] != grid[y + 1, x]:
            return False
    return True


@borrowing
def measure(grid: Labels, n: int, out: Measures) -> None:
    """Fill `out` from the bordered grid (rows+2, columns+2). Equal rows are taken in one step."""
    height, width = grid.shape[0] - 2, grid.shape[1] - 2
    _clear(out, n, height, width)
    walls, lengths = out.stretches[0], out.stretches[1]
    for x in range(width + 1):
        walls[x] = -1
    y = 0
    while y <= height:
        band = 1
        while y + band <= height and _same_rows(grid, y + band):
            band += 1
        row_len = y - y  # a plain 0 is a type of its own at first: all that is called with it would be compiled twice
        start = 0
        b, d = grid[y, 0], grid[y + 1, 0]
        for x in range(width + 1):
            a, c = b, d  # the cells around the vertex: a b below, c d above
            b, d = grid[y, x + 1], grid[y + 1, x + 1]
            if d != c:  # a vertical wall on column line x, beside these rows
                key = min(c, d) * 64 + max(c, d)
                lengths[x] = lengths[x] + band if walls[x] == key else band
                walls[x] = key
                out.columns[x] = 1
                _wall(out, c, d, band, lengths[x], float(x), y + band - 0.5 * lengths[x])
                if c != n:  # the span of room c in these rows ends here
                    first, count = start, (x - start) * band
                    out.cells[c] += count
                    out.centre[c, 0] += count * 0.5 * (first + x)
                    out.centre[c, 1] += count * (y + 0.5 * band)
                    out.box[c, 0] = min(out.box[c, 0], first)
                    out.box[c, 1] = min(out.box[c, 1], y)
                    out.box[c, 2] = max(out.box[c, 2], x)
                    out.box[c, 3] = max(out.box[c, 3], y + band)
                start = x
            else:
                walls[x] = -1
            if a != c and (a != b or c != d):  # a horizontal wall on row line y ends here
                out.rows[y] = 1
                _wall(out, a, c, row_len, row_len, x - 0.5 * row_len, float(y))
                row_len = 0
            row_len = row_len + 1 if b != d else 0
            if (a != b or c != d) and (a != c or b != d):
                _corner(out, a, b, c, d, n)
        y += band
    for i in range(n + 1):
        if out.cells[i] > 0:
            out.centre[i, 0] /= out.cells[i]
            out.centre[i, 1] /= out.cells[i]


@borrowing
def _corner(out: Measures, a: int, b: int, c: int, d: int, n: int) -> None:
    """Count the corners that meet in a vertex with the four cells a b / c d around it."""
    if a == d and min(abs(b - a), abs(c - a)) > 0:
        out.pinched[a] += 1
    if b == c and min(abs(a - b), abs(d - b)) > 0:
        out.pinched[b] += 1
    outside = (a == n) + (b == n) + (c == n) + (d == n)
    for k in range(4):
        own = a if k == 0 else (b if k == 1 else (c if k == 2 else d))
        across = d if k == 0 else (c if k == 1 else (b if k == 2 else a))
        same = (a == own) + (b == own) + (c == own) + (d == own)
        if same == 1 or (same == 2 and across == own):  # alone, or one of two that touch diagonally
            out.corners[own, 0] += 1
            if own != n and outside == 3:
                out.outline_corners[own] += 1
        elif same == 3 and across != own:  # the cell opposite to the odd one: its room has a concave corner here
            out.corners[own, 1] += 1


@borrowing
def inner_area(out: Measures, room: int, n: int, unit: float, half: Halves) -> float:
    """Area between inner wall faces [m2]: cells less half a wall along each side, corners counted once."""
    outer = out.walls[room, n]
    inner = 0
    for b in range(n):
        inner += out.walls[room, b]
    turn = out.corners[room, 0] - out.corners[room, 1]
    mean = half.inner if outer + inner == 0 else (half.inner * inner + half.outer * outer) / (inner + outer)
    return float(out.cells[room] * unit * unit - unit * (half.inner * inner + half.outer * outer) + turn * mean * mean)


@borrowing
def simple(out: Measures, room: int) -> bool:
    """Whether the room is one piece without holes that nowhere touches itself (Euler number of a 4-connected region)."""
    return bool(out.cells[room] > 0 and out.pinched[room] == 0 and out.corners[room, 0] - out.corners[room, 1] == 4)


@compiled
def hull_area(grid: Labels, room: int, boxes: Ints) -> float:
    """Area of the room's convex hull [cells], from the extremes of its rows (monotone chain)."""
    rows = boxes[room, 3] - boxes[room, 1]
    left = np.empty((2 * rows, 2), np.float64)
    right = np.empty((2 * rows, 2), np.float64)
    for k in range(rows):
        y = boxes[room, 1] + k
        x0 = boxes[room, 0]
        while grid[y + 1, x0 + 1] != room:
            x0 += 1
        x1 = boxes[room, 2]
        while grid[y + 1, x1] != room:
            x1 -= 1
        left[2 * k, 0], left[2 * k, 1] = x0, y
        left[2 * k + 1, 0], left[2 * k + 1, 1] = x0, y + 1
        right[2 * k, 0], right[2 * k, 1] = x1, y
        right[2 * k + 1, 0], right[2 * k + 1, 1] = x1, y + 1
    return _chain(right, 1.0) - _chain(left, -1.0)


@compiled
def _chain(points: Floats, side: float) -> float:
    """Integral of x dy under the outer chain of points that are sorted by y; `side` 1: the right one, -1: the left one."""
    hull = np.empty((points.shape[0], 2))
    size = 0
    for k in range(points.shape[0]):
        while size >= 2:
            ax, ay = hull[size - 1, 0] - hull[size - 2, 0], hull[size - 1, 1] - hull[size - 2, 1]
            bx, by = points[k, 0] - hull[size - 1, 0], points[k, 1] - hull[size - 1, 1]
            if side * (ax * by - ay * bx) <= 0.0:
                size -= 1
            else:
                break
        hull[size, 0], hull[size, 1] = points[k, 0], points[k, 1]
        size += 1
    area = 0.0
    for k in range(size - 1):
        area += 0.5 * (hull[k, 0] + hull[k + 1, 0]) * (hull[k + 1, 1] - hull[k, 1])
    return area


@borrowing
def notch_width(grid: Labels, room: int, boxes: Ints) -> int:
    """Return the width of what an L-shaped room leaves of its box [cells]."""
    x0, y0, x1, y1 = boxes[room, 0], boxes[room, 1], boxes[room, 2], boxes[room, 3]
    y = y0 if grid[y0 + 1, x0 + 1] != room or grid[y0 + 1, x1] != room else y1 - 1
    left, right = x0, x1 - 1
    while grid[y + 1, left + 1] != room:
        left += 1
    while grid[y + 1, right + 1] != room:
        right -= 1
    return int((x1 - x0) - (right - left + 1))


@borrowing
def ell_opening(w: int, h: int, a: int, b: int, side: int) -> tuple[int, int]:
    """Return what `opening` does for an L: a box of w x h cells without a corner of a x b.

    A square that avoids the corner lies wholly in one of the two arms that span the box, and both share the corner across.
    """
    upright = side <= w - a and side <= h
    level = side <= w and side <= h - b
    reached = (w - a) * h * upright + w * (h - b) * level - (w - a) * (h - b) * (upright and level)
    return int(reached), int(upright or level)


@compiled
def opening(grid: Labels, room: int, boxes: Ints, side: int) -> tuple[int, int]:  # noqa: C901, PLR0912 - three passes, compiled
    """Cells of the room that a square of `side` cells reaches inside it, and the pieces that the square's places form."""
    x0, y0, x1, y1 = boxes[room, 0], boxes[room, 1], boxes[room, 2], boxes[room, 3]
    h, w = y1 - y0, x1 - x0
    if side > h or side > w:
        return 0, 0
    size = np.zeros((h + 1, w + 1), np.int64)
    place = np.zeros((h + 1, w + 1), np.int64)
    for y in range(h):
        for x in range(w):
            if grid[y0 + y + 1, x0 + x + 1] == room:
                size[y + 1, x + 1] = min(size[y, x], size[y, x + 1], size[y + 1, x]) + 1
                if size[y + 1, x + 1] >= side:
                    place[y + 1, x + 1] = 1
    cover = np.zeros((h + side + 1, w + side + 1), np.int64)
    for y in range(1, h + 1):
        for x in range(1, w + 1):
            if place[y, x] == 1:
                cover[y - side, x - side] += 1
                cover[y, x - side] -= 1
                cover[y - side, x] -= 1
                cover[y, x] += 1
    reached = 0
    for y in range(h):
        for x in range(w):
            if y > 0:
                cover[y, x] += cover[y - 1, x]
            if x > 0:
                cover[y, x] += cover[y, x - 1]
            if x > 0 and y > 0:
                cover[y, x] -= cover[y - 1, x - 1]
            if cover[y, x] > 0:
                reached += 1
    return reached, _pieces(place)


@compiled
def _pieces(mask: Ints) -> int:
    """Count the 4-connected pieces of a mask with an empty first row and column; the mask is consumed."""
    h, w = mask.shape
    stack = np.empty((h * w + 1, 2), np.int64)
    pieces = 0
    for y in range(h):
        for x in range(w):
            if mask[y, x] == 0:
                continue
            pieces += 1
            top = 1
            stack[0, 0], stack[0, 1] = y, x
            mask[y, x] = 0
            while top > 0:
                top -= 1
                cy, cx = stack[top, 0], stack[top, 1]
                for k in range(4):
                    ny = cy + (1 if k == 0 else (-1 if k == 1 else 0))
                    nx = cx + (1 if k == 2 else (-1 if k == 3 else 0))
                    if 0 <= ny < h and 0 <= nx < w and mask[ny, nx] == 1:
                        mask[ny, nx] = 0
                        stack[top, 0], stack[top, 1] = ny, nx
                        top += 1
    return pieces
