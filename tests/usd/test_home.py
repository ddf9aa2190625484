from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pxr import Sdf, Usd, UsdGeom, UsdLux, UsdPhysics

from pipeline.errors import ContentError
from pipeline.usd import write_home, write_library, write_mujoco_overlay
from pipeline.usd.check import check_stage


@pytest.fixture(scope="module")
def dataset(tmp_path_factory, home):
    root = tmp_path_factory.mktemp("dataset")
    scene, assets = home
    write_library(assets.values(), root / "assets")
    path = write_home(scene, assets, root / "usd/shard-00000" / f"{scene.scene_id}.usdc")
    return root, path, write_mujoco_overlay(path)


@pytest.fixture(scope="module")
def stage(dataset):
    return Usd.Stage.Open(str(dataset[1]))


def test_the_stage_and_its_overlay_compose_without_a_warning(dataset):
    _, path, overlay = dataset
    check_stage(path)
    check_stage(overlay)


def test_the_stage_is_thin_and_refers_to_the_library_by_relative_path(dataset):
    layer = Sdf.Layer.FindOrOpen(str(dataset[1]))
    wanted = {f"../../assets/{a}/{a}.usda" for a in ("cabinet_a", "cabinet_b", "chair_a")}
    assert set(layer.GetCompositionAssetDependencies()) == wanted
    assert dataset[1].stat().st_size < 60_000
    assert str(dataset[0]).encode() not in dataset[1].read_bytes()


def test_the_world_is_an_assembly_with_the_physics_scene_beside_it(stage):
    assert stage.GetDefaultPrim().GetPath() == "/World"
    assert Usd.ModelAPI(stage.GetDefaultPrim()).GetKind() == "assembly"
    assert stage.GetPrimAtPath("/PhysicsScene").IsA(UsdPhysics.Scene)


def test_objects_stand_where_the_home_says(stage, home):
    cache = UsdGeom.XformCache()
    for placement in home[0].placements:
        prim = stage.GetPrimAtPath(f"/World/Objects/{placement.object_id}")
        matrix = np.array(cache.GetLocalToWorldTransform(prim))
        assert np.allclose(matrix[3, :3], placement.position)
        front = matrix[1, :3] / placement.scale[1] * -1  # USD's rows are the images of the axes; the front is -y
        assert np.allclose(front, [np.sin(placement.yaw), -np.cos(placement.yaw), 0], atol=1e-6)
        assert not prim.IsInstance()
        assert prim.GetAttribute("semantics:labels:class").Get() == [placement.category]


def test_articulations_are_not_scaled_and_scaled_ones_are_refused(home, tmp_path):
    scene, assets = home
    first = scene.placements[0]
    bad = replace(scene, placements=(replace(first, scale=np.array([1.2, 1.0, 1.0])),))
    with pytest.raises(ContentError, match="scales the articulated"):
        write_home(bad, assets, tmp_path / "bad.usdc")
    assert not (tmp_path / "bad.usdc").exists()


def test_an_unknown_asset_is_named(home, tmp_path):
    scene, assets = home
    with pytest.raises(ContentError, match="chair_a"):
        write_home(scene, {k: v for k, v in assets.items() if k != "chair_a"}, tmp_path / "x.usdc")


def test_room_doors_are_hinges_within_their_swing(stage, home):
    doors = stage.GetPrimAtPath("/World/Doors").GetChildren()
    assert [d.GetName() for d in doors] == ["entrance_0", "door_1", "door_2", "door_3"]
    for door in doors:
        assert door.HasAPI(UsdPhysics.ArticulationRootAPI)
        hinge = UsdPhysics.RevoluteJoint(door.GetPrimAtPath("joints/hinge"))
        assert hinge.GetLowerLimitAttr().Get() == 0
        assert hinge.GetUpperLimitAttr().Get() == pytest.approx(np.degrees(1.5))
        assert door.GetPrimAtPath("leaf").HasAPI(UsdPhysics.RigidBodyAPI)


def test_rooms_have_floor_ceiling_walls_and_a_lamp(stage, home):
    for room in home[0].plan.rooms:
        prim = stage.GetPrimAtPath(f"/World/Rooms/{room.room_id}")
        for part in ("floor", "ceiling"):
            assert prim.GetPrimAtPath(part).GetChildren()
        assert prim.GetPrimAtPath("wall").GetAttribute("semantics:labels:class").Get() == ["wall"]
        assert stage.GetPrimAtPath(f"/World/Lights/{room.room_id}").IsA(UsdLux.RectLight)
    assert stage.GetPrimAtPath("/World/Lights/Sky").IsA(UsdLux.DomeLight)


def test_one_can_walk_through_doorways_but_not_through_walls(stage, home):
    """Boxes of the colliders: none in the middle of the open passage above its threshold, one in the wall beside it."""
    cache = UsdGeom.BBoxCache(Usd.TimeCode.Default(), ["default", "guide"], useExtentsHint=False)
    boxes = []
    for prim in stage.Traverse():
        if prim.HasAPI(UsdPhysics.CollisionAPI) and str(prim.GetPath()).startswith(("/World/Walls", "/World/Rooms")):
            reach = cache.ComputeWorldBound(prim).ComputeAlignedRange()
            boxes.append((np.array(reach.GetMin()), np.array(reach.GetMax())))

    def hit(x, y, z):
        return any(np.all(low <= [x, y, z]) and np.all([x, y, z] <= high) for low, high in boxes)

    assert not hit(3.0, 1.46, 1.0)  # the passage between hall and living room
    assert hit(3.0, 1.46, -0.05)  # has ground
    assert not hit(3.0, 1.46, 2.4)  # its lintel is where nothing of a robot comes
    assert hit(1.0, 1.46, 1.0)  # the wall beside it
    for room in home[0].plan.rooms:
        x, y = np.mean(room.polygon, axis=0)
        assert hit(x, y, -0.05)
        assert not hit(x, y, 1.0)
        assert not hit(x, y, room.height + 0.05)  # nor does anything come to a ceiling
    assert hit(-0.12, 4.5, 1.5)  # a window is wall: it does not open


def test_upper_storeys_are_lifted(home, tmp_path):
    scene, assets = home
    plan = scene.plan
    up = replace(plan, rooms=tuple(replace(r, level=1) for r in plan.rooms), openings=tuple(replace(o, level=1) for o in plan.openings))
    path = write_home(replace(scene, plan=up, placements=()), assets, tmp_path / "up.usda")
    made = check_stage(path)
    matrix = UsdGeom.XformCache().GetLocalToWorldTransform(made.GetPrimAtPath("/World/Rooms/bed"))
    assert matrix.ExtractTranslation()[2] == pytest.approx(plan.storey_height)
    assert UsdGeom.XformCache().GetLocalToWorldTransform(made.GetPrimAtPath("/World/Doors/door_1")).ExtractTranslation()[
        2
    ] == pytest.approx(3.0)


SCRIPT = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[2])
from conftest import make_home
from pipeline.usd import write_home, write_library, write_mujoco_overlay
home, assets = make_home()
root = Path(sys.argv[1])
write_library(assets.values(), root / "assets")
write_mujoco_overlay(write_home(home, assets, root / "usd/shard-00000" / f"{home.scene_id}.usdc"))
"""


def test_another_process_writes_the_same_bytes(dataset, tmp_path):
    root = dataset[0]
    here = Path(__file__).resolve()
    environment = {**os.environ, "PYTHONPATH": str(here.parents[2]), "PYTHONHASHSEED": "7"}
    subprocess.run([sys.executable, "-c", SCRIPT, str(tmp_path), str(here.parent)], check=True, env=environment, cwd=tmp_path)
    files = sorted(p.relative_to(root) for p in root.rglob("*") if p.is_file())
    assert files == sorted(p.relative_to(tmp_path) for p in tmp_path.rglob("*") if p.is_file() and "__pycache__" not in p.parts)
    for name in files:
        assert (root / name).read_bytes() == (tmp_path / name).read_bytes(), name


def test_rewriting_leaves_no_half_file(dataset, home):
    scene, assets = home
    before = dataset[1].read_bytes()
    write_home(scene, assets, dataset[1])
    assert dataset[1].read_bytes() == before
    assert sorted(p.name for p in dataset[1].parent.iterdir()) == ["s0_00000000.mujoco.usda", "s0_00000000.usdc"]
