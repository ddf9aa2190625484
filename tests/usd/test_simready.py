"""Assets go into the folder, and get the provenance, that SimReady's rules NP.005 and SR.004 ask for."""

from __future__ import annotations

import datetime as dt
import json
import runpy
from pathlib import Path

import pytest
from pxr import Sdf, Usd, UsdPhysics

from pipeline.usd import write_library
from pipeline.usd.check import check_stage

EXAMPLE = Path(__file__).parents[2] / "examples" / "simready_assets.py"
OWN = {"asset_name", "asset_type", "asset_license", "category", "source_file", "rigid_body_count", "asset_extents", "mass"}  # of SR.004


@pytest.fixture(scope="module")
def packaged(tmp_path_factory, cabinet):
    folder = tmp_path_factory.mktemp("simready")
    write_library([cabinet], folder / "library")
    package = runpy.run_path(str(EXAMPLE))["package"]
    asset = folder / "library" / cabinet.asset_id
    return asset, package(asset, folder / "out", "somebody", dt.date(2026, 11, 23))


def test_the_interface_is_the_one_usd_file_of_its_folder_and_composes_as_before(packaged):
    asset, path = packaged
    assert path.parent.parent.name == asset.name
    assert [p.name for p in path.parent.iterdir() if p.suffix.startswith(".usd")] == [path.name]
    before, now = (Usd.Stage.Open(str(p)) for p in (asset / f"{asset.name}.usda", path))
    for stage in (before, now):
        stage.GetDefaultPrim().GetVariantSet("MuJoCo").SetVariantSelection("Enabled")
    assert [(p.GetPath(), p.GetAppliedSchemas()) for p in now.Traverse()] == [
        (p.GetPath(), p.GetAppliedSchemas()) for p in before.Traverse()
    ]
    check_stage(path)


def test_every_field_of_provenance_is_said_once(packaged):
    _, path = packaged
    stage = Usd.Stage.Open(str(path))
    about = stage.GetRootLayer().customLayerData
    within, beside = {**about, **about["SimReady_Metadata"]}, json.loads(path.with_suffix(".json").read_text())
    assert all(within[name] for name in OWN)
    assert about["usd_date_generated"] == "2026-11-23"
    assert beside == {"author": "somebody", "qcode": "Q14745"}
    assert not set(within) & set(beside)


def test_the_variant_is_where_the_metadata_says_it_is_and_its_file_has_the_runtime_s_name(packaged):
    asset, path = packaged
    for interface, file in ((asset / f"{asset.name}.usda", f"{asset.name}_mujoco.usda"), (path, "mujoco.usda")):
        layer = Sdf.Layer.FindOrOpen(str(interface))
        said = layer.customLayerData["SimReady_Metadata"]["Variants"]["Physics"]["MuJoCo"]
        variant = layer.GetPrimAtPath(said["prim"]).variantSets[said["variantSetName"]].variants[said["activateOption"]]
        assert [arc.assetPath for arc in variant.primSpec.payloadList.prependedItems] == [f"./runnables/physics/{file}"]
        assert [p.name for p in (interface.parent / "runnables/physics").iterdir()] == [file]


def test_what_stands_still_in_a_home_is_a_body_of_its_own_weight_as_a_prop(tmp_path, chair):
    write_library([chair], tmp_path / "library")
    interface = Sdf.Layer.FindOrOpen(str(tmp_path / f"library/{chair.asset_id}/{chair.asset_id}.usda"))
    assert not interface.customLayerData["SimReady_Metadata"]["rigid_body_count"]
    path = runpy.run_path(str(EXAMPLE))["package"](
        tmp_path / "library" / chair.asset_id, tmp_path / "out", "somebody", dt.date(2026, 11, 23)
    )
    stage = Usd.Stage.Open(str(path))
    assert [p for p in stage.Traverse() if p.HasAPI(UsdPhysics.RigidBodyAPI)] == [stage.GetDefaultPrim()]
    assert UsdPhysics.MassAPI(stage.GetDefaultPrim()).GetMassAttr().Get() == pytest.approx(sum(link.mass for link in chair.links))
    assert stage.GetRootLayer().customLayerData["SimReady_Metadata"]["rigid_body_count"] == 1
    check_stage(path)
