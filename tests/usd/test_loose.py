"""Small things are bodies of their own: they rest on what they stand on, and a drawer still comes out with what is in it."""

import json
import subprocess
import sys

import numpy as np
import pytest
from pxr import Usd, UsdPhysics

from pipeline.entities.home import Home, Placement
from pipeline.usd import write_home, write_library, write_mujoco_overlay
from pipeline.usd.check import check_stage
from pipeline.usd.physics import ITERATIONS
from tests.geometry import furniture

# In a process of its own, as in test_mujoco.
SCRIPT = """
import json, sys
import mujoco, mujoco._usd
import numpy as np
model = mujoco.MjSpec.from_file(sys.argv[1]).compile()
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
names = [model.body(b).name for b in range(model.nbody)]
free = [int(model.jnt_bodyid[j]) for j in range(model.njnt) if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_FREE]
start = data.xpos.copy()
for _ in range(1000):
    mujoco.mj_step(model, data)
rest = np.linalg.norm(data.xpos - start, axis=1)
asleep = int((data.tree_asleep >= 0).sum())
slide = next(j for j in range(model.njnt) if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_SLIDE)
for _ in range(1500):
    data.qfrc_applied[model.jnt_dofadr[slide]] = 25.0
    mujoco.mj_step(model, data)
print(json.dumps({
    "asleep": asleep, "trees": model.ntree, "free": {names[b]: float(rest[b]) for b in free}, "open": float(data.qpos[model.jnt_qposadr[slide]]),
    "moved": {names[b]: (data.xpos[b] - start[b]).tolist() for b in free},
}))
"""


@pytest.fixture(scope="module")
def stage(tmp_path_factory):
    root = tmp_path_factory.mktemp("loose")
    assets = {a.asset_id: a for a in (furniture.tray_chest(), furniture.flip(), furniture.LIBRARY["cup"], furniture.LIBRARY["book"])}

    def put(name, dx, z, support):
        made = assets[name]
        return Placement(f"{name}_0", "room", made.category, name, np.array([2.0 + dx, 2.74, z]), 0.0, made.size, support=support)

    chest = put("tray_chest", 0.0, 0.0, "")
    things = (put("cup", 0.18, 0.5, "tray_chest_0"), put("flip", -0.06, 0.5, "tray_chest_0"), put("book", 0.0, 0.14, "tray_chest_0"))
    write_library(assets.values(), root / "assets")
    path = write_home(
        Home("s0_00000000", 0, 0, "", "", furniture.one_room(), (chest, *things)), assets, root / "usd/shard-00000/scene.usdc"
    )
    return path, write_mujoco_overlay(path)


def test_a_thing_is_a_body_and_says_what_it_stands_on(stage):
    made = Usd.Stage.Open(str(stage[0]))
    cup, flip = (made.GetPrimAtPath(f"/World/Objects/{name}_0") for name in ("cup", "flip"))
    assert cup.GetRelationship("sfgen:support").GetTargets() == ["/World/Objects/tray_chest_0"]
    assert cup.GetChild("base").HasAPI(UsdPhysics.RigidBodyAPI)
    assert cup.GetChild("base").GetAttribute("physics:mass").Get() == pytest.approx(10.0)
    assert cup.GetChild("base").GetAttribute("physxRigidBody:solverPositionIterationCount").Get() == ITERATIONS[0]
    assert not cup.HasAPI(UsdPhysics.ArticulationRootAPI)
    assert flip.HasAPI(UsdPhysics.ArticulationRootAPI)
    assert not flip.GetChild("joints").GetChild("world_fixed")
    assert made.GetPrimAtPath("/World/Objects/tray_chest_0/joints/world_fixed")
    check_stage(stage[0])


def test_things_stay_where_they_stand_and_drawers_take_theirs_along(stage, tmp_path):
    pytest.importorskip("mujoco")
    done = subprocess.run([sys.executable, "-c", SCRIPT, str(stage[1])], capture_output=True, text=True, cwd=tmp_path, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    found = json.loads(done.stdout.splitlines()[-1])
    assert {name.split("/")[3] for name in found["free"]} == {"cup_0", "flip_0", "book_0"}
    assert max(found["free"].values()) < 0.01
    assert found["open"] == pytest.approx(0.3, abs=0.01)
    moved = {name.split("/")[3]: value for name, value in found["moved"].items()}
    assert found["asleep"] == found["trees"]
    assert moved["book_0"][1] < -0.2  # in the drawer, which woke it
    assert abs(moved["cup_0"][1]) < 0.01  # on top
