"""Few boxes instead of many: what an asset's joints sweep, merged where merging adds the least volume."""

import numpy as np
from numpy.typing import NDArray

TIE = 1e-12  # m3: costs nearer than that are alike


def merged_boxes(boxes: NDArray[np.float64], most: int) -> NDArray[np.float64]:
    """Merge boxes (J, 2, 3) until at most `most` are left; each input lies inside one output.

    Greedy: the pair whose union adds the least volume over its two members goes first (ties: the earlier pair).
    """
    left = boxes[np.isfinite(boxes).all((1, 2)) & (boxes[:, 1] > boxes[:, 0]).all(1)]
    while len(left) > most:
        one, other = np.triu_indices(len(left), 1)
        unions = np.stack([np.minimum(left[one, 0], left[other, 0]), np.maximum(left[one, 1], left[other, 1])], 1)
        volumes = volume(left)
        cost = volume(unions) - volumes[one] - volumes[other]
        pair = int(np.flatnonzero(cost <= cost.min() + TIE)[0])
        left = np.delete(left, other[pair], 0)
        left[one[pair]] = unions[pair]
    return left.reshape(-1, 2, 3)


def volume(boxes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the volumes (N,) of boxes (N, 2, 3) [m3]."""
    return np.asarray(np.prod(boxes[:, 1] - boxes[:, 0], axis=1))
