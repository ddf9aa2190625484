"""Convex tilings and covers of plan polygons: rectangles where all edges are axis-parallel, merged triangles elsewhere."""

import itertools

import numpy as np
import shapely
from shapely.geometry import MultiPolygon, Polygon

from pipeline.arrays import Bools, Floats

GRID = 1e-5  # coordinates closer than this are one [m]; poses and plans are rounded to 1e-4


def convex_pieces(region: Polygon | MultiPolygon) -> list[Floats]:
    """Tile `region` [m] with convex polygons (n, 2), counter-clockwise, that meet at their edges only."""
    return [piece for part in polygons(region) for piece in (_rectangles(part) if _rectilinear(part) else _merged_triangles(part))]


def convex_cover(region: Polygon | MultiPolygon) -> list[Floats]:
    """Return convex polygons (n, 2), counter-clockwise, whose union is `region` [m]: fewer than tile it, for they may overlap."""
    return [piece for part in polygons(region) for piece in (_cover(part) if _rectilinear(part) else _merged_triangles(part))]


def polygons(region: shapely.Geometry) -> list[Polygon]:
    """Return the polygons of any geometry, in a fixed order, without slivers."""
    parts = [p for p in shapely.get_parts(region, return_index=False) if p.geom_type == "Polygon" and p.area > 1e-6]
    return sorted(parts, key=lambda p: (p.bounds, p.area))


def _rings(part: Polygon) -> list[Floats]:
    return [np.asarray(ring.coords)[:-1] for ring in (part.exterior, *part.interiors)]


def _rectilinear(part: Polygon) -> bool:
    steps = np.concatenate([np.abs(np.roll(r, -1, axis=0) - r) for r in _rings(part)])
    return bool(np.all(steps.min(axis=1) < GRID))


def _rectangles(part: Polygon) -> list[Floats]:
    """Tile an axis-parallel polygon greedily: at each free grid cell, the larger of the row-first and column-first run."""
    xs, ys, free = _cells(part)
    rectangles: list[Floats] = []
    while free.any():
        blocks = _grow_blocks(free, *map(int, np.argwhere(free)[0]))
        i, j, i1, j1 = block = max(blocks, key=lambda b: (xs[b[2]] - xs[b[0]]) * (ys[b[3]] - ys[b[1]]))
        free[i:i1, j:j1] = False
        rectangles.append(_rectangle(xs, ys, block))
    return rectangles


def _cells(part: Polygon) -> tuple[Floats, Floats, Bools]:
    """Return the x and the y of an axis-parallel polygon's corners, and which cells between them (X - 1, Y - 1) are inside."""
    points = np.concatenate(_rings(part))
    xs, ys = _ticks(points[:, 0]), _ticks(points[:, 1])
    cx, cy = np.meshgrid((xs[1:] + xs[:-1]) / 2, (ys[1:] + ys[:-1]) / 2, indexing="ij")
    return xs, ys, shapely.contains_xy(part, cx, cy)


def _rectangle(xs: Floats, ys: Floats, block: tuple[int, int, int, int]) -> Floats:
    i, j, i1, j1 = block
    return np.array([[xs[i], ys[j]], [xs[i1], ys[j]], [xs[i1], ys[j1]], [xs[i], ys[j1]]])


def _cover(part: Polygon) -> list[Floats]:
    """Cover an axis-parallel polygon greedily by rectangles that cannot grow: each time the one over most of what is left."""
    xs, ys, inside = _cells(part)
    blocks = sorted({block for cell in np.argwhere(inside) for block in _grow_blocks(inside, *map(int, cell))})
    area = np.diff(xs)[:, None] * np.diff(ys)
    left = np.where(inside, area, 0.0)
    chosen = []
    while left.any():
        i, j, i1, j1 = block = max(blocks, key=lambda b: round(float(left[b[0] : b[2], b[1] : b[3]].sum()), 9))
        left[i:i1, j:j1] = 0.0
        chosen.append(_rectangle(xs, ys, block))
    return chosen


def _grow_blocks(inside: Bools, i: int, j: int) -> list[tuple[int, int, int, int]]:
    """Return the blocks (i, j, i1, j1; ends exclusive) about a cell that grow along the rows first, and along the columns first."""
    blocks = []
    for turned in (False, True):
        grid, a, b = (inside.T, j, i) if turned else (inside, i, j)
        a0, a1 = a, a + 1
        while a0 > 0 and grid[a0 - 1, b]:
            a0 -= 1
        while a1 < grid.shape[0] and grid[a1, b]:
            a1 += 1
        b0, b1 = b, b + 1
        while b0 > 0 and grid[a0:a1, b0 - 1].all():
            b0 -= 1
        while b1 < grid.shape[1] and grid[a0:a1, b1].all():
            b1 += 1
        blocks.append((b0, a0, b1, a1) if turned else (a0, b0, a1, b1))
    return blocks


def _ticks(values: Floats) -> Floats:
    ordered = np.sort(values)
    return np.asarray(ordered[np.concatenate([[True], np.diff(ordered) > GRID])])


def _merged_triangles(part: Polygon) -> list[Floats]:
    """Tile any polygon: constrained Delaunay triangles, merged while the union stays convex (Hertel and Mehlhorn 1983)."""
    triangles = polygons(shapely.constrained_delaunay_triangles(part))
    pieces = [np.asarray(shapely.geometry.polygon.orient(t).exterior.coords)[:-1] for t in triangles]
    while True:
        pairs = itertools.combinations(range(len(pieces)), 2)
        merged = next(((i, j, union) for i, j in pairs if (union := _merge(pieces[i], pieces[j])) is not None), None)
        if merged is None:
            return pieces
        i, j, pieces[i] = merged
        del pieces[j]


def _merge(a: Floats, b: Floats) -> Floats | None:
    """Join two counter-clockwise convex polygons along a shared edge, if the result is convex."""
    near = np.linalg.norm(a[:, None] - b[None], axis=2) < GRID
    for i in range(len(a)):
        k = (i + 1) % len(a)
        for j in range(len(b)):
            if near[i, (j + 1) % len(b)] and near[k, j]:
                ring = np.concatenate([np.roll(a, -k, axis=0), np.roll(b, -(j + 1), axis=0)[1:-1]])
                before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
                turn = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
                if np.all(turn > -1e-9):
                    return np.asarray(ring[np.abs(turn) > 1e-9])
    return None
