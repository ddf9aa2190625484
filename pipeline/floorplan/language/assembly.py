"""From rooms and facts to a FloorProgram, with the words that each field was read from."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from pipeline.floorplan.defaults import DEFAULTS
from pipeline.floorplan.language import dwelling, joints, sizes
from pipeline.floorplan.language.draft import Draft
from pipeline.floorplan.language.facts import Reading
from pipeline.floorplan.language.inventory import Named
from pipeline.floorplan.language.items import Item
from pipeline.floorplan.language.spelling import vocabulary
from pipeline.floorplan.language.tokens import MARKS, Token
from pipeline.floorplan.program import FloorProgram

ROLES = {"primary", "guest", "child", "elder", "staff", "carer", "shared"}


def assemble(prompt: str, tokens: list[Token], parsed: list[list[Item]], state: Reading) -> FloorProgram:
    """Return the program of what was read; nothing is filled in."""
    draft = Draft(prompt, tokens)
    stock = state.inventory
    text = re.sub(r"[-–\s]+", " ", prompt.lower().replace("’", "'"))
    _studio(state)
    _ban_rooms(draft, state)
    joints.give_belongings(draft, stock, state.facts)
    joints.join_named(draft, stock, state.facts)
    joints.join_everything(draft, stock, state.facts)
    joints.complete_suites(draft, stock, state.facts)
    joints.keep_apart(draft, stock, state.facts, text)
    sizes.attach(draft, state)
    sizes.compare(draft, stock, text)
    dwelling.read_whole(draft, state, text)
    dwelling.read_style(draft, re.sub(r"(square|sq\.?) ?(m|f)\w*", " ", text))
    spans = sorted((s, e, t) for s, e, t in _rest(state, draft) if not any(v["start"] <= s < v["end"] for v in draft.evidence))
    return FloorProgram.model_validate(
        {
            **draft.fields,
            "rooms": [_room(r) for r in stock.rooms],
            "links": list(draft.links.values()),
            "forbids": draft.forbids,
            "relations": draft.relations,
            "language": "en",
            "evidence": [*_named(parsed, draft), *draft.evidence],
            "unparsed": [{"start": s, "end": e, "text": t} for s, e, t in spans],
        }
    )


def _room(room: Named) -> dict[str, Any]:
    area: dict[str, Any] = {"min": room.low, "max": room.high, "target": room.target}
    stated = any(v is not None for v in area.values())
    if not stated and room.size != 1.0:
        area["target"] = round(DEFAULTS[room.type].area * room.size, 2)
    return {
        "id": room.id,
        "type": room.type,
        "role": room.role if room.role in ROLES else "",
        "functions": tuple(sorted(room.functions)),
        "area": {**area, "stated": stated},
        "level": room.level,
        "exterior": room.exterior,
        "exterior_length": room.exterior_length,
        "window": room.window,
        "objects": room.objects,
        "walkable": room.walkable,
        "min_width": room.min_width,
    }


def _named(parsed: list[list[Item]], draft: Draft) -> list[dict[str, Any]]:
    """Evidence for the rooms themselves."""
    found = []
    for item in (i for s in parsed for i in s if i.ids and i.kind == "room"):
        start, end = draft.tokens[item.first].start, draft.tokens[item.last - 1].end
        found += [{"start": start, "end": end, "text": draft.prompt[start:end], "field": f"rooms.{i}"} for i in item.ids]
    return found


def _rest(state: Reading, draft: Draft) -> Iterable[tuple[int, int, str]]:
    """Words that nothing was read from and that are not mere function words."""
    for k, token in enumerate(draft.tokens):
        plain = token.text in MARKS or token.text in vocabulary()[0] or token.text.endswith("'s")
        if k not in state.used and not plain and token.number is None:
            yield token.start, token.end, draft.prompt[token.start : token.end]


def _studio(state: Reading) -> None:
    """Make a studio without a named main room one room to live and sleep in."""
    stock = state.inventory
    if state.studio is not None and not stock.of("studio_room") and not stock.of("bedroom"):
        living = stock.of("living_room")
        room = living[0] if living else stock.add("studio_room", "", "studio", 0)
        room.type = "studio_room"
        room.functions |= {"living", "sleeping"}
        if not stock.of("kitchen"):
            room.functions.add("cooking")
    for room in stock.of("studio_room"):
        room.functions |= {"living", "sleeping"}


def _ban_rooms(draft: Draft, state: Reading) -> None:
    for kind, item in state.banned:
        draft.forbid("room_type", kind, None, None, item.first, item.last)
