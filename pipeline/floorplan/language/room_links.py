"""Facts about rooms → links, prohibitions and relations between them."""

import graphlib
import itertools
from collections.abc import Iterable, Sequence
from typing import Any, NoReturn

from pipeline.floorplan.language.rooms import HALLS, Fact, Group, Inventory, Reading
from pipeline.floorplan.language.tokens import Words
from pipeline.floorplan.program.consistency import ImpossibleError
from pipeline.floorplan.program.floor_program import Evidence

MERGE_ORDER = ("living_room", "family_room", "dining_room", "kitchen", "studio_room")
OPPOSITE, FAR, WINGS = 0.45, 0.35, 0.2  # "at the other end", "away from" and "in another wing", as shares of the diagonal
ENSUITE = {"ensuite", "primary"}  # roles of bathrooms that belong to a bedroom
KINDS = {"door": "door", "leads": "door", "near": "any", "open": "open", "wall": "wall"}
ASIDE = {"balcony", "garage", "hallway", "staircase"}  # not meant when the largest room is spoken of
INNER = {"closet", "bathroom", "balcony", "storage", "wc", "utility", "garage"}  # may lie behind another room


class Draft:
    """The program while it is put together, as plain data for pydantic."""

    def __init__(self, words: Words) -> None:
        self.words = words
        self.links: dict[tuple[str, str], dict[str, Any]] = {}
        self.forbids: list[dict[str, Any]] = []
        self.relations: list[dict[str, Any]] = []
        self.evidence: list[Evidence] = []
        self.zones: list[dict[str, Any]] = []
        self.fields: dict[str, Any] = {}

    def cite(self, first: int, last: int, field: str) -> None:
        """Note that `field` was read from words[first:last]."""
        entry = self.words.quote(first, last, field)
        if entry not in self.evidence[-40:]:
            self.evidence.append(entry)

    def citations(self, prefix: str) -> list[Evidence]:
        """Return the words of fields."""
        return [e for e in self.evidence if e.field.startswith(prefix)]

    def refuse(self, what: str, advice: str, spans: Iterable[tuple[int, int] | None], field: str = "rooms") -> NoReturn:
        """Refuse a prompt, with the words words[first:last] that cannot be met."""
        places = {self.words.quote(first, last, field) for first, last in filter(None, spans)}
        raise ImpossibleError(what, advice, sorted(places, key=lambda e: (e.start, e.end)))

    def link(self, a: str, b: str, kind: str, fact: Fact, *, stated: bool = True) -> None:
        """Add a link, or sharpen the one there is."""
        if a == b:
            return
        key = (min(a, b), max(a, b))
        old = self.links.get(key)
        if old is None or (old["kind"] in {"any", "wall"} and kind not in {"any", "wall"}):
            self.links[key] = {"a": a, "b": b, "kind": kind, "stated": stated}
        self.cite(fact.first, fact.last, f"links.{a}-{b}")

    def neighbours(self, a: str) -> set[str]:
        """Return the rooms that a room is joined to by an opening."""
        return {k[1] if k[0] == a else k[0] for k, v in self.links.items() if a in k and v["kind"] != "wall"}

    def relate(self, kind: str, a: str, b: str | None, value: float, fact: Fact, c: str | None = None) -> None:
        """Add a relation once."""
        relation = {"kind": kind, "a": a, "b": b, "value": value} | ({"c": c} if c else {})
        if relation not in self.relations:
            self.relations.append(relation)
        self.cite(fact.first, fact.last, f"relations.{kind}.{a}")

    def forbid(self, what: str, a: str, b: str | None, avoid: str | None, fact: Fact) -> None:
        """Add a prohibition once."""
        prohibition = {"what": what, "a": a, "b": b, "avoid": avoid}
        if prohibition not in self.forbids:
            self.forbids.append(prohibition)
        self.cite(fact.first, fact.last, f"forbids.{what}.{a}")


def pairs(a: Group, b: Group) -> list[tuple[str, str]]:
    """Return who is meant with whom: all with a single one, else one by one."""
    if len(a) == 1 or len(b) == 1:
        return list(itertools.product(a, b))
    return list(zip(a, b, strict=True)) if len(a) == len(b) else [(x, b[0]) for x in a]


def join(draft: Draft, state: Reading) -> None:
    """Write all facts into the program."""
    stock, facts = state.inventory, state.facts
    ways = [way for way, only in itertools.pairwise(facts) if only.what == "only" and way.what in {"door", "leads"} and way.a == only.a]
    for fact in facts:
        owners = fact.b if len(fact.b) == len(fact.a) else fact.b[:1] * len(fact.a)
        for thing, owner in zip(fact.a, owners, strict=False) if fact.what == "own" else ():
            if not any(thing in way.a and owner not in way.b for way in ways):  # reached only through another room of its owner's
                _give(draft, stock, thing, owner, fact)
    _merge_rooms(draft, stock, facts)
    for fact in facts:
        if any(i[0] == "*" for i in fact.a + fact.b):
            continue
        if fact.what in KINDS:
            _link_rooms(draft, stock, fact, facts)
        else:
            _relate_rooms(draft, stock, fact, facts)
    _check_order(draft)
    for fact in facts:
        _everything(draft, stock, fact, facts)
    _suites(draft, stock, facts)
    _zones(draft, state)
    for fact in facts:
        _apart(draft, state, fact)


def _give(draft: Draft, stock: Inventory, thing: str, owner: str, fact: Fact) -> None:
    draft.link(owner, thing, "door", fact)
    if stock.get(thing).type in {"bathroom", "wc"} and stock.get(owner).type != "hallway":
        draft.relate("degree", thing, None, 1.0, fact)
        if stock.get(owner).type == "bedroom":
            draft.relate("ensuite", thing, owner, 1.0, fact)


def _merge_rooms(draft: Draft, stock: Inventory, facts: Sequence[Fact]) -> None:
    """Open social rooms to each other; an open kitchen to where one lives."""
    for fact in facts:
        if fact.what == "merge":
            chain = sorted(fact.a, key=lambda i: MERGE_ORDER.index(stock.get(i).type) if stock.get(i).type in MERGE_ORDER else 9)
            for a, b in itertools.pairwise(chain):
                draft.link(a, b, "open", fact)
    for room in stock.of("kitchen"):
        asked = [f for f in facts if f.what == "open_kitchen" and room.id in f.a]
        if not asked or any(f.what in {"open", "merge"} and room.id in f.a + f.b for f in facts):
            continue
        social = [r for kind in ("living_room", "studio_room", "family_room", "dining_room") for r in stock.of(kind)]
        host = social[0] if social else stock.add("living_room", "", "", room.level)
        host.stated = host.stated and bool(social)
        draft.link(host.id, room.id, "open", asked[0], stated=bool(social))


def _link_rooms(draft: Draft, stock: Inventory, fact: Fact, facts: Sequence[Fact]) -> None:
    for a, b in pairs(fact.a, fact.b):
        kinds = {stock.get(a).type, stock.get(b).type}
        inner = bool({a, b} & stock.belongings)
        if inner and kinds & HALLS and len(fact.a) + len(fact.b) > 2:
            continue  # "two baths on the corridor, one en suite"
        kind = KINDS[fact.what]
        denied = any(f.what == "not_connected" and {a, b} <= {*f.a, *f.b} for f in facts)
        if fact.what == "near" and (inner or denied or len(kinds) == 1 or kinds <= {"bedroom", "office"}):
            kind = "wall"  # bedrooms next to each other share a wall, and somebody's own bath has no second door
        draft.link(a, b, "open" if "staircase" in kinds and fact.what != "wall" else kind, fact)


def _relate_rooms(draft: Draft, stock: Inventory, fact: Fact, facts: Sequence[Fact]) -> None:
    """Write what a fact says of rooms beside links."""
    a, what = fact.a[0] if fact.a else "", fact.what
    if what == "only":
        _only(draft, stock, fact, facts)
    elif what == "between" and len(fact.b) > 1:
        for room, end in itertools.product(fact.a, fact.b):
            draft.link(room, end, "any", fact)
            draft.relate("between", room, fact.b[0], 1.0, fact, fact.b[1])
    elif what in {"window", "no_window"}:
        _window(draft, stock, fact)
    elif what in {"not_open", "not_connected", "closed"}:
        others = tuple(r.id for kind in MERGE_ORDER for r in stock.of(kind) if r.id not in fact.a) if what == "closed" else fact.b
        for room, other in itertools.product(fact.a, others):
            draft.forbid("connected" if what == "not_connected" else "open", room, other, None, fact)
    elif what == "largest" and a:
        draft.relate("largest", a, stock.get(a).type, 1.0, fact)
    elif what == "largest_of_all":
        mine = stock.get(a)
        smaller = stock.of("bedroom") if mine.type == "bedroom" else [r for r in stock.rooms if r.stated and r.type not in ASIDE]
        for one in (r.id for r in smaller if r is not mine):
            draft.relate("area_order", a, one, 1.0, fact)
    elif what in {"area_equal", "area_order"}:
        for one, other in itertools.combinations(fact.a, 2) if what == "area_equal" else itertools.product(fact.a, fact.b):
            draft.relate(what, one, other, fact.value, fact)


def _only(draft: Draft, stock: Inventory, fact: Fact, facts: Sequence[Fact]) -> None:
    """Let a room have one door, and those to the rooms behind it."""
    for a in fact.a:
        if stock.get(a).type == "bedroom":  # rooms of its own may lie behind it
            continue
        behind = {i for f in facts if f.what in {"door", "own", "near"} and a in f.b for i in f.a}
        behind |= {i for f in facts if f.what == "leads" and a in f.a for i in f.b}
        ways = [f for f, g in itertools.pairwise(facts) if g is fact and f.what in {"door", "leads"} and a in f.a]
        doors = max(len(ways[-1].b) if ways and len(fact.a) == 1 else 1, 1)  # "only from the two children's rooms"
        draft.relate("degree", a, None, doors + len(behind - set(fact.a)), fact)


def _window(draft: Draft, stock: Inventory, fact: Fact) -> None:
    for room, wish in ((i, "required" if fact.what == "window" else "forbidden") for i in fact.a):
        draft.cite(fact.first, fact.last, f"rooms.{room}.window")
        if stock.get(room).window not in {"auto", wish}:
            words = draft.citations(f"rooms.{room}.window")
            raise ImpossibleError(f"{room} is to have a window and to have none", "keep one of the two", words)
        stock.get(room).window = wish


def _check_order(draft: Draft) -> None:
    """Refuse rooms each of which is to be larger than the other."""
    larger: dict[str, set[str]] = {}
    for r in draft.relations:
        if r["kind"] == "area_order" and r["value"] >= 1.0:
            larger.setdefault(r["a"], set()).add(r["b"])
    try:
        graphlib.TopologicalSorter(larger).prepare()
    except graphlib.CycleError as error:
        what = f"{error.args[1][0]} is to be larger than a room that is to be larger than it"
        raise ImpossibleError(what, "drop one of the two", draft.citations("relations.area_order")) from error


def _everything(draft: Draft, stock: Inventory, fact: Fact, facts: Sequence[Fact]) -> None:
    """Read "everything off a corridor": all rooms that hang on nothing yet."""
    fixed = [i for i in fact.a + fact.b if i[0] != "*"]
    if "*" not in fact.a + fact.b or fact.what not in {"door", "leads", "open", "near"} or not fixed:
        return
    left_out = {i for f in facts if f.what == "except" for i in f.a} | set(fixed)
    for room in list(stock.rooms):
        inner = bool(draft.neighbours(room.id)) and room.type in INNER
        if room.id not in left_out and not inner and room.type not in {*HALLS, "balcony", "staircase", "garage"}:
            draft.link(fixed[0], room.id, "open" if fact.what == "open" else "door", fact)
    if stock.get(fixed[0]).type in {*HALLS, "living_room"}:
        draft.relate("hub", fixed[0], None, 1.0, fact)


def _suites(draft: Draft, stock: Inventory, facts: Sequence[Fact]) -> None:
    """Give each suite a bathroom of its own, directly or through its closet; place en suites that nobody placed."""
    for fact, bed in ((f, stock.get(i)) for f in facts if f.what == "suite" for i in f.a):
        near = draft.neighbours(bed.id)
        reach = near | {j for i in near if stock.get(i).type == "closet" for j in draft.neighbours(i)}
        if not any(stock.get(i).type == "bathroom" for i in reach):
            levels = {r.level for r in stock.rooms} if bed.level is None else {None, bed.level}
            theirs = (r for r in stock.of("bathroom") if r.role in ENSUITE or (r.open_slot and r.level in levels))
            known = [r for r in theirs if not draft.neighbours(r.id)]
            bath = min(known, key=lambda r: not r.role) if known else stock.add("bathroom", "", "en suite", bed.level)
            bath.open_slot = False
            _give(draft, stock, bath.id, bed.id, fact)
            draft.cite(fact.first, fact.last, f"rooms.{bath.id}")
    for bath in (r for r in stock.of("bathroom") if r.role in ENSUITE and not draft.neighbours(r.id)):
        beds = [r for r in stock.of("bedroom") if r.role == "primary"] or stock.of("bedroom")
        beds = sorted(beds, key=lambda r: any(stock.get(i).type == "bathroom" for i in draft.neighbours(r.id)))
        if beds and (bath.role == "ensuite" or beds[0].role == "primary"):
            _give(draft, stock, bath.id, beds[0].id, Fact("own", (bath.id,), (beds[0].id,), 0.0, *(bath.span or (0, 1))))


def _zones(draft: Draft, state: Reading) -> None:
    """Write the zones, and that wings lie apart."""
    for name, (members, e) in state.zones.items():
        if ids := list(members) or state.inventory.zone(name):
            draft.zones.append({"name": name, "members": ids})
            draft.cite(e.first, e.last, f"zones.{name}")
    zones = {z["name"] for z in draft.zones}
    for a, b in itertools.pairwise(n for n in dict.fromkeys(state.wings) if n in zones):
        e = state.zones[b][1]
        draft.relate("separation", a, b, WINGS, Fact("away", (a,), (b,), 0.0, e.first, e.last))


def _apart(draft: Draft, state: Reading, fact: Fact) -> None:
    """Forbid common walls and ways, and ask for distance, where rooms are to be away from each other."""
    stock = state.inventory

    def expand(ids: Group) -> list[str]:
        zones = {f"*zone_{n}": list(members) or stock.zone(n) for n, (members, _) in state.zones.items()}
        return [x for i in ids for x in zones.get(i, [r.id for r in stock.rooms if not i[1:] or r.type == i[1:]] if i[0] == "*" else [i])]

    if fact.what == "no_through":  # no way to the rooms of all leads through some; their own bathrooms and closets may lie behind them
        for one in expand(fact.a):
            for room in stock.rooms:
                if room.id != one and room.type not in INNER and room.id not in draft.neighbours(one):
                    draft.forbid("through", room.id, None, one, fact)
    elif fact.what in {"away", "ban", "avoid"}:
        for a, b in itertools.product(expand(fact.a), expand(fact.b)):
            if a == b:
                continue
            if fact.what == "avoid":
                draft.forbid("through", a, None, b, fact)
                continue
            draft.forbid("adjacent", a, b, None, fact)
            if fact.what == "away":
                draft.relate("separation", a, b, OPPOSITE if "ends" in state.flags else FAR, fact)
