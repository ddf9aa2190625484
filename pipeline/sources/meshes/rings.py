"""Rings of staves, of a cup or a basin, in as few sectors as may be."""

from collections.abc import Callable, Sequence

import numpy as np

from pipeline.arrays import Floats
from pipeline.sources.meshes.mesh_solids import Part

STAVES = 6  # pieces that are taken for a ring
FEWEST, MOST = 3, 12  # sectors of a vessel
WITHIN = 1.05  # share of a ring's radius beyond which a piece is a handle
TURNS = 4  # staves of the first sector that it is begun at
LEVEL = 0.005  # [m] between heights that are one


def same_height(pieces: Sequence[Part]) -> list[list[int]]:
    """Return the pieces by index, together those that lie between the same heights."""
    by_height: dict[tuple[int, int], list[int]] = {}
    for k, piece in enumerate(pieces):
        z = piece.hull[:, 2]
        by_height.setdefault((round(z.min() / LEVEL), round(z.max() / LEVEL)), []).append(k)
    return list(by_height.values())


def is_ring(pieces: Sequence[Part], among: Sequence[int]) -> bool:
    """Whether pieces, by index, stand in a ring."""
    return bool(_staves(pieces, among, *_circle(pieces, among)))


def sectors(pieces: Sequence[Part], passes: Callable[[list[int]], bool]) -> list[list[int]]:
    """Return groups of pieces by index, each of which `passes` as one: the sectors of rings, columns of the whole vessel if they do."""
    rings = [level for level in same_height(pieces) if is_ring(pieces, level)]
    if not rings:
        return []
    middle, radius = max((_circle(pieces, ring) for ring in rings), key=lambda circle: circle[1])
    columns = _fewest(_staves(pieces, range(len(pieces)), middle, radius), passes)
    return columns or [
        group for ring in rings for group in _fewest(_staves(pieces, ring, *_circle(pieces, ring)), passes) if len(group) > 1
    ]


def _circle(pieces: Sequence[Part], among: Sequence[int]) -> tuple[Floats, float]:
    """Return the middle (2,) of pieces and how far they reach from it, half of them."""
    points = np.concatenate([pieces[k].hull[:, :2] for k in among])
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    return middle, float(np.median([np.linalg.norm(pieces[k].hull[:, :2] - middle, axis=1).max() for k in among]))


def _staves(pieces: Sequence[Part], among: Sequence[int], middle: Floats, radius: float) -> list[tuple[float, int]]:
    """Return (angle, index) of the pieces that stand about `middle` (2,) within `radius`, or nothing where they are no ring."""
    about = []
    for k in among:
        outline = pieces[k].hull[:, :2] - middle
        away = outline.mean(axis=0)
        far = float(np.linalg.norm(outline, axis=1).max())
        if far < WITHIN * radius and np.linalg.norm(away) > far / 4 and not _holds(outline):
            about.append((float(np.arctan2(away[1], away[0])), k))
    about.sort()
    return about if len(about) >= STAVES and np.diff([a for a, _ in about]).max() < np.pi / 2 else []


def _holds(points: Floats) -> bool:
    """Whether points (N, 2) stand all about the origin."""
    angles = np.sort(np.arctan2(points[:, 1], points[:, 0]))
    return bool(np.diff(np.append(angles, angles[0] + 2 * np.pi)).max() < np.pi)


def _fewest(staves: Sequence[tuple[float, int]], passes: Callable[[list[int]], bool]) -> list[list[int]]:
    """Return the fewest arcs of a ring that pass, each as long as may be, of those begun at a few staves of the first; none where they are too many."""
    best: list[list[int]] = []
    for first in range(0, len(staves) // FEWEST, max(1, len(staves) // (FEWEST * TURNS))):
        turned = [k for _, k in (*staves[first:], *staves[:first])]
        arcs: list[list[int]] = []
        while turned and (not best or len(arcs) < len(best) - 1):
            arc = _longest(turned, passes)
            arcs.append(turned[:arc])
            turned = turned[arc:]
        if not turned and len(arcs) <= MOST:
            best = arcs
    return best


def _longest(staves: Sequence[int], passes: Callable[[list[int]], bool]) -> int:
    """Return how many of the first staves pass as one, by halving."""
    low, high = 1, len(staves)
    while low < high:
        middle = (low + high + 1) // 2
        if passes(list(staves[:middle])):
            low = middle
        else:
            high = middle - 1
    return low
