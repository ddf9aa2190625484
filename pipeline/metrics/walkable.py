"""Walkable area: SR(tau) and both meanings of R_walkable.

`paper` is (A_room - sum A_i) / A_room, as the paper prints it, over floor-standing objects: occupancy, without union and
without a robot. `free` is the share of the floor that a round robot really covers, coming from the entrance.
"""

from collections.abc import Iterable, Sequence

import numpy as np

from pipeline.metrics.intervals import Mean, Rate, bootstrap, rate
from pipeline.metrics.rows import Row

MEANINGS = ("paper", "free")


def success_rate(ratios: Sequence[float], tau: float) -> Rate:
    """Return SR(tau): the share of rooms whose ratio is at least `tau` (paper eq. success_rate)."""
    # A ratio computed in floating point from sizes rounded to 0.1 mm must not miss its target by the last bit.
    return rate(sum(r >= tau - 1e-9 for r in ratios), len(ratios))


def means(rng: np.random.Generator, rooms: Iterable[Row]) -> dict[str, Mean]:
    """Return the mean R_walkable over rooms, in both meanings."""
    listed = list(rooms)
    return {meaning: bootstrap(rng, [float(r[f"walkable_{meaning}"]) for r in listed]) for meaning in MEANINGS}
