from __future__ import annotations

import shutil

import pytest
from pxr import Gf, Sdf

from pipeline.errors import ContentError
from pipeline.usd import write_home, write_library
from pipeline.usd.check import check_stage


@pytest.fixture
def scene(tmp_path, home):
    made, assets = home
    write_library(assets.values(), tmp_path / "assets")
    return write_home(made, assets, tmp_path / "usd/shard-00000/scene.usda")


def edit(path, change):
    layer = Sdf.Layer.OpenAsAnonymous(str(path))
    change(layer)
    layer.Export(str(path))


def test_a_good_stage_passes(scene):
    assert check_stage(scene).GetDefaultPrim().GetName() == "World"


def test_a_missing_stage_is_named(tmp_path):
    with pytest.raises(ContentError, match=r"nowhere\.usdc is missing"):
        check_stage(tmp_path / "nowhere.usdc")


def test_a_truncated_stage_is_named(scene):
    scene.write_text(scene.read_text()[:200])
    with pytest.raises(ContentError, match="no USD stage"):
        check_stage(scene)


def test_a_missing_asset_is_named(scene, tmp_path):
    shutil.rmtree(tmp_path / "assets/chair_a")
    with pytest.raises(ContentError, match="chair_a"):
        check_stage(scene)


def test_a_missing_payload_is_named(scene, tmp_path):
    (tmp_path / "assets/cabinet_a/cabinet_a_payload.usdc").unlink()
    with pytest.raises(ContentError, match="cabinet_a_payload"):
        check_stage(scene)


def test_an_absolute_path_is_named(scene, tmp_path):
    def change(layer):
        prim = layer.GetPrimAtPath("/World/Objects/chair_0")
        prim.referenceList.prependedItems = [Sdf.Reference(str(tmp_path / "assets/chair_a/chair_a.usda"))]

    edit(scene, change)
    with pytest.raises(ContentError, match="absolute path"):
        check_stage(scene)


def test_a_warning_of_the_composition_is_a_fault(scene):
    def change(layer):
        prim = layer.GetPrimAtPath("/World/Objects/chair_0")
        prim.referenceList.prependedItems = [Sdf.Reference("../../assets/chair_a/chair_a.usda", "/no_such_prim")]

    edit(scene, change)
    with pytest.raises(ContentError, match="usd says"):
        check_stage(scene)


def test_a_scaled_articulation_is_named(scene):
    def change(layer):
        layer.GetAttributeAtPath("/World/Objects/cabinet_0.xformOp:scale").default = Gf.Vec3f(1.5, 1, 1)

    edit(scene, change)
    with pytest.raises(ContentError, match="cabinet_0 is a scaled articulation"):
        check_stage(scene)


def test_disjointed_joint_frames_are_named(scene):
    def change(layer):
        layer.GetAttributeAtPath("/World/Doors/door_1/joints/hinge.physics:localPos0").default = Gf.Vec3f(0.5, 0, 0)

    edit(scene, change)
    with pytest.raises(ContentError, match="door_1/joints/hinge has disjointed frames"):
        check_stage(scene)
