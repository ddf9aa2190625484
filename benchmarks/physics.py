"""What other engines make of our assets and homes: joints that open and shut, things that stay where they lie, speed, validity.

    python benchmarks/physics.py [assets|homes] [--count N] [--dataset DIR] [--python PYTHON ...] [--engines physx,newton,...]

Each engine runs in the first of the given Pythons that has it (this one is tried first), because they do not agree on their
dependencies: `pip install "mujoco[usd]>=4"` here; `newton newton-usd-schemas scipy "mujoco-warp~=3.17.0" "mujoco~=3.17.0" "usd-core<26.9"`, `ovphysx physx-usd-schemas
newton-usd-schemas` and `usd-validation-nvidia "usd-core<26.9"` in a virtual environment of its own. An engine that no Python has is left out, and
named. `assets` puts assets of data/assets, articulated ones and small things in turn, on a floor; `homes` takes those of DATASET;
without either, both. Joints that one engine opens all at once and another does not, for others are in their way, are named at the end.
Pushes are those of engines/plan.py, the trial that of engines/trial.py. Everything found lies in build/physics/*.json.
"""

import argparse
import json
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
HERE = Path(__file__).resolve().parent / "engines"
sys.path[:0] = [str(ROOT), str(HERE)]

ENGINES = {"physx": "ovphysx", "newton": "newton", "mujoco4": "mujoco._usd", "validator": "usd_validation_nvidia"}
OPEN, SHUT, STILL = 0.95, 0.05, (0.005, 1.0)  # shares of a joint's range; [m], [degrees] in 5 s
FLOOR = 1e-4  # [m, rad] beyond that share
BATCH = 48  # assets on one floor
PITCH = 1.5  # [m] between assets


def pythons(candidates: list[str], engines: list[str]) -> dict[str, str]:
    """Return the first Python that has each engine."""
    by_engine = {}
    for engine in engines:
        for python in candidates:
            if not subprocess.run([python, "-c", f"import {ENGINES[engine]}"], capture_output=True, check=False).returncode:
                by_engine[engine] = python
                break
        else:
            print(f"{engine}: no Python has it", flush=True)
    return by_engine


def asset_stage(ids: list[str], folder: Path) -> Path:
    """Write assets of data/assets, and a stage on whose floor they stand apart; return the stage."""
    from pipeline import taxonomy
    from pipeline.entities.files import load_asset
    from pipeline.entities.home import Placement
    from pipeline.geometry.kinematics import sweep_box
    from pipeline.rendering.boxes import box
    from pipeline.usd import write_library, write_mujoco_overlay
    from pipeline.usd.home import placement_text
    from pipeline.usd.layer import read_layer, save
    from pipeline.usd.mesh import convert_mesh
    from pipeline.usd.physics import convert_collider, convert_scene
    from pipeline.usd.prim_templates import group, instantiate

    assets = [load_asset(ROOT / "data" / "assets" / f"{name}.safetensors") for name in ids]
    write_library(assets, folder / "assets")
    objects = []
    x = y = deep = 0.0
    for asset in assets:
        boxes = [sweep_box(asset, k) for k in range(len(asset.joints))] + [np.array([-asset.size / 2, asset.size / 2])]
        low, high = np.min([b[0] for b in boxes], axis=0), np.max([b[1] for b in boxes], axis=0)
        known = taxonomy.load().categories.get(asset.category)
        height = {"floor": 0.0, "wall": 1.2, "ceiling": 2.0}[known.mount if known else "floor"]
        at = np.array([x - low[0], y - low[1], height])
        placed = Placement(asset.asset_id, "", asset.category, asset.asset_id, at, 0.0, asset.size)
        objects.append(placement_text("/World/Objects", placed, {asset.asset_id: asset}, "assets"))
        x, deep = x + high[0] - low[0] + PITCH, max(deep, high[1] - low[1])
        if x > 25:
            x, y, deep = 0.0, y + deep + PITCH, 0.0
    layer = read_layer(
        instantiate(group("assembly"), "/World", instantiate(group("group"), "/World/Objects", "".join(objects))), "World", ".usdc", {}
    )
    convert_scene(layer)
    world = layer.GetPrimAtPath("/World")
    floor = convert_mesh(world, "floor", box("floor", (-30.0, -30.0, -0.5), (60.0, 60.0, 0.0)), (0.5, 0.5, 0.5))
    convert_collider(floor)
    path = save(layer, folder / f"{folder.name}.usdc")
    write_mujoco_overlay(path)
    return path


def pick_assets(count: int) -> list[str]:
    """Return articulated assets and small things in turn, as many kinds of them as there can be, always the same."""
    import pyarrow.parquet as pq

    from pipeline import taxonomy

    known = taxonomy.load().categories
    kinds: dict[str, list[str]] = {}
    for row in pq.read_table(ROOT / "data" / "tables" / "assets.parquet").to_pylist():
        if row["articulated"] or known[row["category"]].loose:
            kinds.setdefault(row["category"], []).append(row["asset_id"])
    turns = range(max(map(len, kinds.values())))
    return [names[turn] for turn in turns for _, names in sorted(kinds.items()) if turn < len(names)][:count]


def trials(stages: list[Path], runs: dict[str, str], folder: Path) -> dict[str, list[dict[str, Any]]]:
    """Give every stage to every engine, each in a process of its own; what is found is kept beside the stage's plan."""
    import plan

    results: dict[str, list[dict[str, Any]]] = {engine: [] for engine in runs}
    for stage in stages:
        todo = plan.read(stage)
        plan_file = folder / f"{stage.stem}.plan.json"
        plan_file.write_text(json.dumps(todo))
        for engine, python in runs.items():
            out = folder / f"{stage.stem}.{engine}.json"
            with (folder / f"{stage.stem}.{engine}.log").open("w") as log:
                call = [python, str(HERE / f"{engine}.py"), str(stage), str(plan_file), str(out)]
                own = {**os.environ, "OMP_NUM_THREADS": "1", "PYTHONPATH": str(ROOT)}  # engines' Pythons do not know this project
                done = subprocess.run(call, stdout=log, stderr=log, check=False, env=own)
            if done.returncode:
                print(f"{engine} failed on {stage.name}: see {log.name}", flush=True)
                continue
            results[engine].append({"plan": todo, "stage": stage.name, **json.loads(out.read_text())})
            report(engine, results[engine][-1:], faults=True)
    return results


def report(engine: str, records: list[dict[str, Any]], *, faults: bool) -> None:
    """Print what an engine found: one line, and with `faults` a line for each thing that is not as it should be."""
    if engine == "validator":
        issues = sum((Counter(r["issues"]) for r in records), Counter())
        print(f"{engine:10s} {dict(issues) or 'no failures, no warnings'}", flush=True)
        for rule, example in records[0]["examples"].items() if faults and records else ():
            print(f"    {rule}: {example[:160]}")
        return
    joints = [j for r in records for j in r["plan"]["joints"]]
    bodies = [b["path"] for r in records for b in r["plan"]["bodies"]]
    opened, closed, left, together = (
        np.concatenate([np.array(r[k], float) for r in records]) for k in ("opened", "closed", "left", "together")
    )
    limited = np.array([j["limited"] for j in joints], bool)
    opens = opened >= OPEN
    near = SHUT + FLOOR / np.array([j["upper"] for j in joints])  # a key of 1 mm gives way by more than its share under a push
    shuts = (np.abs(closed) <= near) | ~limited
    stays = (np.abs(left) <= near) | ~limited
    moved = {k: np.concatenate([np.array(r[k], float).reshape(-1, 2) for r in records]) for k in ("moved_shut", "moved_open")}
    still = {k: (m <= STILL).all(axis=1) for k, m in moved.items()}
    at_rest = [all((np.array(r[k], float).reshape(-1, 2) <= STILL).all() for k in moved) for r in records]
    print(
        f"{engine:10s} {opens.sum()} of {len(joints)} joints open one at a time, {(together >= OPEN).sum()} all at once; {shuts.sum()} shut, "
        f"{stays.sum()} stay shut; {(~still['moved_shut']).sum()} / {(~still['moved_open']).sum()} of {len(bodies)} things move (shut / open), none in {sum(at_rest)} of {len(records)} stages; "
        f"load {np.mean([r['load'] for r in records]):.1f} s of CPU, {np.mean([r['steps_per_second'] for r in records]):.0f} steps/s, {np.mean([r['alone_steps_per_second'] for r in records]):.0f} left alone",
        flush=True,
    )
    for k in np.flatnonzero(~(opens & shuts & stays)) if faults else ():
        j = joints[k]
        print(
            f"    {j['path']} ({j['part']}): opens to {opened[k]:.2f}, shuts to {closed[k]:.2f}, left at {left[k]:.2f}; all at once {together[k]:.2f}"
        )
    for state, m in moved.items() if faults else ():
        for k in np.flatnonzero(~still[state]):
            print(f"    {bodies[k]} {state}: {1000 * m[k, 0]:.1f} mm, {m[k, 1]:.1f} degrees")


def compare_engines(results: dict[str, list[dict[str, Any]]]) -> None:
    """Print how many joints the engines open alike when all are pushed at once, and those which they do not."""
    by_stage = {engine: {r["stage"]: r for r in records} for engine, records in results.items() if engine != "validator" and records}
    shared = sorted(set.intersection(*map(set, by_stage.values()))) if len(by_stage) > 1 else []
    alike, apart = 0, []
    for stage in shared:
        reached = {engine: np.array(records[stage]["together"], float) for engine, records in by_stage.items()}
        opens = np.array([r >= OPEN for r in reached.values()])
        differ = opens.any(axis=0) & ~opens.all(axis=0)
        alike += int((~differ).sum())
        joints = next(iter(by_stage.values()))[stage]["plan"]["joints"]
        apart += [
            (stage, joints[k]["path"], {engine: round(float(r[k]), 2) for engine, r in reached.items()}) for k in np.flatnonzero(differ)
        ]
    if shared:
        print(f"all at once, {alike} of {alike + len(apart)} joints alike in {', '.join(by_stage)}, of {len(shared)} stages")
    for stage, path, shares in apart:
        print(f"    {stage} {path}: {shares}")


def main() -> None:
    """Make or find the stages, run the engines, print the tables."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("what", nargs="?", choices=("assets", "homes"))
    options.add_argument("--count", type=int, default=BATCH)
    options.add_argument("--dataset", type=Path, default=ROOT / "data" / "shards")
    options.add_argument("--python", nargs="*", default=[])
    options.add_argument("--engines", default=",".join(ENGINES))
    options.add_argument("--out", type=Path, default=ROOT / "build" / "physics")
    given = options.parse_args()
    runs = pythons([sys.executable, *given.python], given.engines.split(","))
    given.out.mkdir(parents=True, exist_ok=True)
    for what in [given.what] if given.what else ["assets", "homes"]:
        if what == "homes":
            stages = sorted((given.dataset / "usd").glob("*/*.usdc"))[: given.count]
        else:
            ids = pick_assets(given.count)
            stages = [asset_stage(ids[k : k + BATCH], given.out / f"assets_{k:04d}") for k in range(0, len(ids), BATCH)]
        summarise(what, trials(stages, runs, given.out))


def summarise(what: str, results: dict[str, list[dict[str, Any]]]) -> None:
    """Print what the engines found of all stages together."""
    colliders = [r["plan"]["colliders"] for r in next(iter(results.values()), [])]
    if not colliders:
        print(f"{what}: nothing ran")
        return
    print(f"\n{what}: {len(colliders)} stages, {np.mean(colliders):.0f} colliders each ({min(colliders)} to {max(colliders)})")
    for engine, records in results.items():
        if records:
            report(engine, records, faults=False)
    compare_engines(results)


if __name__ == "__main__":
    main()
