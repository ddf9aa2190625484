"""Plainer hulls: boxes in place of what is nearly one (boards with rounded edges, drawers' fronts, keys), and no more sides than PhysX takes.

Eight corners instead of up to 64 make every contact cheaper, in any engine. The box holds the hull and its sides touch it, so what
it adds lies along edges and at corners. A hull of more sides PhysX makes anew, and a level top comes out lower or askew: a cup on a round table turned by 1.7 degrees.
"""

from collections.abc import Iterator

import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.distance import cdist

from pipeline.arrays import Floats, Ints
from pipeline.sources.meshes.mesh_solids import LEFT_OUT, distances_outside, hull, normals, qhull_of

SIDES = 64
DECIMALS = 3  # of normals, and of distances [m], by which two sides are one
LEVEL = 1e-4  # [m] within which corners are of one level top, or of the level on which a thing stands
DIRECTIONS = 12  # in which such a level keeps its outline
AROUND = np.array([(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if x or y or z], np.float64)
NEAR = 0.005  # [m] that a box may stand out beyond what it replaces: less than a fingertip feels
LOWER = 2e-4  # [m] that it may reach below
SHARE = 0.05  # of its diagonal that it may at most: a small key stays what it is
ALIKE, ACROSS = 0.999, 0.05  # cosine of normals that are one, and of those that are square to each other
CORNERS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
FACES: Ints = np.array(
    [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
)


def simplify_to_box(hull: Floats, faces: Ints, near: float = NEAR, floor: float = -np.inf) -> tuple[Floats, Ints]:
    """Return a convex hull (vertices (V, 3) [m], faces (F, 3) outwards), or the box around it where no point of that is further than `near` away.

    It reaches no lower than `floor` [m], on which the thing stands, lest it is pushed up.

    How far a convex body is from points of a box is greatest at one of its corners, and no more than from there to the nearest vertex.
    """
    if len(hull) <= len(CORNERS):
        return hull, faces
    candidates = []
    for R in _axes(hull, faces):
        local = hull @ R.T
        low, high = local.min(axis=0), local.max(axis=0)
        corners = low + CORNERS * (high - low)
        if (corners @ R)[:, 2].min() < floor - LOWER:
            continue
        away = float(cdist(corners, local).min(axis=1).max())
        if away <= min(near, SHARE * float(np.linalg.norm(high - low))):
            candidates.append((round(away, 9), corners @ R))
    return (min(candidates, key=lambda f: f[0])[1], FACES) if candidates else (hull, faces)


def _axes(hull: Floats, faces: Ints) -> Iterator[Floats]:
    """Yield rotations (3, 3) to the axes that a box may have: the world's, those to which its sides are nearest on the whole, those of its two largest sides."""
    yield np.eye(3)
    ways = normals(hull, faces)
    areas = np.maximum(np.sqrt((ways**2).sum(axis=1)), 1e-15)
    ways /= areas[:, None]
    main = np.linalg.eigh(ways.T @ (ways * areas[:, None]))[1].T  # of a box: its axes, by the areas of its sides
    yield main * np.linalg.det(main).round()
    alike = np.abs(ways @ ways.T)
    together = ((alike > ALIKE) @ areas).round(12)
    first = int(np.argmax(together))
    second = int(np.argmax(np.where(alike[first] < ACROSS, together, -1.0)))
    if alike[first, second] < ACROSS:
        x = ways[first]
        y = ways[second] - (ways[second] @ x) * x
        y /= np.linalg.norm(y)
        yield np.stack([x, y, np.cross(x, y)])


def with_few_sides(corners: Floats, faces: Ints, off: float) -> tuple[Floats, Ints]:
    """Return a convex hull (corners (V, 3) [m], faces (F, 3) outwards), in place of one of more than SIDES one of as many of its corners as that allows.

    Where that would leave a corner out by more than `off` [m] it stays as it is.
    """
    if count_sides(ConvexHull(corners)) <= SIDES:
        return corners, faces
    chosen, kept, left = _outlines(corners), corners, np.inf
    while left > LEFT_OUT and (within := _within(corners[chosen])):
        away = distances_outside(corners, within.equations)
        kept, left = corners[chosen], float(away.max())
        chosen = np.append(chosen, int(np.argmax(away)))
    fewer = hull(kept) if left <= off else None
    return (corners, faces) if fewer is None else fewer[:2]


def count_sides(within: ConvexHull) -> int:
    """Return how many planes bound a hull."""
    return len(np.unique(within.equations.round(DECIMALS), axis=0))


def _within(points: Floats) -> ConvexHull | None:
    """Return the hull of points (N, 3) where it has no more than SIDES sides."""
    within = qhull_of(points)
    return within if within is not None and count_sides(within) <= SIDES else None


def _outlines(corners: Floats) -> Ints:
    """Return the corners (V, 3), by index, that reach farthest all around, and the outlines of a level top and bottom, where things lie and stand."""
    z = corners[:, 2]
    turns = 2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    level = np.stack([np.cos(turns), np.sin(turns)])
    top, bottom = np.flatnonzero(z > z.max() - LEVEL), np.flatnonzero(z < z.min() + LEVEL)
    farthest = np.argmax(corners @ AROUND.T, axis=0)
    return np.unique(np.concatenate([farthest, *(k[np.argmax(corners[k, :2] @ level, axis=0)] for k in (top, bottom))]))
