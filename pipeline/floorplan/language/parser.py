"""Prompt → FloorProgram, without network and always the same: words → items → rooms and facts → program."""

from __future__ import annotations

import re

from pydantic import ValidationError

from pipeline.errors import RefusedError, UsageError
from pipeline.floorplan.check import check
from pipeline.floorplan.completion import complete
from pipeline.floorplan.language import items as kinds
from pipeline.floorplan.language.assembly import assemble
from pipeline.floorplan.language.items import sentences
from pipeline.floorplan.language.reading import read
from pipeline.floorplan.language.spelling import repair
from pipeline.floorplan.language.tokens import tokenize
from pipeline.floorplan.program import FloorProgram

LONGEST = 20_000  # characters


def parse(prompt: str) -> FloorProgram:
    """Return the completed program of an English prompt.

    Raises UsageError when it is empty or too long, RefusedError when nothing in it is understood or it contradicts itself.
    """
    program = complete(understand(prompt))
    check(program)
    return program


def understand(prompt: str) -> FloorProgram:
    """Return what the prompt says, and no more: nothing is filled in or checked."""
    bounded(prompt)
    tokens = repair(tokenize(prompt))
    parsed = sentences(tokens)
    known = {kinds.ROOM, kinds.HOME, kinds.SUITE}
    if not any(i.kind in known or (i.kind == kinds.AMOUNT and i.unit == "rooms") for s in parsed for i in s):
        shown = re.sub(r"\s+", " ", prompt.strip())[:60]
        raise RefusedError(
            f"nothing in the prompt names a room or a home: {shown!r}", "name rooms, e.g. living room, two bedrooms, bathroom"
        )
    try:
        return assemble(prompt, tokens, parsed, read(tokens, parsed))
    except ValidationError as error:  # a number beyond what a program may hold
        fault = error.errors()[0]
        where = ".".join(map(str, fault["loc"]))
        raise RefusedError(f"{where} cannot be {fault['input']}: {fault['msg']}", "ask for a home of usual size") from error


def bounded(prompt: str) -> None:
    """Raise UsageError for a prompt that is empty or too long."""
    if not prompt.strip():
        raise UsageError("the prompt is empty", 'say what you want, e.g. "a two-bedroom flat with an open kitchen"')
    if len(prompt) > LONGEST:
        raise UsageError(f"the prompt is {len(prompt)} characters long", f"keep it under {LONGEST}")
