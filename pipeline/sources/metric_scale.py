"""The metric scale of shapes that have none: PartNet-Mobility's are normalised to the unit sphere.

For each category that an object may serve as, one uniform scale is fitted to the log-normal distribution of that
category's sizes by maximum likelihood.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.sources.calibration import sizes

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Fit:
    """`scale` [m per unit] as `category`; `rms` in standard deviations; log-likelihood of the scaled size."""

    category: str
    scale: float
    rms: float
    likelihood: float


def fit(extent: Floats, category: str) -> Fit | None:
    """Fit a category's sizes to an object of `extent` (w, d, h) [units], or None without statistics.

    With e = log extent and N(m, s^2) the logarithm of the sizes, log scale = sum((m - e) / s^2) / sum(1 / s^2).
    """
    known = sizes().get(category)
    if known is None or extent.min() <= 0:
        return None
    location, spread = known.logarithmic()
    weight = 1 / spread**2
    log_scale = float(((location - np.log(extent)) * weight).sum() / weight.sum())
    z = (np.log(extent) + log_scale - location) / spread
    likelihood = float(-0.5 * (z**2).sum() - np.log(spread).sum() - 1.5 * math.log(2 * math.pi))
    return Fit(category, round(math.exp(log_scale), 6), float(np.sqrt((z**2).mean())), likelihood)


def best(extent: Floats, categories: Iterable[str], *, rms: float, keep: int, margin: float) -> tuple[Fit, ...]:
    """Return the fits within `rms`, most likely first: at most `keep`, none worse than the best by more than `margin`."""
    found = [f for c in categories if (f := fit(extent, c)) is not None and f.rms <= rms]
    found.sort(key=lambda f: (-f.likelihood, f.category))
    return tuple(f for f in found[:keep] if f.likelihood >= found[0].likelihood - margin)
