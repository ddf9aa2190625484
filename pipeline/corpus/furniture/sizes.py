"""Sizes of models: truncated normals per category and axis, drawn in strata so that few draws keep mean and spread."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml
from numpy.typing import NDArray
from scipy.special import ndtr, ndtri

PATH = Path(__file__).resolve().parents[3] / "manifests" / "calibration" / "sizes.yaml"


@dataclass(frozen=True, slots=True)
class SizeStatistics:
    """Full extents (w, d, h) [m] of a category's models: mean, standard deviation, 5th and 95th percentile."""

    mean: NDArray[np.float64]
    std: NDArray[np.float64]
    p05: NDArray[np.float64]
    p95: NDArray[np.float64]


@functools.cache
def load() -> Mapping[str, SizeStatistics]:
    """Read manifests/calibration/sizes.yaml: statistics by category."""
    raw = yaml.safe_load(PATH.read_text(encoding="utf-8"))["categories"]
    return {name: SizeStatistics(*(np.array(entry[k], float) for k in ("mean", "std", "p05", "p95"))) for name, entry in raw.items()}


def draw(rng: np.random.Generator, statistics: SizeStatistics, count: int) -> NDArray[np.float64]:
    """Draw `count` sizes (count, 3) [m]: per axis one draw from each of `count` equal quantile strata, in random order."""
    lower = ndtr((statistics.p05 - statistics.mean) / statistics.std)
    upper = ndtr((statistics.p95 - statistics.mean) / statistics.std)
    strata = np.stack([rng.permutation(count) for _ in range(3)], axis=1)
    u = (strata + rng.uniform(0.1, 0.9, (count, 3))) / max(count, 1)
    return np.asarray(statistics.mean + statistics.std * ndtri(lower + u * (upper - lower)))
