"""Scores of the benchmark's prompts: from the words alone, and given the rooms, links and areas of the ground truth."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.planning import record
from pipeline.experiments.prompt_file import read_prompts
from pipeline.experiments.prompts import SCORES, evaluate_prompts
from pipeline.floorplan import FloorProgram, parse
from pipeline.floorplan.program.floor_program import Entrance, Link, Range, RoomReq
from pipeline.metrics.plan_scores import s_constraint

CASES = Path(__file__).resolve().parents[2] / "manifests" / "prompts" / "benchmark.yaml"


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
    areas: dict[str, float] = {}
    for r in program.rooms:
        areas[r.type] = areas.get(r.type, 0.0) + (r.area.target or 0.0)
    wanted: dict[str, float] = {}
    for row in case["graph"]["rooms"]:
        wanted[row["type"]] = wanted.get(row["type"], 0.0) + row["area"]
    return s_constraint(areas, case["graph"].get("area_ratio") or wanted)


def main(seeds: int) -> None:
    """Print both tables: means over prompts and seeds, and the spread of each score over seeds; keep them in benchmarks/records/planning.json."""
    every = read_prompts(CASES)
    figures: dict[str, Any] = {}
    tops = [ceiling(c, parse(c["prompt"])) for c in every]
    kinds = (
        ("prompt", "from the prompt alone", lambda c: parse(c["prompt"])),
        ("truth", "given the ground-truth rooms, links and areas", truth),
    )
    for key, title, make in kinds:
        scores = evaluate_prompts(every, seeds, make)
        runs = [row["runs"] for row in scores["prompts"]]
        for row in scores["prompts"]:
            for run in row["runs"]:
                if not run["strict"] and make is not truth:
                    print(f"  {row['id']} seed {run['seed']}: P {run['presence']:.3f} A {run['adjacency']:.3f} C {run['constraints']:.3f}")
        spent = scores["mean"]["cpu_seconds"]
        print(f"{scores['plans']} plans, {title}; {1e3 * spent:.0f} CPU ms each")
        figures[key] = {"plans": scores["plans"], "successes": int(sum(run["strict"] for own in runs for run in own)), "cpu_s": spent}
        for name in SCORES:
            table = np.array([[run[name] for run in own] for own in runs])  # prompts, seeds
            each = table.mean(axis=0)
            figures[key][name] = [round(float(v), 4) for v in (each.mean(), each.min(), each.max())]
            worst = table.mean(axis=1).min()
            print(f"  {name:12s} {each.mean():.4f}   seeds {each.min():.4f} to {each.max():.4f}; prompts from {worst:.3f}")
    print(f"S_constraint of exact default areas, prompt alone: {np.mean(tops):.4f}")
    record.keep("scores", seeds, figures | {"ceiling": round(float(np.mean(tops)), 4)})
