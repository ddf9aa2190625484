"""Corners of a small thing's collider as engines can tell them apart.

Four points hold one thing on another in MuJoCo, and Newton, which asks it, may take both ends of a bevel for two of them: a box with edges
of half a millimetre then stood on three corners, and tipped by five degrees.
"""

from dataclasses import replace

import numpy as np
from scipy.spatial import ConvexHull

from pipeline.entities.asset import Mesh

ALIKE = 0.002  # [m] within which two corners are one
LEVEL = 1e-4  # [m] within which corners are of the sole or the top, which stay where they are


def with_distinct_corners(mesh: Mesh) -> Mesh:
    """Return a convex mesh without corners that are close to another: those of its sole and its top are kept before others, outer ones before inner.

    What is hardly thicker than that stays as it is.
    """
    points = mesh.vertices.astype(np.float64)
    low, high = points.min(axis=0), points.max(axis=0)
    if (high - low).min() < 2 * ALIKE:
        return mesh
    between = np.minimum(points[:, 2] - low[2], high[2] - points[:, 2]) > LEVEL
    out = np.linalg.norm(points - (low + high) / 2, axis=1)
    kept: list[int] = []
    for k in np.lexsort((-out.round(6), between)).tolist():
        if all(np.linalg.norm(points[k] - points[i]) > ALIKE for i in kept):
            kept.append(k)
    if len(kept) == len(points):
        return mesh
    corners = mesh.vertices[np.sort(kept)]
    hull = ConvexHull(corners.astype(np.float64))  # what has left a corner convex leaves the others corners
    faces = hull.simplices.astype(np.int32)
    a, b, c = (hull.points[faces[:, k]] for k in range(3))
    inward = np.einsum("fk,fk->f", np.cross(b - a, c - a), hull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    return replace(mesh, vertices=corners, faces=faces)
