"""Two ways to lay out an apartment: rooms on both sides of a corridor, or columns of rooms around the living room."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pipeline.corpus.houses.outline import OUTSIDE, Patch
from pipeline.corpus.houses.room_list import Program

Wish = tuple[str, float]
LINE = 0.12
"""Half a wall on each side of a room: wall lines lie this much further apart than the faces [m]."""
LONGEST_NOOK = 5.5
"""A corridor longer than this is a room of its own, not a part of the living room [m]."""
LARGEST_AISLE = 3.1
"""What is larger is called a corridor [m2]."""
SHORTEST = {"Kitchen": 1.8, "Bathroom": 1.6, "SecondBathroom": 1.55, "Library": 2.35}
"""Least distance between the wall lines of a room in a strip [m]; 2.75 for all others."""


@dataclass(frozen=True, slots=True)
class Draft:
    """Room types and the rectangles that paint them. `parents` names the room that must lead to a suite or balcony."""

    types: tuple[str, ...]
    patches: tuple[Patch, ...]
    parents: dict[int, int]


class Easel:
    """Collects rooms and rectangles while a draft is made [m in, whole 5 cm out]."""

    def __init__(self) -> None:
        self.types: list[str] = []
        self.patches: list[Patch] = []
        self.parents: dict[int, int] = {}

    def room(self, room_type: str, x0: float, y0: float, x1: float, y1: float, parent: int | None = None) -> int:
        """Add a room with its first rectangle and return its number."""
        self.types.append(room_type)
        number = len(self.types) - 1
        if parent is not None:
            self.parents[number] = parent
        self.add(number, x0, y0, x1, y1)
        return number

    def add(self, room: int, x0: float, y0: float, x1: float, y1: float) -> None:
        """Paint another rectangle."""
        box = (_grid(x0), _grid(y0), _grid(x1), _grid(y1))
        if box[0] < box[2] and box[1] < box[3]:
            self.patches.append((room, *box))

    def done(self) -> Draft:
        """Return what was collected."""
        return Draft(tuple(self.types), tuple(self.patches), dict(self.parents))


def _grid(value: float) -> int:
    return round(value * 20) * 5


def spine(rng: np.random.Generator, program: Program) -> Draft:
    """Lay rooms above and below a corridor that starts at the living room."""
    easel = Easel()
    above, corridor = rng.uniform(3.4, 4.3), rng.uniform(1.15, 1.4)
    top, bottom = _two_strips(rng, program)
    below = (
        rng.uniform(2.9, 3.6)
        if any(t in {"SecondBedroom", "Bedroom", "KidsRoom", "ElderlyRoom"} for t, _ in bottom)
        else rng.uniform(2.2, 3.0)
    )
    depth = above + corridor + below
    top_ends, bottom_ends = _even(_ends(top, above), _ends(bottom, below))
    length = max(top_ends[-1], bottom_ends[-1])
    reach = min(max(_start(top_ends), _start(bottom_ends)) + rng.uniform(1.15, 1.35), length)
    if length - reach < 0.6 or rng.random() < 0.25:
        reach = min(top_ends[-1], bottom_ends[-1], length)
    tops = [easel.room(t, a, depth - above, b, depth) for (t, _), a, b in zip(top, [0.0, *top_ends], top_ends, strict=False)]
    lows = [easel.room(t, a, 0.0, b, below) for (t, _), a, b in zip(bottom, [0.0, *bottom_ends], bottom_ends, strict=False)]
    _close_corridor(easel, reach, (top_ends, bottom_ends), (tops, lows), (below, depth - above))
    merged = program.merged_corridor and reach < LONGEST_NOOK
    width = _public_width(program, depth, reach * corridor if merged else 0.0)
    public = _public_column(rng, easel, program, (-width, 0.0, 0.0, depth))
    if merged:
        easel.add(public[0] if easel.types[public[0]] == "LivingDiningRoom" else public[-1], 0.0, below, reach, depth - above)
    else:
        name = "Aisle" if (reach - LINE) * (corridor - LINE) < LARGEST_AISLE else "Corridor"
        easel.room(name, 0.0, below, reach, depth - above)
    if program.suite is not None and program.bedrooms[0] in top:
        k = top.index(program.bedrooms[0])
        side = rng.random() < 0.5
        x0, x1 = [0.0, *top_ends][k], top_ends[k]
        x1 = x1 if k < len(top) - 1 else min(x1, top_ends[-1])
        _suite(rng, easel, program, tops[k], (x0, depth - above, x1, depth), (not side, True))
    _balconies(rng, easel, program, [(public[0], -width, 0.0, depth), (tops[-1], [0.0, *top_ends][-2], top_ends[-1], depth)])
    if program.laundry is not None:
        k = bottom.index(program.wet[0])
        _laundry(rng, easel, program, lows[k], ([0.0, *bottom_ends][k], 0.0, bottom_ends[k], 0.0))
    _corners(rng, easel, program, (-width, 0.0, 0.0, depth), hall_left=True)
    return easel.done()


def centre(rng: np.random.Generator, program: Program) -> Draft:
    """Lay columns of rooms on both sides of the living room."""
    easel = Easel()
    rooms = [*program.bedrooms]
    sides: tuple[list[Wish], list[Wish]] = ([], [])
    widths = (rng.uniform(3.3, 4.1), rng.uniform(3.0, 3.9))
    for wish in sorted(rooms, key=lambda w: -w[1]):
        shorter = min((0, 1), key=lambda s: sum(a for _, a in sides[s]) / widths[s])
        sides[shorter].append(wish)
    kitchen, wet = program.wet[0], list(program.wet[1:])
    small = min((0, 1), key=lambda s: sum(a for _, a in sides[s]) / widths[s])
    sides[small].insert(0, kitchen)
    while wet:
        small = min((0, 1), key=lambda s: sum(a for _, a in sides[s]) / widths[s])
        sides[small].insert(1 if sides[small] else 0, wet.pop(0))
    ends = _even(_ends(sides[0], widths[0]), _ends(sides[1], widths[1]))
    depth = max(ends[0][-1] if ends[0] else 0.0, ends[1][-1] if ends[1] else 0.0)
    width = _public_width(program, depth, 0.0)
    public = _public_column(rng, easel, program, (0.0, 0.0, width, depth))
    numbers: list[list[int]] = [[], []]
    for s, column in enumerate(sides):
        x0, x1 = (-widths[0], 0.0) if s == 0 else (width, width + widths[1])
        for (room_type, _), low, high in zip(column, [0.0, *ends[s]], ends[s], strict=False):
            numbers[s].append(easel.room(room_type, x0, low, x1, high))
            if room_type == "Kitchen" and program.laundry is not None:
                outer = x0 if s == 0 else x1
                _laundry(rng, easel, program, numbers[s][-1], (outer, low, outer, high))
            if program.suite is not None and (room_type, _) == program.bedrooms[0]:
                _suite(rng, easel, program, numbers[s][-1], (x0, low, x1, high), (s == 1, bool(rng.random() < 0.5)))
    spots = [(public[0], 0.0, width, depth)]
    if ends[0] and ends[0][-1] == depth:
        spots.append((numbers[0][-1], -widths[0], 0.0, depth))
    _balconies(rng, easel, program, spots)
    _corners(rng, easel, program, (0.0, 0.0, width, depth), hall_left=bool(rng.random() < 0.5))
    return easel.done()


def _two_strips(rng: np.random.Generator, program: Program) -> tuple[list[Wish], list[Wish]]:
    top, bottom = [program.bedrooms[0]], list(program.wet)
    for wish in program.bedrooms[1:]:
        longer = sum(a for _, a in top) / 3.85 > sum(a for _, a in bottom) / 2.7
        (bottom if longer else top).append(wish)
    if rng.random() < 0.6:
        top.reverse()
    if rng.random() < 0.3:
        bottom.reverse()
    return top, bottom


def _ends(strip: Sequence[Wish], depth: float) -> list[float]:
    """Return where each room of a strip ends along it, from the areas and the strip's depth [m]."""
    lengths = [max(area / (depth - LINE) + LINE, SHORTEST.get(room_type, 2.75)) for room_type, area in strip]
    return [float(v) for v in np.round(np.cumsum(lengths) * 20) / 20]


def _even(one: list[float], other: list[float]) -> tuple[list[float], list[float]]:
    """Stretch two strips to one length where they differ by less than a quarter; else leave a notch in the house."""
    if not one or not other or max(one[-1], other[-1]) > 1.25 * min(one[-1], other[-1]):
        return one, other
    length = round((one[-1] + other[-1]) * 10) / 20
    stretched = [[round(v * length / strip[-1] * 20) / 20 for v in strip] for strip in (one, other)]
    return stretched[0], stretched[1]


def _start(ends: Sequence[float]) -> float:
    return ends[-2] if len(ends) > 1 else 0.0


def _close_corridor(
    easel: Easel,
    reach: float,
    ends: tuple[Sequence[float], Sequence[float]],
    rooms: tuple[Sequence[int], Sequence[int]],
    band: tuple[float, float],
) -> None:
    """Give the corridor's end, behind the last doors, to the last room that borders all of it."""
    length = min(ends[0][-1], ends[1][-1])
    side = 0 if ends[0][-1] >= ends[1][-1] else 1
    end = max(length, ends[side][-1]) if ends[1 - side][-1] >= reach else ends[side][-1]
    if end - reach >= 0.3:
        easel.add(rooms[side][-1], reach, band[0], end, band[1])


def _public_width(program: Program, depth: float, less: float) -> float:
    """Return the width that gives the living (and dining) room its area, less what it has elsewhere [m]."""
    wanted = program.living[1] + (program.dining[1] if program.dining else 0.0) - less
    return float(np.clip(wanted / (depth - LINE) + LINE, 3.4, 6.2))


def _public_column(rng: np.random.Generator, easel: Easel, program: Program, box: tuple[float, float, float, float]) -> list[int]:
    """Paint the living room, and the dining room below it where there is one."""
    x0, y0, x1, y1 = box
    if program.dining is None:
        return [easel.room(program.living[0], x0, y0, x1, y1)]
    share = program.dining[1] / (program.dining[1] + program.living[1])
    cut = y0 + float(np.clip(share * (y1 - y0) + rng.normal(0, 0.15), 2.6, y1 - y0 - 3.0))
    return [easel.room(program.living[0], x0, cut, x1, y1), easel.room(program.dining[0], x0, y0, x1, cut)]


def _suite(
    rng: np.random.Generator, easel: Easel, program: Program, host: int, box: tuple[float, float, float, float], corner: tuple[bool, bool]
) -> None:
    """Cut the suite out of a corner of its bedroom. `corner`: (at the larger x, at the smaller y)."""
    assert program.suite is not None
    room_type, area = program.suite
    x0, y0, x1, y1 = box
    if x1 - x0 < 3.6 or (x1 - x0) * (y1 - y0) < area + 12.5:
        return
    width = float(np.clip(rng.uniform(1.7, 2.3), 1.6, x1 - x0 - 1.5))
    height = float(np.clip(area / (width - LINE) + LINE, 1.6, y1 - y0 - 1.4))
    xa, xb = (x1 - width, x1) if corner[0] else (x0, x0 + width)
    ya, yb = (y0, y0 + height) if corner[1] else (y1 - height, y1)
    easel.room(room_type, xa, ya, xb, yb, parent=host)


def _balconies(rng: np.random.Generator, easel: Easel, program: Program, spots: Sequence[tuple[int, float, float, float]]) -> None:
    """Hang balconies outside the far wall of the living room and a bedroom."""
    for host, x0, x1, y in list(spots)[: program.balconies]:
        width = min(x1 - x0, rng.uniform(2.2, 4.2))
        start = x0 if rng.random() < 0.5 else x1 - width
        easel.room("Balcony", start, y, start + width, y + rng.uniform(1.05, 1.45), parent=host)


def _laundry(rng: np.random.Generator, easel: Easel, program: Program, host: int, side: tuple[float, float, float, float]) -> None:
    """Hang the laundry outside the kitchen's outer wall, which is the degenerate rectangle `side`."""
    assert program.laundry is not None
    x0, y0, x1, y1 = side
    depth = float(np.clip(program.laundry[1] / (max(x1 - x0, y1 - y0) - LINE), 1.25, 1.9)) * rng.uniform(0.95, 1.05)
    if x0 == x1:
        easel.room("LaundryRoom", *((x0 - depth, y0, x0, y1) if x0 <= 0 else (x0, y0, x0 + depth, y1)), parent=host)
    else:
        easel.room("LaundryRoom", x0, y0 - depth, x1, y0, parent=host)


def _corners(rng: np.random.Generator, easel: Easel, program: Program, box: tuple[float, float, float, float], *, hall_left: bool) -> None:
    """Cut an entrance hall, and a storage room beside it, out of the near corners of the public rooms."""
    x0, y0, x1, _ = box
    taken = 0.0
    if program.hall:
        width, height = rng.uniform(1.65, 2.15), rng.uniform(1.8, 2.4)
        if x1 - x0 - width >= 1.7:
            taken = width
            easel.room("Hallway", *_at_side(x0, x1, width, y0, y0 + height, left=hall_left))
    if program.storage is not None:
        width = rng.uniform(1.4, 1.9)
        height = float(np.clip(program.storage[1] / (width - LINE) + LINE, 1.4, 2.4))
        if x1 - x0 - width - taken >= 1.3:
            easel.room("StorageRoom", *_at_side(x0, x1, width, y0, y0 + height, left=not hall_left))


def _at_side(x0: float, x1: float, width: float, y0: float, y1: float, *, left: bool) -> tuple[float, float, float, float]:
    return (x0, y0, x0 + width, y1) if left else (x1 - width, y0, x1, y1)


def shafts(rng: np.random.Generator, patches: Sequence[Patch], rooms: Sequence[Patch], share: float) -> tuple[Patch, ...]:
    """Return patches that cut small service shafts out of corners of some rooms."""
    cuts = []
    for _, x0, y0, x1, y1 in rooms:
        if rng.random() >= share:
            continue
        w, h = (int(v) * 5 for v in rng.integers(7, 13, 2))
        xa = x0 if rng.random() < 0.5 else x1 - w
        ya = y0 if rng.random() < 0.5 else y1 - h
        cuts.append((OUTSIDE, xa, ya, xa + w, ya + h))
    return (*patches, *cuts)


def reorient(rng: np.random.Generator, patches: Sequence[Patch]) -> tuple[Patch, ...]:
    """Mirror and turn a whole draft at random."""
    flip_x, flip_y, swap = (bool(v) for v in rng.random(3) < 0.5)
    transformed = []
    for room, x0, y0, x1, y1 in patches:
        xa, xb = (-x1, -x0) if flip_x else (x0, x1)
        ya, yb = (-y1, -y0) if flip_y else (y0, y1)
        transformed.append((room, ya, xa, yb, xb) if swap else (room, xa, ya, xb, yb))
    return tuple(transformed)
