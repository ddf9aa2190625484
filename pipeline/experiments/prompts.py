"""Prompts of a file, planned with several seeds: scores where there is ground truth, failures and seconds everywhere.

A file is text with a prompt a line, or YAML, JSON or JSON lines with ground truth; it is checked before anything is planned.
"""

import time
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from pipeline.errors import ContentError, RefusedError
from pipeline.floorplan import FloorProgram, request, solve
from pipeline.metrics.plan_checks import CHECKS, MEASURES, NEEDS
from pipeline.metrics.plan_scores import score, score_checks
from pipeline.shards import read_entries, require_prompt

Json = dict[str, Any]
REMEDY = "write a list of {prompt, graph, checks} as manifests/prompts/benchmark.yaml has them; graph and checks may be left out"
CHECKED = ("presence", "adjacency", "constraints", "strict")  # what a case without a graph is scored on
SCORES = ("node", "constraint", "edge", "presence", "adjacency", "constraints", "strict")
NAMES = {"node": "S_node", "constraint": "S_constraint", "edge": "S_edge", "strict": "strict success"}  # in print, of those that differ


class _Loose(BaseModel):
    model_config = ConfigDict(extra="allow", frozen=True, allow_inf_nan=False, coerce_numbers_to_str=True)


class _Room(_Loose):
    id: str
    type: str
    area: Annotated[float, Field(gt=0.0)] | None = None


class _Edge(_Loose):
    a: str
    b: str
    optional: bool = False


class _Graph(_Loose):
    rooms: Annotated[list[_Room], Field(min_length=1, max_length=200)]
    edges: list[_Edge] = []
    area_ratio: dict[str, Annotated[float, Field(ge=0.0)]] | None = None


class _Adjacency(_Loose):
    a: str
    b: str


class _Constraint(_Loose):
    type: str


class _Checks(_Loose):
    presence: dict[str, Annotated[int, Field(ge=0)]] = {}
    absent: list[str] = []
    adjacency: list[_Adjacency] = []
    constraints: list[_Constraint] = []


class _Case(_Loose):
    prompt: Annotated[str, Field(strict=True)]
    id: str = ""
    graph: _Graph | None = None
    checks: _Checks = _Checks()


def read_prompts(path: Path) -> list[Json]:
    """Read a file of prompts as `shards.read_entries` does, each with its ground truth. Raises as that does, and ContentError naming the entry that is wrong."""
    return [_case(entry, f"{name} of {path}", name) for name, entry in read_entries(path, REMEDY)]


def _case(entry: object, where: str, name: str) -> Json:
    """Check an entry, a prompt or a case, and return it as a case."""
    try:
        read = _Case.model_validate({"prompt": entry} if isinstance(entry, str) else entry)
    except ValidationError as error:
        first = error.errors()[0]
        raise ContentError(f"{where}: {'.'.join(map(str, first['loc']))}: {first['msg']}", REMEDY) from error
    if read.graph:
        _graph(read.graph, where)
    for check in read.checks.constraints:
        _constraint(check.model_dump(), where)
    plain = read.model_dump(exclude_none=True)
    return {**plain, "id": read.id or name, "prompt": require_prompt(read.prompt, where)}


def _graph(graph: _Graph, where: str) -> None:
    count = Counter(r.id for r in graph.rooms)
    if twice := [i for i, n in count.items() if n > 1]:
        raise ContentError(f"{where}: two rooms of the graph are called {twice[0]!r}", "give each an id of its own")
    if loose := [e for e in graph.edges if not {e.a, e.b} <= set(count)]:
        raise ContentError(f"{where}: the edge {loose[0].a}-{loose[0].b} names a room that the graph lacks", REMEDY)
    if not graph.area_ratio and (bare := [r.id for r in graph.rooms if r.area is None]):
        raise ContentError(f"{where}: room {bare[0]!r} of the graph has no area", "give each room an area, or the graph an area_ratio")


def _constraint(check: Json, where: str) -> None:
    kind = check["type"]
    if kind not in CHECKS:
        raise ContentError(f"{where}: the constraint {kind!r} is unknown", f"known: {', '.join(CHECKS)}")
    for name in NEEDS.get(kind, ()):
        if check.get(name) is None:
            raise ContentError(f"{where}: the constraint {kind!r} lacks {name!r}", REMEDY)
    for name in check.keys() & MEASURES:
        if isinstance(check[name], bool) or not isinstance(check[name], int | float):
            raise ContentError(f"{where}: {name!r} of the constraint {kind!r} is no number", REMEDY)
    for name, wanted in (("rooms", list), ("avoid", list), ("any_room", list), ("exclude", list), ("zones", dict)):
        if name in check and not isinstance(check[name], wanted):
            raise ContentError(f"{where}: {name!r} of the constraint {kind!r} is no {wanted.__name__}", REMEDY)


def evaluate_prompts(
    cases: Sequence[Json], seeds: int, program: Callable[[Json], FloorProgram] = lambda case: request(case["prompt"])
) -> Json:
    """Return every run's scores and seconds, their means and the spread over seeds; a refused prompt scores 0 throughout.

    `spread` is the standard deviation over seeds of what it stands beside; `seconds` is wall time from prompt to plan. `program` makes of a
    case what is solved: by default what its words ask for.
    """
    rows = []
    for case in cases:
        runs = [_run(case, seed, program) for seed in range(seeds)]
        rows.append({"id": case["id"], "prompt": case["prompt"], "scored": bool(score_names(case)), "runs": runs, **_summary(runs)})
    by_seed = [_means([row["runs"][s] for row in rows]) for s in range(seeds)]
    failed = sum(run["refused"] is not None for row in rows for run in row["runs"])
    return {"seeds": seeds, "prompts": rows, "failures": failed, "plans": seeds * len(rows), **_summary(by_seed)}


def _run(case: Json, seed: int, program: Callable[[Json], FloorProgram]) -> Json:
    start, spent = time.perf_counter(), time.process_time()
    plan, refused = None, None
    try:
        plan = solve(program(case), seed)
    except RefusedError as error:
        refused = str(error)
    seconds, cpu_seconds = round(time.perf_counter() - start, 4), round(time.process_time() - spent, 4)
    run: Json = {"seed": seed, "seconds": seconds, "cpu_seconds": cpu_seconds, "refused": refused}
    names = score_names(case)
    if plan is None:
        return run | dict.fromkeys(names, 0.0)
    if "graph" in case:
        scores = score(plan, case)
        run |= {name: round(float(getattr(scores, name)), 6) for name in SCORES[:-1]} | {"strict": float(scores.success)}
    elif names:
        run |= dict(zip(CHECKED, (round(float(v), 6) for v in score_checks(plan, case)), strict=True))
    return run


def score_names(case: Json) -> tuple[str, ...]:
    """Return the scores that a case has ground truth for."""
    return SCORES if "graph" in case else CHECKED if any(case.get("checks", {}).values()) else ()


def _summary(runs: Sequence[Json]) -> Json:
    mean = _means(runs)
    spread = {k: round(float(np.std([r[k] for r in runs])), 4) for k in mean}
    return {"mean": {k: round(v, 4) for k, v in mean.items()}, "spread": spread}


def _means(runs: Sequence[Json]) -> dict[str, float]:
    """Return the mean of each figure over the runs that have it."""
    listed = {k: [r[k] for r in runs if k in r] for k in (*SCORES, "seconds", "cpu_seconds")}
    return {k: float(np.mean(values)) for k, values in listed.items() if values}


def report(figures: Json) -> str:
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
