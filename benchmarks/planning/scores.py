"""Scores of the benchmark's prompts: from the words alone, and given the rooms, links and areas of the ground truth."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from benchmarks.planning import record
from pipeline.floorplan import FloorProgram, parse, solve
from pipeline.floorplan.program.floor_program import Entrance, Link, Range, RoomReq
from pipeline.metrics.plan_scores import s_constraint, score

CASES = Path(__file__).resolve().parents[2] / "manifests" / "prompts" / "benchmark.yaml"
NAMES = ("node", "constraint", "edge", "strict_node", "strict_edge", "presence", "adjacency", "constraints", "success")


def cases() -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = yaml.safe_load(CASES.read_text(encoding="utf-8"))
    return found


def truth(case: Mapping[str, Any]) -> FloorProgram:
    """Return the program of a case's ground-truth graph: its rooms with their areas, its links, its entrance."""
    rooms = []
    for row in case["graph"]["rooms"]:
        levels = row.get("levels", [row.get("level", 0)])
        area = Range(target=row["area"], stated=True)
        rooms.append(RoomReq(id=row["id"].lower(), type=row["type"], role=row.get("role", ""), level=min(levels), area=area))
    links = tuple(Link(a=e["a"].lower(), b=e["b"].lower(), kind=e["kind"], stated=True) for e in case["graph"]["edges"])
    into = case["graph"].get("entrance")
    return FloorProgram(
        rooms=tuple(rooms), links=links, storeys=case.get("storeys", 1), entrance=Entrance(into=into, stated=into is not None), only=True
    )


def ceiling(case: Mapping[str, Any], program: FloorProgram) -> float:
    """Return S_constraint of a plan whose rooms have exactly the areas of the completed program."""
    made: dict[str, float] = {}
    for r in program.rooms:
        made[r.type] = made.get(r.type, 0.0) + (r.area.target or 0.0)
    wanted: dict[str, float] = {}
    for row in case["graph"]["rooms"]:
        wanted[row["type"]] = wanted.get(row["type"], 0.0) + row["area"]
    return s_constraint(made, case["graph"].get("area_ratio") or wanted)


def main(seeds: int) -> None:
    """Print both tables: means over prompts and seeds, and the spread of each score over seeds; keep them in benchmarks/records/planning.json."""
    every = cases()
    figures: dict[str, Any] = {}
    tops = [ceiling(c, parse(c["prompt"])) for c in every]
    kinds = (
        ("prompt", "from the prompt alone", lambda c: parse(c["prompt"])),
        ("truth", "given the ground-truth rooms, links and areas", truth),
    )
    for key, title, make in kinds:
        table, spent = np.empty((seeds, len(every), len(NAMES))), []
        for j, case in enumerate(every):
            program = make(case)
            for seed in range(seeds):
                start = time.process_time()
                plan = solve(program, seed)
                spent.append(time.process_time() - start)
                found = score(plan, case)
                table[seed, j] = [float(getattr(found, name)) for name in NAMES]
                if not found.success and make is not truth:
                    print(f"  {case['id']} seed {seed}: P {found.presence:.3f} A {found.adjacency:.3f} C {found.constraints:.3f}")
        print(f"{seeds * len(every)} plans, {title}; {1e3 * np.mean(spent):.0f} CPU ms each")
        figures[key] = {
            "plans": table[..., 0].size,
            "successes": int(table[:, :, NAMES.index("success")].sum()),
            "cpu_s": float(np.mean(spent)),
        }
        for k, name in enumerate(NAMES):
            each = table[:, :, k].mean(axis=1)
            figures[key][name] = [round(float(v), 4) for v in (each.mean(), each.min(), each.max())]
            print(
                f"  {name:12s} {each.mean():.4f}   seeds {each.min():.4f} to {each.max():.4f}; prompts from {table[:, :, k].mean(axis=0).min():.3f}"
            )
    print(f"S_constraint of exact default areas, prompt alone: {np.mean(tops):.4f}")
    record.keep("scores", seeds, figures | {"ceiling": round(float(np.mean(tops)), 4)})
