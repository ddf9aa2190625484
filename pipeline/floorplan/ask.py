"""Prompt → program by whichever engine is there: the user's language model, else the built-in parser."""

from __future__ import annotations

from pipeline.floorplan.language import parse
from pipeline.floorplan.program import FloorProgram


def request(prompt: str) -> FloorProgram:
    """Return the completed program of a prompt."""
    return parse(prompt)
