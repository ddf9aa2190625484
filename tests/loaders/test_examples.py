"""The examples run, as programs, on a dataset."""

import math
import re
import runpy
import subprocess
import sys
from pathlib import Path

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


def test_mujoco_homes(exported):
    pytest.importorskip("mujoco")
    said = run("mujoco_homes.py", exported("mjcf"))
    assert "1 homes, 16 joints" in said  # fourteen that move, two things that lie free


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
