"""The nearest training room: whether made rooms are as far from what was learnt as rooms are that never were, or copies of it.

The distance between two rooms of one type is that of their things, matched class by class: metres between matched things,
after the middles of the rooms are laid over each other, in the best of four turns and their mirror images; a metre for
every thing that has no match; the mean over the larger room.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.stats import ks_2samp

from pipeline import taxonomy
from pipeline.arrays import Floats
from pipeline.relations.arrangement import Arrangement

Json = dict[str, Any]

ALONE = 1.0  # cost of a thing without a match, and the most that a match costs [m]
NEAR = 0.05  # rooms of three things and more that are nearer are copies [m]
LOOKED = 12  # training rooms that are looked at closely for each room: those with the most similar furniture, as far from the middle
TURNS = tuple(np.array([[c, -s * m], [s, c * m]], float) for m in (1, -1) for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1)))


def distances(rooms: Sequence[Arrangement], known: Sequence[Arrangement]) -> Floats:
    """Return each room's distance to the nearest of the known rooms of its type [m]; inf where there is none."""
    nearest = np.full(len(rooms), np.inf)
    for kind in sorted({room.layout_type for room in rooms}):
        own = [k for k, room in enumerate(rooms) if room.layout_type == kind]
        others = [room for room in known if room.layout_type == kind]
        if others:
            ours, theirs = (_outlines(group) for group in ([rooms[k] for k in own], others))
            for k, row in zip(own, ours, strict=True):
                close = np.argsort(np.abs(theirs - row).sum(1), kind="stable")[:LOOKED]
                nearest[k] = min(distance(rooms[k], others[j]) for j in close)
    return nearest


def distance(room: Arrangement, other: Arrangement) -> float:
    """Return the distance of two rooms [m]."""
    size = max(len(room.categories), len(other.categories))
    if not size:
        return 0.0
    same = np.array(room.categories, "U32")[:, None] == np.array(other.categories, "U32")[None]
    if not same.any():
        return ALONE
    a, b = (r.position[:, :2] - (r.polygon.min(0) + r.polygon.max(0)) / 2 for r in (room, other))
    best = np.inf
    for turn in TURNS:
        cost = np.where(same, np.minimum(np.linalg.norm(a[:, None] - (b @ turn.T)[None], axis=-1), ALONE), ALONE)
        rows, columns = linear_sum_assignment(cost)
        best = min(best, (cost[rows, columns].sum() + ALONE * (size - len(rows))) / size)
    return float(best)


def novelty(generated: Sequence[Arrangement], held_out: Sequence[Arrangement], train: Sequence[Arrangement]) -> Json:
    """Compare the made rooms' distances to the training rooms with those of held-out rooms (Kolmogorov-Smirnov), and count copies."""
    ours, theirs = distances(generated, train), distances(held_out, train)
    test = ks_2samp(ours, theirs)
    return {
        "made": _quantiles(ours), "held_out": _quantiles(theirs), "statistic": round(float(test.statistic), 4), "p": round(float(test.pvalue), 6),
        "copies": _copies(generated, ours), "copies_held_out": _copies(held_out, theirs), "rooms": len(generated),
    }  # fmt: skip


def _outlines(rooms: Sequence[Arrangement]) -> Floats:
    """Return for each room (R, 2 C) how many things of each kind it has, and how far they are from its middle on average [m].

    Neither changes when a room is turned or mirrored: rooms that are near each other differ little in both.
    """
    names = {name: k for k, name in enumerate(taxonomy.load().names)}
    descriptors = np.zeros((len(rooms), 2 * len(names)))
    for row, room in zip(descriptors, rooms, strict=True):
        kinds = np.array([names[name] for name in room.categories], int)
        away = np.linalg.norm(room.position[:, :2] - (room.polygon.min(0) + room.polygon.max(0)) / 2, axis=1)
        np.add.at(row, kinds, 1.0)
        np.add.at(row, len(names) + kinds, away)
        row[len(names) :] /= np.maximum(row[: len(names)], 1)
    return descriptors


def _quantiles(values: Floats) -> Json:
    finite = values[np.isfinite(values)]
    return (
        dict(zip(("q10", "median", "q90"), np.round(np.quantile(finite, (0.1, 0.5, 0.9)), 4).tolist(), strict=True)) if len(finite) else {}
    )


def _copies(rooms: Sequence[Arrangement], nearest: Floats) -> int:
    return sum(len(room.categories) >= 3 and bool(value < NEAR) for room, value in zip(rooms, nearest, strict=True))
