"""What is known of 3D-FRONT, from manifests/calibration/front.yaml, with intervals for what was counted on 12 scenes."""

import functools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pipeline import params, seeds, yaml_text

PATH = Path(__file__).resolve().parents[2] / "manifests" / "calibration" / "front.yaml"
RESAMPLES = 4000
# Expected range of n normal draws in standard deviations: tells the deviation where only least and most are known.
RANGES = {2: 1.128, 3: 1.693, 4: 2.059, 5: 2.326, 6: 2.534, 7: 2.704, 8: 2.847, 9: 2.970, 10: 3.078, 42: 4.37}
# 97.5 % quantile of Student's t by n - 1 degrees of freedom.
STUDENT = {1: 12.71, 2: 4.303, 3: 3.182, 4: 2.776, 5: 2.571, 6: 2.447, 7: 2.365, 8: 2.306, 9: 2.262, 41: 2.020}

Interval = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Classes:
    """A room kind as the peers see it.

    `word` occurs in the type's name; `counts` are objects by label, `map` maps our categories to labels where they differ;
    `mean` objects per room, `objects` those of single rooms; `most` objects and `side` [m] bound what their filters keep,
    `needs` are labels of which one must be there.
    """

    word: str
    counts: Mapping[str, int]
    map: Mapping[str, str]
    mean: float
    objects: tuple[int, ...]
    most: int
    side: float
    needs: tuple[str, ...]

    def label(self, category: str) -> str | None:
        """Return the peers' label of a category, None where they have none."""
        name = self.map.get(category, category)
        return name if name in self.counts else None


@dataclass(frozen=True, slots=True)
class Reference:
    """The manifest's blocks by name; see its comments for units and sources."""

    classes: Mapping[str, Classes]
    furnished_rooms: tuple[int, ...]
    room_types: Mapping[str, int]
    beyond: tuple[str, ...]
    areas: Mapping[str, tuple[int, float, float, float]]
    walkable: tuple[int, float, float, float]
    shares: Mapping[str, tuple[int, int]]
    defects: Mapping[str, tuple[int, int]]
    relations: Mapping[str, tuple[float, ...]]
    version: int

    def counted(self, category: str) -> bool:
        """Whether the peers have a label for the category in any kind of room."""
        return any(kind.label(category) for kind in self.classes.values())


@functools.cache
def load() -> Reference:
    """Read manifests/calibration/front.yaml."""
    return params.build(Reference, yaml_text.parse(PATH.read_text(encoding="utf-8")), "front", "manifests/calibration/front.yaml")


def bootstrap(values: Sequence[float]) -> Interval:
    """Return the 95 % percentile interval of the mean, resampling the values."""
    sample = np.asarray(values, float)
    draws = seeds.generator(0, "corpus.calibration.bootstrap").integers(len(sample), size=(RESAMPLES, len(sample)))
    low, high = np.percentile(sample[draws].mean(axis=1), [2.5, 97.5])
    return float(low), float(high)


def bootstrap_share(count: int, of: int) -> Interval:
    """Return the 95 % percentile interval of a share, resampling its cases."""
    draws = seeds.generator(0, "corpus.calibration.bootstrap").binomial(of, count / of, RESAMPLES) / of
    low, high = np.percentile(draws, [2.5, 97.5])
    return float(low), float(high)


def from_range(n: int, mean: float, least: float, most: float) -> Interval:
    """Return Student's 95 % interval of a mean where the single values are not known, the deviation from their range."""
    deviation = (most - least) / RANGES[n]
    half = STUDENT[n - 1] * deviation / math.sqrt(n)
    return max(mean - half, least), min(mean + half, most)
