"""Furnished rooms, spoilt: what a metric must see, or its figure says nothing."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from pipeline.relations.arrangement import Arrangement

SHIFT = 0.2  # how far each thing is moved [m]
Harm = Callable[[np.random.Generator, Arrangement], Arrangement]


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


def spoilt(rng: np.random.Generator, room: Arrangement) -> Arrangement:
    """Do all of it."""
    for harm in HARMS.values():
        room = harm(rng, room)
    return room
