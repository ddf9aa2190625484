"""How things stand to the walls of their room: which side is at a wall, how near, how straight."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from pipeline.arrays import Floats
from pipeline.relations.arrangement import Arrangement
from pipeline.relations.clusters import split
from pipeline.relations.model import METRES, RADIANS, Span, WallRelation

AROUND = ("front", "right", "back", "left")
LEAST_CASES = 30  # things of a category
LEAST_SHARE = 0.1  # of them that must be so
FAR = 0.6  # a wall farther off than this is no neighbour [m]
OBLIQUE = 0.35  # nor one that a side does not face, by this angle [rad]


def measure(room: Arrangement) -> tuple[Floats, Floats]:
    """Return for each thing and side, in the order of AROUND, the gap (N, 4) [m] to the wall that it faces and the turn (N, 4) [rad].

    A ray goes from the middle of the thing; negative gaps reach into the wall. inf where a side faces no wall squarely.
    """
    start, stop = room.polygon, np.roll(room.polygon, -1, axis=0)
    edge = stop - start
    outside = np.stack([edge[:, 1], -edge[:, 0]], -1) / np.maximum(np.linalg.norm(edge, axis=1, keepdims=True), 1e-9)
    angles = room.yaw[:, None] + np.array([-np.pi / 2, 0, np.pi / 2, np.pi])
    ways = np.stack([np.cos(angles), np.sin(angles)], -1)  # (N, 4, 2)
    half = room.size[:, [1, 0, 1, 0]] / 2
    towards = ways @ outside.T  # (N, 4, E), cosine between way and the wall's normal
    apart = start[None] - room.position[:, None, :2]  # (N, E, 2)
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = (apart * outside).sum(-1)[:, None] / towards
        hit = room.position[:, None, None, :2] + reach[..., None] * ways[:, :, None]
        place = ((hit - start) * edge).sum(-1) / np.maximum((edge * edge).sum(-1), 1e-12)
        visible = (towards > np.cos(OBLIQUE)) & (reach > 0) & (place > -1e-6) & (place < 1 + 1e-6)
    reach = np.where(visible, reach, np.inf)
    nearest = reach.argmin(-1)
    gap = np.take_along_axis(reach, nearest[..., None], -1)[..., 0] - half
    normal = outside[nearest]
    cross = ways[..., 1] * normal[..., 0] - ways[..., 0] * normal[..., 1]
    turn = np.arctan2(cross, (ways * normal).sum(-1))
    return gap, np.where(np.isfinite(gap), turn, 0.0)


def fit(rooms: Sequence[Arrangement], kinds: Mapping[str, str]) -> Iterator[WallRelation]:
    """Yield for each category the sides that stand at a wall more often than others do.

    `kinds` names the kind of a category: one of which there are too few to tell stands to walls as all of its kind do together.
    """
    names = np.array([name for room in rooms for name in room.categories])
    measures = [measure(room) for room in rooms if room.categories]
    if not measures:
        return
    gaps, turns = np.concatenate([g for g, _ in measures]), np.concatenate([t for _, t in measures])
    kind = np.array([kinds.get(name, "") for name in names.tolist()])
    for name in sorted(set(names.tolist())):
        own = names == name
        if own.sum() < LEAST_CASES and name in kinds:
            own = kind == kinds[name]
        if own.sum() >= LEAST_CASES:
            for side in range(4):
                relation = _relation(name, side, gaps[own], turns[own])
                if relation is not None and relation.share >= LEAST_SHARE and relation.strength > 0:
                    yield relation


def _relation(name: str, side: int, gaps: Floats, turns: Floats) -> WallRelation | None:
    near = np.flatnonzero(gaps[:, side] < FAR)
    if len(near) < LEAST_CASES / 3:
        return None
    parts = [near[part] for part in split(gaps[near, side], max(8, len(gaps) // 33))]
    best = max(parts, key=len)
    gap = Span("outside", *(round(float(v), 4) for v in np.percentile(gaps[best, side], (5, 50, 95))))
    turn = Span("wall", *(round(float(v), 4) for v in np.percentile(turns[best, side], (5, 50, 95))))
    holds = (gaps > gap.low - METRES) & (gaps < gap.high + METRES) & (turns > turn.low - RADIANS) & (turns < turn.high + RADIANS)
    shares = holds.mean(0)
    share, chance = (round(float(part), 4) for part in (shares[side], np.delete(shares, side).mean()))
    return WallRelation(name, AROUND[side], len(gaps), share, chance, gap, turn)
