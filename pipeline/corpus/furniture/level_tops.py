"""Where things can lie on and in a model: the level tops of its solids, boards inside included."""

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.assembly import shape_of
from pipeline.corpus.furniture.catalogue import Model

LEVEL = 1e-4
"""Vertices within this height of the highest lie on the top [m]."""
LEAST = 0.07
"""Narrowest top that anything lies on [m]."""
SHARES = (1.0, 0.96, 0.9, 0.8, 0.7, 0.6)
"""What share of a top's bounds is tried: all of a board, two thirds of a disc."""


@dataclass(frozen=True, slots=True)
class Surfaces:
    """A model's solids and tops, object frame [m].

    `boxes` (n, 2, 3) are the solids' bounds, `tops` (m, 5) the level rectangles (x0, y0, x1, y1, z).
    """

    boxes: NDArray[np.float64]
    tops: NDArray[np.float64]


@functools.lru_cache(maxsize=2048)
def surfaces_of(model: Model) -> Surfaces:
    """Return the surfaces of a model at rest."""
    boxes, tops = [], []
    for piece in shape_of(model).pieces():
        vertices = piece.solid.vertices
        boxes.append(piece.solid.bounds())
        on_top = (vertices[:, 2] > vertices[:, 2].max() - LEVEL).tolist()
        candidates = (level(vertices[list(face)]) for face in piece.solid.faces if all(on_top[k] for k in face))
        tops += [top for top in candidates if top is not None]
    return Surfaces(np.array(boxes).reshape(-1, 2, 3), np.array(tops).reshape(-1, 5))


def level(corners: NDArray[np.float64]) -> tuple[float, float, float, float, float] | None:
    """Return the largest of some rectangles, square to the axes, inside a level convex polygon (n, 3); None if it is narrow."""
    low, high = corners[:, :2].min(axis=0), corners[:, :2].max(axis=0)
    middle, half = (low + high) / 2, (high - low) / 2
    edges = np.roll(corners[:, :2], -1, axis=0) - corners[:, :2]
    signs = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    for share in SHARES:
        points = middle + signs * half * share
        off = points[:, None, :] - corners[None, :, :2]
        if (edges[None, :, 0] * off[..., 1] - edges[None, :, 1] * off[..., 0]).min() >= -1e-6:
            if 2 * share * half.min() < LEAST:
                return None
            (x0, y0), (x1, y1) = points[0].tolist(), points[2].tolist()
            return x0, y0, x1, y1, float(corners[:, 2].max())
    return None
