"""Programs read off plans that an independent generator draws: slicing trees of rectangles with random doors, exits and areas.

Shares no code with the solver: a rectangle is cut at random until it has the wanted number of rooms; doors, open fronts and portals stand
in walls that rooms share; areas are those of the rectangles. So every program has a plan, and a refusal is a failure. Two
kinds: `home` gives rooms the types that fit (bathrooms and closets at ends, bedrooms at outside walls), `wild` gives any type, so
that one walks through bedrooms and offices have no window; only bathrooms stay at ends in both.
"""

from typing import NamedTuple

import numpy as np

from pipeline.floorplan.program.floor_program import Entrance, FloorProgram, Footprint, Link, LinkKind, RoomReq

LEAST_SIDE = 1.55  # of a rectangle, walls included [m]
WALL = 0.16  # of thickness, roughly [m]
DOOR_WALL, OPEN_WALL = 1.45, 2.3  # common wall that an opening needs [m]
ENDS = ("bathroom", "wc", "closet", "storage", "utility")
INNER = ("hallway", "closet", "storage", "media_room", "utility", "library")
THROUGH = ("living_room", "hallway", "kitchen", "dining_room", "family_room", "office", "entry", "library")
WILD = (*THROUGH, "bedroom", "playroom", "gym", "workshop", "meeting_room", "sunroom", "media_room", "studio_room", "utility", "storage")


class Drawn(NamedTuple):
    """A drawn plan: rectangles (n, 4) x0, y0, x1, y1 [m], the openings between them, the way in and other exits."""

    boxes: np.ndarray
    doors: list[tuple[int, int, LinkKind]]
    into: int
    exits: list[int]


def program(rng: np.random.Generator) -> FloorProgram:
    """Draw a plan and return the program that it meets; areas are stated."""
    while True:
        drawn = draw(rng, int(rng.integers(2, 15)))
        if drawn is not None:
            break
    n = len(drawn.boxes)
    degree = np.zeros(n, int)
    for a, b, _ in drawn.doors:
        degree[[a, b]] += 1
    wild = rng.random() < 0.4
    outside = _outside(drawn.boxes) >= 1.6
    sizes = np.prod(drawn.boxes[:, 2:] - drawn.boxes[:, :2] - WALL, axis=1)
    rooms = []
    for i in range(n):
        kind = _type(rng, int(degree[i]), bool(outside[i]), float(sizes[i]), wild, i == drawn.into or i in drawn.exits)
        area = {"target": round(float(sizes[i]), 2), "stated": True}
        rooms.append(RoomReq.model_validate({"id": f"r{i}", "type": kind, "area": area}))
    low, high = drawn.boxes[:, :2].min(axis=0), drawn.boxes[:, 2:].max(axis=0)
    aspect = float((high - low).max() / (high - low).min())
    shape = Footprint(min_aspect=1.0, max_aspect=round(max(1.6, 1.05 * aspect), 2))
    return FloorProgram(
        rooms=tuple(rooms),
        links=tuple(Link(a=f"r{a}", b=f"r{b}", kind=k, stated=True) for a, b, k in drawn.doors),
        entrance=Entrance(into=f"r{drawn.into}", separate=tuple(f"r{i}" for i in drawn.exits), stated=True),
        footprint=shape,
        only=True,
    )


def draw(rng: np.random.Generator, n: int) -> Drawn | None:
    """Draw a plan of n rooms; None where the cuts leave rooms that nothing joins."""
    boxes = _cut(rng, n)
    if boxes is None:
        return None
    walls = sorted(_walls(boxes), key=lambda _: rng.random())
    piece = list(range(n))
    doors: list[tuple[int, int, LinkKind]] = []
    for a, b, length in walls:
        joins = piece[a] != piece[b]
        if not joins and rng.random() > 0.15:
            continue
        roll = rng.random()
        kind: LinkKind = "open" if roll < 0.2 and length >= OPEN_WALL else ("portal" if roll > 0.9 and length >= OPEN_WALL else "door")
        doors.append((a, b, kind))
        piece = [piece[a] if p == piece[b] else p for p in piece]
    outside = np.flatnonzero(_outside(boxes) >= 1.6)
    if len(set(piece)) > 1 or not outside.size:
        return None
    into = int(rng.choice(outside))
    exits = [int(i) for i in outside if i != into and rng.random() < 0.08]
    return Drawn(boxes, doors, into, exits[:2])


def _cut(rng: np.random.Generator, n: int) -> np.ndarray | None:
    area = n * rng.uniform(6.5, 17.0)
    ratio = float(np.exp(rng.uniform(0.0, np.log(1.9))))
    pieces = [np.array([0.0, 0.0, (area * ratio) ** 0.5, (area / ratio) ** 0.5])]
    for _ in range(300):
        if len(pieces) == n:
            return np.array(pieces)
        sizes = np.array([(p[2] - p[0]) * (p[3] - p[1]) for p in pieces])
        k = int(rng.choice(len(pieces), p=sizes / sizes.sum()))
        p = pieces[k]
        wide = p[2] - p[0] > p[3] - p[1]
        axis = (0 if wide else 1) if rng.random() < 0.85 else (1 if wide else 0)
        share = rng.uniform(0.22, 0.78)
        side = p[axis + 2] - p[axis]
        if min(share, 1 - share) * side < LEAST_SIDE:
            continue
        at = p[axis] + share * side
        one, two = p.copy(), p.copy()
        one[axis + 2], two[axis] = at, at
        pieces[k] = one
        pieces.append(two)
    return None


def _walls(boxes: np.ndarray) -> list[tuple[int, int, float]]:
    walls = []
    for a in range(len(boxes)):
        for b in range(a + 1, len(boxes)):
            one, two = boxes[a], boxes[b]
            over = np.minimum(one[2:], two[2:]) - np.maximum(one[:2], two[:2])
            if over.min() > -1e-9 and over.min() < 1e-9 and over.max() >= DOOR_WALL:
                walls.append((a, b, float(over.max())))
    return walls


def _outside(boxes: np.ndarray) -> np.ndarray:
    """Return the longest outside wall of each rectangle [m]."""
    low, high = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    size = boxes[:, 2:] - boxes[:, :2]
    across = np.where((np.abs(boxes[:, 0] - low[0]) < 1e-9) | (np.abs(boxes[:, 2] - high[0]) < 1e-9), size[:, 1], 0.0)
    along = np.where((np.abs(boxes[:, 1] - low[1]) < 1e-9) | (np.abs(boxes[:, 3] - high[1]) < 1e-9), size[:, 0], 0.0)
    return np.maximum(across, along)


def _type(rng: np.random.Generator, degree: int, outside: bool, area: float, wild: bool, enters: bool) -> str:
    if degree == 1 and area < 9.0 and not enters and rng.random() < 0.7:
        return str(rng.choice(ENDS[:2] if wild else ENDS))
    if wild:
        return str(rng.choice(WILD))
    if not outside:
        return str(rng.choice(INNER if degree > 1 else (*INNER, "bathroom")))
    if degree == 1 and not enters:
        return str(rng.choice(("bedroom", "bedroom", "office", "kitchen", "balcony" if area < 15 else "bedroom")))
    return str(rng.choice(THROUGH))
