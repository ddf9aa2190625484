"""Reads the items of a prompt from left to right: which rooms there are, and what is said about them."""

from __future__ import annotations

from pipeline.floorplan.language import items as kinds
from pipeline.floorplan.language.facts import Reading, heard
from pipeline.floorplan.language.items import Item
from pipeline.floorplan.language.naming import mentions
from pipeline.floorplan.language.relating import relations
from pipeline.floorplan.language.tokens import Token


def read(tokens: list[Token], parsed: list[list[Item]]) -> Reading:
    """Read all sentences."""
    state = Reading(tokens)
    for sentence in parsed:
        state.owner, state.owning = "", ""
        mentions(state, sentence)
        relations(state, sentence)
        state.past = heard(state, sentence, len(sentence))
        state.level = state.level if any(i.kind == kinds.LEVEL and i.first == sentence[0].first for i in sentence) else None
    return state
