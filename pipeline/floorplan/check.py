"""Is a completed program consistent? Contradictions are refused, naming what clashes."""

from __future__ import annotations

from pipeline.errors import RefusedError
from pipeline.floorplan.program import MAX_ROOMS, FloorProgram


def check(program: FloorProgram) -> None:
    """Raise RefusedError for a program that no plan can meet."""
    if program.storeys > 1:
        raise RefusedError(f"{program.storeys} storeys", "ask for one")
    if len(program.rooms) > MAX_ROOMS:
        raise RefusedError("too many rooms")
