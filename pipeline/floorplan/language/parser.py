"""Prompt → FloorProgram, without network and always the same: characters → marks → phrases → rooms and facts → program."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from pydantic import ValidationError

from pipeline.errors import RefusedError, UsageError
from pipeline.floorplan.language import dwelling, joints
from pipeline.floorplan.language.amounts import plain_areas, supplied
from pipeline.floorplan.language.attaching import attach, read_furniture
from pipeline.floorplan.language.clauses import Sentence
from pipeline.floorplan.language.facts import Draft, Named, Reading
from pipeline.floorplan.language.frames import framed
from pipeline.floorplan.language.introductions import ban, introduce
from pipeline.floorplan.language.marks import Mark, Words, listen, measured, segment
from pipeline.floorplan.language.order import reorder
from pipeline.floorplan.language.phrases import Element, sentences
from pipeline.floorplan.language.revising import revise
from pipeline.floorplan.language.shorthand import crossed, dealt, shared_unit, widen
from pipeline.floorplan.language.spelling import detect
from pipeline.floorplan.language.text import spread, tokenize
from pipeline.floorplan.program.completion import complete
from pipeline.floorplan.program.consistency import ImpossibleError, check
from pipeline.floorplan.program.defaults import DEFAULTS
from pipeline.floorplan.program.floor_program import Evidence, FloorProgram

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
    dwelling.fill(draft, state)
    _studio(draft, state)
    for kind, e in state.banned:
        if kind in SORTS and any(r.surface and r.surface != e.text for r in stock.of(kind)):
            continue  # "no cellar but a pantry": another room of the type is wanted
        draft.forbid("room_type", kind, None, None, e.first, e.last)
    _beyond(draft, state)
    joints.join(draft, state)
    dwelling.attach(draft, state)
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


def read(heard: Words, sentences: list[list[Element]]) -> Reading:
    """Read all sentences: what is ruled out, what is introduced, then what is said of it."""
    state = Reading(heard)
    for sentence in sentences:
        ban(sentence)
    _kitchenette(state, sentences)
    sentences = [_parted(sentence) for sentence in sentences]
    for sentence in sentences:
        _compared(sentence)
    introduce(state, sentences)
    for sentence in sentences:
        Sentence(state, sentence).read()
    return state


def _compared(sentence: list[Element]) -> None:
    """Let "twice a bedroom" and "as large as a bedroom" mean one that is there, not a new one."""
    for k, e in enumerate(sentence):
        before = next((x for x in reversed(sentence[:k]) if x.kind not in {"relative", "det", "word"}), None)
        if e.kind == "np" and "indefinite" in e.det and e.number is None and before is not None and before.kind in {"factor", "cmp"}:
            e.det = (e.det - {"indefinite"}) | {"definite"}


def _parted(sentence: list[Element]) -> list[Element]:
    """Read "three bathrooms, two en suite" as "three bathrooms, two of them en suite"."""
    made: list[Element] = []
    for k, e in enumerate(sentence):
        counted = sentence[k - 2] if k > 1 and sentence[k - 1].kind in {"comma", "open"} else None
        several = counted is not None and counted.kind == "np" and counted.type == e.type == "bathroom" and (counted.number or 1) > 1
        fewer = counted is not None and (e.number or 1) < (counted.number or 1)
        if several and fewer and e.role == "ensuite" and not e.det:
            made += [Element("pron", "one", e.first, e.first, e.text, number=e.number), replace(e, number=None)]
        else:
            made.append(e)
    return made


def _kitchenette(state: Reading, sentences: list[list[Element]]) -> None:
    """Let the kitchenette of a studio be a function of its one room, not a kitchen of its own."""
    everything = [e for s in sentences for e in s]
    one = any(e.kind == "home" and e.value for e in everything) or any(e.kind == "np" and e.type == "studio_room" for e in everything)
    one = one or any(e.kind == "amount" and e.value == "rooms" and e.number == 1 for e in everything)
    if not one or any(e.kind == "np" and e.type == "bedroom" and not e.banned for e in everything):
        return
    for k, e in enumerate(everything):
        held = e.text == "小 厨 房" and k > 1 and everything[k - 1].value == "has" and everything[k - 2].kind == "home"  # "开间带小厨房"
        if e.kind == "np" and e.type == "kitchen" and e.mark is not None and (held or e.mark.value == "kitchen/corner"):
            e.kind = "corner"
            state.understood(e.first, e.last)


LONGEST = 20_000  # characters
MOST_WORDS = 2_500  # and Chinese characters: reading takes time in proportion to them


def parse(prompt: str) -> FloorProgram:
    """Return the completed program of a prompt in English, German, Spanish or Chinese.

    Raises UsageError when it is empty or too long, RefusedError when nothing in it is understood or it contradicts itself.
    """
    program = complete(understand(prompt))
    check(program)
    return program


def understand(prompt: str) -> FloorProgram:
    """Return what the prompt says, and no more: nothing is filled in or checked."""
    bounded(prompt)
    plain, wishes = read_furniture(prompt)
    return attach(understand_rooms(plain, prompt), wishes, prompt)


def understand_rooms(plain: str, prompt: str) -> FloorProgram:
    """Return what a prompt says of rooms, and no more; `plain` is it without its wishes for furniture, all else in its place."""
    heard = replace(listen(plain, detect(prompt)), prompt=prompt)  # words are cited as they were written
    amounts = dealt(measured(shared_unit(crossed(plain_areas(supplied(segment(heard), heard)), heard)), heard))
    revised = revise(widen(amounts, heard), heard)
    said = framed(revised.marks, heard)
    _one_home(said, heard)
    marks = reorder([m for m in said if m.kind != "people"], heard)
    parsed = sentences(marks, heard)
    spoken = {e.kind for s in parsed for e in s}
    if not spoken & {"np", "home"} and not any(e.kind == "amount" and e.value == "rooms" for s in parsed for e in s):
        shown = re.sub(r"\s+", " ", prompt.strip())[:60]
        raise RefusedError(
            f"nothing in the prompt names a room or a home: {shown!r}", "name rooms, e.g. living room, two bedrooms, bathroom"
        )
    state = read(heard, parsed)
    state.people = next((m for m in said if m.kind == "people"), None)
    state.looks = [e for s in parsed for e in s if e.kind == "look"]
    try:
        return assemble(state, parsed, [*marks, *(replace(m, kind="word") for m in revised.aside)])
    except ValidationError as error:  # a number beyond what a program may hold
        fault = error.errors()[0]
        where = ".".join(map(str, fault["loc"]))
        raise RefusedError(f"{where} cannot be {str(fault['input'])[:60]}: {fault['msg']}", "ask for a home of usual size") from error


def _one_home(marks: Sequence[Mark], heard: Words) -> None:
    """Refuse two homes: a plan is one."""
    for mark in (m for m in marks if m.kind == "homes"):
        start, end = spread(heard.tokens[mark.first : mark.last + 1])
        words = Evidence(start=start, end=end, text=heard.prompt[start:end], field="rooms")
        raise ImpossibleError(f"{mark.number:g} homes are asked for", "ask for one home at a time", [words])


def bounded(prompt: str) -> None:
    """Raise UsageError for a prompt that is empty or too long, in characters or words."""
    if not prompt.strip():
        raise UsageError("the prompt is empty", 'say what you want, e.g. "a two-bedroom flat with an open kitchen"')
    if len(prompt) > LONGEST:
        raise UsageError(f"the prompt is {len(prompt)} characters long", f"keep it under {LONGEST}")
    if (count := len(tokenize(prompt))) > MOST_WORDS:
        raise UsageError(f"the prompt has {count} words and marks", f"keep it under {MOST_WORDS}")
