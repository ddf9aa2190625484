"""What concerns the home as a whole: storeys, outline, closed list of rooms, access, entrance, style."""

from __future__ import annotations

from typing import Any

from pipeline.floorplan.check import ImpossibleError
from pipeline.floorplan.language.draft import Draft
from pipeline.floorplan.language.facts import Reading
from pipeline.floorplan.language.joints import late_zone
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.program import Evidence, Style

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
