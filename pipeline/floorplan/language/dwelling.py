"""What concerns the home as a whole: storeys, outline, closed list of rooms, access, entrance, style."""

from __future__ import annotations

import re
from typing import Any

from pipeline.errors import RefusedError
from pipeline.floorplan.language import lexicon
from pipeline.floorplan.language.draft import Draft
from pipeline.floorplan.language.facts import Reading
from pipeline.floorplan.program import Style

MOST_STOREYS = 3
PANORAMA = 8.5  # outside wall of a living room with panoramic glazing [m]


def read_whole(draft: Draft, state: Reading, text: str) -> None:
    """Read what concerns the whole home: storeys, outline, whether the list of rooms is closed, access and entrance."""
    stock = state.inventory
    levels = [r.level for r in stock.rooms if r.level is not None]
    storeys = state.storeys[0] if state.storeys else 1
    if state.storeys:
        draft.cite(state.storeys[1].first, state.storeys[1].last, "storeys")
    if storeys > MOST_STOREYS:
        raise RefusedError(f"{storeys} storeys are asked for", f"ask for {MOST_STOREYS} at most")
    draft.fields["storeys"] = max(storeys, max(levels, default=0) + 1)
    if draft.fields["storeys"] == 1:
        for room in stock.rooms:
            room.level = 0
    if re.search(r"\b(that's it|nothing else|nothing more|only these|no other rooms)\b", text):
        draft.fields["only"] = True
    if re.search(r"\bno wasted (corridor|hall)|\bno (corridor|hallway)s?\b(?! (narrower|less|smaller))", text):
        draft.forbid("room_type", "hallway", None, None, 0, 1)
    if re.search(r"\b(luxury|luxurious|generous airy|palatial|lavish)\b", text):
        draft.fields["scale"] = 1.3
    _outline(draft, text)
    _access(draft, state, text)
    if re.search(r"eat in kitchen|big enough to eat in|kitchen diner|dining kitchen|kitchen to eat in", text):
        for room in (r for r in stock.of("kitchen") if not r.role):
            room.functions.add("dining")
    if "panoramic" in text:
        for room in stock.of("living_room")[:1]:
            room.exterior_length = PANORAMA


def _outline(draft: Draft, text: str) -> None:
    shape = "L" if re.search(r"\bl shaped?\b", text) else ("T" if re.search(r"\bt shaped?\b", text) else "rectangle")
    if re.search(r"\b[lt] shaped? (living|kitchen|bedroom|sofa|room)", text):
        shape = "rectangle"
    if re.search(r"\b(narrow|elongated)\b[^.]{0,40}\b(house|townhouse|home|plot|site|lot|footprint|outline|building)", text):
        draft.fields["footprint"] = {"shape": shape, "min_aspect": 1.5, "max_aspect": 2.1, "stated": True}
    elif shape != "rectangle" or re.search(r"rectangular (outline|footprint|plan)", text):
        draft.fields["footprint"] = {"shape": shape, "stated": True}


def _access(draft: Draft, state: Reading, text: str) -> None:
    access = draft.fields.setdefault("accessibility", {})
    if re.search(r"wheelchair|step free|barrier free|rollator|no steps", text):
        access["step_free"] = True
    if re.search(r"wheelchair|rollator", text):
        access["min_door"] = max(access.get("min_door", 0.9), 0.9)
        access["min_corridor"] = max(access.get("min_corridor", 1.2), 1.2)
    entrance: dict[str, Any] = {"into": state.entrance, "stated": True} if state.entrance else {}
    if re.search(r"own (front )?door to the outside|own entrance|separate entrance|own outside door", text):
        stock = state.inventory
        owners = [r for kind in ("kitchen", "bedroom") for r in stock.of(kind) if r.role in {"elder", "guest", "staff", "carer"}]
        entrance["separate"] = [owners[0].id] if owners else []
    draft.fields["entrance"] = entrance


def read_style(draft: Draft, text: str) -> None:
    """Set the style's knobs from words of mood and light."""
    knobs: dict[str, int] = {}
    for phrase, changes in lexicon.STYLES.items():
        found = re.search(rf"\b{re.escape(phrase)}\b", text)
        if not found:
            continue
        for knob, value in changes.items():
            if abs(value) > abs(knobs.get(knob, 0)):
                knobs[knob] = value
        if phrase in lexicon.IRREGULAR_WORDS:
            draft.fields["nonrect"] = 1
        at = re.search(phrase.replace(" ", r"[-–\s]+"), draft.prompt, re.IGNORECASE)
        if at:
            draft.evidence.append({"start": at.start(), "end": at.end(), "text": at.group(), "field": "style"})
    if knobs:
        draft.fields["style"] = Style.model_validate(knobs).model_dump()
