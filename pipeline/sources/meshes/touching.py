"""Fewer convex pieces by what a hand feels: neighbours become one piece while its surface stays close to theirs.

The measure is the way from the common hull's surface to the pieces as they were first, so that errors do not add up. A cup
keeps its hollow, with fewer staves; bevels, beads and shallow frames go; a block that is closed all round becomes one piece.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from pipeline.sources.meshes.mesh_solids import MAX_HULL, Part, combined

Floats = NDArray[np.float64]

MOST = 250  # pieces of a link beyond which it is left as it is
SAMPLES = (3, 12)  # points along a side of the hull's triangles, coarse first
SHARE = 0.15  # of the least extent of a link: what its touched surface may be off by at most, however small it is
TOUCHED, HUNG = (
    0.005,
    0.03,
)  # [m] how far a collider's surface may be off where hands and things come; out of reach, flat on walls or floors, leaves
Offer = tuple[float, int, int]


def simpler(pieces: Sequence[Part], tolerance: float) -> tuple[Part, ...]:
    """Return convex pieces [m] as few as they can be felt for the same by, within `tolerance` [m]."""
    if not pieces:
        return ()
    points = np.concatenate([p.hull for p in pieces])
    least = SHARE * float(np.ptp(points, axis=0).min()) if tolerance <= TOUCHED else tolerance
    return fewer(pieces, min(tolerance, least))


def fewer(pieces: Sequence[Part], tolerance: float) -> tuple[Part, ...]:
    """Return convex pieces [m] merged, cheapest pairs first, as long as no surface point goes further than `tolerance` [m] from where it was."""
    if not 2 <= len(pieces) <= MOST or tolerance <= 0:
        return tuple(pieces)
    groups = [[k] for k in range(len(pieces))]
    alive = [True] * len(pieces)
    planes = [_planes(p.hull) for p in pieces]
    hulls = [p.hull for p in pieces]
    volumes = [p.hull_volume for p in pieces]
    boxes = [np.array([p.hull.min(axis=0), p.hull.max(axis=0)]) for p in pieces]

    def offer(i: int, j: int) -> Offer | None:
        if (boxes[i][0] > boxes[j][1] + tolerance).any() or (boxes[j][0] > boxes[i][1] + tolerance).any():
            return None
        away = _deviation(
            np.concatenate([hulls[i], hulls[j]]), volumes[i] + volumes[j], [planes[k] for k in groups[i] + groups[j]], tolerance
        )
        return None if away is None else (round(away, 7), i, j)

    heap = [found for i in range(len(pieces)) for j in range(i + 1, len(pieces)) if (found := offer(i, j))]
    heapq.heapify(heap)
    while heap:
        _, i, j = heapq.heappop(heap)
        if not (alive[i] and alive[j]):
            continue
        alive[i] = alive[j] = False
        points = np.concatenate([hulls[i], hulls[j]])
        made = ConvexHull(points)
        groups.append(groups[i] + groups[j])
        hulls.append(points[made.vertices])
        volumes.append(float(made.volume))
        boxes.append(np.array([points.min(axis=0), points.max(axis=0)]))
        alive.append(True)
        new = len(groups) - 1
        for k in range(new):
            if alive[k] and (found := offer(k, new)):
                heapq.heappush(heap, found)
    return tuple(pieces[g[0]] if len(g) == 1 else combined([pieces[k] for k in g]) for g, lives in zip(groups, alive, strict=True) if lives)


def _planes(points: Floats) -> Floats:
    """Return the planes (F, 4) of a hull."""
    return np.unique(ConvexHull(points).equations.round(9), axis=0)


def _deviation(points: Floats, held: float, planes: Sequence[Floats], tolerance: float) -> float | None:
    """Return how far the hull of points (N, 3) is from pieces (their planes, at most `held` in volume); None beyond the tolerance."""
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return None
    if (len(hull.vertices) > MAX_HULL and tolerance <= TOUCHED) or hull.volume - held > tolerance * hull.area:
        return None
    corners = points[hull.simplices]
    worst = 0.0
    for count in SAMPLES:
        worst = _away(_spread(corners, count), planes, tolerance / 4)
        if worst > tolerance:
            return None
    return worst


def _spread(corners: Floats, count: int) -> Floats:
    """Return points (P, 3) spread over triangles (F, 3, 3), `count` intervals along a side."""
    u, v = (k.ravel() for k in np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij"))
    inside = u + v <= count
    weights = np.stack([u, v, count - u - v], axis=1)[inside] / count
    return np.asarray(np.einsum("pk,fkd->fpd", weights, corners).reshape(-1, 3))


def _away(points: Floats, planes: Sequence[Floats], enough: float) -> float:
    """Return how far the worst of points (P, 3) is from the nearest piece, by the planes of its faces; below `enough` it is not looked at closely."""
    away = np.full(len(points), np.inf)
    for plane in planes:
        left = np.flatnonzero(away > enough)
        away[left] = np.minimum(away[left], (points[left] @ plane[:, :3].T + plane[:, 3]).max(axis=1))
    return float(np.maximum(away, 0.0).max())
