"""Sizes of furniture by category, as log-normal distributions."""

import functools
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.card import cards

LEAST_SPREAD = 0.08  # relative; a narrower one would refuse what is merely unusual


@dataclass(frozen=True, slots=True)
class SizeStatistics:
    """`mean` and `std` (3,) of (w, d, h) [m] over `count` models, 0 where they are an estimate."""

    mean: NDArray[np.float64]
    std: NDArray[np.float64]
    count: int = 0

    def logarithmic(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return location and scale (3,) of the log-normal distribution of that mean and deviation."""
        relative = np.maximum(self.std / self.mean, LEAST_SPREAD)
        scale = np.sqrt(np.log1p(relative**2))
        return np.log(self.mean) - scale**2 / 2, scale


@functools.cache
def sizes() -> Mapping[str, SizeStatistics]:
    """Return the statistics of every category."""
    return {name: SizeStatistics(np.array(c.size.mean), np.array(c.size.std), c.size.n) for name, c in cards().items()}
