"""From what was said to what can be built: one entry per room, levels, links, entrance and areas filled by documented defaults."""

from collections import Counter
from collections.abc import Sequence

from pipeline.floorplan.program.areas import with_areas
from pipeline.floorplan.program.consistency import check_names, check_storeys, reach
from pipeline.floorplan.program.defaults import INTO
from pipeline.floorplan.program.floor_program import OTHERS, Entrance, FloorProgram, Range, RoomReq, RoomType, Shell
from pipeline.floorplan.program.furniture import allot_pieces, matching_categories, spread
from pipeline.floorplan.program.links import connect, distances, is_forbidden, nearness, resolve

UPSTAIRS = {"bedroom", "bathroom", "playroom"}
BESIDE = {"bathroom", "wc", "closet", "balcony", "storage", "utility", "hallway", "office"}  # lie on the storey of what they are joined to
FEW = 6  # rooms, below which an irregular outline has one corner cut out and not two
# rooms of homes in which nobody sleeps where they live
BEYOND_ONE_ROOM = {"dining_room", "hallway", "garage", "playroom", "library", "media_room", "gym", "staircase", "workshop"}
# homes of which nobody says how many bedrooms they have: less floor is one room, the most bedrooms, floor without them and for each [m2]
ONE_ROOM, MOST_BEDROOMS, BESIDE_BEDROOMS, A_BEDROOM = 42.0, 5, 20.0, 27.0
FEW_BEDS = 3  # bedrooms, up to which one bathroom is enough
TABLED = {"kitchen", "living_room", "family_room"}  # in which one may dine
HUBLESS = {"living_room", "family_room", "studio_room", "hallway", "entry"}


def complete(program: FloorProgram) -> FloorProgram:
    """Return the program with every gap filled. Completing twice changes nothing."""
    program = program.model_copy(update={"rooms": _expand(program), "shell": _shell(program)})
    for fill in (_add_missing, _storeys, _add_circulation):
        program = program.model_copy(update={"rooms": fill(program)})
    check_names(program)
    check_storeys(program)
    program = _join(program)
    program = _make_irregular(program.model_copy(update={"entrance": _entrance(program)}))
    return allot_pieces(with_areas(_with_dining(spread(program))))


def _with_dining(program: FloorProgram) -> FloorProgram:
    """Let rooms in which somebody wants a dining table be rooms in which one dines, with the floor for it."""

    def dines(room: RoomReq) -> bool:
        asked = [matching_categories(c, room.type) for c in room.furniture.counts if c.min]
        return room.type in TABLED and "dining" not in room.functions and any(set(names) == {"dining_table"} for names in asked)

    rooms = [r.model_copy(update={"functions": (*r.functions, "dining")}) if dines(r) else r for r in program.rooms]
    return program.model_copy(update={"rooms": tuple(rooms)})


def _make_irregular(program: FloorProgram) -> FloorProgram:
    """Give a home that is to be irregular an outline that is: one notched room is not seen from afar."""
    if not program.nonrect or program.footprint.stated:
        return program
    outline = program.footprint.model_copy(update={"shape": "L" if len(program.rooms) < FEW else "T", "corners": "chamfered"})
    return program.model_copy(update={"footprint": outline, "nonrect": max(program.nonrect, len(program.rooms) // 4)})


def _expand(program: FloorProgram) -> tuple[RoomReq, ...]:
    """Replace an entry with count k by k entries of unique ids."""
    rooms: list[RoomReq] = []
    taken = {r.id for r in program.rooms if r.count == 1}
    for room in program.rooms:
        if room.count == 1:
            rooms.append(room)
            continue
        for k in range(1, room.count + 1):
            name = f"{room.id}_{k}"
            while name in taken:
                name += "x"
            taken.add(name)
            rooms.append(room.model_copy(update={"id": name, "count": 1}))
    return tuple(rooms)


def _shell(program: FloorProgram) -> Shell:
    """Return the shell; what is usual of it gives way where outside walls would be thinner than those between rooms."""
    shell, usual = program.shell, Shell()
    for name, other in (("outer_wall", "inner_wall"), ("inner_wall", "outer_wall")):
        if shell.outer_wall < shell.inner_wall and getattr(shell, name) == getattr(usual, name):
            return shell.model_copy(update={name: getattr(shell, other)})
    return shell


def _forbidden_types(program: FloorProgram) -> set[str]:
    return {f.a for f in program.forbids if f.what == "room_type"}


def _add_missing(program: FloorProgram) -> tuple[RoomReq, ...]:
    """Add the places to live, to cook and to wash that a dwelling needs and nobody named."""
    rooms = list(program.rooms)
    types: set[str] = {r.type for r in rooms}
    functions = {f for r in rooms for f in r.functions}
    never = _forbidden_types(program)
    work = bool(types & {"office", "meeting_room"}) and not types & {"bedroom", "living_room", "studio_room", "family_room"}

    def add(kind: str, name: str, count: int = 1) -> None:
        for _ in range(count if kind not in types | never else 0):
            rooms.append(RoomReq.model_validate({"id": _name(name, rooms), "type": kind, "stated": False}))
            types.add(kind)

    if not program.only and not work:
        roles = {r.role for r in rooms if r.type == "bedroom"}
        of_others = len(roles) == 1 and roles < OTHERS
        if of_others:
            types.discard("bedroom")
        beds = usual_bedrooms(program.total_area) if program.total_area.stated and "bedroom" not in types else 0
        if "studio_room" not in types:
            add("bedroom", "bed", max(beds - 1, 1) if of_others else beds)
        if not types & {"living_room", "family_room", "studio_room"} and "living" not in functions:
            if "bedroom" not in types and (types & BEYOND_ONE_ROOM or len(program.select("bathroom")) > 1):
                add("bedroom", "bed")
            if "bedroom" not in types:
                add("studio_room", "studio")
            else:
                add("living_room", "living")
        # a living room that an open kitchen has brought is no bedroom
        if not types & {"bedroom", "studio_room"} and not any(r.stated for r in rooms if r.type in {"living_room", "family_room"}):
            add("bedroom", "bed")
        if "kitchen" not in types and "cooking" not in functions:
            add("kitchen", "kitchen")
        if "bathroom" not in types:
            add("bathroom", "bath", 1 + (beds > FEW_BEDS))
        elif left := _without_bath(program):
            levels = {r.level for r in left}
            level = levels.pop() if len(levels) == 1 else None
            rooms.append(RoomReq(id=_name("bath", rooms), type="bathroom", level=level, stated=False))
    return tuple(rooms)


def usual_bedrooms(floor: Range) -> int:
    """Return how many bedrooms a home of so much floor usually has; 0: one lives and sleeps in one room."""
    area = floor.target or floor.max or floor.min or 0.0
    return 0 if area < ONE_ROOM else min(MOST_BEDROOMS, round((area - BESIDE_BEDROOMS) / A_BEDROOM))


def _without_bath(program: FloorProgram) -> list[RoomReq]:
    """Return the bedrooms from which one would get to a bathroom only through another's: each bathroom belongs to some bedroom alone, none to theirs."""
    owned = [r for r in program.relations if r.kind == "ensuite"]
    private = {bath.id for r in owned for bath in program.select(r.a)}
    served = {bed.id for r in owned for bed in program.select(r.b or "")}
    if any(bath.id not in private for bath in program.select("bathroom")):
        return []
    return [bed for bed in program.select("bedroom") if bed.id not in served]


def _storeys(program: FloorProgram) -> tuple[RoomReq, ...]:
    """Give every room a storey, and a home of several storeys a staircase and a landing on each upper one."""
    if program.storeys == 1:
        return tuple(r.model_copy(update={"level": 0}) for r in program.rooms)
    rooms = []
    stated = [k for k in program.links if k.stated]
    for room in program.rooms:
        top = program.storeys - 1
        near = [r for k in stated if room.id in k.ends for r in program.rooms if r.id in k.ends and r.id != room.id]
        beside = {r.level for r in near if r.level is not None}
        landing = room.type in UPSTAIRS and any(r.type == "hallway" for r in near)
        if not beside and not landing:  # a closet lies by the largest bedroom, a bath by the entry
            beside = {int(r.type in UPSTAIRS) for r in near}
        usual = beside.pop() if len(beside) == 1 and room.type in BESIDE else (1 if room.type in UPSTAIRS else 0)
        level = room.level if room.level is not None else usual
        rooms.append(room.model_copy(update={"level": 0 if room.type == "staircase" else min(level, top)}))
    if not any(r.level == 0 and r.type != "staircase" for r in rooms):  # nobody lives on the stairs alone: all move down
        rooms = [r.model_copy(update={"level": max((r.level or 0) - 1, 0)}) for r in rooms]
    if program.storeys == 3 and not any(r.level == 2 for r in rooms):
        rooms = _spread(rooms)
    if not any(r.type == "staircase" for r in rooms):
        rooms.append(_more("stairs", "staircase", 0, rooms))
    for level in range(1, program.storeys):
        here = {r.type for r in rooms if r.level == level}
        if here and "hallway" not in here:
            rooms.append(_more("landing" if level == 1 else f"landing_{level}", "hallway", level, rooms))
    return tuple(rooms)


def _spread(rooms: list[RoomReq]) -> list[RoomReq]:
    """Move every second room of each type from the first upper storey to an empty second one."""
    counts: Counter[str] = Counter()
    for k, room in enumerate(rooms):
        if room.level == 1 and room.type != "hallway":
            counts[room.type] += 1
            rooms[k] = room.model_copy(update={"level": 2 if counts[room.type] % 2 == 0 else 1})
    return rooms


def _more(wanted: str, kind: RoomType, level: int | None, rooms: Sequence[RoomReq]) -> RoomReq:
    """Return a room more that nobody named, for the plan needs it."""
    return RoomReq(id=_name(wanted, rooms), type=kind, level=level, stated=False, inferred=True)


def _name(wanted: str, rooms: Sequence[RoomReq]) -> str:
    used = {r.id for r in rooms}
    name, k = wanted, 2
    while name in used:
        name, k = f"{wanted}_{k}", k + 1
    return name


def _add_circulation(program: FloorProgram) -> tuple[RoomReq, ...]:
    """Add an entry or a hallway where three or more closed rooms would have to hang on a living room, or on nothing."""
    rooms = list(program.rooms)
    never = _forbidden_types(program)
    ground = [r for r in rooms if r.level == 0]
    if any(r.type in {"hallway", "entry"} for r in ground):
        return program.rooms
    links = resolve(program)
    hanging = [r for r in ground if r.type in {"bedroom", "bathroom", "office", "library", "media_room", "playroom", "wc", "gym"}]
    owned = {i for k in links for i in k.ends}
    suites = {k.beyond(r.id) for k in links for r in hanging if r.type == "bathroom"}
    loose = [r for r in hanging if r.id not in owned or r.id in suites]
    beds = [r for r in ground if r.type == "bedroom"]
    wanted = len(loose) >= 3 and len(beds) >= 2 and "hallway" not in never
    hubless = len(ground) > 2 and not any(r.type in HUBLESS for r in ground)
    if hubless and not program.only and "entry" not in never:
        rooms.append(_more("entry", "entry", 0, rooms))
    elif wanted and not program.only:
        rooms.append(_more("hall", "hallway", 0, rooms))
    return tuple(rooms)


def _join(program: FloorProgram) -> FloorProgram:
    """Fill in the links. Where rooms then lie nearer than a `hops` relation allows, a hallway more may put them apart.

    Where what may not be joined would be, or a room lies behind one that must not be passed, an entry more gives another way.
    """
    joined = _connected(program)
    if _violates_forbids(joined) and not program.only and "entry" not in _forbidden_types(program):
        around = _connected(program, _more("entry", "entry", 0, program.rooms))
        if not _violates_forbids(around):
            return around
    broken = nearness(distances(program), joined.links)
    if not broken or program.only or "hallway" in _forbidden_types(program):
        return joined
    level = next(r.level for r in program.rooms if r.id == broken[0][0].a)
    wider = _connected(program, _more("hall", "hallway", level, program.rooms))
    return joined if nearness(distances(wider), wider.links) else wider


def _connected(program: FloorProgram, *more: RoomReq) -> FloorProgram:
    """Return the program with more rooms and all its links."""
    program = program.model_copy(update={"rooms": (*program.rooms, *more)})
    return program.model_copy(update={"links": connect(program)})


def _violates_forbids(program: FloorProgram) -> bool:
    """Whether a link that nobody stated joins what may not be joined, or a room can only be reached through one to be avoided."""
    rooms = {r.id: r for r in program.rooms}
    if any(not k.stated and k.opens and is_forbidden(program, rooms[k.a], rooms[k.b]) for k in program.links):
        return True
    root = _entrance(program).into or ""
    ways = [f for f in program.forbids if f.what == "through" and f.avoid]
    avoided = {f.avoid: reach(program, root, frozenset(r.id for r in program.select(f.avoid or ""))) for f in ways}
    return any(r.id not in avoided[f.avoid] and r not in program.select(f.avoid or "") for f in ways for r in program.select(f.a))


def _entrance(program: FloorProgram) -> Entrance:
    stated = program.select(program.entrance.into or "")
    if stated:
        return program.entrance.model_copy(update={"into": stated[0].id})
    ground = [r for r in program.rooms if r.level == 0]
    usual = [r for kind in INTO for r in ground if r.type == kind]
    best = usual or [r for r in ground if r.type not in {"bathroom", "wc", "balcony", "closet"}] or ground
    return program.entrance.model_copy(update={"into": best[0].id, "stated": False})
