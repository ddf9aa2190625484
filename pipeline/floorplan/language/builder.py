"""What was read → the program: its rooms, amounts, storeys, outline, style, and evidence."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pipeline.floorplan.language.lexicon import kinds
from pipeline.floorplan.language.room_links import Draft, join
from pipeline.floorplan.language.rooms import HALLS, Fact, Inventory, Named, Reading
from pipeline.floorplan.language.tokens import Token
from pipeline.floorplan.program.consistency import ImpossibleError
from pipeline.floorplan.program.defaults import DEFAULTS
from pipeline.floorplan.program.floor_program import MOST_ASPECT, Accessibility, FloorProgram, Shell, Style

ABOUT = 0.1  # "about 75 m2" allows this much either way
SAME = 0.02  # two totals that differ by less are one, said twice
MOST_STOREYS, MOST_PEOPLE, MOST_COUNTED = 3, 8, 9
PANORAMA = 8.5  # outside wall of a living room with panoramic glazing [m]
LUXURY = 1.3
WIDTHS = (1.0, 20.0)  # of a room [m]
NARROW = {"min_aspect": 1.5, "max_aspect": 2.1}
OUTLINES: Mapping[str, dict[str, Any]] = {"shape_l": {"shape": "L"}, "shape_t": {"shape": "T"}, "rectangle": {"shape": "rectangle"}, "narrow": NARROW, "chamfered": {"corners": "chamfered"}}  # fmt: skip
SHELL = {"ceiling": ("ceiling",), "walls": ("inner_wall", "outer_wall"), "inner_walls": ("inner_wall",), "outer_walls": ("outer_wall",)}
MEASURED = {**SHELL, "doors": ("min_door",), "corridors": ("min_corridor",)}  # what has a length, and its fields of the program
SMALL = kinds("small")
BESIDES = kinds("besides")
HOUSE = 2  # bedrooms of a house of which nothing is said
STRANGERS = {"guest", "elder", "carer", "staff"}  # whose bedrooms are beside those of the people who live there
LIVED = kinds("lived")
GROUND = kinds("ground")
SORTS = kinds("sorts")


def assemble(state: Reading, parsed: list[list[Token]]) -> FloorProgram:
    """Return the program of what was read; nothing is filled in."""
    draft, stock = Draft(state.words), state.inventory
    _count(draft, state)
    _studio(draft, state)
    for kind, e in state.banned:
        if not (kind in SORTS and any(r.surface and r.surface != e.text for r in stock.of(kind))):  # "no cellar but a pantry"
            draft.forbid("room_type", kind, None, None, Fact("ban", (), (), 0.0, e.first, e.last))
    join(draft, state)
    _amounts(draft, state)
    _whole(draft, state)
    _style(draft, state)
    if state.entrance:
        into, e = state.entrance
        draft.fields["entrance"] = {"into": into, "stated": True}
        draft.cite(e.first, e.last, "entrance.into")
    if state.outside:
        owner, e = state.outside
        theirs = [r.id for kind in ("kitchen", "bedroom") for r in stock.of(kind) if r.role in STRANGERS]
        draft.fields["entrance"] = {**draft.fields.get("entrance", {}), "separate": [i for i in (*theirs, owner) if i][:1]}
        draft.cite(e.first, e.last, "entrance.separate")
    named, known = Draft(state.words), {r.id for r in stock.rooms}
    for e in (e for s in parsed for e in s if e.kind in {"np", "pron", "det"} and e.last > e.first):
        for i in (i for i in e.ids if i in known):
            named.cite(e.first, e.last, f"rooms.{i}")
    return FloorProgram.model_validate(
        {
            **draft.fields,
            "rooms": [_room(r) for r in stock.rooms],
            "links": list(draft.links.values()),
            "forbids": draft.forbids,
            "relations": draft.relations,
            "zones": draft.zones,
            "language": state.words.lexicon.language,
            "evidence": [*named.evidence, *draft.evidence],
        }
    )


def _room(room: Named) -> dict[str, Any]:
    area: dict[str, Any] = {"min": room.low, "max": room.high, "target": room.target}
    stated = any(v is not None for v in area.values())
    if not stated and room.size != 1.0:
        area["target"] = round(DEFAULTS[room.type].area * room.size, 2)
    own = {f: getattr(room, f) for f in ("id", "stated", "type", "level", "exterior_length", "window", "min_width")}
    role = "" if room.role == "ensuite" else room.role
    own["furniture"] = {"counts": [{"category": f, "min": 1} for f in room.functions if f == "shower"]}  # "a shower room"
    return own | {"role": role, "functions": tuple(sorted(room.functions - {"shower"})), "area": area | {"stated": stated}}


# how many rooms


def _count(draft: Draft, state: Reading) -> None:
    """Make as many rooms as a number of rooms says: "a three-room flat", counted as people do where the language is spoken."""
    stock = state.inventory
    if state.rooms is None:
        if state.people is not None and state.studio is None:
            _bedrooms(draft, state, state.people)
        elif _is_house(state):
            _sleepers(state.inventory, HOUSE)
        return
    count, token = state.rooms
    draft.cite(token.first, token.last, "rooms")
    lex = state.words.lexicon
    usual = "counts_living_rooms" in lex.traits  # there "three rooms" is how one says what is to live and to sleep in
    # elsewhere "six rooms: three bedrooms, ..." lists all, but "three rooms, kitchen, bath" does not
    listed = any(token.text.endswith(t) for t in lex.sign("all_rooms")) if usual else count <= len(stock.rooms)
    if count <= MOST_COUNTED and not listed:
        known = list(stock.rooms)
        _living_rooms(draft, state, count, token)
        for room in stock.rooms:
            room.stated &= usual or room in known
    elif count > 1:
        while sum(r.type not in BESIDES for r in stock.rooms) < count and len(stock.rooms) != count:
            kind = next((k for k in ("living_room", "kitchen", "bathroom") if not stock.of(k)), "bedroom")
            stock.add(kind, "", "room", None).stated = False
        draft.fields["only"] = True


def _bedrooms(draft: Draft, state: Reading, people: Token) -> None:
    """Add the bedrooms that so many people take, of which nobody stated how many there are: one for each who shares a flat, one for two where so many sleep, else one for two and one for each of the others."""
    beside = {"children": 1, "sharers": 0, "sleepers": -int(people.number) // 2}.get(people.value, -1)
    if _sleepers(state.inventory, max(1, min(int(people.number) + beside, MOST_PEOPLE - 1))):
        draft.cite(people.first, people.last, "rooms")


def _is_house(state: Reading) -> bool:
    """Whether the home is a house, which one room to live and sleep in is not, of which neither floor nor rooms are said to be all."""
    house = state.words.lexicon.sign("house")
    bounded = "closed" in state.flags or any(rooms is None and token.value == "area" for token, rooms in state.amounts)
    return bool(state.homes) and all(e.text in house for e in state.homes) and not bounded


def _sleepers(stock: Inventory, wanted: int) -> bool:
    """Add bedrooms until there are so many, children's included, where no other is stated; return whether."""
    if stock.of("studio_room") or any(r.role not in {"child", *STRANGERS} for r in stock.of("bedroom")):
        return False
    for _ in range(wanted - sum(r.role == "child" for r in stock.of("bedroom"))):
        stock.add("bedroom", "", "", None).stated = False
    return True


def _living_rooms(draft: Draft, state: Reading, count: int, token: Token) -> None:
    """Count rooms to live and sleep in: three are a living room and two bedrooms; one is a studio."""
    stock = state.inventory
    beds = [r for r in stock.of("bedroom") if r.stated]
    if len(beds) > count:
        what = f"{len(beds)} bedrooms are asked for in a home of {count} rooms"
        draft.refuse(what, "keep one of the two counts", [(token.first, token.last), *(r.span for r in beds)])
    if count == 1 and not stock.of("bedroom"):
        state.studio = state.studio or (state.homes[0] if state.homes else None)
        if not stock.of("studio_room") and not stock.of("living_room"):
            stock.add("studio_room", "", "studio", None)
        return
    if "living_room" not in {kind for kind, _ in state.banned} and not stock.of("living_room") and not stock.of("studio_room"):
        stock.add("living_room", "", "", None)
    while sum(r.type in LIVED for r in stock.rooms) < count:
        stock.add("bedroom", "", "", None, open_slot=True)


def _studio(draft: Draft, state: Reading) -> None:
    """Make a studio without a named main room one room to live and sleep in."""
    stock, home = state.inventory, state.studio
    theirs = [r for r in stock.of("bedroom") if r.role not in STRANGERS]  # "a studio with a guest room" is both
    if home is not None and not stock.of("studio_room") and not theirs:
        living = stock.of("living_room")
        room = living[0] if living else stock.add("studio_room", "", "studio", 0)
        room.type, room.span = "studio_room", room.span or (home.first, home.last)
        if not stock.of("kitchen"):
            room.functions.add("cooking")
    beds = [r for r in theirs if r.open_slot or r.stated]
    if home is not None and len(beds) > 1:
        spans = [(home.first, home.last), *(r.span for r in beds)]
        draft.refuse(f"a studio is one room, and {len(beds)} bedrooms are asked for", "ask for a flat", spans)
    for room in stock.of("studio_room"):
        room.functions |= {"living", "sleeping"}


# amounts


def _amounts(draft: Draft, state: Reading) -> None:
    """Attach areas, widths and heights."""
    for token, ids in state.amounts:
        rooms = [state.inventory.get(i) for i in ids or () if i[0] != "*"]
        if ids == ("*",):
            rooms = [r for r in state.inventory.rooms if r.type not in SMALL or token.bound == "most"]
        if token.value == "area" and token.number > 0:
            for room in rooms:
                _area(draft, token, room)
            if not rooms:
                _total(draft, token)
        elif token.value in MEASURED or (token.value == "length" and rooms):
            _length(draft, token, rooms)


def _range(token: Token) -> dict[str, float]:
    if token.high is not None:
        return {"min": token.number, "max": token.high}
    return {{"least": "min", "most": "max"}.get(token.bound, "target"): token.number}


def _area(draft: Draft, token: Token, room: Named) -> None:
    box = _range(token)
    room.low, room.high, room.target = box.get("min", room.low), box.get("max", room.high), box.get("target", room.target)
    room.min_width = token.side if token.side is not None else room.min_width
    draft.cite(token.first, token.last, f"rooms.{room.id}.area")


def _total(draft: Draft, token: Token) -> None:
    box = _range(token)
    if "target" in box:
        box |= {"min": box["target"] * (1 - ABOUT), "max": box["target"] * (1 + ABOUT)}
    old = draft.fields.get("total_area", {})
    draft.cite(token.first, token.last, "total_area")
    if token.side is not None:  # "8 m by 12 m"
        _sides(draft, token, token.number / token.side**2)
    low = max((x for x in (old.get("min"), box.get("min")) if x is not None), default=None)
    high = min((x for x in (old.get("max"), box.get("max")) if x is not None), default=None)
    if low is not None and high is not None and low > high * (1 + SAME):
        raise ImpossibleError("two total areas are asked for", "keep one of the two", draft.citations("total_area"))
    draft.fields["total_area"] = {**(old or box), "min": low, "max": high, "stated": True}


def _sides(draft: Draft, token: Token, aspect: float) -> None:
    """Give the home the outline of its sides. Refuses one that is too narrow."""
    if aspect > MOST_ASPECT:
        advice = f"ask for a longer side of at most {MOST_ASPECT:g} times the shorter"
        draft.refuse(f"a home {aspect:.1f} times as long as wide", advice, [(token.first, token.last)], "footprint")
    around = {"min_aspect": max(aspect / (1 + SAME), 1.0), "max_aspect": min(aspect * (1 + SAME), MOST_ASPECT)}
    draft.fields["footprint"] = {**around, "stated": True}


def _length(draft: Draft, token: Token, rooms: Sequence[Named]) -> None:
    """Note a length. Refuses one that nothing of its kind has; "at least" less than the least is met by that."""
    what = "corridors" if token.value == "length" and any(r.type in HALLS for r in rooms) else token.value
    part = "shell" if what in SHELL else "accessibility" if what in MEASURED else "rooms"
    known = (Shell.model_fields | Accessibility.model_fields)[MEASURED[what][0]].metadata if what in MEASURED else ()
    low, high = (known[0].ge, known[1].le) if known else WIDTHS
    if token.number > high or (token.number < low and token.bound != "least"):
        name = what.replace("_", " ") if known else "a room"
        draft.refuse(f"{name} of {token.number:g} m", f"ask for {low:g} to {high:g} m", [(token.first, token.last)], part)
    for field in MEASURED.get(what, ()):
        draft.cite(token.first, token.last, f"{part}.{field}")
        draft.fields.setdefault(part, {}).update({field: max(token.number, low)} | ({"stated": True} if what in SHELL else {}))
    for room in () if known else rooms:
        room.min_width = max(token.number, low)
        draft.cite(token.first, token.last, f"rooms.{room.id}.min_width")


# the whole home


def _whole(draft: Draft, state: Reading) -> None:
    """Read what concerns the whole home."""
    stock, flags, fields = state.inventory, state.flags, draft.fields
    _levels(state)
    storeys = max(state.storeys[0] if state.storeys else 1, *(r.level + 1 for r in stock.rooms if r.level is not None), 1)
    said = [(state.storeys[1].first, state.storeys[1].last)] if state.storeys else []
    for first, last in (*said, *((e.first, e.last) for e in state.levels)):
        draft.cite(first, last, "storeys")
    if storeys > MOST_STOREYS:
        draft.refuse(f"{storeys} storeys are asked for", f"ask for {MOST_STOREYS} at most", said, "storeys")
    bungalow = state.words.lexicon.sign("bungalow")
    single = [e for e in (flags.get("single"), *state.homes) if e is not None and (e.kind == "flag" or e.text in bungalow)]
    above = [(e.first, e.last) for e in state.levels if e.value != "0"] or said
    if storeys > 1 and single and above:
        spans = [(single[0].first, single[0].last), *above]
        draft.refuse("a home of one storey has nothing upstairs", "ask for two storeys", spans, "storeys")
    fields["storeys"] = storeys
    for room in stock.rooms if storeys == 1 else ():
        room.level = 0

    def stated(flag: str, field: str) -> bool:
        if flag in flags:
            draft.cite(flags[flag].first, flags[flag].last, field)
        return flag in flags

    fields |= {"only": True} if stock.rooms and stated("closed", "only") else {}
    fields |= {"scale": LUXURY} if stated("luxury", "scale") else {}
    if "no_hall" in flags:
        draft.forbid("room_type", "hallway", None, None, Fact("ban", (), (), 0.0, flags["no_hall"].first, flags["no_hall"].last))
    sides = fields.get("footprint", {})
    for flag, outline in OUTLINES.items():
        if stated(flag, "footprint"):
            fields["footprint"] = {**fields.get("footprint", {}), **outline, **sides, "stated": True}
    access = fields.setdefault("accessibility", {})
    for flag in ("wheelchair", "step_free", "single"):
        access |= {"step_free": True} if stated(flag, "accessibility.step_free") else {}
    if "wheelchair" in flags:
        access |= {"min_door": max(access.get("min_door", 0.9), 0.9), "min_corridor": max(access.get("min_corridor", 1.2), 1.2)}
    for room in stock.of("living_room")[:1]:
        room.exterior_length = PANORAMA if stated("panorama", f"rooms.{room.id}.exterior_length") else None


def _levels(state: Reading) -> None:
    """Put zones, and what is spoken of as the rest, on their storey."""
    rooms, said = state.inventory.rooms, {e.first for e in state.levels}
    if all(r.level for r in rooms):
        # "front room, kitchen, two bedrooms and a bathroom above": not all of the list, but what stands next to the word
        for room in rooms:
            next_to = room.span is not None and room.span[1] in said
            room.level = None if room.type in GROUND and not next_to else room.level
    for name, level in sorted(state.heights.items(), key=lambda h: h[0] == "*"):
        zone = state.zones[name][0] or state.inventory.zone(name) if name in state.zones else ()
        for room in rooms:
            if room.id in zone or (name == "*" and room.level is None and room.type != "staircase"):
                room.level = level


def _style(draft: Draft, state: Reading) -> None:
    """Set the scale from "a small house" (each of its rooms is so, by less), the style's knobs from words of mood and light."""
    for e in (e for e in state.homes if e.number):
        draft.fields.setdefault("scale", round(math.sqrt(e.number or 1.0), 2))
        draft.cite(e.first, e.last, "scale")
    knobs: dict[str, int] = {}
    for e in state.looks:
        look = state.words.lexicon.looks[int(e.value)]
        knobs |= {knob: value for knob, value in look.knobs.items() if abs(value) > abs(knobs.get(knob, 0))}
        if look.nonrect:
            draft.fields["nonrect"] = look.nonrect
        draft.cite(e.first, e.last, "style")
    if {"wheelchair", "step_free", "single"} & set(state.flags):
        knobs.setdefault("min_width", 2)
    if knobs:
        draft.fields["style"] = Style.model_validate(knobs).model_dump()


@dataclass(frozen=True, slots=True)
class Mention:
    """Words of the prompt that name rooms."""

    start: int
    end: int
    ids: tuple[str, ...]


def room_mentions(program: FloorProgram) -> list[Mention]:
    """Return where the prompt names rooms, in its order."""
    by_span: dict[tuple[int, int], list[str]] = {}
    ids = {r.id for r in program.rooms}
    for e in program.evidence:
        room = e.field.removeprefix("rooms.")
        if e.field.startswith("rooms.") and room in ids:
            by_span.setdefault((e.start, e.end), []).append(room)
    return [Mention(start, end, tuple(dict.fromkeys(rooms))) for (start, end), rooms in sorted(by_span.items())]
