"""Amounts and marks of the whole home: areas, widths, outline, style."""

from __future__ import annotations

from typing import Any

from pipeline.errors import RefusedError
from pipeline.floorplan.language.facts import HALLS, Draft, Named, Reading
from pipeline.floorplan.language.joints import late_zone
from pipeline.floorplan.language.marks import Mark
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.text import spread
from pipeline.floorplan.program.consistency import ImpossibleError
from pipeline.floorplan.program.floor_program import MAX_ROOMS, Evidence, Style

ABOUT = 0.1  # "about 75 m2" allows this much either way
SAME = 0.02  # two totals that differ by less are one, said twice

SMALL = {"wc", "hallway", "entry", "storage", "closet", "balcony", "staircase", "bathroom", "utility"}  # not meant by "every room at least"


def attach(draft: Draft, state: Reading) -> None:
    """Attach amounts: areas and widths."""
    stock = state.inventory
    for mark, ids in state.amounts:
        rooms = [stock.get(i) for i in ids or () if not i.startswith("*")]
        if ids == ("*",):
            rooms = [r for r in stock.rooms if r.type not in SMALL or mark.bound == "most"]
        if mark.value == "area" and mark.number > 0:
            _area(draft, mark, rooms)
        elif mark.value in SHELL:
            _shell(draft, mark)
        elif mark.value in {"length", "doors", "corridors"}:
            _length(draft, mark, rooms)


def _area(draft: Draft, mark: Mark, rooms: list[Named]) -> None:
    box = _range(mark)
    for k, room in enumerate(rooms):
        if mark.parts:
            box = {"target": mark.parts[min(k, len(mark.parts) - 1)]}
        room.low, room.high, room.target = box.get("min", room.low), box.get("max", room.high), box.get("target", room.target)
        if mark.side is not None:
            room.min_width = mark.side
        draft.cite(mark.first, mark.last, f"rooms.{room.id}.area")
        if room.low is not None and room.high is not None and room.low > room.high:
            words = [Evidence.model_validate(e) for e in draft.evidence if e["field"] == f"rooms.{room.id}.area"]
            raise ImpossibleError(f"{room.id} is to have at least {room.low:g} and at most {room.high:g} m²", "keep one of the two", words)
    if rooms:
        return
    made = _whole_range(box)
    old = draft.fields.get("total_area")
    draft.cite(mark.first, mark.last, "total_area")
    if old is None:
        draft.fields["total_area"] = made
        return
    low, high = (
        max((x for x in (old.get("min"), made.get("min")) if x is not None), default=None),
        min((x for x in (old.get("max"), made.get("max")) if x is not None), default=None),
    )
    if low is not None and high is not None and low > high * (1 + SAME):
        words = [Evidence.model_validate(e) for e in draft.evidence if e["field"] == "total_area"]
        raise ImpossibleError("two total areas are asked for", "keep one of the two", words)
    draft.fields["total_area"] = {**old, "min": low, "max": high}


def _range(mark: Mark) -> dict[str, float]:
    if mark.high is not None:
        return {"min": mark.number, "max": mark.high}
    if mark.bound == "least":
        return {"min": mark.number}
    return {"max": mark.number} if mark.bound == "most" else {"target": mark.number}


def _whole_range(box: dict[str, float]) -> dict[str, Any]:
    if "target" in box:
        return {"target": box["target"], "min": box["target"] * (1 - ABOUT), "max": box["target"] * (1 + ABOUT), "stated": True}
    return {**box, "stated": True}


SHELL = {"ceiling": ("ceiling",), "walls": ("inner_wall", "outer_wall"), "inner_walls": ("inner_wall",), "outer_walls": ("outer_wall",)}


def _shell(draft: Draft, mark: Mark) -> None:
    """Set the height of rooms or the thickness of walls; what no home has is refused with the words."""
    for field in SHELL[mark.value]:
        draft.cite(mark.first, mark.last, f"shell.{field}")
        low, high = LIMITS[field]
        if not low <= mark.number <= high:
            words = [Evidence.model_validate(draft.evidence[-1])]
            raise ImpossibleError(f"{field.replace('_', ' ')} of {mark.number:g} m", f"ask for {low:g} to {high:g} m", words)
        draft.fields["shell"] = {**draft.fields.get("shell", {}), field: mark.number, "stated": True}


LIMITS = {"ceiling": (1.8, 8.0), "inner_wall": (0.05, 0.6), "outer_wall": (0.05, 0.6)}  # [m]


def _length(draft: Draft, mark: Mark, rooms: list[Named]) -> None:
    value = mark.number
    access = draft.fields.setdefault("accessibility", {})
    if mark.value == "doors" and 0.6 <= value <= 1.2:
        access["min_door"] = max(value, 0.7)
        draft.cite(mark.first, mark.last, "accessibility.min_door")
    elif mark.value == "corridors" or any(r.type in HALLS for r in rooms):
        if 0.7 <= value <= 3.0:
            access["min_corridor"] = max(value, 0.8)
            draft.cite(mark.first, mark.last, "accessibility.min_corridor")
    elif 1.0 <= value <= 20.0:
        for room in rooms:
            room.min_width = value
            draft.cite(mark.first, mark.last, f"rooms.{room.id}.min_width")


def fill(draft: Draft, state: Reading) -> None:
    """Make as many rooms as a number of rooms says: "a three-room flat", in German and Chinese counted as people there do."""
    if state.rooms is None:
        _peopled(draft, state)
        return
    count, mark = state.rooms
    stock, traits = state.inventory, state.heard.lexicon.traits
    draft.cite(mark.first, mark.last, "rooms")
    if count > MAX_ROOMS:
        raise RefusedError(f"{count} rooms are asked for", f"ask for {MAX_ROOMS} at most")
    if "counts_living_rooms" in traits and not mark.text.endswith(("raeume", "个 房 间")) and count <= 9:
        _living_rooms(draft, state, count)
        return
    if count < 2:
        return
    while len(stock.rooms) < count:
        missing = [k for k in ("living_room", "kitchen", "bathroom") if not stock.of(k)]
        stock.add(missing[0] if missing else "bedroom", "", "room", None)
    draft.fields["only"] = True


def _peopled(draft: Draft, state: Reading) -> None:
    """Give a home of which only its people are told a bedroom for two, and one for each of the others: nobody stated these."""
    stock = state.inventory
    if state.people is None or state.studio is not None or any(stock.of(k) for k in ("bedroom", "studio_room")):
        return
    for _ in range(max(1, min(int(state.people.number), MOST_PEOPLE) - 1)):
        stock.add("bedroom", "", "", None).stated = False
    draft.cite(state.people.first, state.people.last, "rooms")


MOST_PEOPLE = 8


def _words(draft: Draft, state: Reading, rooms: list[Named]) -> list[Evidence]:
    found = [Evidence.model_validate(e) for e in draft.evidence if e["field"] == "rooms"]
    spans = {r.span for r in rooms if r.span is not None}
    for first, last in sorted(spans):
        start, end = spread(state.heard.tokens[first:last])
        found.append(Evidence(start=start, end=end, text=draft.prompt[start:end], field="rooms"))
    return found


def _living_rooms(draft: Draft, state: Reading, count: int) -> None:
    """German usage counts rooms to live and sleep in: three are a living room and two bedrooms; one is a studio."""
    stock = state.inventory
    lived = {"living_room", "bedroom", "office", "dining_room", "playroom", "library", "studio_room", "family_room"}
    beds = [r for r in stock.of("bedroom") if r.stated]
    if len(beds) > count:
        raise ImpossibleError(
            f"{len(beds)} bedrooms are asked for in a home of {count} rooms", "keep one of the two counts", _words(draft, state, beds)
        )
    if count == 1 and not stock.of("bedroom"):
        state.studio = state.studio or state.homes[0] if state.homes else state.studio
        if not stock.of("studio_room") and not stock.of("living_room"):
            stock.add("studio_room", "", "studio", None)
        return
    banned = {kind for kind, _ in state.banned}
    if "living_room" not in banned and not stock.of("living_room") and not stock.of("studio_room"):
        stock.add("living_room", "", "", None)
    while sum(r.type in lived for r in stock.rooms) < count:
        stock.add("bedroom", "", "", None, open_slot=True)


MOST_STOREYS = 3
PANORAMA = 8.5  # outside wall of a living room with panoramic glazing [m]
LUXURY = 1.3
NARROW = {"min_aspect": 1.5, "max_aspect": 2.1}


def read_whole(draft: Draft, state: Reading) -> None:
    """Read what concerns the whole home."""
    stock, flags = state.inventory, state.flags
    _heights(state)
    levels = [r.level for r in stock.rooms if r.level is not None]
    storeys = state.storeys[0] if state.storeys else 1
    if state.storeys:
        draft.cite(state.storeys[1].first, state.storeys[1].last, "storeys")
    if storeys > MOST_STOREYS:
        words = [Evidence.model_validate(draft.evidence[-1])]
        raise ImpossibleError(f"{storeys} storeys are asked for", f"ask for {MOST_STOREYS} at most", words)
    _one_storey(draft, state, max(storeys, max(levels, default=0) + 1))
    draft.fields["storeys"] = max(storeys, max(levels, default=0) + 1)
    if draft.fields["storeys"] == 1:
        for room in stock.rooms:
            room.level = 0
    _closed(draft, flags, bool(stock.rooms))
    _outline(draft, state)
    _access(draft, state)
    _entrance(draft, state)
    if "panorama" in flags:
        for room in stock.of("living_room")[:1]:
            room.exterior_length = PANORAMA
            draft.cite(flags["panorama"].first, flags["panorama"].last, f"rooms.{room.id}.exterior_length")


BUNGALOWS = {"bungalow", "平 房"}


def _one_storey(draft: Draft, state: Reading, storeys: int) -> None:
    """Refuse rooms upstairs in a home of one storey, with both words."""
    one = [e for e in (state.flags.get("single"), *state.homes) if e is not None and (e.kind == "flag" or e.text in BUNGALOWS)]
    above = [(e.first, e.last) for e in state.levels if e.value != "0"] or (
        [(state.storeys[1].first, state.storeys[1].last)] if state.storeys else []
    )
    if storeys == 1 or not one or not above:
        return
    before = len(draft.evidence)
    for first, last in ((one[0].first, one[0].last), *above):
        draft.cite(first, last, "storeys")
    words = [Evidence.model_validate(e) for e in draft.evidence[before:]]
    raise ImpossibleError("a home of one storey has nothing upstairs", "ask for two storeys", words)


def _heights(state: Reading) -> None:
    """Put zones, and what is spoken of as the rest, on their storey."""
    ground = {"living_room", "kitchen", "dining_room", "garage", "entry", "wc", "utility"}
    if (state.storeys or (1,))[0] > 1 and all(r.level for r in state.inventory.rooms):
        for room in state.inventory.rooms:  # "front room, kitchen, two bedrooms and a bathroom above": not all of the list
            room.level = None if room.type in ground else room.level
    for name, level in sorted(state.heights.items(), key=lambda h: h[0] == "*"):
        zone = set(state.zones[name][0] or late_zone(state.inventory, name)) if name in state.zones else set()
        for room in state.inventory.rooms:
            if room.id in zone or (name == "*" and room.level is None and room.type != "staircase"):
                room.level = level


def _closed(draft: Draft, flags: dict[str, Element], named: bool) -> None:
    if "closed" in flags and named:
        draft.fields["only"] = True
        draft.cite(flags["closed"].first, flags["closed"].last, "only")
    if "no_hall" in flags:
        draft.forbid("room_type", "hallway", None, None, flags["no_hall"].first, flags["no_hall"].last)
    if "luxury" in flags:
        draft.fields["scale"] = LUXURY
        draft.cite(flags["luxury"].first, flags["luxury"].last, "scale")


def _outline(draft: Draft, state: Reading) -> None:
    for flag, made in (
        ("shape_l", {"shape": "L"}),
        ("shape_t", {"shape": "T"}),
        ("rectangle", {"shape": "rectangle"}),
        ("narrow", NARROW),
        ("chamfered", {"corners": "chamfered"}),
    ):
        if flag in state.flags:
            draft.fields["footprint"] = {**draft.fields.get("footprint", {}), **made, "stated": True}
            draft.cite(state.flags[flag].first, state.flags[flag].last, "footprint")


def _access(draft: Draft, state: Reading) -> None:
    access = draft.fields.setdefault("accessibility", {})
    for flag in ("wheelchair", "step_free", "single"):
        if flag in state.flags:
            access["step_free"] = True
            draft.cite(state.flags[flag].first, state.flags[flag].last, "accessibility.step_free")
    if "wheelchair" in state.flags:
        access["min_door"] = max(access.get("min_door", 0.9), 0.9)
        access["min_corridor"] = max(access.get("min_corridor", 1.2), 1.2)


def _entrance(draft: Draft, state: Reading) -> None:
    entrance: dict[str, Any] = {}
    if state.entrance:
        into, e = state.entrance
        entrance = {"into": into, "stated": True}
        draft.cite(e.first, e.last, "entrance.into")
    if state.outside:
        owner, e = state.outside
        stock = state.inventory
        owners = [r for kind in ("kitchen", "bedroom") for r in stock.of(kind) if r.role in {"elder", "guest", "staff", "carer"}]
        separate = owners[0].id if owners else owner
        if separate:
            entrance["separate"] = [separate]
            draft.cite(e.first, e.last, "entrance.separate")
    draft.fields["entrance"] = entrance


def read_style(draft: Draft, state: Reading) -> None:
    """Set the style's knobs from words of mood and light."""
    knobs: dict[str, int] = {}
    looks = state.heard.lexicon.looks
    for e in state.looks:
        look = looks[int(e.value)]
        for knob, value in look.knobs.items():
            if abs(value) > abs(knobs.get(knob, 0)):
                knobs[knob] = value
        if look.nonrect:
            draft.fields["nonrect"] = look.nonrect
        draft.cite(e.first, e.last, "style")
    if {"wheelchair", "step_free", "single"} & set(state.flags):
        knobs.setdefault("min_width", 2)
    if knobs:
        draft.fields["style"] = Style.model_validate(knobs).model_dump()
