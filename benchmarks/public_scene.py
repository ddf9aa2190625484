"""MuJoCo's speed on our homes beside a public scene of furniture that opens: `python benchmarks/public_scene.py [DATASET]`.

The scene is the Franka kitchen of gymnasium-robotics (MIT), where Python has that package (`pip install --no-deps gymnasium-robotics`);
the homes are the first COUNT of DATASET. All of them step with the same step of time: with a billionth of a newton on each degree
of freedom before every step, which keeps all of it awake, and left alone, when what may sleep does.
"""

import importlib.util
import sys
import time
from pathlib import Path

import mujoco
import mujoco._usd  # its reader of USD registers itself
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
PACKAGE, SCENE = "gymnasium_robotics", "envs/assets/kitchen_franka/kitchen_assets/kitchen_env_model.xml"
COUNT = 8
DT = 1 / 240  # [s]
SETTLE, WATCHED = 240, 480  # steps


def main() -> None:
    """Print a line for the public scene, where it can be had, and the mean of the homes."""
    dataset = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "data" / "shards"
    found = importlib.util.find_spec(PACKAGE)
    if found and found.submodule_search_locations:
        show("Franka kitchen", [Path(found.submodule_search_locations[0]) / SCENE])
    else:
        print(f"Franka kitchen: {PACKAGE} is not installed")
    homes = sorted((dataset / "usd").glob("*/*.mujoco.usda"))[:COUNT]
    if not homes:
        sys.exit(f"{dataset} has no homes: name a dataset")
    show(f"{len(homes)} homes, in the mean", homes)


def show(name: str, scenes: list[Path]) -> None:
    """Print how large scenes are and how fast they step."""
    table = np.array([measure(scene) for scene in scenes])
    colliders, joints, awake, alone = table.mean(axis=0)
    print(f"{name}: {colliders:.0f} colliders, {joints:.0f} joints; {awake:.0f} steps/s awake, {alone:.0f} left alone")


def measure(scene: Path) -> tuple[int, int, float, float]:
    """Return the colliders and joints with a range of a scene, its steps a second awake and left alone."""
    model = mujoco.MjSpec.from_file(str(scene)).compile()
    model.opt.timestep = DT
    data = mujoco.MjData(model)
    colliders = int(((model.geom_contype != 0) | (model.geom_conaffinity != 0)).sum())
    return colliders, int((model.jnt_limited != 0).sum()), _speed(model, data, touched=True), _speed(model, data, touched=False)


def _speed(model: mujoco.MjModel, data: mujoco.MjData, *, touched: bool) -> float:
    mujoco.mj_resetData(model, data)
    mujoco.mj_step(model, data, SETTLE)
    start = time.process_time()
    for _ in range(WATCHED):
        if touched:
            data.qfrc_applied[:] = 1e-9
        mujoco.mj_step(model, data)
    return WATCHED / (time.process_time() - start)


if __name__ == "__main__":
    main()
