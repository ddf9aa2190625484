"""Step many homes at once in MuJoCo, each in a thread of its own.

sfgen export data/shards --to mjcf --out exported/mjcf
python examples/mujoco_homes.py exported/mjcf
"""

import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import mujoco
import numpy as np


def main(folder: str, seconds: float = 1.0) -> None:
    """Load every home and let it rest; MuJoCo lets other threads run while it steps."""
    models = [mujoco.MjModel.from_xml_path(str(path)) for path in sorted(Path(folder).glob("homes/*/*.xml"))]
    states = [mujoco.MjData(model) for model in models]
    steps = [round(seconds / model.opt.timestep) for model in models]
    before = time.perf_counter()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(mujoco.mj_step, models, states, steps))
    rate = sum(steps) / (time.perf_counter() - before)
    print(
        f"{len(models)} homes, {sum(model.njnt for model in models)} joints, {sum(model.ngeom for model in models)} geoms: {rate:.0f} steps/s"
    )
    for model, state in zip(models, states, strict=True):
        hinged = model.jnt_type != mujoco.mjtJoint.mjJNT_FREE
        print(f"  after {seconds:g} s the joint that moved most stands at {np.abs(state.qpos[model.jnt_qposadr[hinged]]).max():.4f}")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "exported/mjcf")
