"""Convex pieces of parts that are not convex, by greedy plane cuts.

The work is bounded by counts (cells of a grid, samples, cuts), never by the clock, and all of it is arithmetic on arrays:
the same mesh gives the same pieces on any machine, however busy. Meshes need not be closed, nor drawn once only.

A part is seen on a grid: cells that its surface passes, cells of air that can be reached from outside, and what is left,
its inside. How far a hull is from its part is the depth of the deepest air in it. The piece with most air is cut by the
plane whose two sides have the smallest hulls, what falls apart is taken apart, until no pocket is deeper than a
tolerance or the pieces are as many as they may be. (The loop is that of Lien and Amato 2007, approximate convex
decomposition; the measure is that of a hand that does not get into a pocket, not the volume's.)
"""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy import ndimage
from scipy.spatial import ConvexHull

from pipeline.arrays import Bools, Floats, Ints
from pipeline.sources.meshes.mesh_solids import cross, qhull_of

CELLS = 120_000  # of a grid at most
FINE = 2.0  # cells that a tolerance is wide, where CELLS allow it
SAMPLES = 500_000  # points on a surface at most; beyond that a coarser grid is taken
PLANES = 5  # tried along each axis for a cut
SEEN = 1000  # points by which a cut is judged
LAYERS = 12  # cells that a block of them is wide at most
WALL = 0.12  # share of a piece's cells from which on two layers of them are a wall
HOLLOW = 0.1  # cells of its inside for one of its surface up to which a part is of sheets
FULL = 0.8  # of its outline that a wall covers
GAIN = 0.95  # share of its volume above which a cut gains nothing by itself
BALANCE = 0.04  # share of the volume that an uneven cut costs more than an even one: where no single cut helps, halves
AIR = 8000  # cells of air at most that are looked at for a piece
FAR = 64  # cells across; a pocket that deep is deep enough


@dataclass(frozen=True, slots=True)
class Cut:
    """Points (N, 3) of each piece, whose hulls cover the part, and the deepest pocket (same unit) that is left in any of them."""

    pieces: tuple[Floats, ...]
    depth: float


@dataclass(frozen=True, slots=True)
class _Grid:
    """A part on a grid whose cells are `cell` wide, from `low` on.

    `points` (K, 3), one of the surface for each of its `cells` (K, 3); `depth` (X, Y, Z) is how far a cell of air is from
    the surface, 0 in the part. `sheets`: it has hardly an inside.
    """

    low: Floats
    cell: float
    points: Floats
    cells: Ints
    depth: Floats
    sheets: bool


@dataclass(frozen=True, slots=True)
class _Piece:
    """Cells of the surface by index, the hull, and what it holds of air that is too deep: cells, and the greatest depth."""

    members: Ints
    hull: ConvexHull
    air: int
    depth: float


def cut(vertices: Floats, faces: Ints, tolerance: float, most: int) -> Cut:
    """Cut a part (vertices (V, 3), faces (F, 3)) into at most `most` pieces without pockets deeper than `tolerance`."""
    grid = _grid(vertices, faces, tolerance)
    enough = max(tolerance, FINE * grid.cell)
    whole = _make_piece(grid, np.arange(len(grid.points)), enough)
    if whole is None:
        return Cut((vertices[np.unique(faces)],), 0.0)
    if whole.depth <= enough or most < 2:
        return Cut((vertices[np.unique(faces)],), whole.depth)
    pieces = [whole]
    closed: list[_Piece] = []  # those that no plane divides
    while pieces and len(pieces) + len(closed) < most:
        worst = max(range(len(pieces)), key=lambda k: (pieces[k].depth > enough, pieces[k].air))
        if pieces[worst].depth <= enough:
            break
        piece = pieces.pop(worst)
        sides = _divide(grid, piece, most - len(pieces) - len(closed), enough)
        if len(sides) < 2:
            closed.append(piece)
        else:
            pieces += sides
    all_pieces = pieces + closed
    return Cut(tuple(grid.points[p.members[p.hull.vertices]] for p in all_pieces), max(p.depth for p in all_pieces))


def _grid(vertices: Floats, faces: Ints, tolerance: float) -> _Grid:
    corners = vertices[faces]
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    extent = high - low
    cell = max(tolerance / FINE, float(extent.max()) / 256, 1e-9)
    while float(np.prod(np.floor(extent / cell) + 3)) > CELLS:
        cell *= 1.1
    while (count := int(_count(corners, cell / 2).sum())) > SAMPLES:
        cell *= max(math.sqrt(count / SAMPLES), 1.1)
    points = _samples(corners, cell / 2)
    shape = (np.floor(extent / cell).astype(np.int64) + 3).tolist()
    low = low - cell * (3 - np.mod(extent / cell, 1.0)) / 2  # a border of air all round, the part in the middle
    cells = np.clip(np.floor((points - low) / cell).astype(np.int64), 1, np.array(shape) - 2)
    # Of the samples of a cell the outermost stands for it: corners and edges stay what they are.
    away = ((points - (vertices[faces].min(axis=(0, 1)) + extent / 2)) ** 2).sum(axis=1)
    code = (cells[:, 0] * shape[1] + cells[:, 1]) * shape[2] + cells[:, 2]
    order = np.lexsort((*points.T, -away.round(12), code))
    first = order[np.unique(code[order], return_index=True)[1]]
    surface = np.zeros(shape, bool)
    surface[tuple(cells[first].T)] = True
    regions = ndimage.label(~surface)[0]
    outside = regions == regions[0, 0, 0]
    depth = np.minimum(ndimage.distance_transform_edt(outside), FAR) * cell
    sheets = int((~outside & ~surface).sum()) < HOLLOW * len(first)
    return _Grid(low, cell, points[first], cells[first], np.where(outside, depth, 0.0), sheets)


def _sides(corners: Floats, cell: float) -> tuple[Floats, Ints, Ints]:
    """Return triangles (F, 3, 3) with their longest edge first, and the steps along it and towards the third corner (F,)."""
    edges = np.stack([corners[:, (k + 1) % 3] - corners[:, k] for k in range(3)])
    lengths = np.sqrt((edges**2).sum(axis=2))
    first = np.argmax(lengths, axis=0)
    rows = np.arange(len(corners))
    turned = np.stack([corners[rows, (first + k) % 3] for k in range(3)], axis=1)
    base = np.maximum(lengths[first, rows], 1e-15)
    area = np.sqrt((cross(edges[0], edges[1]) ** 2).sum(axis=1))
    return turned, np.ceil(base / cell).astype(np.int64) + 1, np.ceil(area / base / cell).astype(np.int64) + 1


def _count(corners: Floats, cell: float) -> Ints:
    _, along, across = _sides(corners, cell)
    return along * across


def _samples(corners: Floats, cell: float) -> Floats:
    """Return points (N, 3) on triangles, their corners among them, no further apart than a cell."""
    turned, along, across = _sides(corners, cell)
    count = along * across
    owner = np.repeat(np.arange(len(corners)), count)
    number = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    u = (number % along[owner]) / np.maximum(along[owner] - 1, 1)
    v = (number // along[owner]) / np.maximum(across[owner] - 1, 1)
    a, b, c = (turned[owner, k] for k in range(3))
    return np.asarray((a + (b - a) * u[:, None]) * (1 - v)[:, None] + c * v[:, None])


def _make_piece(grid: _Grid, members: Ints, enough: float) -> _Piece | None:
    """Return a piece with what its hull holds of air deeper than `enough`, None where it spans no volume."""
    points = grid.points[members]
    hull = qhull_of(points if len(points) >= 4 and np.ptp(points, axis=0).min() > 0.1 * grid.cell else _thick(points, grid.cell))
    if hull is None:
        return None
    if len(hull.points) > len(points):  # thickened: no air in a sheet
        return _Piece(np.tile(members, 2), hull, 0, 0.0)
    first, last = grid.cells[members].min(axis=0), grid.cells[members].max(axis=0) + 1
    block = tuple(slice(a, b) for a, b in zip(first, last, strict=True))
    depth = grid.depth[block]
    air = np.argwhere(depth > enough)
    step = -(-len(air) // AIR)
    air = air[:: max(step, 1)]
    centres = grid.low + (air + first + 0.5) * grid.cell
    for normal in _planes(hull):
        keep = centres @ normal[:3] + normal[3] <= -0.5 * grid.cell
        air, centres = air[keep], centres[keep]
        if not len(air):
            break
    depths = depth[tuple(air.T)]
    return _Piece(members, hull, step * len(depths), float(depths.max(initial=0.0)))


def _planes(hull: ConvexHull) -> Floats:
    """Return planes (N, 4) of a hull, one for normals that are nearly the same: those of a sphere are some 400."""
    _, first = np.unique((hull.equations[:, :3] * 8).round(), axis=0, return_index=True)
    return np.asarray(hull.equations[np.sort(first)])


def _thick(points: Floats, cell: float) -> Floats:
    """Return points of a sheet with a thickness, the sheet's own first."""
    spread = np.linalg.svd(points - points.mean(axis=0), full_matrices=True)[2] if len(points) > 1 else np.eye(3)
    return np.concatenate([points + 0.05 * cell * spread[2], points - 0.05 * cell * spread[2]])


def _divide(grid: _Grid, piece: _Piece, most: int, enough: float) -> list[_Piece]:
    """Return a wall of a piece and the rest, else the sides of its best cut, each in as many pieces as it falls apart to.

    Fewer than 2 where no plane divides it.
    """
    wall = _wall(grid, piece.members) if grid.sheets else None
    if wall is not None:
        blocks = [piece.members[wall], *_apart(grid, piece.members[~wall])]
        peeled = [p for block in blocks if (p := _make_piece(grid, block, enough)) is not None]
        if 2 <= len(peeled) <= most:
            return peeled
    cost, axis, plane = min((_best(grid, piece, axis) for axis in range(3)), key=lambda option: option[:2])
    if math.isfinite(cost) and cost > GAIN:
        axis, plane = _foresight(grid, piece) or (axis, plane)
    if plane < 0:
        return []
    where = grid.cells[piece.members, axis]
    pieces: list[_Piece] = []
    for side in (piece.members[where <= plane], piece.members[where >= plane]):  # both hold the layer of the cut: no gap
        pieces += [p for block in _apart(grid, np.unique(side)) if (p := _make_piece(grid, block, enough)) is not None]
    return pieces if len(pieces) <= max(most, 2) else sorted(pieces, key=lambda p: -p.hull.volume)[: max(most, 2)]


def _foresight(grid: _Grid, piece: _Piece) -> tuple[int, int] | None:
    """Return (axis, layer) of the halving after which the next cut gains most: a ring gains nothing by one cut, but by two."""
    options = []
    for axis in range(3):
        where = grid.cells[piece.members, axis]
        plane = int(where.min() + where.max()) // 2
        if where.max() - where.min() < 4:
            continue
        sides = [_make_piece(grid, piece.members[side], math.inf) for side in (where <= plane, where >= plane)]
        then = [min(_best(grid, p, k)[0] for k in range(3)) * p.hull.volume for p in sides if p is not None]
        options.append((round(sum(min(t, p.hull.volume) for t, p in zip(then, [p for p in sides if p], strict=True)), 9), axis, plane))
    return min(options)[1:] if options else None


def _wall(grid: _Grid, members: Ints) -> Bools | None:
    """Return which cells (K,) are the largest flat wall across an axis, two layers thick; None where there is none.

    What is made of boards or drawn as sheets, an open box say, has nothing to gain by any one cut elsewhere.
    """
    best: tuple[int, Bools] | None = None
    for axis in range(3):
        where = grid.cells[members, axis] - grid.cells[members, axis].min()
        count = np.bincount(where)
        if len(count) < 4:  # it is such a wall
            return None
        pairs = count[:-1] + count[1:]
        k = int(np.argmax(pairs))
        if pairs[k] < WALL * len(members) or (best is not None and pairs[k] <= best[0]):
            continue
        inside = (where == k) | (where == k + 1)
        flat = np.unique(np.delete(grid.cells[members[inside]], axis, axis=1), axis=0)
        outline = qhull_of((flat[:, None] + np.array([(0, 0), (0, 1), (1, 0), (1, 1)])).reshape(-1, 2))
        if outline is not None and len(flat) >= FULL * outline.volume and not inside.all():
            best = int(pairs[k]), inside
    return None if best is None else best[1]


def _apart(grid: _Grid, members: Ints) -> list[Ints]:
    """Return cells of the surface by the blocks that hang together."""
    low = grid.cells[members].min(axis=0)
    cells = grid.cells[members] - low
    there = np.zeros((cells.max(axis=0) + 1).tolist(), bool)
    there[tuple(cells.T)] = True
    label, count = ndimage.label(there, np.ones((3, 3, 3)))
    mine = label[tuple(cells.T)]
    return [members[mine == k] for k in range(1, count + 1)]


def _best(grid: _Grid, piece: _Piece, axis: int) -> tuple[float, int, int]:
    """Return (cost, axis, layer of cells) of the best plane across an axis; layer -1 where there is none."""
    where = grid.cells[piece.members, axis]
    first, last = int(where.min()), int(where.max())
    if last - first < 2:
        return math.inf, axis, -1
    planes = np.unique(np.linspace(first, last, PLANES + 2)[1:-1].round().astype(np.int64))
    planes = planes[(planes > first) & (planes < last)]
    members = _fewer(grid, piece.members, axis)
    at, points = grid.cells[members, axis], grid.points[members]
    left = _volumes([points[at <= planes[0]], *(points[(at > a) & (at <= b)] for a, b in pairwise(planes))])
    right = _volumes(
        [points[at >= planes[-1]], *(points[(at >= a) & (at < b)] for a, b in zip(planes[-2::-1], planes[:0:-1], strict=True))]
    )[::-1]
    whole = max(float(piece.hull.volume), 1e-15)
    even = np.abs((planes - first) / (last - first) - 0.5) * 2
    share = (last - first) * grid.cell / (float(max(grid.depth.shape)) * grid.cell)
    cost = (np.array(left) + np.array(right)) / whole + BALANCE * (1 + even - share)
    k = int(np.argmin(cost.round(9)))
    return float(cost[k].round(9)), axis, int(planes[k])


def _fewer(grid: _Grid, members: Ints, axis: int) -> Ints:
    """Return at most about SEEN of the members, for estimates: of each column of cells along an axis the outermost of every layer."""
    step, all_of_them = 1, members
    while len(members) > SEEN:
        step += 1
        blocks = grid.cells[all_of_them] // np.where(np.arange(3) == axis, 1, step)
        code = (blocks[:, 0] << 40) | (blocks[:, 1] << 20) | blocks[:, 2]
        away = ((grid.points[all_of_them] - grid.points[all_of_them].mean(axis=0)) ** 2).sum(axis=1)
        order = np.lexsort((all_of_them, -away.round(12), code))
        members = all_of_them[order[np.unique(code[order], return_index=True)[1]]]
        if step > LAYERS:
            break
    return members


def _volumes(blocks: list[Floats]) -> list[float]:
    """Return the volumes of the hulls of the first, the first two, ... of the blocks of points."""
    kept, volumes = np.zeros((0, 3)), []
    for block in blocks:
        kept = np.concatenate([kept, block])
        volume = 0.0
        if len(kept) > 3 and (hull := qhull_of(kept)) is not None:  # else flat so far
            kept, volume = kept[hull.vertices], float(hull.volume)
        volumes.append(volume)
    return volumes
