"""FID, KID and SCA on plan views, for the features of any net; train against test beside it, and what harm does to it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeline.metrics.perturbations import HARMS
from pipeline.metrics.two_samples import frechet, kernel_distance, linear_accuracy
from pipeline.relations.arrangement import Arrangement
from pipeline.rendering.plan_view import SIZE, plan_view

Embed = Callable[[NDArray[np.uint8]], NDArray[np.float64]]
Json = dict[str, Any]

STATES = ("intact", *HARMS)  # what the net of our own was trained to tell


def views_of(rooms: Sequence[Arrangement]) -> NDArray[np.uint8]:
    """Return plan views (R, 64, 64, 3)."""
    return np.stack([plan_view(room) for room in rooms]) if rooms else np.zeros((0, SIZE, SIZE, 3), np.uint8)


def compare_views(
    rng: np.random.Generator, seed: int, embed: Embed, real: Sequence[Arrangement], sets: Mapping[str, Sequence[Arrangement]]
) -> Json:
    """Return FID, KID and SCA of each set of rooms against the real ones."""
    truth = embed(views_of(real))
    names = [room.name for room in real]
    figures: Json = {}
    for key, rooms in sets.items():
        features = embed(views_of(rooms))
        figures[key] = {
            "fid": round(frechet(truth, features), 4),
            "kid": kernel_distance(rng, truth, features),
            "sca": linear_accuracy(seed, truth, features, names, [room.name for room in rooms]),
            "rooms": len(rooms),
        }
    return figures
