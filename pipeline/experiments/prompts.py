"""Prompts of a file, planned with several seeds: scores where there is ground truth, failures and seconds everywhere."""

import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from pipeline.errors import RefusedError, SfgenError
from pipeline.floorplan import FloorProgram, request, solve
from pipeline.metrics.plan_scores import score, score_checks

Json = dict[str, Any]
CHECKED = ("presence", "adjacency", "constraints", "strict")  # what a case without a graph is scored on
SCORES = ("node", "constraint", "edge", "presence", "adjacency", "constraints", "strict")
NAMES = {"node": "S_node", "constraint": "S_constraint", "edge": "S_edge", "strict": "strict success"}  # in print, of those that differ


def case_program(case: Mapping[str, Any]) -> FloorProgram:
    """Return what the words of a case ask for."""
    return request(case["prompt"])


def evaluate_prompts(
    cases: Sequence[Mapping[str, Any]], seeds: int, program: Callable[[Mapping[str, Any]], FloorProgram] = case_program
) -> Json:
    """Return every run's scores and seconds, their means and the spread over seeds; a refused prompt scores 0 throughout.

    `spread` is the standard deviation over seeds of what it stands beside; `seconds` is wall time from prompt to plan. `program` makes of a case
    what is solved.
    """
    rows = []
    for case in cases:
        runs = [_run(case, seed, program) for seed in range(seeds)]
        rows.append({"id": case["id"], "prompt": case["prompt"], "scored": bool(score_names(case)), "runs": runs, **_summary(runs)})
    by_seed = [_means([row["runs"][s] for row in rows]) for s in range(seeds)]
    failed = sum(run["refused"] is not None for row in rows for run in row["runs"])
    return {"seeds": seeds, "prompts": rows, "failures": failed, "plans": seeds * len(rows), **_summary(by_seed)}


def _run(case: Mapping[str, Any], seed: int, program: Callable[[Mapping[str, Any]], FloorProgram]) -> Json:
    start, spent = time.perf_counter(), time.process_time()
    refused = None
    plan = None
    try:
        plan = solve(program(case), seed)
    except SfgenError as error:
        if not isinstance(error, RefusedError):
            raise
        refused = str(error)
    run: Json = {"seed": seed, "seconds": round(time.perf_counter() - start, 4), "cpu_seconds": round(time.process_time() - spent, 4)}
    run["refused"] = refused
    names = score_names(case)
    if plan is None:
        return run | dict.fromkeys(names, 0.0)
    if "graph" in case:
        scores = score(plan, case)
        run |= {name: round(float(getattr(scores, name)), 6) for name in SCORES[:-1]} | {"strict": float(scores.success)}
    elif names:
        run |= dict(zip(CHECKED, (round(float(v), 6) for v in score_checks(plan, case)), strict=True))
    return run


def score_names(case: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the scores that a case has ground truth for."""
    return SCORES if "graph" in case else CHECKED if any(case.get("checks", {}).values()) else ()


def _summary(runs: Sequence[Mapping[str, Any]]) -> Json:
    mean = _means(runs)
    spread = {k: round(float(np.std([r[k] for r in runs])), 4) for k in mean}
    return {"mean": {k: round(v, 4) for k, v in mean.items()}, "spread": spread}


def _means(runs: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    """Return the mean of each figure over the runs that have it."""
    listed = {k: [r[k] for r in runs if k in r] for k in (*SCORES, "seconds", "cpu_seconds")}
    return {k: float(np.mean(values)) for k, values in listed.items() if values}


def report(figures: Mapping[str, Any]) -> str:
    """Return the figures as a table: a line per prompt, then the mean over all with its spread over seeds."""
    any_scored = any(row["scored"] for row in figures["prompts"])
    names = [*SCORES, "seconds"] if any_scored else ["seconds"]
    wide = min(32, max(len(row["id"]) for row in figures["prompts"]) + 2)
    head = f"{'prompt':{wide}s}" + "".join(f"{NAMES.get(n, n):>16s}" for n in names) + f"{'refused':>10s}"
    lines = [head]
    for row in figures["prompts"]:
        cells = "".join(f"{row['mean'][n]:16.3f}" if n in row["mean"] else f"{'-':>16s}" for n in names)
        lines.append(f"{row['id'][: wide - 1]:{wide}s}{cells}{sum(r['refused'] is not None for r in row['runs']):10d}")
    for label in ("mean", "spread"):
        cells = "".join(f"{figures[label][n]:16.4f}" if n in figures[label] else f"{'-':>16s}" for n in names)
        lines.append(f"{label:{wide}s}{cells}" + (f"{figures['failures']:10d}" if label == "mean" else ""))
    lines.append(
        f"{figures['plans']} plans: {len(figures['prompts'])} prompts with {figures['seeds']} seeds; spread: standard deviation over seeds"
    )
    lines += [f"refused: {row['id']}: {r['refused']}" for row in figures["prompts"] for r in row["runs"][:1] if r["refused"]]
    return "\n".join(lines) + "\n"
