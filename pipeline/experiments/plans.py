"""The floor plan experiment: the benchmark's prompts, parsed and solved, against their ground truth."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import yaml

from pipeline import floorplan
from pipeline.errors import ContentError, SfgenError
from pipeline.floorplan.language import parse
from pipeline.metrics.plan_scores import score

Json = dict[str, Any]


def read_benchmark(text: str) -> list[Json]:
    """Read a prompt set with ground truth (manifests/prompts/benchmark.yaml)."""
    cases = yaml.safe_load(text)
    if not isinstance(cases, list) or not all(isinstance(c, dict) and {"id", "prompt", "graph"} <= c.keys() for c in cases):
        raise ContentError("the benchmark is not a list of {id, prompt, graph}", "restore manifests/prompts/benchmark.yaml")
    return cases


def plan_table(cases: Sequence[Mapping[str, Any]], seeds: int) -> Json:
    """Return the mean scores over prompts and seeds, and one row per prompt; a refused prompt scores 0 throughout."""
    names = ("node", "constraint", "edge", "presence", "adjacency", "constraints", "benchmark")
    rows: list[Json] = []
    for case in cases:
        made = []
        start = time.process_time()
        for seed in range(seeds):
            try:
                found = score(floorplan.solve(parse(case["prompt"]), seed), case)
                made.append({**{name: float(getattr(found, name)) for name in names}, "strict": float(found.success)})
            except SfgenError:
                made.append(dict.fromkeys((*names, "strict"), 0.0))
        spent = (time.process_time() - start) / seeds
        mean = {name: round(float(np.mean([m[name] for m in made])), 4) for name in made[0]}
        rows.append({"id": case["id"], **mean, "cpu_seconds": round(spent, 4)})
    total = {name: round(float(np.mean([row[name] for row in rows])), 4) for name in rows[0] if name != "id"}
    return {"mean": total, "prompts": rows, "seeds": seeds}
