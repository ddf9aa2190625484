"""MuJoCo, which shares no code with us, loads the overlay: joints move through their range, what is fixed stays."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from pipeline.usd import write_home, write_library, write_mujoco_overlay

# In a process of its own: mujoco's USD plug-ins change what usd-core knows, and it logs to the working directory.
SCRIPT = """
import json, sys
import mujoco, mujoco._usd
import numpy as np
model = mujoco.MjSpec.from_file(sys.argv[1]).compile()
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
fixed = [b for b in range(1, model.nbody) if model.body_weldid[b] == 0]
start = data.xpos[fixed].copy()
for _ in range(300):
    mujoco.mj_step(model, data)
drift = float(np.abs(data.qpos).max())
asleep = int((data.tree_asleep >= 0).sum())
reached = {}
for j in range(model.njnt):
    ends = []
    for push in (1, -1):
        for _ in range(1500):
            data.qfrc_applied[:] = 0
            data.qfrc_applied[j] = push * (30.0 if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_SLIDE else 8.0)
            mujoco.mj_step(model, data)
        ends.append(float(data.qpos[j]))
    limited = bool(model.jnt_limited[j])
    reached[model.joint(j).name] = [*ends, float(model.jnt_range[j][1]) if limited else None]
print(json.dumps({
    "bodies": model.nbody, "trees": model.ntree, "asleep": asleep, "fixed": len(fixed), "moved": float(np.abs(data.xpos[fixed] - start).max()), "drift": drift,
    "reached": reached, "free": int((model.jnt_type == mujoco.mjtJoint.mjJNT_FREE).sum()),
    "mass": {model.body(b).name: float(model.body_mass[b]) for b in range(1, model.nbody)},
}))
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory, home):
    pytest.importorskip("mujoco")
    root = tmp_path_factory.mktemp("mujoco")
    scene, assets = home
    write_library(assets.values(), root / "assets")
    overlay = write_mujoco_overlay(write_home(scene, assets, root / "usd/shard-00000/scene.usdc"))
    done = subprocess.run([sys.executable, "-c", SCRIPT, str(overlay)], capture_output=True, text=True, cwd=root, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    assert "WARNING" not in done.stderr + done.stdout
    return json.loads(done.stdout.splitlines()[-1])


def test_every_joint_moves_through_its_range(run):
    assert len(run["reached"]) == 4 + 3 * 3  # four room doors; drawer, door and knob of three cabinets
    for name, (opened, closed, upper) in run["reached"].items():
        if upper is not None:
            assert opened == pytest.approx(upper, rel=0.01), name
            assert closed == pytest.approx(0.0, abs=0.01 * upper), name
        else:
            assert opened > 3.0, name  # a knob without limits goes round


def test_what_is_fixed_stays_and_nothing_falls_open(run):
    assert run["fixed"] == 4 + 3  # door frames and cabinet bases
    assert run["free"] == 0
    assert run["moved"] < 1e-9
    assert run["drift"] < 0.005


def test_what_stands_still_sleeps_until_it_is_pushed(run):
    assert run["asleep"] == run["trees"] == 4 + 3 * 3  # and each of them woke: test_every_joint_moves_through_its_range


def test_bodies_weigh_what_the_assets_say(run, cabinet):
    for link in cabinet.links:
        assert run["mass"][f"/World/Objects/cabinet_0/{link.name}"] == pytest.approx(link.mass, rel=1e-3)
