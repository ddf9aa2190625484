"""Attempts to find a plan: of programs of the prior, and of programs read off plans of an independent generator. A refusal, a crash and whatever the audit finds are failures alike."""

import time
import traceback
from collections.abc import Callable

import numpy as np

from pipeline.errors import SfgenError
from pipeline.floorplan import FloorProgram, complete, prior, solve
from tests.floorplan import audit, trees

SOURCES: dict[str, Callable[[np.random.Generator], FloorProgram]] = {"prior": prior, "trees": trees.program}


def attempt(one: tuple[str, int]) -> tuple[float, list[str]]:
    """Solve one program, by source and number; return the solver's CPU seconds and what is wrong, each fault with its kind before a colon."""
    source, number = one
    start = time.process_time()
    try:
        program = complete(SOURCES[source](np.random.default_rng((number, 4))))
        start = time.process_time()
        plan = solve(program, number)
        spent = time.process_time() - start
        return spent, [f"fault: {f}" for f in audit.faults(program, plan)]
    except SfgenError as error:
        return time.process_time() - start, [f"refused: {error}"]
    except Exception as error:  # noqa: BLE001 - a crash is a failure, and no reason to stop counting
        where = traceback.extract_tb(error.__traceback__)[-1]
        return time.process_time() - start, [f"crash: {error!r} at {where.filename.rsplit('/', 1)[-1]}:{where.lineno}"]
