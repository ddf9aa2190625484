"""Sizes of models: skewed distributions per category and axis, drawn in strata so that few draws keep mean and spread."""

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import ndtri

from pipeline.card import cards

TAIL = float(ndtri(0.95))
MOST_SKEWED = 1.2
"""Largest shape parameter of the log-normal; beyond it a handful of draws cannot show the spread."""
LEAST, MOST = 0.75, 1.3
"""No draw is smaller than this share of the 5th percentile, or larger than this multiple of the 95th."""
ROUNDS = 6


@dataclass(frozen=True, slots=True)
class SizeStatistics:
    """Full extents (w, d, h) [m] of a category's models: mean, standard deviation, 5th and 95th percentile.

    `models` is how many models these were counted on; 0: our own estimate.
    """

    mean: NDArray[np.float64]
    std: NDArray[np.float64]
    p05: NDArray[np.float64]
    p95: NDArray[np.float64]
    models: int = 0


@functools.cache
def load() -> Mapping[str, SizeStatistics]:
    """Return the statistics on the categories' cards."""
    return {
        name: SizeStatistics(np.array(s.mean), np.array(s.std), np.array(s.p05), np.array(s.p95), s.n)
        for name, s in ((name, card.size) for name, card in cards().items())
    }


def draw(rng: np.random.Generator, statistics: SizeStatistics, count: int, rounds: Sequence[bool] = ()) -> NDArray[np.float64]:
    """Draw `count` sizes (count, 3) [m]: per axis one draw from each of `count` equal quantile strata, in random order.

    From three draws on their mean and standard deviation are those of the category, as far as the bounds let them. Where
    `rounds` (count,) is true, width and depth are equal.
    """
    sizes = np.stack([_axis(rng, statistics, axis, count) for axis in range(3)], axis=1)
    for axis in range(3):
        sizes[:, axis] = rng.permutation(sizes[:, axis])
    mask = np.array(rounds, bool) if len(rounds) else np.zeros(count, bool)
    if mask.any():
        sizes[mask, :2] = _round(rng, statistics, int(mask.sum()))[:, None]
    for _ in range(ROUNDS):  # what is clipped at a bound shifts the others
        for axis in range(3):
            free = ~mask if axis < 2 and (~mask).sum() >= 2 else np.ones(count, bool)
            _standardise(sizes[:, axis], free, statistics, axis)
    if mask.any():
        sizes[mask, 1] = sizes[mask, 0]
    return sizes


def _axis(rng: np.random.Generator, statistics: SizeStatistics, axis: int, count: int) -> NDArray[np.float64]:
    """Draw one axis: a shifted log-normal with the category's mean and deviation, leaning as its percentiles do."""
    mean, std = float(statistics.mean[axis]), float(statistics.std[axis])
    z = ndtri((np.arange(count) + rng.uniform(0.1, 0.9, count)) / max(count, 1))
    above, below = float(statistics.p95[axis]) - mean, mean - float(statistics.p05[axis])
    if min(above, below) <= 0:
        return np.asarray(mean + std * z)
    shape, sign = skew(above / below)
    if shape < 1e-3:
        return np.asarray(mean + std * z)
    scale = std / np.sqrt(np.expm1(shape**2))
    return np.asarray(mean + sign * scale * (np.exp(sign * shape * z - shape**2 / 2) - 1))


@functools.lru_cache(maxsize=512)
def skew(ratio: float) -> tuple[float, float]:
    """Return (shape, sign) of the log-normal whose (p95 - mean) / (mean - p05) is `ratio`; sign -1: it leans the other way."""
    sign, wanted = (1.0, ratio) if ratio >= 1 else (-1.0, 1 / ratio)

    def lean(shape: float) -> float:
        middle = np.exp(shape**2 / 2)
        return float((np.exp(TAIL * shape) - middle) / (middle - np.exp(-TAIL * shape)))

    # The ratio grows with the shape up to a point; the mean passes the 95th percentile far beyond MOST_SKEWED.
    peak = max(np.linspace(0.01, MOST_SKEWED, 60), key=lean)
    if wanted <= lean(0.01):
        return 0.0, sign
    return (float(peak) if wanted >= lean(float(peak)) else float(brentq(lambda s: lean(s) - wanted, 0.01, peak))), sign


def _round(rng: np.random.Generator, statistics: SizeStatistics, count: int) -> NDArray[np.float64]:
    """Draw diameters (count,): where the distributions of width and depth meet, each weighed by its precision."""
    precision = 1 / np.maximum(statistics.std[:2], 1e-3) ** 2
    middle = float((statistics.mean[:2] * precision).sum() / precision.sum())
    z = ndtri((rng.permutation(count) + rng.uniform(0.1, 0.9, count)) / count)
    return np.asarray(np.maximum(middle + 0.8 * float(statistics.std[:2].min()) * z, LEAST * float(statistics.p05[:2].max())))


def _standardise(values: NDArray[np.float64], free: NDArray[np.bool_], statistics: SizeStatistics, axis: int) -> None:
    """Shift and stretch the `free` values so that all together have the category's mean and deviation; keep the bounds."""
    count = len(values)
    if count < 3:
        return
    mean, std = float(statistics.mean[axis]), float(statistics.std[axis])
    fixed = values[~free]
    n = int(free.sum())
    middle = (count * mean - fixed.sum()) / n
    variance = (count * std**2 - float(((fixed - mean) ** 2).sum())) / n - (middle - mean) ** 2
    now = float(values[free].std())
    stretch = np.sqrt(max(variance, 0.04 * std**2)) / now if now > 1e-9 else 1.0
    values[free] = middle + (values[free] - values[free].mean()) * stretch
    np.clip(values, LEAST * statistics.p05[axis], MOST * statistics.p95[axis], out=values)
