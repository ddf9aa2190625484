"""Target areas: what is stated holds, the rest follows defaults, relations between rooms and the total."""

from collections import Counter
from collections.abc import Sequence

from pipeline.floorplan.program.defaults import DEFAULTS, EATIN_KITCHEN, LIVING_DINING, OUTSIDE, PRIMARY_BEDROOM
from pipeline.floorplan.program.floor_program import OTHERS, FloorProgram, Range, RoomReq

HALL_SHARE, HALL_LEAST = 0.08, 4.0
HALL_PER_DOOR = 1.0  # m2: doors on both sides of a corridor 1.1 m wide, one every 1.8 m
LEAST_SCALE, MOST_SCALE = 0.45, 2.6  # how far defaults may shrink or stretch to meet a stated total
MOST_STRETCH = 1.35  # how far rooms of a smaller storey may grow
SLACK = 1.06  # a target lies this far inside a one-sided bound


def with_areas(program: FloorProgram) -> FloorProgram:
    """Return the program with a target area for each room and for the whole; what was stated is not moved."""
    if program.total_area.target is not None and all(r.area.target is not None for r in program.rooms):
        return program  # it was completed before: going over it once more would move areas again
    rooms = list(program.rooms)
    free = [not r.area.stated for r in rooms]
    target = [_first_guess(r, rooms, program.scale) for r in rooms]
    _halls(program, rooms, target, free)
    _relate(program, rooms, target, free)
    _total(program, rooms, target, free)
    _relate(program, rooms, target, free)
    _balance(rooms, target, free)
    filled = tuple(
        r.model_copy(update={"area": Range(min=r.area.min, max=r.area.max, target=round(t, 3), stated=r.area.stated)})
        for r, t in zip(rooms, target, strict=True)
    )
    inside = sum(t for r, t in zip(rooms, target, strict=True) if r.type not in OUTSIDE)
    total = program.total_area.model_copy(update={"target": program.total_area.target or round(inside, 3)})
    return program.model_copy(update={"rooms": filled, "total_area": total})


def _first_guess(room: RoomReq, rooms: Sequence[RoomReq], scale: float) -> float:
    low, high = room.area.min, room.area.max
    if room.area.target is not None:
        return room.area.target
    if low is not None and high is not None:
        return (low + high) / 2
    guess = _default(room, rooms) * scale
    if low is not None:
        return max(guess, low * SLACK)
    return min(guess, high / SLACK) if high is not None else guess


def _default(room: RoomReq, rooms: Sequence[RoomReq]) -> float:
    if room.type == "bedroom":
        beds = [r for r in rooms if r.type == "bedroom"]
        primary = [r for r in beds if r.role == "primary"]
        if not primary and len(beds) > 1:
            primary = [r for r in beds if r.role not in OTHERS][:1]
        if room in primary:
            return PRIMARY_BEDROOM
        return (PRIMARY_BEDROOM + DEFAULTS["bedroom"].area) / 2 if len(beds) == 1 else DEFAULTS["bedroom"].area
    if room.type == "kitchen" and "dining" in room.functions:
        return EATIN_KITCHEN
    if room.type == "living_room":
        apart = "dining" not in room.functions and any(r.type == "dining_room" or "dining" in r.functions for r in rooms)
        cooking = DEFAULTS["kitchen"].area if "cooking" in room.functions else 0.0
        return cooking + (DEFAULTS["living_room"].area if apart else LIVING_DINING)
    return DEFAULTS[room.type].area


def usual_area(room: RoomReq, program: FloorProgram) -> float:
    """Return what a room of its kind usually has among these [m2]; of a hallway, what its storey's rooms and doors ask for."""
    if room.type != "hallway":
        return _default(room, program.rooms) * program.scale
    rooms = [r.model_copy(update={"area": Range()}) if r.id == room.id else r for r in program.rooms]
    target = [r.area.target or 0.0 for r in program.rooms]
    _halls(program, rooms, target, [True] * len(rooms))
    return next(t for r, t in zip(rooms, target, strict=True) if r.id == room.id)


def _halls(program: FloorProgram, rooms: Sequence[RoomReq], target: list[float], free: Sequence[bool]) -> None:
    """Give free hallways their share of what the other rooms of their storeys take, and wall enough for their doors."""
    doors = Counter(i for k in program.links if k.opens for i in (k.a, k.b))
    for level in {r.level for r in rooms}:
        halls = [i for i, r in enumerate(rooms) if r.type == "hallway" and r.area.target is None and free[i] and r.level == level]
        others = sum(t for r, t in zip(rooms, target, strict=True) if r.type not in {"hallway", *OUTSIDE} and r.level == level)
        for i in halls:
            target[i] = max(HALL_LEAST, HALL_SHARE * others / len(halls), HALL_PER_DOOR * doors[rooms[i].id])


def _relate(program: FloorProgram, rooms: Sequence[RoomReq], target: list[float], free: Sequence[bool]) -> None:
    """Move free targets until the area relations hold with some air."""
    index = {r.id: i for i, r in enumerate(rooms)}

    def pick(selector: str | None) -> list[int]:
        return [index[r.id] for r in program.select(selector)] if selector else []

    for relation in program.relations:
        larger = pick(relation.a)
        smaller = [i for i in pick(relation.b) if i not in larger]
        if relation.kind == "area_equal" and larger:
            alike = [*larger, *smaller]
            mean = sum(target[i] for i in alike) / len(alike)
            for i in alike:
                target[i] = mean if free[i] or rooms[i].area.target is None else target[i]
        elif relation.kind in {"area_order", "largest"} and smaller:
            ratio = relation.value * 1.08 if relation.kind == "area_order" else 1.08
            most = max(target[i] for i in smaller)
            for i in larger:
                if target[i] < ratio * most:
                    if free[i] or rooms[i].area.max is rooms[i].area.target is None:
                        target[i] = ratio * most
                    for j in smaller:
                        if free[j]:
                            target[j] = min(target[j], target[i] / ratio)
        elif relation.kind == "area_share":
            whole = sum(t for r, t in zip(rooms, target, strict=True) if r.type not in OUTSIDE)
            for i in larger:
                if target[i] < relation.value * whole and free[i] and relation.value < 0.95:
                    target[i] = relation.value * 1.03 / (1 - relation.value * 1.03) * (whole - target[i])


def _balance(rooms: Sequence[RoomReq], target: list[float], free: Sequence[bool]) -> None:
    """Stretch the free rooms of smaller storeys towards the size of the largest, so that walls stand above walls."""
    levels = sorted({r.level or 0 for r in rooms})
    if len(levels) == 1:
        return
    stairs = sum(t for r, t in zip(rooms, target, strict=True) if r.type == "staircase")
    sums = {v: sum(t for r, t in zip(rooms, target, strict=True) if (r.level or 0) == v) + stairs * (v > 0) for v in levels}
    most = max(sums.values())
    for level in levels:
        # what has a target already was stretched before, or is meant: completing twice changes nothing
        loose = [i for i, r in enumerate(rooms) if (r.level or 0) == level and r.area.target is None and free[i] and r.type != "staircase"]
        flexible = sum(target[i] for i in loose)
        if flexible > 0 and sums[level] < 0.999 * most:
            factor = min(1.0 + (most - sums[level]) / flexible, MOST_STRETCH)
            for i in loose:
                target[i] *= factor


def _total(program: FloorProgram, rooms: Sequence[RoomReq], target: list[float], free: Sequence[bool]) -> None:
    """Scale the free targets so that the interior meets the stated total."""
    wish = program.total_area
    inside = [i for i, r in enumerate(rooms) if r.type not in OUTSIDE]
    now = sum(target[i] for i in inside)
    goal = now
    if wish.target is not None and wish.stated:
        goal = wish.target
    elif wish.min is not None and now < wish.min * 1.03:
        goal = wish.min * 1.03
    elif wish.max is not None and now > wish.max * 0.95:
        goal = wish.max * 0.95
    loose = [i for i in inside if free[i]]
    flexible = sum(target[i] for i in loose)
    if flexible <= 0 or goal == now:
        return
    factor = min(max((goal - (now - flexible)) / flexible, LEAST_SCALE), MOST_SCALE)
    for i in loose:
        target[i] *= factor
