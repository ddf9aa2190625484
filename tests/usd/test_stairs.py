"""A house of two storeys: one shaft from its floor to the upper ceiling, with steps that collide."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from pxr import Usd, UsdGeom, UsdPhysics

from pipeline.entities.home import Home
from pipeline.entities.plan import Opening, Plan, Room
from pipeline.floorplan import complete, solve
from pipeline.floorplan.program.floor_program import FloorProgram, RoomReq
from pipeline.geometry.stairs import steps
from pipeline.usd.home import write_home
from pipeline.usd.mujoco import write_mujoco_overlay


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    rooms = (RoomReq(id="living", type="living_room", level=0), RoomReq(id="bed", type="bedroom", level=1))
    plan = solve(complete(FloorProgram(storeys=2, rooms=rooms, only=True)), 0)
    path = tmp_path_factory.mktemp("house") / "house.usda"
    write_home(Home("house", 0, 0, "", "", plan, ()), {}, path)
    return plan, Usd.Stage.Open(str(path))


def heights(stage, path):
    box = UsdGeom.BBoxCache(0, [UsdGeom.Tokens.default_]).ComputeWorldBound(stage.GetPrimAtPath(path)).ComputeAlignedRange()
    return np.round([box.GetMin()[2], box.GetMax()[2]], 3)


def test_the_shaft_goes_through(house):
    plan, stage = house
    room = next(r for r in plan.rooms if r.type == "staircase")
    path, top = f"/World/Rooms/{room.room_id}", plan.storey_height + room.height
    assert heights(stage, f"{path}/floor")[1] == 0.0
    assert heights(stage, f"{path}/ceiling")[0] == pytest.approx(top)
    assert heights(stage, f"{path}/wall") == pytest.approx((0.0, top))


def test_steps_collide_and_reach_the_upper_floor(house):
    plan, stage = house
    solids = [p for level in (0, 1) for p in stage.GetPrimAtPath(f"/World/Walls/level_{level}/stairs").GetChildren()]
    assert all(p.HasAPI(UsdPhysics.CollisionAPI) for p in solids)
    tops = sorted(heights(stage, p.GetPath())[1] for p in solids if p.GetName().startswith(("step", "landing")))
    assert tops[-1] == plan.storey_height
    assert max(np.diff([0.0, *tops])) <= 0.2 + 1e-6


def fans(faces):
    """Return by corner how many groups of polygons there meet in no edge."""
    links = {}
    for face in faces:
        for before, corner, after in zip(face[-1:] + face[:-1], face, face[1:] + face[:1], strict=True):
            near = {before, after}
            apart = []
            for group in links.get(corner, []):
                if group & near:
                    near |= group
                else:
                    apart.append(group)
            links[corner] = [*apart, near]
    return {corner: len(groups) for corner, groups in links.items()}


def test_walls_of_a_staircase_meet_in_edges(tmp_path):
    hall = np.array([[0, -2], [5, -2], [5, -0.12], [0, -0.12]], float)
    shaft = Room("stairs", "staircase", np.array([[0, 0], [2.9, 0], [2.9, 2.1], [0, 2.1]], float))
    rooms = (shaft, Room("below", "hallway", hall), Room("above", "hallway", hall, 1))
    plan = Plan(rooms, (Opening("door", "open", ("stairs", "above"), np.array([[0.85, -0.06], [2.05, -0.06]]), 2.4, level=1),), "below")
    stage = Usd.Stage.Open(str(write_home(Home("house", 0, 0, "", "", plan, ()), {}, tmp_path / "house.usda")))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/World/Rooms/stairs/wall"))
    ends = np.cumsum(mesh.GetFaceVertexCountsAttr().Get())
    faces = [face.tolist() for face in np.split(np.array(mesh.GetFaceVertexIndicesAttr().Get()), ends[:-1])]
    assert set(fans(faces).values()) == {1}


# In a process of its own: mujoco's USD plug-ins change what usd-core knows, and it logs to the working directory.
DROP = """
import json, sys
import mujoco, mujoco._usd
spec = mujoco.MjSpec.from_file(sys.argv[1])
places = json.loads(sys.argv[2])
for i, place in enumerate(places):
    body = spec.worldbody.add_body(name=f"box_{i}", pos=place)
    body.add_freejoint()
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.03, 0.03, 0.03], mass=0.2)
model = spec.compile()
data = mujoco.MjData(model)
for _ in range(1000):
    mujoco.mj_step(model, data)
print(json.dumps([data.body(f"box_{i}").xpos[2] - 0.03 for i in range(len(places))]))
"""


def test_a_box_comes_to_rest_on_every_step(house):
    pytest.importorskip("mujoco")
    plan, stage = house
    path = Path(stage.GetRootLayer().realPath)
    flight = [s for s in steps(plan, 0) if s.kind == "step"]
    places = [[*s.polygon.mean(axis=0), s.top + 0.08] for s in flight]
    command = [sys.executable, "-c", DROP, str(write_mujoco_overlay(path)), json.dumps(places)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=path.parent, timeout=300)
    assert json.loads(done.stdout.splitlines()[-1]) == pytest.approx([s.top for s in flight], abs=2e-3)
