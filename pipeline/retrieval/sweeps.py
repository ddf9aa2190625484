"""Few boxes instead of many: what an asset's joints sweep, merged where merging adds the least volume."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def merged_boxes(boxes: NDArray[np.float64], most: int) -> NDArray[np.float64]:
    """Merge boxes (J, 2, 3) until at most `most` are left; each input lies inside one output.

    Greedy: the pair whose union adds the least volume over its two members goes first (ties: the earlier pair).
    """
    left = [box for box in boxes if np.isfinite(box).all() and (box[1] > box[0]).all()]
    while len(left) > most:
        best, pair = np.inf, (0, 1)
        for i in range(len(left)):
            for j in range(i + 1, len(left)):
                cost = volume(union(left[i], left[j])) - volume(left[i]) - volume(left[j])
                if cost < best - 1e-12:
                    best, pair = cost, (i, j)
        i, j = pair
        left = [*left[:i], union(left[i], left[j]), *left[i + 1 : j], *left[j + 1 :]]
    return np.array(left).reshape(-1, 2, 3)


def union(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the box (2, 3) around two boxes."""
    return np.stack([np.minimum(a[0], b[0]), np.maximum(a[1], b[1])])


def volume(box: NDArray[np.float64]) -> float:
    """Return the volume of a box (2, 3) [m3]."""
    return float(np.prod(box[1] - box[0]))
