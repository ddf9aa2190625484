"""Prompts of a file, planned with several seeds: scores where there is ground truth, failures and seconds everywhere."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from pipeline.errors import ContentError, RefusedError, SfgenError, UsageError
from pipeline.floorplan import request, solve
from pipeline.metrics.plan_checks import CHECKS
from pipeline.metrics.plan_scores import score
from pipeline.shards import require_prompt

Json = dict[str, Any]
SCORES = ("node", "constraint", "edge", "presence", "adjacency", "constraints", "strict")
NAMES = {
    "node": "S_node",
    "constraint": "S_constraint",
    "edge": "S_edge",
    "presence": "presence",
    "adjacency": "adjacency",
    "constraints": "constraints",
    "strict": "strict success",
}
MOST_BYTES, MOST_SEEDS = 16 << 20, 1000


class _Loose(BaseModel):
    model_config = ConfigDict(extra="allow", frozen=True, allow_inf_nan=False)


class _Room(_Loose):
    id: str
    type: str
    area: Annotated[float, Field(gt=0.0)]


class _Edge(_Loose):
    a: str
    b: str


class _Graph(_Loose):
    rooms: Annotated[list[_Room], Field(min_length=1, max_length=200)]
    edges: list[_Edge] = []
    area_ratio: dict[str, float] | None = None


class _Adjacency(_Loose):
    a: str
    b: str


class _Constraint(_Loose):
    type: str


class _Checks(_Loose):
    presence: dict[str, int] = {}
    absent: list[str] = []
    adjacency: list[_Adjacency] = []
    constraints: list[_Constraint] = []


class _Case(_Loose):
    prompt: str
    id: str = ""
    graph: _Graph | None = None
    checks: _Checks = _Checks()


def read_prompts(path: Path) -> list[Json]:
    """Read a text file (a prompt a line, `#` begins a comment) or a YAML list of prompts, with ground truth where there is some.

    Raises UsageError for a path that is no file, ContentError naming the entry that is wrong.
    """
    if not path.is_file():
        raise UsageError(
            f"{path} is {'not a file' if path.exists() else 'missing'}", "give a text file with a prompt a line, or a YAML list"
        )
    if path.stat().st_size > MOST_BYTES:
        raise ContentError(f"{path} is larger than {MOST_BYTES >> 20} MiB", "give fewer prompts")
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ContentError(f"cannot read {path} ({error})", "give a file in UTF-8") from error
    if path.suffix.lower() not in {".yaml", ".yml"}:
        lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip() and not line.lstrip().startswith("#")]
        cases = [{"id": f"line {n}", "prompt": require_prompt(line, f"line {n} of {path}")} for n, line in lines]
    else:
        cases = _yaml_cases(path, text)
    if not cases:
        raise UsageError(f"{path} holds no prompt", "write one prompt a line")
    return cases


def _yaml_cases(path: Path, text: str) -> list[Json]:
    remedy = "write a list of {prompt, graph, checks} as manifests/prompts/benchmark.yaml has them; graph and checks may be left out"
    try:
        found = yaml.safe_load(text)
    except (yaml.YAMLError, RecursionError) as error:
        raise ContentError(f"{path} is not YAML ({str(error).splitlines()[0]})", remedy) from error
    if not isinstance(found, list):
        raise ContentError(f"{path} is not a list", remedy)
    cases: list[Json] = []
    for n, entry in enumerate(found, 1):
        where = f"entry {n} of {path}"
        case = {"prompt": entry} if isinstance(entry, str) else entry
        try:
            read = _Case.model_validate(case)
        except ValidationError as error:
            first = error.errors()[0]
            raise ContentError(f"{where}: {'.'.join(map(str, first['loc']))}: {first['msg']}", remedy) from error
        ids = {r.id for r in read.graph.rooms} if read.graph else set()
        loose = [e for e in (read.graph.edges if read.graph else ()) if not {e.a, e.b} <= ids]
        if loose:
            raise ContentError(f"{where}: the edge {loose[0].a}-{loose[0].b} names a room that the graph lacks", remedy)
        unknown = [c.type for c in read.checks.constraints if c.type not in CHECKS]
        if unknown:
            raise ContentError(f"{where}: the constraint {unknown[0]!r} is unknown", f"known: {', '.join(CHECKS)}")
        plain = read.model_dump(exclude_none=True)
        cases.append({**plain, "id": read.id or f"entry {n}", "prompt": require_prompt(read.prompt, where)})
    return cases


def measured(cases: Sequence[Mapping[str, Any]], seeds: int) -> Json:
    """Return every run's scores and seconds, their means and the spread over seeds; a refused prompt scores 0 throughout.

    `spread` is the standard deviation over seeds of what it stands beside; `seconds` is wall time from prompt to plan.
    """
    rows = []
    for case in cases:
        runs = [_run(case, seed) for seed in range(seeds)]
        rows.append({"id": case["id"], "prompt": case["prompt"], "scored": "graph" in case, "runs": runs, **_summary(runs)})
    by_seed = [
        {k: float(np.mean([row["runs"][s][k] for row in rows if k in row["runs"][s]])) for k in (*SCORES, "seconds") if _any(rows, s, k)}
        for s in range(seeds)
    ]
    failed = sum(run["refused"] is not None for row in rows for run in row["runs"])
    return {"seeds": seeds, "prompts": rows, "failures": failed, "plans": seeds * len(rows), **_summary(by_seed)}


def _any(rows: Sequence[Json], seed: int, key: str) -> bool:
    return any(key in row["runs"][seed] for row in rows)


def _run(case: Mapping[str, Any], seed: int) -> Json:
    start, spent = time.perf_counter(), time.process_time()
    refused = None
    plan = None
    try:
        plan = solve(request(case["prompt"]), seed)
    except SfgenError as error:
        if not isinstance(error, RefusedError):
            raise
        refused = str(error)
    run: Json = {"seed": seed, "seconds": round(time.perf_counter() - start, 4), "cpu_seconds": round(time.process_time() - spent, 4)}
    run["refused"] = refused
    if "graph" in case:
        if plan is None:
            return run | dict.fromkeys(SCORES, 0.0)
        found = score(plan, case)
        run |= {name: round(float(getattr(found, name)), 6) for name in SCORES[:-1]} | {"strict": float(found.success)}
    return run


def _summary(runs: Sequence[Mapping[str, Any]]) -> Json:
    keys = [k for k in (*SCORES, "seconds") if runs and k in runs[0]]
    return {
        "mean": {k: round(float(np.mean([r[k] for r in runs])), 4) for k in keys},
        "spread": {k: round(float(np.std([r[k] for r in runs])), 4) for k in keys},
    }


def report(found: Mapping[str, Any]) -> str:
    """Return the figures as a table: a line per prompt, then the mean over all with its spread over seeds."""
    scored = any(row["scored"] for row in found["prompts"])
    names = [*SCORES, "seconds"] if scored else ["seconds"]
    wide = min(32, max(len(row["id"]) for row in found["prompts"]) + 2)
    head = f"{'prompt':{wide}s}" + "".join(f"{NAMES.get(n, n):>16s}" for n in names) + f"{'refused':>10s}"
    lines = [head]
    for row in found["prompts"]:
        cells = "".join(f"{row['mean'][n]:16.3f}" if n in row["mean"] else f"{'-':>16s}" for n in names)
        lines.append(f"{row['id'][: wide - 1]:{wide}s}{cells}{sum(r['refused'] is not None for r in row['runs']):10d}")
    for label in ("mean", "spread"):
        cells = "".join(f"{found[label][n]:16.4f}" if n in found[label] else f"{'-':>16s}" for n in names)
        lines.append(f"{label:{wide}s}{cells}" + (f"{found['failures']:10d}" if label == "mean" else ""))
    lines.append(
        f"{found['plans']} plans: {len(found['prompts'])} prompts with {found['seeds']} seeds; spread: standard deviation over seeds"
    )
    lines += [f"refused: {row['id']}: {r['refused']}" for row in found["prompts"] for r in row["runs"][:1] if r["refused"]]
    return "\n".join(lines) + "\n"
