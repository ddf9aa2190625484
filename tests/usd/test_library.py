from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from pxr import Usd, UsdGeom, UsdPhysics, UsdShade, UsdUtils

from pipeline.entities.asset import Joint
from pipeline.errors import ContentError
from pipeline.rendering.boxes import box, solid_link
from pipeline.usd import write_library
from pipeline.usd.check import check_stage
from pipeline.usd.physics import ITERATIONS, gravity_load
from pipeline.usd.resistance import resistance


@pytest.fixture(scope="module")
def library(tmp_path_factory, cabinet, chair):
    folder = tmp_path_factory.mktemp("library")
    return folder, write_library([cabinet, chair], folder)


def open_asset(library, name):
    return Usd.Stage.Open(str(library[0] / name / f"{name}.usda"))


def test_files_are_named_after_the_asset_and_listed(library):
    folder, files = library
    assert sorted(p for p in folder.rglob("*") if p.is_file()) == sorted(files)
    names = [p.name for p in files if p.suffix in {".usda", ".usdc"}]
    assert len(set(names)) == len(names) == 5  # interface, payload and overlay of the cabinet; two of the chair


def test_interface_is_a_labelled_component_in_metres(library):
    stage = open_asset(library, "cabinet_a")
    prim = stage.GetDefaultPrim()
    assert Usd.ModelAPI(prim).GetKind() == "component"
    assert prim.GetAttribute("semantics:labels:class").Get() == ["cabinet"]
    assert UsdGeom.GetStageUpAxis(stage) == "Z"
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1
    hint = np.array(UsdGeom.ModelAPI(prim).GetExtentsHintAttr().Get())
    assert np.allclose(hint[1] - hint[0], [0.92, 0.53, 1.0], atol=1e-5)  # handle and knob stick out
    assert stage.GetRootLayer().customLayerData["SimReady_Metadata"]["rigid_body_count"] == 4


def test_links_are_sibling_bodies_whose_colliders_share_their_mass(library, cabinet):
    stage = open_asset(library, "cabinet_a")
    bodies = [p for p in stage.Traverse() if p.HasAPI(UsdPhysics.RigidBodyAPI)]
    assert [b.GetName() for b in bodies] == ["base", "drawer", "door", "knob"]
    for body, link in zip(bodies, cabinet.links, strict=True):
        assert body.GetParent() == stage.GetDefaultPrim()
        api = UsdPhysics.MassAPI(body)
        assert api.GetMassAttr().Get() == pytest.approx(link.mass)
        assert np.allclose(api.GetCenterOfMassAttr().Get(), link.com, atol=1e-6)
        assert np.allclose(sorted(api.GetDiagonalInertiaAttr().Get()), np.linalg.eigvalsh(link.inertia), rtol=1e-4)
        colliders = [p for p in Usd.PrimRange(body) if p.HasAPI(UsdPhysics.CollisionAPI)]
        assert len(colliders) == len(link.colliders)
        assert sum(UsdPhysics.MassAPI(c).GetMassAttr().Get() for c in colliders) == pytest.approx(link.mass, rel=1e-5)
        for collider in colliders:
            if collider.IsA(UsdGeom.Mesh):
                assert UsdPhysics.MeshCollisionAPI(collider).GetApproximationAttr().Get() == "convexHull"


def test_slides_are_in_metres_and_hinges_in_degrees(library, cabinet):
    stage = open_asset(library, "cabinet_a")
    slide = UsdPhysics.PrismaticJoint(stage.GetPrimAtPath("/cabinet_a/joints/drawer_slide"))
    hinge = UsdPhysics.RevoluteJoint(stage.GetPrimAtPath("/cabinet_a/joints/door_hinge"))
    knob = UsdPhysics.RevoluteJoint(stage.GetPrimAtPath("/cabinet_a/joints/knob_turn"))
    assert slide.GetUpperLimitAttr().Get() == pytest.approx(cabinet.joints[0].upper)
    assert hinge.GetUpperLimitAttr().Get() == pytest.approx(math.degrees(cabinet.joints[1].upper))
    assert knob.GetUpperLimitAttr().Get() == math.inf
    fixed = UsdPhysics.FixedJoint(stage.GetPrimAtPath("/cabinet_a/joints/world_fixed"))
    assert fixed.GetBody0Rel().GetTargets() == ["/cabinet_a"]
    assert fixed.GetBody1Rel().GetTargets() == ["/cabinet_a/base"]
    assert stage.GetDefaultPrim().HasAPI(UsdPhysics.ArticulationRootAPI)


def test_physx_is_told_at_the_root_how_long_to_solve(library):
    said = "physxArticulation:solverPositionIterationCount"
    stage = open_asset(library, "cabinet_a")
    assert {str(p.GetPath()): p.GetAttribute(said).Get() for p in stage.Traverse() if p.HasAttribute(said)} == {"/cabinet_a": ITERATIONS[0]}
    static = open_asset(library, "chair_a")
    assert not any(p.HasAttribute(said) for p in static.Traverse())


def test_base_and_movers_do_not_collide(library):
    stage = open_asset(library, "cabinet_a")
    targets = UsdPhysics.FilteredPairsAPI(stage.GetPrimAtPath("/cabinet_a/base")).GetFilteredPairsRel().GetTargets()
    assert targets == ["/cabinet_a/drawer", "/cabinet_a/door", "/cabinet_a/knob"]


def test_a_lid_on_a_seat_comes_to_lie_against_the_cistern(tmp_path, cabinet):
    """Where both turn by a right angle, the lid's hinge alone would let it through."""
    base = (box("bowl", (-0.2, -0.35, 0), (0.2, 0.3, 0.39)), box("cistern", (-0.2, 0.16, 0.39), (0.2, 0.35, 0.75)))
    plates = [(box(name, (-0.2, -0.35, z), (0.2, 0.11, z + 0.015)),) for name, z in (("seat", 0.394), ("lid", 0.414))]
    links = tuple(solid_link(b[-1].name, b, b, 1.0) for b in (base, *plates))
    joints = tuple(
        Joint(f"hinge_{k}", "revolute", k, k + 1, np.array([-1.0, 0, 0]), np.array([0, 0.11, 0.4]), 0.0, 1.6, "hinge_lid") for k in (0, 1)
    )
    write_library([replace(cabinet, asset_id="toilet_a", links=links, joints=joints, parts=())], tmp_path)
    stage = Usd.Stage.Open(str(tmp_path / "toilet_a" / "toilet_a.usda"))
    targets = [
        UsdPhysics.FilteredPairsAPI(stage.GetPrimAtPath(f"/toilet_a/{n}")).GetFilteredPairsRel().GetTargets() for n in ("cistern", "seat")
    ]
    assert targets == [["/toilet_a/seat"], ["/toilet_a/lid"]]


def test_handles_are_named_and_labelled(library):
    stage = open_asset(library, "cabinet_a")
    prim = stage.GetPrimAtPath("/cabinet_a/drawer/handle")
    assert prim.GetAttribute("semantics:labels:class").Get() == ["handle"]
    assert prim.GetAttribute("semantics:labels:part").Get() == ["line_fixed_handle"]


def test_static_assets_have_colliders_without_bodies_and_hide_those_that_differ(library):
    stage = open_asset(library, "chair_a")
    prims = list(stage.Traverse())
    assert not any(p.HasAPI(UsdPhysics.RigidBodyAPI) or p.IsA(UsdPhysics.Joint) for p in prims)
    colliders = {p.GetName(): UsdGeom.Imageable(p).ComputePurpose() for p in prims if p.HasAPI(UsdPhysics.CollisionAPI)}
    assert colliders == {"below_collider": "guide", "behind_collider": "guide"}  # boxes are cubes of their own


def test_materials_carry_surface_and_friction_in_one_binding(library):
    stage = open_asset(library, "cabinet_a")
    material, _ = UsdShade.MaterialBindingAPI(stage.GetPrimAtPath("/cabinet_a/door/panel")).ComputeBoundMaterial()
    assert material.GetPrim().HasAPI(UsdPhysics.MaterialAPI)
    assert material.ComputeSurfaceSource()[0].GetIdAttr().Get() == "UsdPreviewSurface"


def test_textures_are_relative_files_beside_the_asset(tmp_path, textured):
    files = write_library([textured], tmp_path)
    assert (tmp_path / "chair_t/textures/oak.png").read_bytes() == b"png"
    assert tmp_path / "chair_t/textures/oak.png" in files
    _, assets, unresolved = UsdUtils.ComputeAllDependencies(str(tmp_path / "chair_t/chair_t.usda"))
    assert not unresolved
    assert [a.endswith("chair_t/textures/oak.png") for a in assets] == [True]


def test_a_texture_outside_the_folder_is_refused(tmp_path, textured):
    textured.textures["../../evil.png"] = b"x"
    with pytest.raises(ContentError, match="outside its folder"):
        write_library([textured], tmp_path)
    assert not (tmp_path.parent / "evil.png").exists()


def test_the_mujoco_variant_moves_the_root_to_the_base(library):
    stage = open_asset(library, "cabinet_a")
    prim = stage.GetDefaultPrim()
    assert prim.GetVariantSet("MuJoCo").GetVariantSelection() == "Disabled"
    prim.GetVariantSet("MuJoCo").SetVariantSelection("Enabled")
    assert not prim.HasAPI(UsdPhysics.ArticulationRootAPI)
    assert stage.GetPrimAtPath("/cabinet_a/base").HasAPI(UsdPhysics.ArticulationRootAPI)
    assert not UsdPhysics.FixedJoint(stage.GetPrimAtPath("/cabinet_a/joints/world_fixed")).GetBody0Rel().GetTargets()


@pytest.mark.parametrize("name", ["cabinet_a", "chair_a"])
def test_assets_compose_without_a_warning(library, name):
    check_stage(library[0] / name / f"{name}.usda")


def test_gravity_does_not_open_what_hangs_or_looks_up(cabinet):
    def joint(kind, part, axis):
        return Joint("j", kind, 0, 1, np.array(axis, float), np.zeros(3), 0.0, 0.5, part)

    def held(axis, kind="revolute", part="hinge_door"):
        return resistance(replace(cabinet, joints=(joint(kind, part, axis), *cabinet.joints[1:])), 0)

    pulls = gravity_load(replace(cabinet, joints=(joint("revolute", "hinge_door", (1, 0, 0)), *cabinet.joints[1:])), 0)
    assert pulls != 0
    open_, shut = (1, 0, 0) if pulls > 0 else (-1, 0, 0), (-1, 0, 0) if pulls > 0 else (1, 0, 0)
    assert abs(pulls) < held(open_).friction < 1.5 * abs(pulls) + 0.1, "it holds, and a push overcomes it"
    assert held(shut).friction <= 0.1
    button = held((0, 1, 0), "prismatic", "slider_button")
    assert button.stiffness > 0, "buttons spring back"
    assert button.damping == pytest.approx(2 * math.sqrt(button.stiffness * button.inertia)), "... and do not swing"
    assert gravity_load(cabinet, 0) == pytest.approx(0.0)
    key = replace(cabinet, joints=(joint("prismatic", "slider_button", (0, 0, -1)), *cabinet.joints[1:]))
    assert gravity_load(key, 0) == pytest.approx(9.81 * cabinet.links[1].mass)
    assert resistance(key, 0).stiffness * 0.05 * 0.5 > gravity_load(key, 0), "... and are not pressed down by their own weight"


def test_newtons_stops_are_springs_by_the_metre_and_by_the_degree(library, cabinet):
    stage = open_asset(library, "cabinet_a")
    for k, unit in ((0, 1.0), (1, math.degrees(1.0))):
        prim = stage.GetPrimAtPath(f"/cabinet_a/joints/{cabinet.joints[k].name}")
        stiffness, damping = (unit * prim.GetAttribute(f"newton:{name}").Get() for name in ("limitStiffness", "limitDamping"))
        inertia = resistance(cabinet, k).inertia
        assert 0.05 * stiffness / inertia == pytest.approx(120.0**2), "per second squared, as Newton takes it"
        assert damping == pytest.approx(2 * math.sqrt(stiffness * inertia / 0.05)), "damped critically: it neither bounces nor creeps"


def test_what_waits_for_another_joint_says_so(cabinet, tmp_path):
    slide, hinge, knob = cabinet.joints
    files = write_library([replace(cabinet, joints=(replace(slide, after=(hinge.name,)), hinge, knob))], tmp_path)
    stage = open_asset((tmp_path, files), "cabinet_a")
    after = stage.GetPrimAtPath("/cabinet_a/joints/drawer_slide").GetRelationship("sfgen:after")
    assert after.GetTargets() == ["/cabinet_a/joints/door_hinge"]
    assert not stage.GetPrimAtPath("/cabinet_a/joints/door_hinge").GetRelationship("sfgen:after")
