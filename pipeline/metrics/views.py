"""FID, KID and SCA on plan views, for the features of any net; and furnished rooms, spoilt: what a metric must see, or its figure says nothing."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Floats
from pipeline.metrics.two_samples import frechet, kernel_distance, linear_accuracy
from pipeline.relations.arrangement import Arrangement
from pipeline.rendering.plan_view import SIZE, plan_view

Embed = Callable[[NDArray[np.uint8]], Floats]  # plan views (R, 64, 64, 3) to features (R, F)
Features = Callable[[Sequence[Arrangement]], Floats]  # rooms to features (R, F)
Harm = Callable[[np.random.Generator, Arrangement], Arrangement]
Json = dict[str, Any]

SHIFT = 0.2  # how far each thing is moved [m]


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


def jitter(rng: np.random.Generator, room: Arrangement) -> Arrangement:
    """Move each thing by 20 cm, in any direction."""
    way = rng.uniform(0, 2 * np.pi, len(room.yaw))
    position = room.position.copy()
    position[:, :2] += SHIFT * np.stack([np.cos(way), np.sin(way)], -1)
    return replace(room, position=position)


def permute_yaws(rng: np.random.Generator, room: Arrangement) -> Arrangement:
    """Give each thing the yaw of another, and a single one another quarter."""
    if len(room.yaw) < 2:
        return replace(room, yaw=room.yaw + rng.integers(1, 4) * np.pi / 2)
    spread = np.ptp(np.mod(room.yaw + 0.01, 2 * np.pi)) > 0.1
    yaw = rng.permutation(room.yaw) if spread else room.yaw + rng.integers(0, 4, len(room.yaw)) * np.pi / 2
    return replace(room, yaw=yaw)


def swap_places(rng: np.random.Generator, room: Arrangement) -> Arrangement:
    """Let things change places: each takes the place and yaw of another, and keeps its kind and size."""
    order = rng.permutation(len(room.yaw))
    position = room.position[order].copy()
    position[:, 2] = room.position[:, 2]
    return replace(room, position=position, yaw=room.yaw[order])


HARMS: Mapping[str, Harm] = MappingProxyType({"jittered": jitter, "turned": permute_yaws, "swapped": swap_places})
STATES = ("intact", *HARMS)  # what the net of our own was trained to tell


def spoilt(rng: np.random.Generator, room: Arrangement) -> Arrangement:
    """Do all of it."""
    for harm in HARMS.values():
        room = harm(rng, room)
    return room
