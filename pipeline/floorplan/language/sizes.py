"""Amounts in a prompt → areas, widths, the whole home."""

from __future__ import annotations

from typing import Any

from pipeline.errors import RefusedError
from pipeline.floorplan.check import ImpossibleError
from pipeline.floorplan.language.draft import Draft
from pipeline.floorplan.language.facts import HALLS, Reading
from pipeline.floorplan.language.inventory import Named
from pipeline.floorplan.language.marks import Mark
from pipeline.floorplan.language.text import spread
from pipeline.floorplan.program import MAX_ROOMS, Evidence

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
