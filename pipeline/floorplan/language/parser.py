"""Prompt → FloorProgram, without network and always the same: characters → marks → phrases → rooms and facts → program."""

from __future__ import annotations

import bisect
import itertools
import re
from collections.abc import Sequence
from dataclasses import replace

from pydantic import ValidationError

from pipeline.errors import RefusedError, UsageError
from pipeline.floorplan.language.attaching import attach
from pipeline.floorplan.language.builder import assemble
from pipeline.floorplan.language.facts import Reading
from pipeline.floorplan.language.frames import apply_frames, reorder
from pipeline.floorplan.language.furnishing import Claim, read_furniture
from pipeline.floorplan.language.lexicon import kinds
from pipeline.floorplan.language.marks import Mark, Words, amounts, listen, segment
from pipeline.floorplan.language.naming import introduce
from pipeline.floorplan.language.phrases import Element, ban, refuse, sentences, settle
from pipeline.floorplan.language.sentences import read
from pipeline.floorplan.language.spelling import detect
from pipeline.floorplan.language.text import tokenize
from pipeline.floorplan.program.completion import complete
from pipeline.floorplan.program.consistency import check
from pipeline.floorplan.program.floor_program import Evidence, FloorProgram, Span

LONGEST = 20_000  # characters
MOST_WORDS = 2_500  # and Chinese characters: reading takes time in proportion to them
EMPTY = kinds("empty")
READ = {"used"}  # what was read with its neighbours
NOT_BUILT = {"unbuilt", "car"}  # a garage is one for one car
# flags that hold wherever they stand, and such as only underline what is said
STRESS = kinds("stress")
POINTING = {"each", "other", "own", "another"}  # determiners that say something
LEADING = {"num", "ord", "adj", "size", "det", "clf", "times", "amount", "fill", "look"}  # in front of a room


def parse(prompt: str) -> FloorProgram:
    """Return the completed program of a prompt in any language that has a lexicon.

    Raises UsageError when it is empty or too long, RefusedError when nothing in it is understood or it contradicts itself.
    """
    program = complete(understand(prompt))
    check(program)
    return program


def understand(prompt: str) -> FloorProgram:
    """Return what the prompt says, and no more: nothing is filled in or checked."""
    check_length(prompt)
    plain, wishes = read_furniture(prompt)
    return attach(understand_rooms(plain, prompt, wishes), wishes, prompt)


def understand_rooms(plain: str, prompt: str, wishes: Sequence[Claim] = ()) -> FloorProgram:
    """Return what a prompt says of rooms, and no more; `plain` is it without its wishes for furniture, all else in its place."""
    words = replace(listen(plain, detect(prompt)), prompt=prompt)  # words are cited as they were written
    marks = _with_wishes(amounts(segment(words), words), wishes, words)
    said = [m for m in apply_frames(marks, words) if m.kind != "wish"]
    refuse(said, words)
    people = [m for m in said if m.kind == "people"]
    marks = reorder([m for m in said if m.kind != "people"], words)
    parsed = sentences(marks, words)
    everything = [e for s in parsed for e in s]
    if not any(e.kind in {"np", "home"} or (e.kind, e.value) == ("amount", "rooms") for e in everything):
        shown = re.sub(r"\s+", " ", prompt.strip())[:60]
        advice = "name rooms, e.g. living room, two bedrooms, bathroom"
        raise RefusedError(f"nothing in the prompt names a room or a home: {shown!r}", advice)
    state = Reading(words, people=next(iter(people), None), looks=[e for e in everything if e.kind == "look"])
    for sentence in parsed:
        ban(sentence)
    settle(parsed)
    introduce(state, parsed)
    for sentence in parsed:
        read(state, sentence)
    try:
        program = assemble(state, parsed)
    except ValidationError as error:  # a number beyond what a program may hold
        fault = error.errors()[0]
        where = ".".join(map(str, fault["loc"]))
        raise RefusedError(f"{where} cannot be {str(fault['input'])[:60]}: {fault['msg']}", "ask for a home of usual size") from error
    return program.model_copy(update=_left_out(state, parsed, program.evidence, sorted([*marks, *people[1:]], key=lambda m: m.first)))


def _with_wishes(marks: Sequence[Mark], wishes: Sequence[Claim], words: Words) -> list[Mark]:
    """Return the marks with one in each place from which a wish was taken out: whose it is tells which rooms there are."""
    starts = [t.start for t in words.tokens]
    places = [bisect.bisect_left(starts, w.start) for w in wishes]
    return sorted([*(Mark("wish", first=k, last=k) for k in places), *marks], key=lambda m: m.first)


def check_length(prompt: str) -> None:
    """Raise UsageError for a prompt that is empty or too long, in characters or words."""
    if not prompt.strip():
        raise UsageError("the prompt is empty", 'say what you want, e.g. "a two-bedroom flat with an open kitchen"')
    if len(prompt) > LONGEST:
        raise UsageError(f"the prompt is {len(prompt)} characters long", f"keep it under {LONGEST}")
    if (count := len(tokenize(prompt))) > MOST_WORDS:
        raise UsageError(f"the prompt has {count} words and marks", f"keep it under {MOST_WORDS}")


def _left_out(
    state: Reading, parsed: list[list[Element]], evidence: Sequence[Evidence], marks: Sequence[Mark]
) -> dict[str, tuple[Span, ...]]:
    """Return what nothing was made of: `unbuilt`, names of what nobody builds; `unparsed`, words that are in no vocabulary, and words that say something and stand in no evidence."""
    tokens = state.heard.tokens
    places = [{k for k, t in enumerate(tokens) if e.start <= t.start and t.end <= e.end} for e in evidence]
    cited = _consumed_tokens(state, parsed, places, evidence)
    spans: dict[str, list[Span]] = {"unparsed": [], "unbuilt": []}
    for k, mark in enumerate(marks):
        free = mark.last > mark.first and not cited & set(range(mark.first, mark.last))
        named = free and mark.value in NOT_BUILT
        if named or (mark.kind == "word" and mark.last > mark.first) or (free and _says(state, marks, k)):
            start, end = tokens[mark.first].start, tokens[mark.last - 1].end
            spans["unbuilt" if named else "unparsed"].append(Span(start=start, end=end, text=state.heard.prompt[start:end]))
    return {field: tuple(some) for field, some in spans.items()}


def _consumed_tokens(state: Reading, parsed: list[list[Element]], places: Sequence[set[int]], evidence: Sequence[Evidence]) -> set[int]:
    """Return the tokens that something was made of: evidence, what belongs to a phrase in it, and words that only help a statement."""
    cited = state.used.union(*places)
    stated = set().union(*(p for p, e in zip(places, evidence, strict=True) if e.field.split(".")[0] != "rooms" or e.field.count(".") > 1))
    roles = {r.role for r in state.inventory.rooms}
    starred = any("*" in f.a + f.b for f in state.facts) or any(ids == ("*",) for _, ids in state.amounts)
    for sentence in parsed:
        ends = [-1, *(k for k, e in enumerate(sentence) if e.kind in {"comma", "but"}), len(sentence)]
        for a, b in itertools.pairwise(ends):
            part = sentence[a + 1 : b]
            has_statement = bool(part) and bool(stated & set(range(min(e.first for e in part), max(e.last for e in part))))
            has_statement = has_statement or any(e.kind == "flag" and e.value in STRESS for e in part)
            for k, e in enumerate(part):
                if (
                    e.kind in READ
                    or (e.kind == "owner" and (e.value in roles or any(x.kind in {"np", "home"} for x in part[:k])))
                    or (e.kind == "every" and (starred or has_statement))
                    or (e.kind == "flag" and e.value in STRESS)
                    or (has_statement and (e.kind == "flag" or (e.kind, e.value) in {("cue", "from"), ("adj", "open")}))
                    or (has_statement and e.kind in {"det", "pron"} and (e.ids or e.value != "each"))
                ):
                    cited.update(range(e.first, e.last))
                elif e.kind == "corner" or (e.kind == "np" and (e.ids or e.banned)):
                    cited.update(range(e.first, e.last), *(range(m.first, m.last) for m in e.taken))
    return cited


def _says(state: Reading, marks: Sequence[Mark], k: int) -> bool:
    """Whether the mark at k says something by itself."""
    mark = marks[k]
    if mark.kind in EMPTY or (mark.kind == "det" and mark.value not in POINTING):
        return k > 0 and (mark.kind, mark.value, marks[k - 1].kind) == ("join", "to", "join")  # "and to a study": something leads there
    if mark.kind == "cue":
        return mark.value not in {"has", "in"} and mark.text not in state.heard.lexicon.sign("quiet")
    dweller = mark.kind == "owner" and any(m.text in state.heard.lexicon.sign("towards") for m in marks[max(0, k - 2) : k])
    if dweller or (mark.kind, mark.value) in {("pron", "it"), ("pron", "one")}:
        return False  # "for my granny: ..." says who lives there
    if (mark.kind, mark.value) in {("adj", "closed"), ("adj", "plain")} or (k and mark.kind == "size" and marks[k - 1].kind == "amount"):
        return False  # what is not open is apart anyway; "20 m² groß"
    ahead = marks[k + 1] if k + 1 < len(marks) else None
    head = next((m for m in marks[k + 1 :] if m.kind not in LEADING | {"owner", "word"}), None)
    if mark.kind in LEADING and head is not None and head.kind == "home":
        return False  # "a shared student flat"
    return not (mark.kind == "num" and ahead is not None and ahead.kind in {"owner", "fill", "word", "verb"})  # "three generations"
