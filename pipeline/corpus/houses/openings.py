"""Doors, open fronts, windows and the entrance of a draft: every room is reached, every living space has daylight."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pipeline.corpus.houses.outline import OUTER_WALL, OUTSIDE, Wall
from pipeline.entities.plan import Opening, OpeningKind, Swing

CORRIDORS = ("Hallway", "Aisle", "Corridor")
PUBLIC = ("LivingDiningRoom", "LivingRoom", "DiningRoom")
# Where a room would rather have its door: types of the neighbour, best first.
DOORS_TO: dict[str, tuple[str, ...]] = {
    "Kitchen": ("DiningRoom", "LivingDiningRoom", *CORRIDORS, "LivingRoom"),
    "DiningRoom": ("LivingRoom", *CORRIDORS),
    "LivingRoom": ("DiningRoom", *CORRIDORS),
    "LivingDiningRoom": CORRIDORS,
    "Hallway": ("LivingDiningRoom", "DiningRoom", "LivingRoom"),
    "Aisle": ("LivingDiningRoom", "LivingRoom", "DiningRoom"),
    "Corridor": ("LivingDiningRoom", "LivingRoom", "DiningRoom"),
}
ANY_DOOR = ("Corridor", "Aisle", "Hallway", "LivingDiningRoom", "DiningRoom", "LivingRoom")
DOOR_HEIGHT = 2.1
MARGIN = 20
"""Wall left between a door and the end of a stretch, beyond the other wall's half thickness [cm]."""
# Window by room type: widest [cm], sill [m], height [m].
WINDOWS: dict[str, tuple[int, float, float]] = {
    "Balcony": (400, 1.05, 1.3),
    "Kitchen": (120, 1.1, 1.1),
    "Bathroom": (70, 1.4, 0.8),
    "SecondBathroom": (70, 1.4, 0.8),
    "MasterBathroom": (80, 1.4, 0.8),
    "LaundryRoom": (80, 1.2, 1.0),
}


@dataclass(frozen=True, slots=True)
class WallOpening:
    """An opening in a wall stretch, in wall coordinates: from `low` to `high` along it [cm]."""

    wall: int
    low: int
    high: int
    kind: OpeningKind
    rooms: tuple[int, ...]
    height: float
    sill: float
    swing_room: int | None = None
    hinge: int = 0


def wall_openings(
    rng: np.random.Generator, types: Sequence[str], parents: dict[int, int], walls: Sequence[Wall]
) -> tuple[WallOpening, ...] | None:
    """Place doors, then the entrance, then windows. None where a room cannot be reached."""
    placed: list[WallOpening] = []
    for room in range(len(types)):
        if types[room] in PUBLIC and _first_public(types) == room:
            continue
        gap = _connection(rng, room, types, parents, walls, placed)
        if gap is None:
            return None
        if all(set(h.rooms) != set(gap.rooms) for h in placed):
            placed.append(gap)
    if not _is_connected(len(types), placed):
        return None
    entrance = _entrance(rng, types, walls, placed)
    if entrance is None:
        return None
    placed.append(entrance)
    for room, room_type in enumerate(types):
        placed += _windows(rng, room, room_type, walls, placed)
    return tuple(placed)


def _first_public(types: Sequence[str]) -> int:
    return next(i for i, t in enumerate(types) if t in PUBLIC)


def _is_connected(count: int, placed: Sequence[WallOpening]) -> bool:
    reached, edge = {0}, [0]
    while edge:
        room = edge.pop()
        for gap in placed:
            if room in gap.rooms:
                for other in gap.rooms:
                    if other not in reached:
                        reached.add(other)
                        edge.append(other)
    return len(reached) == count


def _connection(
    rng: np.random.Generator, room: int, types: Sequence[str], parents: dict[int, int], walls: Sequence[Wall], placed: Sequence[WallOpening]
) -> WallOpening | None:
    """Choose the wall that a room's door stands in, and the door."""
    wanted = [parents[room]] if room in parents else []
    if not wanted:
        order = DOORS_TO.get(types[room], ANY_DOOR)
        hosts = [i for i, t in enumerate(types) if i != room and t in order and i not in parents]
        wanted = sorted(hosts, key=lambda i: order.index(types[i]))
    for host in wanted:
        shared = [i for i, w in enumerate(walls) if {w.a, w.b} == {room, host}]
        for i in sorted(shared, key=lambda i: -walls[i].length):
            gap = _door(rng, i, walls[i], room, host, types, placed)
            if gap is not None:
                return gap
    return None


def _door(
    rng: np.random.Generator, index: int, wall: Wall, room: int, host: int, types: Sequence[str], placed: Sequence[WallOpening]
) -> WallOpening | None:
    kind, width = _door_kind(rng, types[room], types[host], wall.length)
    room_for = wall.length - 2 * (6 + (6 if kind == "open" else 12))
    if kind == "open":
        width = min(width, room_for)
    if width > room_for or width < 65:
        return None
    free = _free(index, wall, placed, 15)
    spans = next((s for spare in (36, 12, 0) if (s := [(a, b) for a, b in free if b - a >= width + spare])), [])
    if not spans:
        return None
    a, b = spans[int(rng.integers(len(spans)))]
    slack = b - a - width
    if kind == "door" and width < 100:  # a leaf opens against the wall beside it: near a corner
        margin = min(MARGIN, slack // 2)
        start = a + margin if rng.random() < 0.5 else b - margin - width
    else:
        start = a + slack // 2 if kind == "open" or rng.random() < 0.6 else a + int(rng.integers(0, max(slack, 1)))
    start = round(start)
    hinge = 0 if start + width / 2 < (wall.low + wall.high) / 2 else 1
    leaf = kind == "door" and width <= 100
    height = DOOR_HEIGHT if kind == "door" else float(rng.choice([2.2, 2.3, 2.4]))
    return WallOpening(index, start, start + width, kind, (room, host), height, 0.0, room if leaf else None, hinge)


def _door_kind(rng: np.random.Generator, room_type: str, host_type: str, length: int) -> tuple[OpeningKind, int]:
    """Return the kind of connection and its width [cm]. A `door` wider than 1 m slides and has no leaf that swings."""
    if room_type in PUBLIC or room_type in CORRIDORS:
        return "open", min(length - 24, 5 * int(rng.integers(20, 45)))
    if room_type == "Balcony":
        return "door", min(length - 40, 5 * int(rng.integers(32, 56)))
    if room_type == "Kitchen" and host_type in PUBLIC and rng.random() < 0.55 and length > 190:
        return ("open" if rng.random() < 0.35 else "door"), min(length - 40, 5 * int(rng.integers(24, 36)))
    narrow = room_type in {"Bathroom", "SecondBathroom", "MasterBathroom", "StorageRoom", "LaundryRoom", "CloakRoom"}
    return "door", int(rng.choice([70, 75, 80] if narrow else [80, 85, 90]))


def _free(index: int, wall: Wall, placed: Sequence[WallOpening], margin: int) -> list[tuple[int, int]]:
    """Return the stretches of a wall clear of its ends and of those placed, with a margin [cm]."""
    spans = [(wall.low + 12, wall.high - 12)]
    for gap in placed:
        if gap.wall == index:
            spans = [p for a, b in spans for p in ((a, min(b, gap.low - margin)), (max(a, gap.high + margin), b)) if p[1] - p[0] > 0]
    return spans


def _entrance(rng: np.random.Generator, types: Sequence[str], walls: Sequence[Wall], placed: Sequence[WallOpening]) -> WallOpening | None:
    """Put the entrance into the hall if there is one, else into a public room; away from the long outer walls."""
    rank = {"Hallway": 0, "Corridor": 1, "Aisle": 1, "DiningRoom": 2, "LivingDiningRoom": 3, "LivingRoom": 4}
    candidates = []
    for i, wall in enumerate(walls):
        inside = wall.b if wall.a == OUTSIDE else wall.a
        if OUTSIDE in (wall.a, wall.b) and types[inside] in rank and wall.length >= 130:
            candidates.append((rank[types[inside]], wall.length, i, inside))
    for _, length, i, inside in sorted(candidates):
        width = 90 if length < 160 else 95
        spans = [(a, b) for a, b in _free(i, walls[i], placed, 20) if b - a >= width + 10]
        if spans:
            a, b = spans[int(rng.integers(len(spans)))]
            near_low = rng.random() < 0.5
            start = a + min(20, b - a - width) if near_low else b - width - min(20, b - a - width)
            return WallOpening(i, start, start + width, "entrance", (inside,), DOOR_HEIGHT, 0.0, inside, 0 if near_low else 1)
    return None


def _windows(
    rng: np.random.Generator, room: int, room_type: str, walls: Sequence[Wall], placed: Sequence[WallOpening]
) -> list[WallOpening]:
    """Put windows into the outer walls of a room: one in the longest, now and then a second around the corner."""
    outer = [(w.length, i) for i, w in enumerate(walls) if {w.a, w.b} == {room, OUTSIDE} and w.length >= 90]
    windows: list[WallOpening] = []
    if room_type in CORRIDORS or room_type in {"StorageRoom", "CloakRoom"}:
        return windows
    widest, sill, height = WINDOWS.get(room_type, (240, float(rng.choice([0.3, 0.6, 0.9, 0.9])), 0.0))
    height = height or float(rng.choice([2.3, 2.4])) - sill
    count = 3 if room_type == "Balcony" else 2 if room_type in PUBLIC or rng.random() < 0.15 else 1
    for _, i in sorted(outer, reverse=True)[:count]:
        spans = sorted(_free(i, walls[i], placed, 25), key=lambda s: s[0] - s[1])
        if not spans or spans[0][1] - spans[0][0] < 60:
            continue
        a, b = spans[0]
        share = 1.0 if room_type == "Balcony" else rng.uniform(0.4, 0.75)
        width = int(np.clip(round((b - a) * share / 5) * 5, 60, widest))
        start = a + (b - a - width) // 2 + (0 if b - a - width < 40 else int(rng.integers(-10, 10)))
        windows.append(WallOpening(i, start, start + width, "window", (room,), height, sill))
    return windows


def opening(number: int, gap: WallOpening, walls: Sequence[Wall], angle: float) -> Opening:
    """Turn a gap into the plan's record: the segment on the wall's centre line [m]."""
    wall = walls[gap.wall]
    shift = 0.0
    if OUTSIDE in (wall.a, wall.b):  # outer walls grow outwards from the inner face
        out = (OUTER_WALL - 12) / 2
        shift = out if wall.b == OUTSIDE else -out
    at = (wall.at + shift) / 100
    ends = np.array([[at, gap.low / 100], [at, gap.high / 100]]) if wall.vertical else np.array([[gap.low / 100, at], [gap.high / 100, at]])
    swing = None if gap.swing_room is None else Swing(f"room_{gap.swing_room}", gap.hinge, angle)
    return Opening(f"opening_{number}", gap.kind, tuple(f"room_{r}" for r in gap.rooms), ends, gap.height, gap.sill, swing)
