"""The unit of a 3D-FUTURE model and, where nobody names it, its category: read off its size.

Most models are in metres; some dozens of the release are in centimetres, and nothing in their files says so.
"""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from pipeline.sources.category_sizes import sizes

Floats = NDArray[np.float64]
FACTORS = (1.0, 0.01, 100.0)  # to metres
AGREES = 3.0  # a model that is at most so many times as large or small as its declared box is in that unit
OTHER_UNIT = 25.0  # a model so many times as large, or small, as is usual in its category is in another unit
OTHER_UNIT_LONG = 10.0  # the same for a model that is longer than any furniture
LONGEST = 8.0  # [m] no movable furniture is longer
CENTIMETRES_EXTENT = 15.0  # [m] what is larger is in centimetres, where its category has no statistics


def unit_factor(extent: Floats, declared: Floats | None, category: str | None) -> float:
    """Return the factor to metres of a model of `extent` (w, d, h) [its own units]: 1, 0.01 or 100.

    The box (w, d, h) [m] that scene records declare decides where there is one and one of the units agrees with it;
    the size that is usual in its category decides otherwise.
    """
    if declared is not None:
        ratio = float(np.median(extent / declared))
        for factor in FACTORS:
            if 1 / AGREES < ratio * factor < AGREES:
                return factor
    known = sizes().get(category or "")
    if known is None:
        return 0.01 if extent.max() > CENTIMETRES_EXTENT else 1.0
    ratio = float(np.exp(np.log(np.maximum(extent, 1e-9) / known.mean).mean()))
    if ratio > (OTHER_UNIT_LONG if extent.max() > LONGEST else OTHER_UNIT):
        return 0.01
    return 100.0 if ratio < 1 / OTHER_UNIT else 1.0


def likeliest(size: Floats, categories: Iterable[str]) -> str | None:
    """Return the category whose log-normal size distribution makes `size` (w, d, h) [m] most likely.

    None where none of the categories has statistics.
    """
    candidates = []
    for category in categories:
        known = sizes().get(category)
        if known is not None:
            location, spread = known.logarithmic()
            z = (np.log(np.maximum(size, 1e-9)) - location) / spread
            candidates.append((float(0.5 * (z**2).sum() + np.log(spread).sum()), category))
    return min(candidates)[1] if candidates else None
