"""The floor condition: walls and openings of a room as tokens."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.diffusion.context import RoomContext, RoomOpening

WALLS = 20  # wall tokens; a polygon with more corners loses those that matter least
OPENINGS = 12  # opening tokens; a room with more openings loses the narrowest
TOKENS = WALLS + OPENINGS
KINDS = ("wall", "door", "open", "portal", "window", "entrance")


@dataclass(frozen=True, slots=True)
class Floor:
    """One room's tokens, M = 32: first the polygon's edges in order, then the openings. Room frame.

    `ends` (M, 2, 2) [m]; `normal` (M, 2) unit, into the room; `kind` (M,) index into KINDS; `hinge` (M,) end of the
    segment (0 or 1) about which a leaf turns into this room, else -1; `sill` (M,) [m]; `mask` (M,) where there is a token.
    """

    ends: NDArray[np.float32]
    normal: NDArray[np.float32]
    kind: NDArray[np.int64]
    hinge: NDArray[np.int64]
    sill: NDArray[np.float32]
    mask: NDArray[np.bool_]


def floor_tokens(context: RoomContext) -> Floor:
    """Return the tokens of a room. The origin is the centre of the polygon's box, the axes are the world's."""
    polygon = simplify_polygon(np.asarray(context.polygon, float), WALLS) - context.centre
    ends, normal = np.zeros((TOKENS, 2, 2), np.float32), np.zeros((TOKENS, 2), np.float32)
    kind, hinge, sill, mask = (
        np.zeros(TOKENS, np.int64),
        np.full(TOKENS, -1, np.int64),
        np.zeros(TOKENS, np.float32),
        np.zeros(TOKENS, bool),
    )
    walls = np.stack([polygon, np.roll(polygon, -1, 0)], 1)
    inward = inward_normals(walls)
    count = len(walls)
    ends[:count], normal[:count], mask[:count] = walls, inward, True
    openings = sorted(context.openings, key=lambda g: -float(np.linalg.norm(g.segment[1] - g.segment[0])))[:OPENINGS]
    for i, opening in enumerate(openings, WALLS):
        ends[i], normal[i], swapped = on_wall(opening, context.centre, walls, inward)
        kind[i], sill[i], mask[i] = KINDS.index(opening.kind), opening.sill, True
        hinge[i] = opening.hinge if opening.hinge < 0 or not swapped else 1 - opening.hinge
    return Floor(ends, normal, kind, hinge, sill, mask)


def inward_normals(walls: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return unit normals (n, 2), into the room, of the edges (n, 2, 2) of a counter-clockwise polygon."""
    along = walls[:, 1] - walls[:, 0]
    normal = np.stack([-along[:, 1], along[:, 0]], 1)
    unit: NDArray[np.float64] = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-9)
    return unit


def on_wall(
    opening: RoomOpening, centre: NDArray[np.float64], walls: NDArray[np.float64], inward: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], bool]:
    """Project an opening from the wall's centre line to the face of the nearest parallel wall, with the wall's direction.

    Returns the ends (2, 2) in the room frame, the inward normal (2,), and whether the ends were swapped.
    """
    segment = np.asarray(opening.segment, float) - centre
    middle, along = segment.mean(0), segment[1] - segment[0]
    along = along / max(float(np.linalg.norm(along)), 1e-9)
    start, edge = walls[:, 0], walls[:, 1] - walls[:, 0]
    place = np.clip(((middle - start) * edge).sum(1) / np.maximum((edge**2).sum(1), 1e-9), 0, 1)
    distance = np.linalg.norm(start + place[:, None] * edge - middle, axis=1) + 2 * np.abs(inward @ along)
    wall = int(distance.argmin())
    normal = inward[wall]
    placed = segment - ((segment - start[wall]) @ normal)[:, None] * normal
    swapped = bool((placed[1] - placed[0]) @ edge[wall] < 0)
    return placed[::-1] if swapped else placed, normal, swapped


def simplify_polygon(polygon: NDArray[np.float64], most: int) -> NDArray[np.float64]:
    """Drop the corners that enclose the least area until at most `most` are left (Visvalingam and Whyatt, 1993)."""
    while len(polygon) > most:
        before, after = np.roll(polygon, 1, 0) - polygon, np.roll(polygon, -1, 0) - polygon
        area = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
        polygon = np.delete(polygon, int(area.argmin()), 0)
    return polygon
