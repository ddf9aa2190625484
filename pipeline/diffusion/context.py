"""What the layout model is asked (a room, its walls and openings as tokens) and what it answers (proposals): plain numpy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.plan import OpeningKind, Plan

WALLS = 20  # wall tokens; a polygon with more corners loses those that matter least
OPENINGS = 12  # opening tokens; a room with more openings loses the narrowest
TOKENS = WALLS + OPENINGS
KINDS = ("wall", "door", "open", "portal", "window", "entrance")


class Library(Protocol):
    """What the sampler asks of the asset library while it guides: the retrieval index of a layer above is one."""

    def lookup(
        self,
        tastes: Sequence[Any],
        categories: Sequence[Sequence[str | None]],
        positions: NDArray[np.float64],
        sizes: NDArray[np.float64],
        latents: NDArray[np.float64],
    ) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
        """Find the asset that each slot will retrieve: `tastes` (B,) of the rooms; categories (B, N), None for an empty slot; positions and sizes (B, N, 3) [m]; latents (B, N, 32).

        Returns its size as placed (B, N, 3) [m] (the asked one where there is none), and the boxes that its joints sweep
        (B, N, K, 2, 3) [m]: lower and upper corner in the object frame, NaN where a slot has fewer than K.
        """
        ...


@dataclass(frozen=True, slots=True)
class RoomOpening:
    """An opening as one of its rooms sees it.

    `segment` (2, 2) [m, world]; `hinge` is the end of the segment (0 or 1) about which the leaf turns into THIS room,
    or -1 where it turns elsewhere or has none. `sill` [m] above the floor.
    """

    kind: OpeningKind
    segment: NDArray[np.float64]
    sill: float = 0.0
    hinge: int = -1


@dataclass(frozen=True, slots=True)
class CategoryBounds:
    """How many objects of these categories a room is to have: at least `least`, at most `most` (None: any number)."""

    categories: tuple[str, ...]
    least: int = 0
    most: int | None = None


@dataclass(frozen=True, slots=True)
class RoomContext:
    """A room to furnish.

    `polygon` (n, 2) [m, world], inner wall faces, counter-clockwise. `n_target` is the exact number of objects that is
    asked for, or None; `category_bounds` bound the numbers of categories; `taste` is what the library is asked to suit; where it holds something of the first of two groups in `company`, it holds so many things of the second. `elevation` [m] is the z of the floor, `height` [m] that of the ceiling above it.
    """

    layout_type: str
    polygon: NDArray[np.float64]
    openings: tuple[RoomOpening, ...] = ()
    n_target: int | None = None
    elevation: float = 0.0
    height: float = 2.7
    category_bounds: tuple[CategoryBounds, ...] = ()
    company: tuple[tuple[tuple[str, ...], tuple[str, ...], int], ...] = ()
    taste: Any = None

    @classmethod
    def of(
        cls, plan: Plan, room_id: str, layout_type: str, n_target: int | None = None, category_bounds: tuple[CategoryBounds, ...] = ()
    ) -> RoomContext:
        """Take one room out of a plan."""
        room = plan.room(room_id)
        openings = tuple(
            RoomOpening(o.kind, o.segment, o.sill, o.swing.hinge if o.swing and o.swing.room_id == room_id else -1)
            for o in plan.openings
            if room_id in o.rooms
        )
        return cls(layout_type, room.polygon, openings, n_target, plan.elevation(room_id), room.height, category_bounds)

    @property
    def centre(self) -> NDArray[np.float64]:
        """Centre of the polygon's box (2,) [m, world]: the origin of the room frame, whose axes are the world's."""
        middle: NDArray[np.float64] = (self.polygon.min(0) + self.polygon.max(0)) / 2
        return middle


@dataclass(frozen=True, slots=True)
class Proposal:
    """One object that the model places.

    `position` (3,) [m, world]: bottom centre of the box, storey elevation included; `yaw` [rad] in (-pi, pi]; `size`
    (3,) [m] full extents (w, d, h); `latent` (32,) the shape that is asked for.
    """

    category: str
    position: NDArray[np.float64]
    yaw: float
    size: NDArray[np.float64]
    latent: NDArray[np.float32]


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
    kind, hinge = np.zeros(TOKENS, np.int64), np.full(TOKENS, -1, np.int64)
    sill, mask = np.zeros(TOKENS, np.float32), np.zeros(TOKENS, bool)
    walls = np.stack([polygon, np.roll(polygon, -1, 0)], 1)
    along = walls[:, 1] - walls[:, 0]
    inward = np.stack([-along[:, 1], along[:, 0]], 1) / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    count = len(walls)
    ends[:count], normal[:count], mask[:count] = walls, inward, True
    openings = sorted(context.openings, key=lambda g: -float(np.linalg.norm(g.segment[1] - g.segment[0])))[:OPENINGS]
    for i, opening in enumerate(openings, WALLS):
        ends[i], normal[i], swapped = on_wall(opening, context.centre, walls, inward)
        kind[i], sill[i], mask[i] = KINDS.index(opening.kind), opening.sill, True
        hinge[i] = opening.hinge if opening.hinge < 0 or not swapped else 1 - opening.hinge
    return Floor(ends, normal, kind, hinge, sill, mask)


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
