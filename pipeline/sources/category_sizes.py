"""Sizes of furniture by category, from manifests/calibration/sizes.yaml; taxonomy sizes where that has none."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml
from numpy.typing import NDArray

from pipeline import taxonomy

PATH = Path(__file__).resolve().parents[2] / "manifests" / "calibration" / "sizes.yaml"
SPREAD = 0.15  # relative deviation assumed where only a mean is known
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
    """Return the statistics of every category that has any."""
    raw = yaml.safe_load(PATH.read_text(encoding="utf-8")) if PATH.is_file() else {}
    table = raw.get("categories", {})
    found = {}
    for category in taxonomy.load().categories.values():
        if category.name in table:
            entry = table[category.name]
            found[category.name] = SizeStatistics(np.array(entry["mean"]), np.array(entry["std"]), int(entry.get("n", 0)))
        elif category.size:
            mean = np.array(category.size)
            found[category.name] = SizeStatistics(mean, SPREAD * mean)
    return found
