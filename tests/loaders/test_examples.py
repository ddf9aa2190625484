"""The examples run, as programs, on a dataset."""

import json
import math
import re
import runpy
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import sfgen

ROOT = Path(__file__).parents[2]


def run(name, *folders):
    answer = subprocess.run(
        [sys.executable, str(ROOT / "examples" / name), *map(str, folders)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        env={"PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"},
    )
    assert answer.returncode == 0, answer.stderr
    return answer.stdout


def test_load_dataset(dataset_folder):
    said = run("load_dataset.py", dataset_folder)
    assert "10 homes, licence CC0-1.0" in said
    assert "10 bedroom, 10 kitchen" in said
    assert "thing_0/joint_0 opens to" in said


def test_torch_dataset(dataset_folder):
    errors = [float(line.split("error ")[1].split()[0]) for line in run("torch_dataset.py", dataset_folder).splitlines()]
    assert len(errors) == 3
    assert errors[2] < errors[0]


@pytest.fixture(scope="module")
def exported(furnished, tmp_path_factory):
    """The furnished home in a format."""
    from pipeline.export import ExportFolder, export_home

    home = sfgen.load(furnished)[0]

    def export(form):
        folder = ExportFolder(tmp_path_factory.mktemp("exported") / form, form, "d", "CC0-1.0")
        export_home(folder, home.usd, home.scene_id)
        return folder.path

    return export


def test_mujoco_homes(exported, tmp_path):
    """Two homes at once, each with its own joints."""
    pytest.importorskip("mujoco")
    folder = exported("mjcf")
    _export_another(folder, tmp_path)
    said = run("mujoco_homes.py", folder)
    assert "2 homes, 23 joints" in said  # 14 that move, 2 things that lie free; 7 that move
    assert len(moved := [float(value) for value in re.findall(r"moved most stands at ([\d.]+)", said)]) == 2
    assert max(moved) < 0.005


def _export_another(folder, place):
    """Put a home with a cabinet and a chair beside the furnished one's export."""
    from pipeline.export import ExportFolder, export_home
    from pipeline.usd import write_home, write_library, write_mujoco_overlay
    from tests.usd.conftest import make_home

    home, assets = make_home()
    home = replace(home, scene_id="s0_00000001", placements=tuple(p for p in home.placements if p.object_id in {"cabinet_0", "chair_0"}))
    write_library(assets.values(), place / "assets")
    stage = write_home(home, assets, place / "usd" / "shard-00000" / f"{home.scene_id}.usdc")
    write_mujoco_overlay(stage)
    export_home(ExportFolder(folder, "mjcf", "d", "CC0-1.0"), stage, home.scene_id)


def test_mujoco_robot(furnished, exported):
    """It gets to the drawer without touching anything, and the drawer comes out."""
    pytest.importorskip("mujoco")
    said = run("mujoco_robot.py", furnished, exported("mjcf"))
    driven, touched, missed = map(
        float, re.search(r"drove ([\d.]+) m, touched something in (\d+) steps, .* within ([\d.]+) mm", said).groups()
    )
    opened, whole = map(float, re.search(r"open by ([\d.]+) of ([\d.]+) m", said).groups())
    assert driven > 3
    assert touched == 0
    assert missed < 10
    assert opened > 0.95 * whole > 0.1


def test_sapien_home(exported):
    pytest.importorskip("sapien")
    said = run("sapien_home.py", exported("urdf"))
    moved = float(re.search(r"none has moved more than ([\d.]+)", said)[1])
    assert "cabinet_0: drawer_slide 0.35" in said
    assert moved < 0.005


def test_sapien_takes_pairs_that_pass_and_friction_as_the_urdf_means_them(exported):
    """SAPIEN's own loader lets parts of different things pass each other, and gives every joint the same friction."""
    sapien = pytest.importorskip("sapien")
    example = runpy.run_path(str(ROOT / "examples" / "sapien_home.py"))
    home = next(exported("urdf").glob("homes/*/home.json"))
    scene = sapien.Scene([sapien.physx.PhysxCpuSystem()])  # things live as long as it does
    placed = example["load"](scene, home, example["Unseen"])
    things = {name: thing for name, thing in placed.items() if isinstance(thing, sapien.physx.PhysxArticulation)}
    same = {
        name: {shape.get_collision_groups()[3] for link in thing.links for shape in link.get_collision_shapes()}
        for name, thing in things.items()
    }
    assert len(set.union(*same.values())) == sum(map(len, same.values())) == len(things) > 4
    knob, about = things["cabinet_0"].find_link_by_name("knob"), json.loads(home.read_text())
    at = next(thing["position"] for thing in about["placed"] if thing["name"] == "cabinet_0")
    assert np.linalg.norm(knob.entity.pose.p - at) < 1.5  # links stand where the thing does before any step
    slide = things["cabinet_0"].find_joint_by_name("drawer_slide")
    resistance = re.search(
        rf'<joint name="{slide.name}".*?friction="([^"]+)"', (home.parents[2] / "assets/cabinet_a/cabinet_a.urdf").read_text(), re.DOTALL
    )
    assert slide.friction == pytest.approx(float(resistance[1]) / (9.81 * slide.child_link.mass))


def test_maniskill_home(furnished, exported):
    """It rests with a robot before the drawer, comes out when pulled, and is shut by a reset."""
    pytest.importorskip("mani_skill")
    said = run("maniskill_home.py", furnished, exported("urdf"))
    rested, pulled, again = map(float, re.findall(r"is open by ([\d.-]+)", said))
    assert abs(rested) < 0.005
    assert pulled > 0.95
    assert again == 0
    assert "success True" in said


def test_newton_home(furnished):
    pytest.importorskip("newton")
    assert "nothing has moved more than 0.00" in run("newton_home.py", furnished)


def test_isaac_lab_scene_names_the_prims_that_are_there(furnished):
    """Isaac Lab itself cannot be had here; what its configuration refers to can be looked up."""
    from pxr import Usd, UsdPhysics

    home = sfgen.load(furnished)[0]
    stage = Usd.Stage.Open(str(home.usd))
    found = runpy.run_path(str(ROOT / "examples" / "isaac_lab_scene.py"))["articulations"](home)
    assert len(found) == 4 + 3 + 1
    for article in found.values():
        prim = stage.GetDefaultPrim().GetPrimAtPath(article.prim)
        assert prim.HasAPI(UsdPhysics.ArticulationRootAPI)
        assert all(prim.GetPrimAtPath(f"joints/{name}").IsA(UsdPhysics.Joint) for name in article.joints)
    for placed in home.objects:
        if placed.object_id in found:
            article = found[placed.object_id]
            assert article.position == pytest.approx(placed.position.tolist())
            assert article.orientation == pytest.approx((math.cos(placed.yaw / 2), 0, 0, math.sin(placed.yaw / 2)))


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.py")), ids=lambda p: p.name)
def test_every_example_is_tested(path):
    assert any(f'"{path.name}"' in test.read_text() for test in (ROOT / "tests").rglob("test_*.py"))
