"""Sizes of furniture by category, as log-normal distributions, and what they tell of a model whose files do not say it.

Most models of 3D-FUTURE are in metres; some dozens of the release are in centimetres, and nothing in their files says so.
"""

import functools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from pipeline.arrays import Floats
from pipeline.card import cards

LEAST_SPREAD = 0.08  # relative; a narrower one would refuse what is merely unusual
FACTORS = (1.0, 0.01, 100.0)  # to metres
AGREES = 3.0  # a model that is at most so many times as large or small as its declared box is in that unit
OTHER_UNIT = 25.0  # a model so many times as large, or small, as is usual in its category is in another unit
OTHER_UNIT_LONG = 10.0  # the same for a model that is longer than any furniture
MIN_SIZE, LONGEST = 0.01, 8.0  # [m] no furniture is flatter, no movable one longer
CENTIMETRES_EXTENT = 15.0  # [m] what is larger is in centimetres, where its category has no statistics


@dataclass(frozen=True, slots=True)
class SizeStatistics:
    """`mean` and `std` (3,) of (w, d, h) [m] over `count` models, 0 where they are an estimate."""

    mean: Floats
    std: Floats
    count: int = 0

    def logarithmic(self) -> tuple[Floats, Floats]:
        """Return location and scale (3,) of the log-normal distribution of that mean and deviation."""
        relative = np.maximum(self.std / self.mean, LEAST_SPREAD)
        scale = np.sqrt(np.log1p(relative**2))
        return np.log(self.mean) - scale**2 / 2, scale


@functools.cache
def sizes() -> Mapping[str, SizeStatistics]:
    """Return the statistics of every category."""
    return {name: SizeStatistics(np.array(c.size.mean), np.array(c.size.std), c.size.n) for name, c in cards().items()}


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


def likeliest_category(size: Floats, categories: Iterable[str]) -> str | None:
    """Return the category whose size distribution makes `size` (w, d, h) [m] most likely, None where there is none."""

    def cost(category: str) -> tuple[float, str]:
        location, spread = sizes()[category].logarithmic()
        z = (np.log(np.maximum(size, 1e-9)) - location) / spread
        return float(0.5 * (z**2).sum() + np.log(spread).sum()), category

    return min(filter(sizes().__contains__, categories), key=cost, default=None)
