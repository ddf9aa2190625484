"""Clusters on a line: where the density of a sample has a valley, it falls into two."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from pipeline.arrays import Floats

WIDTH = 0.05  # narrowest kernel
FINE = 5  # grid points to a kernel's width
VALLEY = 0.6  # a valley is no deeper split than this share of the lower of its two peaks
RANGE = 8.0  # values farther out than this are counted at the end of the grid


def density(values: Floats) -> tuple[Floats, Floats]:
    """Return a kernel estimate over a regular grid: the grid (G,), and its density (G,)."""
    spread = float(np.std(values))
    width = max(WIDTH, 0.3 * spread * (len(values) / 100) ** -0.2)
    step = width / FINE
    low = max(-RANGE, float(values.min())) - 4 * width
    high = min(RANGE, float(values.max())) + 4 * width
    count = int(np.ceil((high - low) / step)) + 1
    cells = np.bincount(np.clip(((values - low) / step).astype(int), 0, count - 1), minlength=count)
    smooth = gaussian_filter1d(cells.astype(float), FINE, mode="constant")
    return low + step * (np.arange(count) + 0.5), smooth / (len(values) * step)


def entropy(values: Floats) -> float:
    """Return minus the mean log density [nats]: the lower, the better the values keep together."""
    grid, densities = density(values)
    return -float(np.mean(np.log(np.interp(values, grid, densities) + 1e-9)))


def split(values: Floats, least: int) -> list[NDArray[np.intp]]:
    """Return the clusters, left to right, as indices; those of fewer than `least` values go with a neighbour."""
    if len(values) < 2 * least:
        return [np.arange(len(values))]
    grid, densities = density(values)
    cuts = grid[_valleys(densities)]
    order = np.digitize(values, cuts)
    clusters = [np.flatnonzero(order == k) for k in range(len(cuts) + 1)]
    while len(clusters) > 1 and min(map(len, clusters)) < least:
        k = min(range(len(clusters)), key=lambda i: len(clusters[i]))
        other = k - 1 if k and (k == len(clusters) - 1 or _apart(values, clusters, k - 1) < _apart(values, clusters, k)) else k + 1
        first = min(k, other)
        clusters[first : first + 2] = [np.concatenate(clusters[first : first + 2])]
    return clusters


def _apart(values: Floats, clusters: list[NDArray[np.intp]], k: int) -> float:
    left, right = values[clusters[k]], values[clusters[k + 1]]
    return float(right.min() - left.max()) if len(left) and len(right) else 0.0


def _valleys(densities: Floats) -> list[int]:
    """Return the grid points at which to cut: the lowest between two peaks, where it is low enough."""
    rise = np.flatnonzero((densities[1:-1] > densities[:-2]) & (densities[1:-1] >= densities[2:])) + 1
    peaks = [int(p) for p in rise]
    cuts: list[int] = []
    while len(peaks) > 1:
        lows = [a + int(np.argmin(densities[a:b])) for a, b in pairwise(peaks)]
        worth = [densities[v] / min(densities[a], densities[b]) for v, a, b in zip(lows, peaks[:-1], peaks[1:], strict=True)]
        k = int(np.argmax(worth))
        if worth[k] <= VALLEY:
            cuts = lows
            break
        del peaks[k if densities[peaks[k]] < densities[peaks[k + 1]] else k + 1]
    return cuts
