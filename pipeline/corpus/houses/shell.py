"""The surfaces of a house: floors, ceilings, walls with their holes, and the reveals of doors and windows.

Everything in our frame [m, Z up]; a quad's corners run counter-clockwise seen from where it is looked at.
"""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from pipeline.corpus.houses.room_occupancy import Side, inside_intervals, sides_of, wall_of
from pipeline.entities.plan import Opening, Plan, Room

Point = tuple[float, float, float]
Quad = tuple[Point, Point, Point, Point]
Hole = tuple[float, float, float, float]  # from, to along a side, sill and top [m]
INNER = 0.12
OUTER = 0.24
FRAME = 0.05


@dataclass(frozen=True, slots=True)
class Surface:
    """A mesh of the shell: its 3D-FRONT type, the room that lists it, its quads, the opening that it belongs to or -1."""

    type: str
    room: int
    quads: tuple[Quad, ...]
    opening: int = -1


def surfaces(plan: Plan) -> tuple[Surface, ...]:
    """Return all surfaces of a plan, room by room, then opening by opening."""
    shell: list[Surface] = []
    sides = [sides_of(room) for room in plan.rooms]
    for number, room in enumerate(plan.rooms):
        shell.append(Surface("Floor", number, tuple(_flat(room, 0.0, up=True))))
        shell.append(Surface("Ceiling", number, tuple(_flat(room, room.height, up=False))))
        others = [s for k, other in enumerate(sides) if k != number for s in other]
        bare = [_outer_parts(side, others) for side in sides[number]]
        openings = [(o, wall_of(sides[number], o)) for o in plan.openings if room.room_id in o.rooms]
        for k, side in enumerate(sides[number]):
            holes = [(low, high, o.sill, o.sill + o.height) for o, (wall, low, high) in openings if wall is side]
            shell.append(Surface("WallInner", number, tuple(_wall(side, 0.0, (0.0, side.length), holes, room.height, inside=True))))
            spans = _outer_spans(k, sides[number], bare)
            quads = [q for span in spans for q in _wall(side, -OUTER, span, holes, room.height, inside=False)]
            if quads:
                shell.append(Surface("WallOuter", number, tuple(quads)))
                shell.append(Surface("WallTop", number, tuple(_level(side, a, b, room.height) for a, b in bare[k])))
    for k, opening in enumerate(plan.openings):
        shell += _reveals(plan, sides, k, opening)
    return tuple(shell)


def _flat(room: Room, z: float, *, up: bool) -> Iterator[Quad]:
    """Cut a rectilinear polygon into rectangles between the x of its vertices."""
    points = [(float(x), float(y)) for x, y in room.polygon]
    xs = sorted({x for x, _ in points})
    for a, b in itertools.pairwise(xs):
        for low, high in inside_intervals(points, (a + b) / 2):
            quad = ((a, low, z), (b, low, z), (b, high, z), (a, high, z))
            yield quad if up else (quad[3], quad[2], quad[1], quad[0])


def _wall(side: Side, off: float, span: tuple[float, float], holes: Sequence[Hole], height: float, *, inside: bool) -> Iterator[Quad]:
    """Cover a wall over a `span` along it, `off` in front of it, with upright rectangles around its holes."""
    cuts = sorted({*span, *(v for h in holes for v in h[:2] if span[0] < v < span[1])})
    for a, b in itertools.pairwise(cuts):
        at = (a + b) / 2
        hole = next((h for h in holes if h[0] < at < h[1]), None)
        bands = [(0.0, height)] if hole is None else [(0.0, hole[2]), (hole[3], height)]
        for z0, z1 in bands:
            if z1 - z0 < 1e-6:
                continue
            (ax, ay), (bx, by) = side.point(a, off), side.point(b, off)
            # Walking along the side the room is on the left, so a quad seen from inside runs against it.
            quad = ((bx, by, z0), (ax, ay, z0), (ax, ay, z1), (bx, by, z1))
            yield quad if inside else (quad[1], quad[0], quad[3], quad[2])


def _outer_parts(side: Side, others: Sequence[Side]) -> list[tuple[float, float]]:
    """Return the stretches of a side behind which there is no other room within a wall's thickness."""
    blocked = []
    for other in others:
        if (other.tx, other.ty) != (-side.tx, -side.ty):
            continue
        near, _ = side.off((other.x, other.y, other.x, other.y))
        if -OUTER - 0.02 < near < 0:
            start, _ = side.along((other.x, other.y, other.x, other.y))
            blocked.append((start - other.length - INNER, start + INNER))
    at, parts = 0.0, []
    for low, high in sorted(blocked):
        if min(low, side.length) - at > 0.05:
            parts.append((at, min(low, side.length)))
        at = max(at, high)
    if side.length - at > 0.05:
        parts.append((at, side.length))
    return parts


def _outer_spans(k: int, sides: Sequence[Side], bare: Sequence[Sequence[tuple[float, float]]]) -> list[tuple[float, float]]:
    """Return the stretches of side `k`'s outer face: longer than the inner one around outer corners, shorter in notches."""
    side, before, after = sides[k], sides[k - 1], sides[(k + 1) % len(sides)]
    parts = [list(p) for p in bare[k]]
    if not parts:
        return []
    if parts[0][0] == 0.0:
        turns_left = before.tx * side.ty - before.ty * side.tx > 0
        meets = any(b == before.length for _, b in bare[k - 1])
        parts[0][0] += (-OUTER if meets else 0.0) if turns_left else OUTER
    if parts[-1][1] == side.length:
        turns_left = side.tx * after.ty - side.ty * after.tx > 0
        meets = any(a == 0.0 for a, _ in bare[(k + 1) % len(sides)])
        parts[-1][1] += (OUTER if meets else 0.0) if turns_left else -OUTER
    return [(a, b) for a, b in parts if b - a > 0.01]


def _level(side: Side, low: float, high: float, z: float) -> Quad:
    """Return the horizontal strip on top of an outer wall."""
    (ax, ay), (bx, by) = side.point(low, 0.0), side.point(high, 0.0)
    (cx, cy), (dx, dy) = side.point(high, -OUTER), side.point(low, -OUTER)
    return ((dx, dy, z), (cx, cy, z), (bx, by, z), (ax, ay, z))


def _reveals(plan: Plan, sides: Sequence[Sequence[Side]], k: int, opening: Opening) -> list[Surface]:
    """Return the jambs, head and sill inside a wall, and around doors the frame on the room's face."""
    number = next(i for i, r in enumerate(plan.rooms) if r.room_id == opening.rooms[0])
    side, low, high = wall_of(sides[number], opening)
    thick = INNER if len(opening.rooms) == 2 else OUTER
    z0, z1 = opening.sill, opening.sill + opening.height

    def at(s: float, v: float, z: float) -> Point:
        return (*side.point(s, v), z)

    quads: list[Quad] = [
        (at(low, -thick, z0), at(low, 0, z0), at(low, 0, z1), at(low, -thick, z1)),
        (at(high, 0, z0), at(high, -thick, z0), at(high, -thick, z1), at(high, 0, z1)),
        (at(low, -thick, z1), at(low, 0, z1), at(high, 0, z1), at(high, -thick, z1)),
        (at(low, 0, z0), at(low, -thick, z0), at(high, -thick, z0), at(high, 0, z0)),
    ]
    kind = {"window": "Window", "open": "Hole", "portal": "Hole"}.get(opening.kind, "Door")
    reveals = [Surface(kind, number, tuple(quads), k)]
    if kind == "Door":
        f = 0.004
        frame: list[Quad] = [
            (at(low, f, 0), at(low - FRAME, f, 0), at(low - FRAME, f, z1), at(low, f, z1)),
            (at(high + FRAME, f, 0), at(high, f, 0), at(high, f, z1), at(high + FRAME, f, z1)),
            (at(high + FRAME, f, z1), at(low - FRAME, f, z1), at(low - FRAME, f, z1 + FRAME), at(high + FRAME, f, z1 + FRAME)),
        ]
        reveals.append(Surface("Pocket", number, tuple(frame), k))
    return reveals
