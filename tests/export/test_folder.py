"""A folder of exported homes: killed runs go on, what is whole stays, nothing half-written is left."""

import subprocess
import sys

import pytest

import sfgen
from pipeline.errors import UsageError
from pipeline.export import ExportFolder, export_home

KILLED = """
import os, signal, sys
from pipeline.export import folder
from sfgen import cli

def write_half(scene, place, form):
    place.mkdir(parents=True)
    (place / "building.urdf").write_text("<robot")
    os.kill(os.getpid(), signal.SIGKILL)

folder._write_home = write_half
cli.run(sys.argv[1:])
"""


def files(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture(scope="module")
def home(furnished):
    return sfgen.load(furnished)[0]


def test_a_killed_export_goes_on_and_leaves_nothing_half_written(furnished, tmp_path):
    arguments = ["export", str(furnished), "--to", "urdf", "--out"]
    killed = subprocess.run([sys.executable, "-c", KILLED, *arguments, str(tmp_path / "cut")], check=False)
    assert killed.returncode == -9
    assert not list((tmp_path / "cut").glob("homes/s0*"))
    assert {path.name for path in (tmp_path / "cut").glob("assets/*")} == {"book", "cabinet_a", "cabinet_b", "chair_a", "flip"}
    for name in ("cut", "whole"):
        assert subprocess.run([sys.executable, "-m", "sfgen.cli", *arguments, str(tmp_path / name)], check=False).returncode == 0
    assert files(tmp_path / "cut") == files(tmp_path / "whole")


def test_what_is_there_is_not_written_again(home, tmp_path):
    folder = ExportFolder(tmp_path / "out", "mjcf", "d", "CC0-1.0")
    path = export_home(folder, home.usd, home.scene_id)
    before = path.stat().st_mtime_ns, path.stat().st_ino
    assert export_home(ExportFolder(tmp_path / "out", "mjcf", "d", "CC0-1.0"), home.usd, home.scene_id) == path
    assert (path.stat().st_mtime_ns, path.stat().st_ino) == before


def test_a_folder_of_another_export_is_refused(tmp_path):
    ExportFolder(tmp_path / "out", "mjcf", "d", "CC0-1.0")
    for form, dataset in (("glb", "d"), ("mjcf", "e")):
        with pytest.raises(UsageError, match="holds something else"):
            ExportFolder(tmp_path / "out", form, dataset, "CC0-1.0")
