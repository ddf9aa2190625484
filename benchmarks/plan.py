"""CPU time and scores of floor plans: `python -m benchmarks.plan`. Prints a table; takes about a minute."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import yaml

from pipeline.entities.plan import Plan
from pipeline.floorplan import FloorProgram, complete, parse, prior, solve
from pipeline.floorplan.program import RoomReq
from pipeline.metrics.plan_scores import score

SEEDS, PRIOR = 2, 100
HOMES = {
    5: ("living_room", "kitchen", "bedroom", "bathroom", "entry"),
    8: ("living_room", "kitchen", "bedroom", "bedroom", "bathroom", "hallway", "wc", "balcony"),
    12: (
        "living_room",
        "kitchen",
        "dining_room",
        "hallway",
        "bedroom",
        "bedroom",
        "bedroom",
        "bathroom",
        "bathroom",
        "wc",
        "utility",
        "office",
    ),
}
CASES = Path(__file__).resolve().parents[1] / "manifests" / "prompts" / "benchmark.yaml"


def timed(program: FloorProgram, seed: int) -> tuple[Plan, float]:
    start = time.process_time()
    plan = solve(program, seed)
    return plan, time.process_time() - start


def main() -> None:
    solve(complete(FloorProgram(rooms=(RoomReq(id="studio", type="studio_room"),))), 0)  # compile
    print("rooms    mean ms     p95 ms     max ms   (CPU, program to plan, warm)")
    for count, kinds in HOMES.items():
        program = complete(FloorProgram(rooms=tuple(RoomReq(id=f"r{i}", type=k) for i, k in enumerate(kinds)), only=True))
        times = [1000 * timed(program, seed)[1] for seed in range(30)]
        print(f"{count:5d} {np.mean(times):10.0f} {np.percentile(times, 95):10.0f} {max(times):10.0f}")
    times = [1000 * timed(prior(np.random.default_rng(seed)), seed)[1] for seed in range(PRIOR)]  # raises when one is refused
    print(f"prior {np.mean(times):10.0f} {np.percentile(times, 95):10.0f} {max(times):10.0f}   ({PRIOR} programs, none refused)")
    rows = []
    for case in yaml.safe_load(CASES.read_text(encoding="utf-8")):
        program = parse(case["prompt"])
        for seed in range(SEEDS):
            plan, seconds = timed(program, seed)
            found = score(plan, case)
            rows.append(
                (found.node, found.constraint, found.edge, found.presence, found.adjacency, found.constraints, found.success, seconds)
            )
            if not found.success:
                print(f"{case['id']} seed {seed}: P {found.presence:.2f} A {found.adjacency:.2f} C {found.constraints:.2f}")
    means = np.mean(np.array(rows, dtype=float), axis=0)
    names = ("S_node", "S_constraint", "S_edge", "presence", "adjacency", "constraints", "strict success", "CPU s")
    print(f"\n{len(rows)} plans of the {len(rows) // SEEDS} benchmark prompts, from the prompt alone:")
    for name, value in zip(names, means, strict=True):
        print(f"  {name:15s} {value:.4f}")


if __name__ == "__main__":
    main()
