"""Words about the furniture of a plan that is given: they may name its rooms, and ask for no others."""

import dataclasses
from collections.abc import Iterator, Mapping

from pipeline.errors import RefusedError
from pipeline.floorplan.language.builder import Mention, room_mentions
from pipeline.floorplan.language.lexicon import LANGUAGES, lexicon
from pipeline.floorplan.language.parser import attach, read_furniture, understand_rooms
from pipeline.floorplan.language.spelling import detect
from pipeline.floorplan.language.text import check_length, fold, split_words
from pipeline.floorplan.program.consistency import ImpossibleError, check_furniture
from pipeline.floorplan.program.floor_program import Evidence, FloorProgram, RoomReq, Span
from pipeline.floorplan.program.furniture import allot_pieces, spread


def with_wishes(program: FloorProgram, prompt: str) -> FloorProgram:
    """Return the program of a given plan with the prompt's wishes for furniture.

    What else the prompt says is in its `unparsed` and `unbuilt`. Raises RefusedError when the prompt has no such wish, names a room that
    the plan lacks, or asks for what no room can meet.
    """
    check_length(prompt)
    plain, claims = read_furniture(prompt)
    if not claims:
        raise RefusedError(
            f"nothing in the prompt is a wish for furniture: {' '.join(prompt.split())[:60]!r}",
            'the plan is given; say what shall stand in it, e.g. "a bedroom with two nightstands, nordic"',
        )
    try:
        said: FloorProgram | None = understand_rooms(plain, prompt)
    except RefusedError:  # no room is named: the wishes are the whole home's
        said = None
    mentions = _in_plan(program, said, prompt) if said is not None else []
    lost = {"unparsed": said.unparsed, "unbuilt": said.unbuilt} if said is not None else {"unparsed": tuple(_unknown(plain, prompt))}
    wished = allot_pieces(spread(attach(program.model_copy(update=lost), claims, prompt, mentions)))
    check_furniture(wished)
    return wished


def _unknown(plain: str, prompt: str) -> Iterator[Span]:
    """Yield the words that are in no vocabulary of a prompt that names no room; `plain` is it without its wishes."""
    try:
        known = lexicon(detect(prompt)).vocabulary
    except RefusedError:  # wishes alone tell no language
        known = set().union(*(lexicon(language).vocabulary for language in LANGUAGES))
    for word in split_words(plain):
        if word.text[0].isalpha() and fold(word.text) not in known:
            yield Span(start=word.start, end=word.end, text=prompt[word.start : word.end])


def _in_plan(program: FloorProgram, said: FloorProgram, prompt: str) -> list[Mention]:
    """Return the mentions with the ids of the plan's rooms instead of those that the words alone would make."""
    rooms: Mapping[str, RoomReq] = {r.id: r for r in said.rooms}
    mentions = []
    for mention in room_mentions(said):
        ids = tuple(dict.fromkeys(i for name in mention.ids for i in _alike(program, rooms[name])))
        if not ids:
            words = Evidence(start=mention.start, end=mention.end, text=prompt[mention.start : mention.end], field="rooms")
            kind = rooms[mention.ids[0]].type.replace("_", " ")
            have = ", ".join(sorted({r.type.replace("_", " ") for r in program.rooms}))
            raise ImpossibleError(f"the plan has no {kind}", f"it has {have}", [words])
        mentions.append(dataclasses.replace(mention, ids=ids))
    return mentions


def _alike(program: FloorProgram, room: RoomReq) -> tuple[str, ...]:
    """Return the plan's rooms of that id, else of that type and role, else of that type."""
    alike = [r for r in program.rooms if r.type == room.type]
    exact = [r for r in alike if room.role and r.role == room.role]
    return tuple(r.id for r in exact or alike)
