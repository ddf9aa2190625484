"""Is a completed program consistent? Contradictions and impossibilities are refused, naming the words that clash."""

import itertools
from collections import Counter
from collections.abc import Iterable, Iterator

from pipeline.errors import RefusedError
from pipeline.floorplan.program.daylight import is_flat
from pipeline.floorplan.program.defaults import DEFAULTS, OUTSIDE
from pipeline.floorplan.program.floor_program import MAX_ROOMS, Evidence, FloorProgram, RoomReq
from pipeline.floorplan.program.furniture import faults as furniture_faults
from pipeline.floorplan.program.links import distances, nearness

LEAST_SHARE = 0.4  # a room of less than this share of its type's usual area is no such room
CORNERS = {"rectangle": 4, "L": 5, "T": 6, "any": 6}  # of an outline that stick out
WALLS = 1.02  # total area may be exceeded by this much before stated areas clash with it
PRIVATE = {"bathroom", "wc", "closet", "balcony", "storage", "office", "sunroom", "utility"}  # may lie behind a bedroom


class ImpossibleError(RefusedError):
    """A request that contradicts itself; `clashes` are the words of the prompt that do."""

    code = "impossible"

    def __init__(self, message: str, remedy: str, clashes: Iterable[Evidence] = ()) -> None:
        self.clashes = tuple(dict.fromkeys(clashes))
        words = sorted({c.text for c in self.clashes})
        super().__init__(f"{message} ({' / '.join(repr(w) for w in words)})" if words else message, remedy)


Fault = tuple[str, str, list[Evidence]]  # what cannot be, what helps, and the words that clash


def check(program: FloorProgram) -> None:
    """Raise ImpossibleError (a RefusedError) for a program that no plan can meet."""
    check_names(program)
    for faults in (_shell, _forbidden, _areas, _degrees, _ways, _distances, _corners, _planar):
        for fault in faults(program):
            raise ImpossibleError(*fault)
    check_furniture(program)


def check_furniture(program: FloorProgram) -> None:
    """Raise ImpossibleError for the first wish for furniture that no room can meet."""
    for message, remedy, fields in furniture_faults(program):
        raise ImpossibleError(message, remedy, evidence_for(program, *fields))


def evidence_for(program: FloorProgram, *fields: str) -> list[Evidence]:
    """Return the evidence of fields that start with one of the names."""
    return [e for e in program.evidence if any(e.field == f or e.field.startswith(f + ".") for f in fields)]


def check_names(program: FloorProgram) -> None:
    """Raise ImpossibleError when ids repeat or a selector names no room."""
    twice = [name for name, count in Counter(r.id for r in program.rooms).items() if count > 1]
    if twice:
        raise ImpossibleError(f"two rooms are called {twice[0]!r}", "give each room an id of its own")
    if len(program.rooms) > MAX_ROOMS:
        raise ImpossibleError(f"{len(program.rooms)} rooms are asked for", f"ask for {MAX_ROOMS} at most")
    wanted = {s for k in program.links for s in (k.a, k.b)} | {s for r in program.relations for s in (r.a, r.b, r.c) if s}
    wanted |= {m for z in program.zones for m in z.members}
    if program.entrance.into:
        wanted.add(program.entrance.into)
    for selector in sorted(wanted):
        if not program.select(selector):
            raise ImpossibleError(f"no room is called {selector!r}", f"rooms are {', '.join(r.id for r in program.rooms)}")


def check_storeys(program: FloorProgram) -> None:
    """Raise ImpossibleError when a storey has no room, or a stated link would join rooms of two storeys; levels are filled in."""
    for level in range(program.storeys):
        if not any(r.level == level and r.type != "staircase" for r in program.rooms):
            message = f"{program.storeys} storeys are asked for, and level {level} has no room"
            raise ImpossibleError(message, "name a room for each storey, or ask for fewer storeys", evidence_for(program, "storeys"))
    for k in program.links:
        ones, others = program.select(k.a), program.select(k.b)
        meet = any(a.level == b.level or "staircase" in {a.type, b.type} for a in ones for b in others)
        if k.stated and ones and others and not meet:
            words = evidence_for(program, *k.fields, f"rooms.{k.a}", f"rooms.{k.b}")
            raise ImpossibleError(f"{k.a} and {k.b} are to be joined and lie on different storeys", "put both on one storey", words)


def _shell(program: FloorProgram) -> Iterator[Fault]:
    inner, outer = program.shell.inner_wall, program.shell.outer_wall
    if outer < inner:
        message = f"outside walls of {outer:g} m are thinner than those between rooms, {inner:g} m"
        yield message, "make them as thick at least", evidence_for(program, "shell")


def _forbidden(program: FloorProgram) -> Iterator[Fault]:
    for f in program.forbids:
        if f.what == "room_type":
            there = [r for r in program.rooms if r.type == f.a and r.stated]
            if there:
                words = evidence_for(program, f"forbids.room_type.{f.a}", *(f"rooms.{r.id}" for r in there))
                yield f"a {f.a.replace('_', ' ')} is both asked for and ruled out", "keep one of the two", words
            continue
        apart = [{a.id, b.id} for a in program.select(f.a) for b in program.select(f.b or "") if a.id != b.id]
        for k in program.links:
            if k.ends in apart and (f.what == "adjacent" or (f.what == "connected" and k.opens) or (f.what == "open" and k.kind == "open")):
                words = evidence_for(program, f"forbids.{f.what}.{f.a}", *k.fields)
                yield f"{k.a} and {k.b} are to be joined and kept apart", "keep one of the two", words


def _least(room: RoomReq) -> float:
    """Return the smallest area that the room can have."""
    if room.area.min is not None:
        return room.area.min
    if room.area.stated and room.area.target is not None:
        return 0.9 * room.area.target
    return LEAST_SHARE * DEFAULTS[room.type].area


def _areas(program: FloorProgram) -> Iterator[Fault]:
    for room in program.rooms:
        low, high = room.area.min, room.area.max
        if low is not None and high is not None and low > high:
            words = evidence_for(program, f"rooms.{room.id}.area")
            yield f"{room.id} is to have at least {low:g} and at most {high:g} m²", "swap the two", words
    inside = [r for r in program.rooms if r.type not in OUTSIDE]
    whole = program.total_area
    most = whole.target * 1.1 if whole.max is None and whole.stated and whole.target else whole.max
    least = sum(_least(r) for r in inside)
    if most is not None and least > most * WALLS:
        rooms = {f"rooms.{r.id}.area" for r in program.rooms}
        words = [w for w in program.evidence if w.field in {"total_area", "rooms", *rooms}]
        message = f"{len(inside)} rooms need at least {least:.0f} m² and {most:.0f} m² are allowed"
        yield message, "ask for fewer rooms or more area", words
    low = whole.min if whole.stated else None
    if low is not None and all(r.area.stated for r in inside):
        largest = sum(r.area.max or (r.area.target or r.area.min or 0.0) * (1.1 if r.area.min is None else 3.0) for r in inside)
        if largest < low / WALLS:
            words = evidence_for(program, "total_area", *(f"rooms.{r.id}.area" for r in inside))
            yield f"the rooms add up to {largest:.0f} m², the home to at least {low:.0f} m²", "change one", words
    for relation in (r for r in program.relations if r.kind == "area_order"):
        for a, b in itertools.product(program.select(relation.a), program.select(relation.b or "")):
            high = a.area.max or (a.area.target if a.area.stated else None)
            if a.id != b.id and high is not None and b.area.stated and high * 1.1 < relation.value * _least(b):
                words = evidence_for(program, f"relations.area_order.{a.id}", f"rooms.{a.id}.area", f"rooms.{b.id}.area")
                yield f"{a.id} cannot be {relation.value:g} times as large as {b.id}", "change an area", words


def _degrees(program: FloorProgram) -> Iterator[Fault]:
    for relation in (r for r in program.relations if r.kind == "degree"):
        for room in program.select(relation.a):
            joined = [k for k in program.links if room.id in k.ends and k.opens]
            if len(joined) > relation.value:
                doors = f"{relation.value:g} door{'s' * (relation.value != 1)}"
                words = evidence_for(program, f"relations.degree.{room.id}", *(x for k in joined for x in k.fields))
                yield f"{room.id} is to have {doors} and is joined to {len(joined)} rooms", "drop one of the links", words


def _ways(program: FloorProgram) -> Iterator[Fault]:
    """Every room is reached from the entrance, bathrooms are no thoroughfares, and avoided rooms are avoided."""
    root = program.entrance.into or ""
    reached = reach(program, root, frozenset())
    for room in program.rooms:
        if room.id not in reached:
            words = evidence_for(program, f"rooms.{room.id}")
            yield f"{room.id} can be reached only through a bathroom or a bedroom", "say what it opens off", words
    for f in (f for f in program.forbids if f.what == "through" and f.avoid):
        avoid = frozenset(r.id for r in program.select(f.avoid or ""))
        for room in program.select(f.a):
            if room.id not in reach(program, root, avoid - {room.id}):
                words = evidence_for(program, f"forbids.through.{f.a}", *(f"links.{room.id}-{i}" for i in avoid))
                yield f"{room.id} can be reached only through {', '.join(sorted(avoid))}", "add another door", words


def reach(program: FloorProgram, root: str, avoid: frozenset[str]) -> set[str]:
    """Return the rooms that one can walk to from `root` without entering `avoid`.

    No way leads through a bathroom, nor through a balcony or from a bedroom to a room that is not its own unless such a link was stated.
    """
    kinds = {r.id: r.type for r in program.rooms}
    reachable, frontier = {root} - avoid, [root]
    while frontier:
        here = frontier.pop()
        if here in avoid or (here != root and kinds[here] in {"bathroom", "wc"}):
            continue
        for k in program.links:
            other = k.beyond(here)
            if other is None or other in reachable or other in avoid or not k.opens:
                continue
            private = kinds[here] == "balcony" or (kinds[here] == "bedroom" and kinds[other] not in PRIVATE)
            if private and here != root and not k.stated:
                continue
            reachable.add(other)
            frontier.append(other)
    return reachable


def _distances(program: FloorProgram) -> Iterator[Fault]:
    for asked, openings in nearness(distances(program), program.links):
        fields = [x for k in program.links if {asked.a, asked.b} == k.ends for x in k.fields]
        words = evidence_for(program, f"relations.hops.{asked.selector}", *fields)
        message = f"hops: {asked.a} and {asked.b} are to be at least {asked.least:g} openings apart and lie {openings} apart"
        yield message, "drop a link between them, or let the home have a hallway more", words


def _corners(program: FloorProgram) -> Iterator[Fault]:
    """Refuse more corner rooms than an outline has corners: each belongs to one room."""
    most = max(CORNERS.values()) if program.storeys > 1 else CORNERS[program.footprint.shape]  # a smaller storey leaves one open
    for level in range(program.storeys):
        rooms = [r for r in program.rooms if r.exterior == "corner" and r.level == level]
        if len(rooms) > most:
            message = f"{len(rooms)} rooms of one storey are to have a corner of the outline ('exterior: corner'), which has {most}"
            yield message, "ask for fewer corner rooms", evidence_for(program, *(f"rooms.{r.id}" for r in rooms))


def _planar(program: FloorProgram) -> Iterator[Fault]:
    """Rooms on one floor can touch only as the links of a planar graph do, those with outside walls on its outer face."""
    for level in range(program.storeys):
        ids = {r.id for r in program.rooms if r.level == level or r.type == "staircase"}
        links = [k for k in program.links if k.a in ids and k.b in ids]
        if not is_flat(links, ()):
            words = evidence_for(program, *(f"links.{k.a}-{k.b}" for k in links if k.stated))
            yield "the links between rooms cross: no flat plan has them all", "drop a link", words
