"""Failures to find a plan: programs of the prior, and programs read off plans of an independent generator.

A refusal, a crash and whatever the audit finds are failures alike. Nothing stops the run: each is printed with its seed and reason.
"""

from __future__ import annotations

import sys
import time
import traceback
from collections import Counter
from collections.abc import Callable

import numpy as np

from benchmarks.planning import audit, trees
from pipeline.errors import SfgenError
from pipeline.floorplan import FloorProgram, complete, prior, solve

SOURCES: dict[str, Callable[[np.random.Generator], FloorProgram]] = {"prior": prior, "trees": trees.program}


def main(count: int, first: int, sources: tuple[str, ...] = tuple(SOURCES)) -> int:
    """Solve `count` programs of each source; print what failed and return how many did."""
    failed = 0
    for source in sources:
        times: list[float] = []
        kinds: Counter[str] = Counter()
        for k in range(first, first + count):
            spent, bad = attempt(source, k)
            times.append(spent)
            if bad:
                kinds[bad[0].split(":")[0]] += 1
                print(f"  {source} {k}: {'; '.join(bad)}", flush=True)
            if k % 500 == 499:
                print(f"... {source} {k + 1 - first}: {sum(kinds.values())} failed", file=sys.stderr, flush=True)
        print(f"{source}: {sum(kinds.values())} of {count} failed {dict(kinds)}; CPU ms mean {1e3 * np.mean(times):.0f}", end="")
        print(f", p50 {1e3 * np.median(times):.0f}, p99 {1e3 * np.percentile(times, 99):.0f}, max {1e3 * max(times):.0f}", flush=True)
        failed += sum(kinds.values())
    return failed


def attempt(source: str, number: int) -> tuple[float, list[str]]:
    """Solve one program; return the solver's CPU seconds and what is wrong, each fault with its kind before a colon."""
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
