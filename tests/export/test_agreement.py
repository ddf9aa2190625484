"""What MJCF, URDF and GLB say is what USD says: read again by code that shares nothing with the exporter."""

import numpy as np
import pytest

import sfgen
from pipeline.export import FORMATS, ExportFolder, export_home
from pipeline.export.stage import read_asset, read_home
from tests.export import readings

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
    assert len(found) == 6
    assert max(found.values()) < TOLERANCE, found


def test_a_deviation_is_seen(home):
    stage = readings.from_usd(home.usd)
    name, joint = next(iter(stage.joints.items()))
    moved = stage._replace(joints={**stage.joints, name: joint._replace(origin=joint.origin + np.array([0, 2e-6, 0]))})
    assert readings.deviations(stage, moved)["origins [m]"] == pytest.approx(2e-6)
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
