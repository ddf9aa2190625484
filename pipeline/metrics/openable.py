"""Openable objects per room, before and after: a guidance that blocks less by placing less has gained nothing."""

from collections.abc import Iterable

import numpy as np

from pipeline.metrics.intervals import Mean, bootstrap
from pipeline.metrics.rows import Row


def per_room(rng: np.random.Generator, rooms: Iterable[Row]) -> dict[str, Mean]:
    """Return openable objects per furnished room as shipped, and as the layout model had placed them."""
    listed = [r for r in rooms if r["layout_type"]]
    sampled = [r for r in listed if r["openable_sampled"] is not None]
    return {
        "shipped": bootstrap(rng, [float(r["openable"]) for r in listed]),
        "sampled": bootstrap(rng, [float(r["openable_sampled"]) for r in sampled]),
        "objects": bootstrap(rng, [float(r["objects"]) for r in listed]),
    }
