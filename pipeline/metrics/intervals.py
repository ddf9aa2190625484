"""Uncertainty of what is counted and averaged. Every figure of a report carries its interval."""

import math
from collections.abc import Sequence
from typing import TypedDict

import numpy as np

from pipeline.arrays import Floats

Z95 = 1.959963984540054  # two-sided 95 % quantile of the normal distribution


class Rate(TypedDict):
    """A share of trials with its 95 % Wilson interval."""

    rate: float
    low: float
    high: float
    successes: int
    n: int


class Mean(TypedDict):
    """A mean with its 95 % bootstrap interval."""

    mean: float
    low: float
    high: float
    n: int


def wilson(successes: int, n: int, z: float = Z95) -> tuple[float, float]:
    """Return the Wilson score interval of a share (Wilson 1927); (0, 1) without trials."""
    if n == 0:
        return 0.0, 1.0
    p = successes / n
    centre = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    return max(0.0, min(p, centre - half)), min(1.0, max(p, centre + half))


def rate(successes: int, n: int) -> Rate:
    """Return a share with its Wilson interval; the share of no trials is 0, with the interval (0, 1)."""
    low, high = wilson(successes, n)
    share = successes / n if n else 0.0
    return {"rate": round(share, 6), "low": round(low, 6), "high": round(high, 6), "successes": int(successes), "n": int(n)}


def bootstrap(rng: np.random.Generator, values: Sequence[float], resamples: int = 1000) -> Mean:
    """Return the mean of per-scene values with its 95 % percentile interval (Efron 1979); zeros without values."""
    data = np.asarray(values, float)
    if not len(data):
        return {"mean": 0.0, "low": 0.0, "high": 0.0, "n": 0}
    return interval(float(data.mean()), data[rng.integers(0, len(data), (resamples, len(data)))].mean(1), len(data))


def interval(mean: float, drawn: Sequence[float] | Floats, n: int) -> Mean:
    """Return a mean of `n` with the interval that holds 95 % of what was drawn."""
    low, high = np.quantile(drawn, [0.025, 0.975])
    return {"mean": round(mean, 6), "low": round(float(low), 6), "high": round(float(high), 6), "n": n}
