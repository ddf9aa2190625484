"""Hulls of no more sides than PhysX takes. What has more it makes anew, and a level top comes out lower or askew: a cup on a round table turned by 1.7 degrees."""

import numpy as np
from scipy.spatial import ConvexHull

from pipeline.arrays import Floats, Ints
from pipeline.sources.meshes.mesh_solids import LEFT_OUT, distances_outside, hull, qhull_of

SIDES = 64
ALIKE = 3  # decimals of normals, and of distances [m], by which two sides are one
LEVEL = 1e-4  # [m] within which corners are of one level top, or of the level on which a thing stands
DIRECTIONS = 12  # in which such a level keeps its outline
AROUND = np.array([(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if x or y or z], np.float64)


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
    return len(np.unique(within.equations.round(ALIKE), axis=0))


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
