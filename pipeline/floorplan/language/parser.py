"""Prompt → FloorProgram, without network and always the same: characters → marks → phrases → rooms and facts → program."""

from __future__ import annotations

import re
from dataclasses import replace

from pydantic import ValidationError

from pipeline.errors import RefusedError, UsageError
from pipeline.floorplan.language.amounts import amounts
from pipeline.floorplan.language.attaching import attach
from pipeline.floorplan.language.builder import assemble
from pipeline.floorplan.language.facts import Reading
from pipeline.floorplan.language.frames import framed
from pipeline.floorplan.language.furnishing import read_furniture
from pipeline.floorplan.language.naming import introduce
from pipeline.floorplan.language.order import reorder
from pipeline.floorplan.language.phrases import sentences, settle
from pipeline.floorplan.language.revising import ban, choose, refuse
from pipeline.floorplan.language.sentences import read
from pipeline.floorplan.language.spelling import detect
from pipeline.floorplan.language.text import tokenize
from pipeline.floorplan.language.tokens import listen, segment
from pipeline.floorplan.program.completion import complete
from pipeline.floorplan.program.consistency import check
from pipeline.floorplan.program.floor_program import FloorProgram

LONGEST = 20_000  # characters
MOST_WORDS = 2_500  # and Chinese characters: reading takes time in proportion to them


def parse(prompt: str) -> FloorProgram:
    """Return the completed program of a prompt in any language that has a lexicon.

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
    said = framed(choose(amounts(segment(heard), heard)), heard)
    refuse(said, heard)
    marks = reorder([m for m in said if m.kind != "people"], heard)
    parsed = sentences(marks, heard)
    everything = [e for s in parsed for e in s]
    if not any(e.kind in {"np", "home"} or (e.kind, e.value) == ("amount", "rooms") for e in everything):
        shown = re.sub(r"\s+", " ", prompt.strip())[:60]
        advice = "name rooms, e.g. living room, two bedrooms, bathroom"
        raise RefusedError(f"nothing in the prompt names a room or a home: {shown!r}", advice)
    state = Reading(heard, people=next((m for m in said if m.kind == "people"), None), looks=[e for e in everything if e.kind == "look"])
    for sentence in parsed:
        ban(sentence)
    settle(parsed)
    introduce(state, parsed)
    for sentence in parsed:
        read(state, sentence)
    try:
        return assemble(state, parsed, marks)
    except ValidationError as error:  # a number beyond what a program may hold
        fault = error.errors()[0]
        where = ".".join(map(str, fault["loc"]))
        raise RefusedError(f"{where} cannot be {str(fault['input'])[:60]}: {fault['msg']}", "ask for a home of usual size") from error


def bounded(prompt: str) -> None:
    """Raise UsageError for a prompt that is empty or too long, in characters or words."""
    if not prompt.strip():
        raise UsageError("the prompt is empty", 'say what you want, e.g. "a two-bedroom flat with an open kitchen"')
    if len(prompt) > LONGEST:
        raise UsageError(f"the prompt is {len(prompt)} characters long", f"keep it under {LONGEST}")
    if (count := len(tokenize(prompt))) > MOST_WORDS:
        raise UsageError(f"the prompt has {count} words and marks", f"keep it under {MOST_WORDS}")
