"""Prompt → program by whichever engine is there: the user's language model, else the built-in parser."""

import logging

from pipeline.errors import RefusedError, UsageError
from pipeline.floorplan.language import parse
from pipeline.floorplan.language.llm import Server, UnansweredError, ask, server_from_env
from pipeline.floorplan.language.text import check_length
from pipeline.floorplan.program.completion import complete
from pipeline.floorplan.program.consistency import ImpossibleError, check
from pipeline.floorplan.program.floor_program import Evidence, FloorProgram

LOG = logging.getLogger(__name__)
WHY = {"unparsed": "not understood", "unbuilt": "not built here"}


def request(prompt: str, server: Server | None = None, *, strict: bool = False) -> FloorProgram:
    """Return the completed program of a prompt: by the language model that `server` or the environment names, else built in.

    With `strict`, a prompt of which words were not understood, or ask for what nobody builds, is refused with them.
    """
    return require_understood(_read(prompt, server), strict=strict)


def require_understood(program: FloorProgram, *, strict: bool) -> FloorProgram:
    """Return a program; with `strict`, raises ImpossibleError where words of its prompt were not understood or ask for what nobody builds."""
    lost = {"unparsed": program.unparsed, "unbuilt": program.unbuilt} if strict else {}
    if any(lost.values()):
        what = "; ".join(f"{WHY[field]}: {', '.join(repr(s.text) for s in spans)}" for field, spans in lost.items() if spans)
        words = [Evidence(start=s.start, end=s.end, text=s.text, field=field) for field, spans in lost.items() for s in spans]
        raise ImpossibleError(what, "say it in other words, or leave out --strict", words)
    return program


def _read(prompt: str, server: Server | None) -> FloorProgram:
    """Return the completed program of a prompt.

    What the model answers is checked like everything else; when it gives no usable program, a warning says so and the built-in
    parser takes over. A contradiction in the words is refused even where the model has settled it by itself. Raises UsageError and
    RefusedError as `parse` does.
    """
    server = server or server_from_env()
    if server is None:
        return parse(prompt)
    check_length(prompt)
    try:
        program = complete(ask(prompt, server))
        check(program)
    except UnansweredError as error:
        LOG.warning("the language model gave no program (%s); the built-in parser takes over", error)
        return parse(prompt)
    except (RefusedError, UsageError):
        # the model may have invented the contradiction: the words decide
        LOG.warning("the language model's program contradicts itself; the built-in parser takes over")
        return parse(prompt)
    try:
        parse(prompt)
    except ImpossibleError:
        raise
    except RefusedError:
        LOG.debug("only the language model has understood the prompt")
    return program
