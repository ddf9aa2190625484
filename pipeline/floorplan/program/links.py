"""The graph of links: selectors resolved to rooms, and what nobody stated filled in until every room can be reached."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from pipeline.entities.plan import hops
from pipeline.floorplan.program.defaults import DEFAULTS, HUBS
from pipeline.floorplan.program.floor_program import FloorProgram, Link, Relation, RoomReq

ANY_HUB = (*HUBS, "staircase")
# Who stands for a group of joined rooms when the group is attached to the rest.
FRONT = (*HUBS, "library", "media_room", "playroom", "gym", "meeting_room", "sunroom", "utility", "bedroom", "storage", "closet")
BUDGET = 600  # sets of links that are tried before `hops` relations are given up


class Distance(NamedTuple):
    """At least `least` openings are to lie on every way from room `a` to room `b`; `selector` is what the request called `a`."""

    selector: str
    a: str
    b: str
    least: float


def distances(program: FloorProgram) -> tuple[Distance, ...]:
    """Return what the `hops` relations ask for, room by room; without `b` the rooms of `a` are meant with each other."""
    return tuple(
        Distance(r.a, a.id, b.id, r.value)
        for r in program.relations
        if r.kind == "hops"
        for a in program.select(r.a)
        for b in program.select(r.b or r.a)
        if a.id != b.id
    )


def nearness(asked: Sequence[Distance], links: Sequence[Link]) -> list[tuple[Distance, int]]:
    """Return the distances that the graph of links breaks, and how many openings there are. Rooms that nothing joins yet are far apart."""
    pairs = [(link.a, link.b) for link in links if link.opens]
    openings = [(distance, hops(pairs, distance.a).get(distance.b)) for distance in asked]
    return [(distance, count) for distance, count in openings if count is not None and count < distance.least]


def resolve(program: FloorProgram) -> tuple[Link, ...]:
    """Expand selectors to room ids: `each` gives every room of `a` a partner of `b`, `some` joins one pair."""
    by_pair: dict[tuple[str, str], Link] = {}
    for link in program.links:
        ones, others = program.select(link.a), program.select(link.b)
        pairs: list[tuple[RoomReq, RoomReq]] = []
        for k, one in enumerate(ones):
            partners = [o for o in others if o.id != one.id and _meet(one, o)]
            if partners:
                pairs.append((one, partners[k % len(partners)] if len(partners) == len(ones) else partners[0]))
        for one, other in pairs[:1] if link.quant == "some" else pairs:
            key = (min(one.id, other.id), max(one.id, other.id))
            between = any(_passes(r, one.id, other.id) or _passes(r, other.id, one.id) for r in program.relations)
            kind = "door" if link.kind == "any" and between else link.kind  # one walks through what lies between
            new = link.model_copy(update={"a": one.id, "b": other.id, "kind": kind, "quant": "each"})
            old = by_pair.get(key)
            if old is None or (new.opens and not old.opens):
                by_pair[key] = new
    return tuple(by_pair.values())


def _passes(relation: Relation, room: str, side: str) -> bool:
    """Whether `room` is said to lie between `side` and another one."""
    return relation.kind == "between" and relation.a == room and side in {relation.b, relation.c}


def _meet(a: RoomReq, b: RoomReq) -> bool:
    return a.level is None or b.level is None or "staircase" in {a.type, b.type} or a.level == b.level


def connect(program: FloorProgram) -> tuple[Link, ...]:
    """Add links until the rooms form one piece. Groups are attached by the usual parent of the room that stands for them.

    Where `hops` relations are broken that way, other parents and other rooms are tried; if none keeps them, the usual links are returned.
    """
    stated = resolve(program)
    root = _root(program, stated)
    distant = distances(program)
    completion = _complete(program, stated, root, distant, set())
    return _resolve_kinds(program, completion if completion is not None else _complete(program, stated, root, (), set()) or stated)


def _resolve_kinds(program: FloorProgram, links: Sequence[Link]) -> tuple[Link, ...]:
    """Say what joins rooms that are to lie next to each other: the door that is there already, one between rooms that one walks through, else no more than the wall."""
    kinds = {r.id: r.type for r in program.rooms}
    doors = {k.ends: k for k in links if k.opens}
    stated = {k.ends for k in links if k.stated}
    settled: list[Link] = []
    for link in links:
        if doors.get(link.ends, link) is not link:
            continue  # a door needs the wall
        walked = all(kinds[i] in HUBS and DEFAULTS[kinds[i]].through for i in link.ends)
        kind = "door" if link.kind == "any" and walked else link.kind
        settled.append(link.model_copy(update={"kind": kind, "stated": link.ends in stated}))
    return tuple(settled)


def _complete(
    program: FloorProgram, links: tuple[Link, ...], root: str, distant: Sequence[Distance], seen: set[frozenset[tuple[str, str, bool]]]
) -> tuple[Link, ...] | None:
    """Return the first completion that keeps rooms far enough apart. Links only bring rooms nearer: a set that fails is left at once."""
    key = frozenset((k.a, k.b, k.opens) for k in links)
    if key in seen or len(seen) >= BUDGET or nearness(distant, links):
        return None
    seen.add(key)
    groups = _groups(program, links)
    if len(groups) <= 1:
        return links
    for link in _options(program, groups, root, links, wide=bool(distant)):
        completion = _complete(program, (*links, link), root, distant, seen)
        if completion is not None:
            return completion
    return None


def _options(program: FloorProgram, groups: Sequence[frozenset[str]], root: str, links: Sequence[Link], *, wide: bool) -> Iterator[Link]:
    """Yield links that attach one more group to the root's, the usual one first; `wide`: by any of the group's rooms."""
    main = next(g for g in groups if root in g)
    fronts = {g: _fronts(program, g, links) for g in groups if root not in g}
    waiting = sorted(fronts, key=lambda g: _order(fronts[g][0]))
    usual = [link for g in waiting for link in _host_links(program, fronts[g][0], main, links)]
    yield from usual
    if not usual:
        yield from _unusual(program, fronts[waiting[0]][:1], frozenset({root}))
        yield from (link for g in waiting for link in _unusual(program, fronts[g], main))
    if wide:
        yield from (link for g in waiting for front in fronts[g][1:] for link in _host_links(program, front, main, links))


def _unusual(program: FloorProgram, fronts: Sequence[RoomReq], main: frozenset[str]) -> Iterator[Link]:
    """Yield the links by which any of some rooms may hang on any room of `main` on its storey, on what one walks through first."""
    hosts = sorted((r for r in program.rooms if r.id in main), key=lambda r: (not DEFAULTS[r.type].through, _order(r)))
    for front in fronts:
        for host in hosts:
            if _meet(host, front):
                yield _opening(host, front)


def _groups(program: FloorProgram, links: Sequence[Link]) -> list[frozenset[str]]:
    """Return the groups of rooms that one can walk between without passing through a bathroom, in the order of their first room."""
    dead = {r.id for r in program.rooms if r.type in {"bathroom", "wc"}}
    rank = {t: i for i, t in enumerate(HUBS)}
    kinds = {r.id: r.type for r in program.rooms}
    kept: list[tuple[str, str]] = []
    used: set[str] = set()
    # of a bathroom's doors the one to the most public room counts
    for link in sorted(links, key=lambda k: min(rank.get(kinds[k.a], 99), rank.get(kinds[k.b], 99))):
        ends = link.ends & dead
        if link.opens and not ends & used:
            kept.append((link.a, link.b))
            used |= ends
    groups: list[frozenset[str]] = []
    for room in program.rooms:
        if not any(room.id in group for group in groups):
            groups.append(frozenset(hops(kept, room.id)))
    return groups


def _root(program: FloorProgram, links: Sequence[Link]) -> str:
    """Return the room that the rest is attached to: the entrance if stated, else the busiest hub of the lowest storey."""
    stated = program.select(program.entrance.into or "")
    if stated:
        return stated[0].id
    ground = [r for r in program.rooms if not r.level] or list(program.rooms)
    for kind in ("entry", "hallway", "living_room", "studio_room", *HUBS):
        same = [r for r in ground if r.type == kind]
        if same:
            return max(same, key=lambda r: _load(r, links)).id
    return ground[0].id


def _fronts(program: FloorProgram, group: frozenset[str], links: Sequence[Link]) -> list[RoomReq]:
    """Return the rooms of a group that may stand for it, the most public first; a full one only where all are."""
    members = [r for r in program.rooms if r.id in group]
    rank = {t: i for i, t in enumerate(FRONT)}
    free = [m for m in members if not _is_full(program, m, links)] or members
    return sorted(free, key=lambda r: rank.get(r.type, len(rank)))


def _order(room: RoomReq) -> int:
    """Attach circulation first, so that others find it."""
    order = ("entry", "hallway", "staircase", "living_room", "studio_room", "family_room", "dining_room", "kitchen", "utility")
    return order.index(room.type) if room.type in order else len(order)


def _host_links(program: FloorProgram, front: RoomReq, main: frozenset[str], links: Sequence[Link]) -> Iterator[Link]:
    """Yield the links by which a room may hang on one of `main`, the usual one first."""
    beside = {k.beyond(front.id) for k in links if not k.opens}
    second = front.type == "kitchen" and front.role not in {"", "primary"}  # a kitchen of somebody's own stands by itself
    usual = DEFAULTS["bedroom"].entered_from[1:] if second else DEFAULTS[front.type].entered_from or ANY_HUB
    if DEFAULTS[front.type].belongs:
        near = {r.type for r in program.rooms if r.id in beside}
        usual = tuple(sorted(usual, key=lambda t: t not in near))
    for wanted in usual:
        hosts = [r for r in program.rooms if r.type == wanted and r.id in main and _meet(r, front)]
        hosts = [h for h in hosts if not _is_full(program, h, links) and not is_forbidden(program, h, front)]
        hosts = [h for h in hosts if h.type != "hallway" or h.level == front.level or front.type == "staircase"] or hosts
        if wanted == "bedroom" and front.type in {"closet", "bathroom"}:
            taken = {k.beyond(r.id) for k in links for r in program.rooms if r.type == front.type}
            hosts = [h for h in hosts if h.id not in taken] or hosts
        if wanted == "hallway":
            hosts = sorted(hosts, key=lambda h: _load(h, links))
        hosts = sorted(hosts, key=lambda h: h.id not in beside)
        for host in hosts:
            yield _opening(host, front)


def _opening(host: RoomReq, front: RoomReq) -> Link:
    """Return the usual link of two rooms: stairs stand open, all others get a door."""
    return Link(a=host.id, b=front.id, kind="open" if "staircase" in {front.type, host.type} else "door")


def _load(room: RoomReq, links: Sequence[Link]) -> int:
    return sum(room.id in k.ends for k in links)


def _is_full(program: FloorProgram, room: RoomReq, links: Sequence[Link]) -> bool:
    """Whether a `degree` relation or the type leaves no room for another opening."""
    load = _load(room, [k for k in links if k.opens])
    asked = [r.value for r in program.relations if r.kind == "degree" and _covers(program, r.a, room)]
    if asked:
        return load >= min(asked)
    return load >= 1 and not DEFAULTS[room.type].through and room.type in {"bathroom", "wc", "balcony", "storage", "closet"}


def is_forbidden(program: FloorProgram, a: RoomReq, b: RoomReq) -> bool:
    """Whether no opening may join two rooms; `b` would be the one farther in."""

    def hits(one: str, other: str | None) -> bool:
        return other is not None and _covers(program, one, b) and _covers(program, other, a)

    apart = [f for f in program.forbids if f.what in {"adjacent", "connected"} and f.b]
    ways = [f for f in program.forbids if f.what == "through"]
    return any(hits(f.a, f.b) or hits(f.b or "", f.a) for f in apart) or any(hits(f.a, f.avoid) for f in ways)


def _covers(program: FloorProgram, selector: str, room: RoomReq) -> bool:
    """Whether `program.select(selector)` has this room; most selectors are told by its id and type alone."""
    if selector == room.id:
        return True
    return (selector == room.type or bool(program.zones)) and any(r.id == room.id for r in program.select(selector))
