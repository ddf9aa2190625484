"""Failures to find a plan: programs of the prior, and programs read off plans of an independent generator."""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Callable

import numpy as np

from benchmarks.planning import audit, trees
from pipeline.errors import SfgenError
from pipeline.floorplan import FloorProgram, complete, prior, solve

SOURCES: dict[str, Callable[[np.random.Generator], FloorProgram]] = {"prior": prior, "trees": trees.program}
SHOWN = 12


def main(count: int, first: int, sources: tuple[str, ...] = tuple(SOURCES)) -> int:
    """Solve `count` programs of each source; print what failed and return how many did."""
    failed = 0
    for source in sources:
        times, wrong, kinds = [], [], Counter()
        for k in range(first, first + count):
            program = complete(SOURCES[source](np.random.default_rng((k, 4))))
            start = time.process_time()
            try:
                plan = solve(program, k)
                bad = audit.faults(program, plan)
            except SfgenError as error:
                bad = [f"refused: {error}"]
            times.append(time.process_time() - start)
            if bad:
                wrong.append((k, len(program.rooms), bad[0]))
                kinds[bad[0].split(":")[0] if bad[0].startswith("refused") else "fault"] += 1
            if k % 500 == 499:
                print(f"... {source} {k + 1 - first}: {len(wrong)} failed", file=sys.stderr, flush=True)
        print(f"{source}: {len(wrong)} of {count} failed {dict(kinds)}; CPU ms mean {1e3 * np.mean(times):.0f}", end="")
        print(f", p50 {1e3 * np.median(times):.0f}, p99 {1e3 * np.percentile(times, 99):.0f}, max {1e3 * max(times):.0f}", flush=True)
        for k, rooms, bad in wrong[:SHOWN]:
            print(f"  {source} {k} ({rooms} rooms): {bad}")
        failed += len(wrong)
    return failed
