"""A house of two storeys: one shaft from its floor to the upper ceiling, with steps that collide."""

from __future__ import annotations

import numpy as np
import pytest
from pxr import Usd, UsdGeom, UsdPhysics

from pipeline.entities.home import Home
from pipeline.floorplan import complete, solve
from pipeline.floorplan.program import FloorProgram, RoomReq
from pipeline.usd.home import write_home


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
