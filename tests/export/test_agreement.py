"""What MJCF, URDF and GLB say is what USD says: read again by code that shares nothing with the exporter."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

import sfgen
from pipeline.export import FORMATS, ExportFolder, export_home
from pipeline.export.stage import read_asset, read_home
from pipeline.usd import write_home, write_library
from tests.export import readings
from tests.usd.conftest import make_home
from tests.usd.test_shared_boards import make_cupboard, put

TOLERANCE = 1e-6


@pytest.fixture(scope="module")
def home(furnished):
    return sfgen.load(furnished)[0]


@pytest.fixture(scope="module")
def exported(home, tmp_path_factory):
    place = tmp_path_factory.mktemp("exported")
    return {form: export_home(ExportFolder(place / form, form, "d", "CC0-1.0"), home.usd, home.scene_id) for form in FORMATS}


@pytest.mark.parametrize("form", FORMATS)
def test_a_format_says_what_usd_says(home, exported, form):
    if form == "mjcf":
        pytest.importorskip("mujoco")
    stage = readings.from_usd(home.usd)
    assert len(stage.joints) == 4 + 3 * 3 + 1  # room doors; drawer, door and knob of three cabinets; a lid
    assert len(stage.bodies) == 4 * 2 + 3 * 4 + 2 + 1
    found = readings.deviations(stage, readings.READERS[form](exported[form]))
    assert len(found) == 6 + (form != "glb")  # in which nothing collides
    assert max(found.values()) < TOLERANCE, found


def test_a_deviation_is_seen(home):
    stage = readings.from_usd(home.usd)
    name, joint = next(iter(stage.joints.items()))
    moved = stage._replace(joints={**stage.joints, name: joint._replace(origin=joint.origin + np.array([0, 2e-6, 0]))})
    assert readings.deviations(stage, moved)["origins [m]"] == pytest.approx(2e-6)
    assert readings.deviations(stage, stage._replace(colliders=stage.colliders + Counter({("cabinet_0", "door"): 1})))["colliders"] == 1
    with pytest.raises(ValueError, match="not the same"):
        readings.deviations(stage, stage._replace(joints={}))


def test_the_joints_are_those_of_the_tables(home):
    stage = readings.from_usd(home.usd)
    for row in home.joints:
        joint = stage.joints[row.object_id, row.joint_id]
        assert np.allclose(joint.axis, row.axis, atol=1e-4)
        assert np.isclose(joint.upper, row.upper, atol=1e-4) or row.type == "continuous"


def test_every_collider_and_what_one_sees_is_there(home):
    """Volumes and areas of the record against the stage's own meshes."""
    from pxr import Usd, UsdPhysics

    scene = read_home(home.usd, home.scene_id, read_asset)
    stage = Usd.Stage.Open(str(home.usd))
    felt = [p for p in Usd.PrimRange(stage.GetDefaultPrim()) if p.HasAPI(UsdPhysics.CollisionAPI)]
    counted = sum(len(body.boxes) + len(body.hulls) for placed in scene.placed for body in scene.models[placed.model].bodies)
    assert counted == len(felt)
    cabinet = scene.models["cabinet_a"]
    assert [len(body.boxes) for body in cabinet.bodies] == [6, 5, 2, 1]  # boxes of six, five, two panels and a knob are boxes again
    drawer = cabinet.bodies[1]
    assert {surface.group for surface in drawer.surfaces} == {"", "handle"}
    assert np.allclose(drawer.handle, [0, -0.265, 0.8075], atol=1e-5)


@pytest.mark.parametrize("form", ["mjcf", "urdf"])
def test_boards_that_a_home_switches_off_are_off_in_every_format(form, tmp_path):
    """A cupboard and one without doors meet before a wall; a third stands alone and keeps its boards."""
    if form == "mjcf":
        pytest.importorskip("mujoco")
    cupboard = make_cupboard()
    still = replace(cupboard, asset_id="open_a", links=cupboard.links[:1], joints=())
    width, depth = cupboard.size[:2]
    at = 6.0 - depth / 2 - 0.003
    run = [put(f"unit_{k}", asset, 2.96 + k * (width + 0.002), at) for k, asset in enumerate((cupboard, still))]
    home = replace(make_home()[0], placements=(*run, put("alone", cupboard, 1.0, 3.5)))
    assets = {asset.asset_id: asset for asset in (cupboard, still)}
    write_library(assets.values(), tmp_path / "assets")
    stage = readings.from_usd(write_home(home, assets, tmp_path / "usd/shard-00000/home.usdc"))
    assert stage.colliders["alone", "base"] == 6
    assert sorted(stage.colliders[f"unit_{k}", "base"] for k in range(2)) == [4, 5]  # two backs and a side are off
    path = export_home(ExportFolder(tmp_path / form, form, "d", "CC0-1.0"), tmp_path / "usd/shard-00000/home.usdc", "home")
    found = readings.READERS[form](path)
    assert found.colliders == stage.colliders
    assert max(readings.deviations(stage, found).values()) < TOLERANCE
