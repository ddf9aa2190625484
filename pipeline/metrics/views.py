"""FID, KID and SCA on plan views, for the features of any net; train against test beside it, and what harm does to it."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Floats
from pipeline.metrics.perturbations import HARMS
from pipeline.metrics.two_samples import frechet, kernel_distance, linear_accuracy
from pipeline.relations.arrangement import Arrangement
from pipeline.rendering.plan_view import SIZE, plan_view

Embed = Callable[[NDArray[np.uint8]], Floats]  # plan views (R, 64, 64, 3) to features (R, F)
Features = Callable[[Sequence[Arrangement]], Floats]  # rooms to features (R, F)
Json = dict[str, Any]

STATES = ("intact", *HARMS)  # what the net of our own was trained to tell


def views_of(rooms: Sequence[Arrangement]) -> NDArray[np.uint8]:
    """Return plan views (R, 64, 64, 3)."""
    return np.stack([plan_view(room) for room in rooms]) if rooms else np.zeros((0, SIZE, SIZE, 3), np.uint8)


def features_once(embed: Embed) -> Features:
    """Return what tells the features of rooms by their plan views, and draws and embeds each room but once: the same rooms stand in many samples."""
    known: dict[int, tuple[Arrangement, Floats]] = {}  # by identity; the room is held, so that no other takes its number

    def features_of(rooms: Sequence[Arrangement]) -> Floats:
        unseen = list({id(room): room for room in rooms if id(room) not in known}.values())
        if unseen:
            known.update((id(room), (room, own)) for room, own in zip(unseen, embed(views_of(unseen)), strict=True))
        return np.stack([known[id(room)][1] for room in rooms])

    return features_of


def compare_views(
    rng: np.random.Generator, seed: int, features_of: Features, real: Sequence[Arrangement], sets: Mapping[str, Sequence[Arrangement]]
) -> Json:
    """Return FID, KID and SCA of each set of rooms against the real ones."""
    truth = features_of(real)
    names = [room.name for room in real]
    figures: Json = {}
    for key, rooms in sets.items():
        features = features_of(rooms)
        figures[key] = {
            "fid": round(frechet(truth, features), 4),
            "kid": kernel_distance(rng, truth, features),
            "sca": linear_accuracy(seed, truth, features, names, [room.name for room in rooms]),
            "rooms": len(rooms),
        }
    return figures
