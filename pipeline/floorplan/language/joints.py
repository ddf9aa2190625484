"""Facts about rooms → links, prohibitions and relations between them."""

from __future__ import annotations

import itertools

from pipeline.floorplan.language.facts import HALLS, Draft, Fact, Group, Inventory, Reading
from pipeline.floorplan.program.consistency import ImpossibleError
from pipeline.floorplan.program.floor_program import Evidence

MERGE_ORDER = ("living_room", "family_room", "dining_room", "kitchen", "studio_room")
OPPOSITE, FAR, WINGS = 0.45, 0.35, 0.2  # "at the other end", "away from" and "in another wing", as shares of the diagonal
KINDS = {"door": "door", "leads": "door", "near": "any", "open": "open", "wall": "wall"}
ASIDE = {"balcony", "garage", "hallway", "staircase"}  # not meant when the largest room is spoken of
INNER = {"closet", "bathroom", "balcony", "storage", "wc", "utility", "garage"}


def pairs(a: Group, b: Group) -> list[tuple[str, str]]:
    """Return who is meant with whom: neighbours of one list, all with a single one, else one by one."""
    if not a or not b:
        return list(itertools.pairwise(a or b))
    if len(a) == 1 or len(b) == 1:
        return [(x, y) for x in a for y in b]
    if len(a) == len(b):
        return list(zip(a, b, strict=True))
    return [(x, b[0]) for x in a]


def join(draft: Draft, state: Reading) -> None:
    """Write all facts into the program."""
    stock, facts = state.inventory, state.facts
    _itself(draft, facts)
    _circle(draft, facts)
    _belongings(draft, stock, facts)
    _merged(draft, stock, facts)
    for fact in facts:
        if any(i.startswith(("*", "<")) for i in fact.a + fact.b):
            continue
        if fact.what in KINDS:
            _linked(draft, stock, fact, facts)
        else:
            _related(draft, stock, fact, facts)
    _ordered(draft)
    _everything(draft, stock, facts)
    _suites(draft, stock, facts)
    _apart(draft, state)


def _itself(draft: Draft, facts: list[Fact]) -> None:
    """Refuse a room that is to be reached through itself."""
    for fact in facts:
        if fact.what == "itself" and fact.a:
            draft.cite(fact.first, fact.last, f"links.{fact.a[0]}-{fact.a[0]}")
            words = [Evidence.model_validate(draft.evidence[-1])]
            raise ImpossibleError(f"{fact.a[0]} cannot be reached through itself", "say what it opens off", words)


def _circle(draft: Draft, facts: list[Fact]) -> None:
    """Refuse rooms each of which is to be reached only through the other."""
    hosts: dict[str, tuple[str, Fact]] = {}
    for way, only in itertools.pairwise(facts):
        if only.what == "only" and way.what == "door" and way.a == only.a and len(way.b) == 1:
            hosts |= dict.fromkeys(way.a, (way.b[0], way))
    for start in hosts:
        seen, here = [start], hosts[start][0]
        while here in hosts and here not in seen:
            seen.append(here)
            here = hosts[here][0]
        if here == start and len(seen) > 1:
            before = len(draft.evidence)
            for name in seen:
                draft.cite(hosts[name][1].first, hosts[name][1].last, f"links.{name}-{hosts[name][0]}")
            words = [Evidence.model_validate(e) for e in draft.evidence[before:]]
            raise ImpossibleError(f"{' and '.join(seen)} are each to be reached only through the other", "say what one opens off", words)


def _belongings(draft: Draft, stock: Inventory, facts: list[Fact]) -> None:
    """Join each room to the one it belongs to: own bathrooms, en suites, kitchens open to a social room."""
    for fact in facts:
        if fact.what == "own":
            owners = fact.b if len(fact.b) == len(fact.a) else fact.b[:1] * len(fact.a)
            if not owners:
                continue
            for thing, owner in zip(fact.a, owners, strict=True):
                if not _behind(facts, thing, owner):
                    _give(draft, stock, thing, owner, fact)
        elif fact.what == "ensuite":
            rooms = [stock.get(i) for i in fact.b if not i.startswith("*")]
            baths = [r for r in rooms if r.type == "bathroom"]
            beds = [r for r in rooms if r.type == "bedroom"]
            hosts = [r for r in stock.of("bedroom") if r.role == "primary"] or stock.of("bedroom")
            for k, room in enumerate(baths or beds):
                if room.type == "bathroom" and hosts:
                    near = [r for r in hosts if not _has_bath(draft, stock, r.id)] or hosts
                    _give(draft, stock, room.id, near[0].id, fact)
                elif room.type == "bedroom":
                    slots = [r for r in stock.of("bathroom") if (r.open_slot or r.whole) and not r.role and not draft.linked(r.id)]
                    loose = [r for r in stock.of("bathroom") if r.role == "ensuite" and not draft.linked(r.id)]
                    bath = (loose or slots or [stock.add("bathroom", "", "en suite", room.level)])[0]
                    bath.open_slot = False
                    _give(draft, stock, bath.id, room.id, fact)
                    draft.cite(fact.first, fact.last, f"rooms.{bath.id}")
                del k


def _behind(facts: list[Fact], thing: str, owner: str) -> bool:
    """Whether a room is reached only through another one of its owner's: "with closet and bath: you reach the bath only through the closet"."""
    for way, only in itertools.pairwise(facts):
        if only.what == "only" and way.what == "door" and thing in way.a and only.a == way.a and owner not in way.b:
            return any(f.what == "own" and owner in f.b and set(way.b) & set(f.a) for f in facts)
    return False


def _has_bath(draft: Draft, stock: Inventory, bed: str) -> bool:
    return any(stock.get(i).type == "bathroom" for i in draft.linked(bed))


def _give(draft: Draft, stock: Inventory, thing: str, owner: str, fact: Fact) -> None:
    draft.link(owner, thing, "door", fact)
    stock.belongings.add(thing)
    if stock.get(thing).type in {"bathroom", "wc"} and stock.get(owner).type != "hallway":
        draft.relate("degree", thing, None, 1.0, fact)
        if stock.get(owner).type == "bedroom":
            draft.relate("ensuite", thing, owner, 1.0, fact)


def _merged(draft: Draft, stock: Inventory, facts: list[Fact]) -> None:
    for fact in facts:
        if fact.what == "merge":
            chain = sorted(fact.a, key=lambda i: MERGE_ORDER.index(stock.get(i).type) if stock.get(i).type in MERGE_ORDER else 9)
            for a, b in itertools.pairwise(chain):
                draft.link(a, b, "open", fact)
    for room in stock.of("kitchen"):
        asked = [f for f in facts if f.what == "open_kitchen" and room.id in f.a]
        stated = any(f.what in {"open", "merge"} and room.id in f.a + f.b for f in facts)
        if asked and not stated:
            social = [r for kind in ("living_room", "studio_room", "family_room", "dining_room") for r in stock.of(kind)]
            if social:
                draft.link(social[0].id, room.id, "open", asked[0])
            else:
                made = stock.add("living_room", "", "", room.level)
                made.stated = False
                draft.link(made.id, room.id, "open", asked[0])
                draft.links[min(made.id, room.id), max(made.id, room.id)]["stated"] = False


def _linked(draft: Draft, stock: Inventory, fact: Fact, facts: list[Fact]) -> None:
    owned = stock.belongings
    for a, b in pairs(fact.a, fact.b):
        if fact.what == "door" and len(fact.b) > 1 and draft.linked(a) & set(fact.b) and len(fact.a) > 1:
            continue
        halls = HALLS & {stock.get(a).type, stock.get(b).type}
        inner = next((i for i in (a, b) if i in owned), None)
        if inner and halls and len(fact.a) + len(fact.b) > 2:
            continue  # "two baths on the corridor, one en suite"
        kind = "wall" if fact.what == "near" and {a, b} & owned else KINDS[fact.what]  # somebody's own bath has no second door
        if fact.what == "near" and (
            stock.get(a).type == stock.get(b).type or {stock.get(a).type, stock.get(b).type} <= {"bedroom", "office"}
        ):
            kind = "wall"  # bedrooms next to each other share a wall, no door
        if (
            fact.what == "leads"
            and {stock.get(a).type, stock.get(b).type} <= {"kitchen", "dining_room", "living_room"}
            and len(fact.b) == 1
        ):
            kind = "door"
        if fact.what == "near" and any(f.what == "not_connected" and {a, b} <= {*f.a, *f.b} for f in facts):
            kind = "wall"  # "the library adjoins the bedroom but has no door to it"
        stairs = "staircase" in {stock.get(a).type, stock.get(b).type}
        draft.link(a, b, "open" if stairs and fact.what != "wall" else kind, fact)


def _related(draft: Draft, stock: Inventory, fact: Fact, facts: list[Fact]) -> None:  # noqa: C901, PLR0912 - one branch per kind of fact
    what = fact.what
    if what == "between" and len(fact.b) >= 2:
        for a in fact.a:
            for b in fact.b:
                draft.link(a, b, "any", fact)
            draft.relate("between", a, fact.b[0], 1.0, fact, fact.b[1])
    elif what == "only":
        for a in fact.a:
            if stock.get(a).type != "bedroom":  # rooms of its own may lie behind it
                behind = {
                    i
                    for f in facts
                    for i in (f.a if f.what in {"door", "own", "near"} and a in f.b else f.b if f.what == "leads" and a in f.a else ())
                }
                ways = [f for f, g in itertools.pairwise(facts) if g is fact and f.what in {"door", "leads"} and a in f.a]
                doors = max(len(ways[-1].b) if ways and len(fact.a) == 1 else 1, 1)  # "only from the two children's rooms"
                draft.relate("degree", a, None, doors + len(behind - set(fact.a)), fact)
    elif what == "largest" and fact.a:
        draft.relate("largest", fact.a[0], stock.get(fact.a[0]).type, 1.0, fact)
    elif what == "smallest" and fact.a:
        for b in fact.b:
            if b != fact.a[0]:
                draft.relate("area_order", b, fact.a[0], 1.0, fact)
    elif what in {"largest_of_all", "smallest_of_all"}:
        mine = stock.get(fact.a[0])
        others = [r for r in stock.rooms if r.id != mine.id and r.stated and (r.type not in ASIDE or what == "smallest_of_all")]
        for other in (r for r in others if mine.type != "bedroom" or r.type == "bedroom"):
            a, b = (mine.id, other.id) if what == "largest_of_all" else (other.id, mine.id)
            draft.relate("area_order", a, b, 1.0, fact)
    elif what == "area_order":
        for a, b in itertools.product(fact.a, fact.b):
            draft.relate("area_order", a, b, fact.value, fact)
    elif what == "area_equal":
        for a, b in itertools.combinations(fact.a, 2):
            draft.relate("area_equal", a, b, fact.value, fact)
    elif what in {"window", "no_window"}:
        for a in fact.a:
            wish = "required" if what == "window" else "forbidden"
            draft.cite(fact.first, fact.last, f"rooms.{a}.window")
            if stock.get(a).window not in {"auto", wish}:
                words = [Evidence.model_validate(e) for e in draft.evidence if e["field"] == f"rooms.{a}.window"]
                raise ImpossibleError(f"{a} is to have a window and to have none", "keep one of the two", words)
            stock.get(a).window = wish
    elif what == "closed":
        for room in (r for kind in MERGE_ORDER for r in stock.of(kind) if r.id not in fact.a):
            draft.forbid("open", fact.a[0], room.id, None, fact.first, fact.last)
    elif what in {"not_open", "not_connected"}:
        for a, b in itertools.product(fact.a, fact.b):
            draft.forbid("open" if what == "not_open" else "connected", a, b, None, fact.first, fact.last)


def _ordered(draft: Draft) -> None:
    """Refuse rooms each of which is to be larger than the other."""
    larger: dict[str, set[str]] = {}
    for r in draft.relations:
        if r["kind"] == "area_order" and r["value"] >= 1.0:
            larger.setdefault(r["a"], set()).add(r["b"])
    for start, below in larger.items():
        seen: set[str] = set()
        here = set(below)
        while here and start not in here:
            seen |= here
            here = {b for a in here for b in larger.get(a, ())} - seen
        if start in here:
            words = [Evidence.model_validate(e) for e in draft.evidence if e["field"].startswith("relations.area_order")]
            raise ImpossibleError(f"{start} is to be larger than a room that is to be larger than it", "drop one of the two", words)


def _everything(draft: Draft, stock: Inventory, facts: list[Fact]) -> None:
    """Read "everything off a corridor": all rooms that hang on nothing yet."""
    left_out = {i for f in facts if f.what == "except" for i in f.a}
    for fact in facts:
        stars = [i for i in fact.a + fact.b if i == "*"]
        if not stars or fact.what not in {"door", "leads", "open", "near"}:
            continue
        fixed = [i for i in fact.a + fact.b if not i.startswith("*")]
        for room in list(stock.rooms):
            if not fixed or room.id in fixed or room.id in left_out:
                continue
            inner = draft.linked(room.id) and room.type in INNER
            if not inner and room.type not in HALLS | {"balcony", "staircase", "garage"}:
                draft.link(fixed[0], room.id, "open" if fact.what == "open" else "door", fact)
        if fixed and stock.get(fixed[0]).type in HALLS | {"living_room"}:
            draft.relate("hub", fixed[0], None, 1.0, fact)


def _suites(draft: Draft, stock: Inventory, facts: list[Fact]) -> None:
    """Give each suite a bathroom of its own, directly or through its closet; place en suites that nobody placed."""
    for fact in facts:
        for bed in fact.a if fact.what == "suite" else ():
            near = draft.linked(bed)
            reach = near | {j for i in near if stock.get(i).type == "closet" for j in draft.linked(i)}
            if any(stock.get(i).type == "bathroom" for i in reach):
                continue
            loose = [r for r in stock.of("bathroom") if not draft.linked(r.id) and r.role in {"ensuite", "primary"}]
            level = stock.get(bed).level
            slots = [
                r for r in stock.of("bathroom") if r.open_slot and not draft.linked(r.id) and (level is None or r.level in {None, level})
            ]
            bath = (loose or slots or [stock.add("bathroom", "", "en suite", stock.get(bed).level)])[0]
            bath.open_slot = False
            _give(draft, stock, bath.id, bed, fact)
            draft.cite(fact.first, fact.last, f"rooms.{bath.id}")
    for bath in stock.of("bathroom"):
        if bath.role in {"ensuite", "primary"} and not draft.linked(bath.id):
            beds = [r for r in stock.of("bedroom") if r.role == "primary"] or stock.of("bedroom")
            free = [r for r in beds if not _has_bath(draft, stock, r.id)] or beds
            if free and (bath.role == "ensuite" or free[0].role == "primary"):
                _give(draft, stock, bath.id, free[0].id, Fact("own", (bath.id,), (free[0].id,), 0.0, *(bath.span or (0, 1))))


def _apart(draft: Draft, state: Reading) -> None:  # noqa: C901, PLR0912 - one branch per case: a grammar
    """Forbid common walls and ways, and ask for distance, where rooms are to be away from each other."""
    stock = state.inventory
    share = OPPOSITE if "ends" in state.flags else FAR

    def expand(ids: Group) -> list[str]:
        made: list[str] = []
        for i in ids:
            if i.startswith("*zone_"):
                members = state.zones[i[6:]][0]
                made += members or late_zone(stock, i[6:])
            elif i.startswith("*"):
                made += [r.id for r in stock.rooms if not i[1:] or r.type == i[1:]]
            else:
                made.append(i)
        return made

    for name, (members, e) in state.zones.items():
        ids = list(members) or late_zone(stock, name)
        if ids:
            draft.zones.append({"name": name, "members": ids})
            draft.cite(e.first, e.last, f"zones.{name}")
    zones = {z["name"] for z in draft.zones}
    for a, b in itertools.pairwise(n for n in dict.fromkeys(state.wings) if n in zones):
        e = state.zones[b][1]
        draft.relate("separation", a, b, WINGS, Fact("away", (a,), (b,), 0.0, e.first, e.last))
    for fact in state.facts:
        if fact.what == "no_ensuite":
            for bed in (r for r in stock.of("bedroom") if not fact.b or r.id in fact.b):
                for bath in stock.of("bathroom"):
                    draft.forbid("connected", bath.id, bed.id, None, fact.first, fact.last)
        if fact.what == "no_through":
            _no_way(draft, stock, expand(fact.a), fact)
        if fact.what not in {"away", "ban", "avoid"}:
            continue
        for a, b in itertools.product(expand(fact.a), expand(fact.b)):
            if a == b:
                continue
            if fact.what == "avoid":
                draft.forbid("through", a, None, b, fact.first, fact.last)
                continue
            draft.forbid("adjacent", a, b, None, fact.first, fact.last)
            if fact.what == "away":
                draft.relate("separation", a, b, share, fact)


def _no_way(draft: Draft, stock: Inventory, ids: list[str], fact: Fact) -> None:
    """Let no way to the rooms of all lead through some; their own bathrooms and closets may lie behind them."""
    for bed in ids:
        for room in stock.rooms:
            if room.id != bed and room.type not in INNER and room.id not in draft.linked(bed):
                draft.forbid("through", room.id, None, bed, fact.first, fact.last)


def late_zone(stock: Inventory, name: str) -> list[str]:
    """Return the rooms of a zone that was named before they were."""
    kinds = {"bedroom": {"bedroom"}, "living": {"living_room", "dining_room", "family_room"}, "work": {"office", "meeting_room"}}
    return [r.id for r in stock.rooms if r.type in kinds.get(name, ()) or (r.type == "bedroom" and r.role == name)]
