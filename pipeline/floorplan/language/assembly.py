"""From rooms and facts to a FloorProgram, with the words that each field was read from."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from pipeline.floorplan.check import ImpossibleError
from pipeline.floorplan.defaults import DEFAULTS
from pipeline.floorplan.language import dwelling, joints, sizes
from pipeline.floorplan.language.draft import Draft
from pipeline.floorplan.language.facts import Reading
from pipeline.floorplan.language.inventory import Named
from pipeline.floorplan.language.marks import Mark
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.program import Evidence, FloorProgram

SORTS = {
    "storage",
    "balcony",
    "wc",
    "utility",
    "closet",
    "garage",
    "hallway",
    "entry",
    "office",
    "family_room",
    "playroom",
}  # types of many names
QUIET = {"on", "around", "along", "by", "al", "ins", "进 入", "进", "in", "off"}  # prepositions that mean something else as well
RELATIONS = {"door", "leads", "open", "near", "wall", "away", "apart", "between", "avoid", "ensuite"}
SAYING = {
    "word",
    "cmp",
    "factor",
    "amount",
    "ord",
    "owner",
    "level",
    "room",
    "suite",
    "enter",
    "outside",
    "except",
    "pron",
}  # kinds of marks that never stand idle
ROLES = {"primary", "guest", "child", "elder", "staff", "carer", "shared"}


def assemble(state: Reading, parsed: list[list[Element]], marks: list[Mark]) -> FloorProgram:
    """Return the program of what was read; nothing is filled in."""
    draft = Draft(state.heard)
    stock = state.inventory
    sizes.fill(draft, state)
    _studio(draft, state)
    for kind, e in state.banned:
        if kind in SORTS and any(r.surface and r.surface != e.text for r in stock.of(kind)):
            continue  # "no cellar but a pantry": another room of the type is wanted
        draft.forbid("room_type", kind, None, None, e.first, e.last)
    _beyond(draft, state)
    joints.join(draft, state)
    sizes.attach(draft, state)
    dwelling.read_whole(draft, state)
    dwelling.read_style(draft, state)
    evidence = [*_named(parsed, draft, state), *draft.evidence]
    return FloorProgram.model_validate(
        {
            **draft.fields,
            "rooms": [_room(r) for r in stock.rooms],
            "links": list(draft.links.values()),
            "forbids": draft.forbids,
            "relations": draft.relations,
            "zones": draft.zones,
            "language": state.heard.lexicon.language,
            "evidence": evidence,
            "unparsed": [{"start": s, "end": e, "text": t} for s, e, t in _rest(state, evidence, marks)],
        }
    )


def _room(room: Named) -> dict[str, Any]:
    area: dict[str, Any] = {"min": room.low, "max": room.high, "target": room.target}
    stated = any(v is not None for v in area.values())
    if not stated and room.size != 1.0:
        area["target"] = round(DEFAULTS[room.type].area * room.size, 2)
    return {
        "id": room.id,
        "stated": room.stated,
        "type": room.type,
        "role": room.role if room.role in ROLES else "",
        "functions": tuple(sorted(room.functions)),
        "area": {**area, "stated": stated},
        "level": room.level,
        "exterior": room.exterior,
        "exterior_length": room.exterior_length,
        "window": room.window,
        "min_width": room.min_width,
    }


def _named(parsed: list[list[Element]], draft: Draft, state: Reading) -> list[dict[str, Any]]:
    """Evidence for the rooms themselves."""
    found = []
    known = {r.id for r in state.inventory.rooms}
    for e in (e for s in parsed for e in s if e.ids and e.kind == "np" and e.last > e.first):
        start, end = draft.tokens[e.first].start, max(draft.tokens[e.last - 1].end, draft.tokens[e.first].end)
        found += [{"start": start, "end": end, "text": draft.prompt[start:end], "field": f"rooms.{i}"} for i in e.ids if i in known]
    return found


def _rest(state: Reading, evidence: Iterable[Mapping[str, Any]], marks: Sequence[Mark]) -> Iterator[tuple[int, int, str]]:
    """Yield what nothing was made of: words that are in no vocabulary, and words that say something and stand in no evidence."""
    tokens, prompt = state.heard.tokens, state.heard.prompt
    cited = {k for e in evidence for k, t in enumerate(tokens) if e["start"] <= t.start and t.end <= e["end"]} | state.used
    for k, mark in enumerate(marks):
        if mark.last > mark.first and not cited & set(range(mark.first, mark.last)) and _says(marks, k, cited):
            start, end = tokens[mark.first].start, tokens[mark.last - 1].end
            yield start, end, prompt[start:end]


def _says(marks: Sequence[Mark], k: int, cited: set[int]) -> bool:
    """Whether the mark at k says something by itself: what stands in front of a room that was read does not."""
    mark = marks[k]
    if mark.kind == "cue":
        return mark.value in RELATIONS and mark.text not in QUIET
    pointing = mark.kind == "det" and mark.value in {"each", "other", "own", "another"}
    if not (mark.kind in SAYING or pointing) or (mark.kind == "pron" and mark.value in {"it", "one"}):
        return False
    ahead = k + 1
    while ahead < len(marks) and marks[ahead].kind in {"num", "ord", "adj", "size", "det", "clf", "times", "amount", "fill", "look"}:
        ahead += 1
    head = marks[ahead] if ahead < len(marks) else mark
    described = head.kind == "home" or (head.kind in {"room", "suite"} and bool(cited & set(range(head.first, head.last))))
    return not (mark.kind in {"ord", "det"} and described)


def _beyond(draft: Draft, state: Reading) -> None:
    """Refuse counts that contradict each other: "a two-bedroom flat ... the third bedroom"."""
    for fact in state.facts:
        if fact.what == "beyond":
            rooms = [state.inventory.get(i) for i in fact.a]
            draft.cite(fact.first, fact.last, "rooms")
            words = [Evidence.model_validate(e) for e in draft.evidence if e["field"] == "rooms"]
            words += [Evidence(start=s, end=e, text=draft.prompt[s:e], field="rooms") for s, e in {_place(draft, r) for r in rooms} if e]
            name = rooms[0].type.replace("_", " ")
            raise ImpossibleError(f"{len(rooms)} {name}s are asked for, and then {fact.value:g}", "keep one of the two counts", words)


def _place(draft: Draft, room: Named) -> tuple[int, int]:
    if room.span is None:
        return 0, 0
    return draft.tokens[room.span[0]].start, draft.tokens[room.span[1] - 1].end


def _studio(draft: Draft, state: Reading) -> None:
    """Make a studio without a named main room one room to live and sleep in."""
    stock = state.inventory
    if state.studio is not None and not stock.of("studio_room") and not stock.of("bedroom"):
        living = stock.of("living_room")
        room = living[0] if living else stock.add("studio_room", "", "studio", 0)
        room.type = "studio_room"
        room.functions |= {"living", "sleeping"}
        room.span = room.span or (state.studio.first, state.studio.last)
        if not stock.of("kitchen"):
            room.functions.add("cooking")
    beds = [r for r in stock.of("bedroom") if r.open_slot or r.stated]
    if state.studio is not None and len(beds) > 1:
        spans = [(state.studio.first, state.studio.last), *sorted({r.span for r in beds if r.span is not None})]
        places = [(draft.tokens[a].start, draft.tokens[b - 1].end) for a, b in spans]
        words = [Evidence(start=s, end=e, text=draft.prompt[s:e], field="rooms") for s, e in places]
        raise ImpossibleError(f"a studio is one room, and {len(beds)} bedrooms are asked for", "ask for a flat", words)
    for room in stock.of("studio_room"):
        room.functions |= {"living", "sleeping"}
