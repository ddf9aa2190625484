"""Boxes in place of hulls that are nearly boxes: boards with rounded edges, drawers' fronts, keys.

Eight corners instead of up to 64 make every contact cheaper, in any engine. The box holds the hull and its sides touch it, so what
it adds lies along edges and at corners.
"""

from collections.abc import Iterator

import numpy as np
from scipy.spatial.distance import cdist

from pipeline.arrays import Floats, Ints
from pipeline.sources.meshes.mesh_solids import normals

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
