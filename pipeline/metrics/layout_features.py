"""A room as a row of numbers that a random forest can read: counts, gaps to walls and neighbours in steps of 8 cm, turns.

What the floor says is left out: real and made rooms share it.
"""

from collections.abc import Sequence

import numpy as np

from pipeline import taxonomy
from pipeline.arrays import Floats
from pipeline.metrics.rules import frames_of
from pipeline.relations.arrangement import Arrangement
from pipeline.relations.walls import AROUND, measure

STEP = 0.08  # of gaps [m]
LOW, HIGH = -3, 12  # steps: what is farther is far
ABSENT = HIGH + 2.0
GAPS = ("back", "side", "wall", "beside", "look")  # what is told for each kind of thing
SKEWS = np.radians([1.0, 3.0, 8.0])


def steps(gap: Floats) -> Floats:
    """Return gaps [m] in whole steps, cut at both ends."""
    return np.asarray(np.floor(np.clip(gap, LOW * STEP, (HIGH + 0.5) * STEP) / STEP))


def features(rooms: Sequence[Arrangement]) -> Floats:
    """Return the features (R, F) of rooms."""
    names = taxonomy.load().names
    return np.stack([_row(room, names) for room in rooms]) if rooms else np.zeros((0, 0))


def summaries(rooms: Sequence[Arrangement]) -> Floats:
    """Return those of the features that are counts over the whole room (R, L): of kinds, gaps and skews."""
    return features(rooms)[:, : -len(GAPS) * len(taxonomy.load().names)]


def _row(room: Arrangement, names: Sequence[str]) -> Floats:
    kind = np.array([names.index(name) for name in room.categories], int)
    n = len(kind)
    gap, turn = measure(room) if n else (np.zeros((0, 4)), np.zeros((0, 4)))
    gap = np.where(np.isfinite(gap), gap, HIGH * STEP)
    beside, look = _neighbours(room)
    skew = np.abs(turn[np.arange(n), gap.argmin(1)]) if n else np.zeros(0)
    back = AROUND.index("back")
    least = {
        "back": steps(gap[:, back]), "side": steps(gap[:, [1, 3]].min(1)) if n else gap[:, 0],
        "wall": steps(gap.min(1)) if n else gap[:, 0], "beside": steps(beside), "look": look,
    }  # fmt: skip
    each = np.full((len(least), len(names)), ABSENT)
    for row, values in zip(each, least.values(), strict=True):
        np.minimum.at(row, kind, values)
    bins = np.arange(LOW, HIGH + 2)
    lines = [np.histogram(least[key], bins)[0] for key in ("back", "side", "wall", "beside")]
    turns = np.histogram(skew, [0.0, *SKEWS, np.pi])[0]
    return np.concatenate([np.bincount(kind, minlength=len(names)), [n], *lines, turns, each.ravel()]).astype(float)


def _neighbours(room: Arrangement) -> tuple[Floats, Floats]:
    """Return for each thing the gap to the nearest other [m], and the quarter by which their fronts differ."""
    n = len(room.yaw)
    if n < 2:
        return np.full(n, HIGH * STEP), np.zeros(n)
    frames = frames_of(room, np.arange(n), np.arange(n))
    gap = frames.gaps().max(1).reshape(n, n) + np.where(np.eye(n, dtype=bool), 99.0, 0.0)
    nearest = gap.argmin(1)
    quarter = np.mod(np.rint(frames.turn / (np.pi / 2)), 4).reshape(n, n)
    each = np.arange(n)
    return gap[each, nearest], quarter[each, nearest]
