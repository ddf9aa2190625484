"""What is controlled: the number of objects, SR(N); the walkable area, SR(tau) and R_walkable; and openable objects before and after.

A guidance that blocks less by placing less has gained nothing. Of R_walkable, `paper` is (A_room - sum A_i) / A_room, as the paper prints
it, over floor-standing objects: occupancy, without union and without a robot; `free` is the share of the floor that a round robot really
covers, coming from the entrance.
"""

from collections.abc import Iterable, Sequence

import numpy as np

from pipeline.metrics.intervals import Mean, Rate, bootstrap, rate
from pipeline.metrics.rows import Row

MEANINGS = ("paper", "free")


def quantity(rooms: Iterable[Row]) -> dict[str, Rate]:
    """Return SR(N), the share of rooms with exactly the number of objects that was asked for (paper eq.), for each N in rows of the rooms table.

    Ascending, keyed by N as text (JSON has no other keys).
    """
    asked: dict[int, list[bool]] = {}
    for r in rooms:
        if r["asked_objects"] is not None:
            asked.setdefault(int(r["asked_objects"]), []).append(r["objects"] == r["asked_objects"])
    return {str(n): rate(sum(hits), len(hits)) for n, hits in sorted(asked.items())}


def walkable(rooms: Iterable[Row], meaning: str, tau: float) -> Rate:
    """Return SR(tau): the share of rooms whose R_walkable is at least `tau` (paper eq. success_rate)."""
    ratios = [float(r[f"walkable_{meaning}"]) for r in rooms]
    # A ratio computed in floating point from sizes rounded to 0.1 mm must not miss its target by the last bit.
    return rate(sum(r >= tau - 1e-9 for r in ratios), len(ratios))


def walkable_means(rng: np.random.Generator, rooms: Sequence[Row]) -> dict[str, Mean]:
    """Return the mean R_walkable over rooms, in both meanings."""
    return {meaning: bootstrap(rng, [float(r[f"walkable_{meaning}"]) for r in rooms]) for meaning in MEANINGS}


def openable(rng: np.random.Generator, rooms: Iterable[Row]) -> dict[str, Mean]:
    """Return openable objects per furnished room as shipped, and as the layout model had placed them."""
    listed = [r for r in rooms if r["layout_type"]]
    sampled = [r for r in listed if r["openable_sampled"] is not None]
    return {
        "shipped": bootstrap(rng, [float(r["openable"]) for r in listed]),
        "sampled": bootstrap(rng, [float(r["openable_sampled"]) for r in sampled]),
        "objects": bootstrap(rng, [float(r["objects"]) for r in listed]),
    }
