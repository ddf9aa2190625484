"""One storey of a completed program as numbers for the searches."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np

from pipeline.arrays import Floats, Ints
from pipeline.floorplan.program.daylight import YIELDS, daylit
from pipeline.floorplan.program.defaults import DEFAULTS, OUTSIDE
from pipeline.floorplan.program.floor_program import FloorProgram, RoomReq
from pipeline.floorplan.search.energy import TERMS, Terms
from pipeline.floorplan.search.grid import Halves
from pipeline.floorplan.search.spec import Spec

UNIT = 0.25  # side of a cell [m]
FRAME = 0.105  # wall beside the frame of an opening [m]
OPEN_FRONT, PORTAL = 1.5, 1.2  # least clear widths [m]
# How far an unstated area may miss its target: a share, and a strip of this width [m] along one side, for the raster; where nothing else helps.
LOOSE, STRIP, EASED = 0.02, 0.2, 0.4
SMALL, BUSY = 7.0, 3  # rooms of less area [m2] or so many links give up their outside wall first
HALL_WEIGHT = 0.25  # how much an unstated hallway's usual area counts beside that of a room
FLIGHTS = (2.85, 2.1)  # what two flights side by side take, with their landings [m]: 16 risers of 0.18 m, treads of 0.27 m
SOFTER = (1.0, 0.3, 0.1, 0.03)  # factors on the weights of all terms then: what must be comes before what should
EASED_HALL = 1.95  # how much larger than its target an unstated hallway may be then
NARROWEST = 1.2  # clear width that rooms keep, where theirs is not less anyway [m]: what stands along one wall, and a robot before it
STATED = 0.10  # how far a stated target may be missed
EDGE = 0.012  # hard bounds are drawn in by this share, so that rounding cannot cross them
MOST_STRETCH = 1.4  # how far usual areas are stretched under a larger storey
FREE_HALL = (0.6, 1.7)  # how far an unstated hallway's area may move


@dataclass(frozen=True)
class Storey:
    """A storey's rooms, its numbers, and what the slicing search needs beside them: gross areas and their bounds [cells]."""

    level: int
    rooms: tuple[RoomReq, ...]
    spec: Spec
    weights: Terms
    gross: Floats
    gross_low: Floats
    gross_high: Floats
    clear: Floats  # (n,) width between the middles of walls that corridors, and rooms of a stated width, must keep [m]


def cells(metres: float) -> int:
    """Return the number of cells that cover a length."""
    return int(np.ceil(metres / UNIT - 1e-9))


def halves(program: FloorProgram) -> Halves:
    """Return half the thickness of the program's walls [m]."""
    return Halves(program.shell.inner_wall / 2, program.shell.outer_wall / 2)


def sides(program: FloorProgram) -> float:
    """Return what an opening needs of straight wall beside its clear width [m]: its frame's, and half a wall at both ends."""
    return 2 * FRAME + 2 * max(halves(program))


def is_flexible_hall(room: RoomReq) -> bool:
    """Whether a room is circulation of no stated area, which takes what is left."""
    return room.type in {"hallway", "entry"} and not room.area.stated


def wall_for(kind: str, door: float, small: bool, beside: float) -> int:
    """Return the straight wall [cells] that a link of that kind needs; `beside` [m] as `sides` returns it."""
    if kind in {"wall", "any"}:
        return 2
    if kind == "open":
        return cells((1.1 if small else OPEN_FRONT) + beside)
    if kind == "portal":
        return cells((1.0 if small else PORTAL) + beside)
    return cells(door + beside)


def weights_of(program: FloorProgram, factor: float = 1.0) -> Terms:
    """Return the weights: defaults times two to the power of the knobs, and a factor on all."""
    return Terms(*(getattr(Terms(), name) * 2.0 ** getattr(program.style, name) * factor for name in TERMS))


def storey(program: FloorProgram, level: int, stair_cells: tuple[int, int, int, int] | None = None, ease: int = 0) -> Storey:
    """Translate one storey of a completed program. `stair_cells` is the rectangle that the staircase must take, if it is fixed.

    `ease` lets go of what nobody stated: 1 of usual widths and of much of the usual areas, 2 of usual outside walls of rooms that are
    small, busy or can do without, 3 of all usual outside walls.
    """
    rooms = tuple(r for r in program.rooms if r.level == level or (r.type == "staircase" and level < program.storeys))
    index = {r.id: i for i, r in enumerate(rooms)}
    stairs = next((i for i, r in enumerate(rooms) if r.type == "staircase"), -1)
    target = np.array([r.area.target or DEFAULTS[r.type].area for r in rooms])
    low, high = _bounds(rooms, target, ease)
    half = halves(program)
    link, need = _links(program, index, target)
    here = program.model_copy(update={"rooms": rooms})
    ban, apart, order = _relations(here, index)
    clear = np.array([_clear(r, program) for r in rooms])
    outside = _outside(rooms, program, level, ease)
    # a small room cannot be as wide as its type usually is
    least = np.array([cells(min(w, 0.92 * t**0.5 + 2 * half.inner)) for w, t in zip(clear, target, strict=True)])
    strict = _strict_widths(rooms, least, half, ease)
    kinds = [DEFAULTS[r.type] for r in rooms]
    square, habitable, useful = (np.array([int(getattr(k, name)) for k in kinds]) for name in ("square", "habitable", "useful"))
    flexible = np.array([is_flexible_hall(r) for r in rooms])
    spec = Spec(
        unit=UNIT, half=half,
        root=index.get(program.entrance.into or "", max(stairs, 0)),
        target=target, low=low, high=high, total=_total(program),
        area_weight=np.where(flexible, HALL_WEIGHT, 1.0),
        inside=np.array([int(r.type not in OUTSIDE) for r in rooms]),
        least=least, strict=strict, square=square, habitable=habitable, useful=useful,
        corridor=np.array([int(r.type == "hallway") for r in rooms]),
        link=link, need=need, ban=ban, apart=apart, order=order, between=_between(here, index), near=_near(here, index),
        outside=np.array(outside),
        outside_sum=np.array([cells(r.exterior_length + 0.5) if r.exterior_length else 0 for r in rooms]),
        corner=np.array([int(r.exterior == "corner") for r in rooms]),
        stair_room=stairs if stair_cells is not None else -1,
        stair=np.array(stair_cells or (0, 0, 0, 0)),
        flight=np.array([stairs, *(cells(s + 2 * half.inner) for s in FLIGHTS)] if program.storeys > 1 else [-1, 0, 0]),
        nonrect=program.nonrect if level == 0 else 0,
    )  # fmt: skip
    gross = _gross(target, half)
    gross_low, gross_high = np.where(flexible, gross * 0.75, gross), np.where(flexible, gross * (1.9 if ease else 1.3), gross)
    return Storey(level, rooms, spec, weights_of(program, SOFTER[min(ease, len(SOFTER) - 1)]), gross, gross_low, gross_high, clear)


def _total(program: FloorProgram) -> Floats:
    """Return the bounds of the home's area [m2], where it is stated and on one storey."""
    wish = program.total_area
    if program.storeys > 1 or not wish.stated:
        return np.array([0.0, np.inf])
    return np.array([(wish.min or 0.0) * (1 + EDGE), (wish.max or np.inf) * (1 - EDGE)])


def _links(program: FloorProgram, index: Mapping[str, int], target: Floats) -> tuple[Ints, Ints]:
    """Return which rooms open to each other, and the straight wall that each pair is to share [cells], both (n, n)."""
    n, door = len(index), program.accessibility.min_door
    link, need = np.zeros((n, n), np.int64), np.zeros((n, n), np.int64)
    for k in (k for k in program.links if k.a in index and k.b in index):
        a, b = index[k.a], index[k.b]
        need[a, b] = need[b, a] = wall_for(k.kind, door, min(target[a], target[b]) < 7.0, sides(program))
        link[a, b] = link[b, a] = max(link[a, b], int(k.opens))
    return link, need


def _strict_widths(rooms: Sequence[RoomReq], least: Ints, half: Halves, ease: int) -> Ints:
    """Return the widths below which no room may fall [cells]: less than the usual least ones, where nobody stated them."""
    narrowest = cells(NARROWEST + 2 * half.inner)
    strict = np.maximum((0.8 * least).astype(np.int64), np.minimum(least, narrowest))
    for i, r in enumerate(rooms):
        if r.min_width is not None or r.type in {"hallway", "entry"}:
            strict[i] = least[i]
        elif r.type == "wc":
            strict[i] = cells(0.85 + 2 * half.inner)
        elif ease:
            strict[i] = min(strict[i], narrowest)
    return strict


def stretch_storeys(program: FloorProgram) -> FloorProgram:
    """Stretch the usual areas of storeys that are smaller than what stands on them, so that no room hangs in the air.

    A stated total stays: then what stands on them shrinks as well.
    """
    half = halves(program)
    rooms = list(program.rooms)
    above = 0.0
    for level in reversed(range(program.storeys)):
        gross = {
            i: float(_gross(np.array([r.area.target or DEFAULTS[r.type].area]), half)[0])
            for i, r in enumerate(rooms)
            if r.level == level or r.type == "staircase"
        }
        free = [i for i in gross if not rooms[i].area.stated and rooms[i].type != "staircase"]
        flexible, whole = sum(gross[i] for i in free), sum(gross.values())
        if flexible and whole < above:
            factor = min(1.0 + (above - whole) / flexible, MOST_STRETCH)
            for i in free:
                rooms[i] = _scaled(rooms[i], factor, 1.0)
            whole += (factor - 1.0) * flexible
        above = max(above, whole)
    loose = [i for i, r in enumerate(rooms) if not r.area.stated and r.type not in OUTSIDE]
    before, after = (sum(rs[i].area.target or 0.0 for i in loose) for rs in (program.rooms, rooms))
    if program.total_area.stated and after > before:
        for i in loose:
            rooms[i] = _scaled(rooms[i], before, after)
    return program.model_copy(update={"rooms": tuple(rooms)})


def _scaled(room: RoomReq, over: float, under: float) -> RoomReq:
    """Return a room whose target area is `over` / `under` times what it was."""
    return room.model_copy(update={"area": room.area.model_copy(update={"target": (room.area.target or 0.0) * over / under})})


def _gross(target: Floats, half: Halves) -> Floats:
    """Area up to wall centre lines [cells] of a room of that inner area, were it nearly square."""
    side = np.sqrt(target) + 2 * (0.65 * half.inner + 0.35 * half.outer)
    return np.asarray(side * side / UNIT**2)


def _bounds(rooms: tuple[RoomReq, ...], target: Floats, ease: int) -> tuple[Floats, Floats]:
    loose, most = (EASED, EASED_HALL) if ease else (LOOSE + STRIP / np.sqrt(target), FREE_HALL[1])
    low, high = target * (1 - loose), target * (1 + loose)
    for i, r in enumerate(rooms):
        if is_flexible_hall(r):
            low[i], high[i] = target[i] * FREE_HALL[0], target[i] * most
        if r.area.stated and r.area.target is not None and r.area.min is None and r.area.max is None:
            low[i], high[i] = target[i] * (1 - STATED) * (1 + EDGE), target[i] * (1 + STATED) * (1 - EDGE)
        if r.area.min is not None:
            low[i] = max(low[i], r.area.min * (1 + EDGE))
        if r.area.max is not None:
            high[i] = min(high[i], r.area.max * (1 - EDGE))
    return low, high


def _clear(room: RoomReq, program: FloorProgram) -> float:
    """Return the width between the middles of a room's walls [m]: what is asked for holds beside an outside wall too."""
    half = halves(program)
    usual = DEFAULTS[room.type].width + 2 * half.inner
    if room.min_width is not None:
        return room.min_width + half.inner + half.outer
    if room.type == "hallway":
        return max(usual, program.accessibility.min_corridor + half.inner + half.outer)
    return usual


def _outside(rooms: tuple[RoomReq, ...], program: FloorProgram, level: int, ease: int) -> list[int]:
    """Straight outside wall that each room needs [cells]: what was asked for, and usual ones as far as all fit together."""
    asked = [_asked_outside(r, program, level) for r in rooms]
    free = [r for r, a in zip(rooms, asked, strict=True) if a == 0 and r.exterior != "none"]
    usual = [r for r in free if DEFAULTS[r.type].exterior and r.type != "entry"]
    ids = {r.id for r in rooms}
    links = [k for k in program.links if k.a in ids and k.b in ids]
    if ease >= 2:
        doors = Counter(i for k in links for i in (k.a, k.b))
        usual = [r for r in usual if ease == 2 and r.type not in YIELDS and (r.area.target or 0.0) >= SMALL and doors[r.id] < BUSY]
    lit = daylit(links, [r.id for r, a in zip(rooms, asked, strict=True) if a], [(r.id, r.type) for r in usual])
    return [a or (cells(0.8 + sides(program)) if r.id in lit else 0) for r, a in zip(rooms, asked, strict=True)]


def _asked_outside(room: RoomReq, program: FloorProgram, level: int) -> int:
    """Return the straight outside wall that a room is asked to have [cells], for its gate, its door, or as such; 0 for none."""
    into = level == 0 and program.entrance.into == room.id
    own = any(room in program.select(s) for s in program.entrance.separate)
    if room.type == "garage":
        return cells(2.4 + sides(program))
    if into or own or room.exterior == "door":
        return cells(0.9 + sides(program))
    walled = room.exterior in {"wall", "corner"} or (room.window == "required" and room.exterior != "none")
    return cells(1.0 + sides(program)) if walled else 0


def _relations(program: FloorProgram, index: dict[str, int]) -> tuple[Ints, Floats, Floats]:
    n = len(index)
    ban, apart, order = np.zeros((n, n), np.int64), np.zeros((n, n)), np.zeros((n, n))

    def pairs(one: str, other: str | None) -> list[tuple[int, int]]:
        ones = [index[r.id] for r in program.select(one)]
        others = [index[r.id] for r in program.select(other or one)]
        return [(a, b) for a in ones for b in others if a != b]

    for f in program.forbids:
        if f.what == "adjacent":
            for a, b in pairs(f.a, f.b):
                ban[a, b] = ban[b, a] = 1
    for r in program.relations:
        for a, b in pairs(r.a, r.b):
            if r.kind == "separation":
                apart[a, b] = apart[b, a] = max(apart[a, b], r.value * (1 + 3 * EDGE))
            elif r.kind == "area_order":
                order[a, b] = max(order[a, b], r.value * (1 + EDGE))
            elif r.kind == "largest":
                order[a, b] = max(order[a, b], 1 + EDGE)
            elif r.kind == "area_equal":
                order[a, b] = order[b, a] = max(order[a, b], 1 / (1 + r.value) + EDGE)
    return ban, apart, order


def _between(program: FloorProgram, index: dict[str, int]) -> Ints:
    """Return rows (a, b, c) of rooms of which a lies between b and c."""
    asked = [[program.select(x) for x in (r.a, r.b, r.c)] for r in program.relations if r.kind == "between" and r.b and r.c]
    triples = [[index[r.id] for r in rooms] for sides in asked for rooms in product(*sides) if len({r.id for r in rooms}) == 3]
    return np.array(triples, np.int64).reshape(-1, 3)


def _near(program: FloorProgram, index: dict[str, int]) -> Floats:
    """Return rows (a, b, share) of rooms that belong together: members of a zone; shares of each sum to 1."""
    groups = [list(combinations(sorted({index[r.id] for m in z.members for r in program.select(m)}), 2)) for z in program.zones]
    pairs = [(a, b, 1.0 / len(group)) for group in groups for a, b in group]
    return np.array(pairs, np.float64).reshape(-1, 3)
