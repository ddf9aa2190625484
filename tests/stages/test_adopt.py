import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from pipeline import params
from pipeline.errors import ContentError, UsageError
from pipeline.sources import inventory
from stages import adopt, preprocess
from tests.sources.test_recognition import front, partnet

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def root(tmp_path):
    (tmp_path / "checkout").mkdir()
    shutil.copy(ROOT / "params.yaml", tmp_path / "checkout")
    return tmp_path / "checkout"


def section(root):
    return params.read(root / "params.yaml")["preprocess"]


def test_copies_are_named_with_inventory_and_licence_and_nothing_else_changes(root, tmp_path, capsys):
    before = (root / "params.yaml").read_text().splitlines()
    copies = front(tmp_path / "my data"), partnet(tmp_path / "objects")
    adopt.main(root, copies)
    assert (section(root)["front"], section(root)["partnet"]) == tuple(str(c) for c in copies)
    assert "LicenseRef" in section(root)["front_licence"]
    assert params.read(root / "params.yaml")["shard"]["licence"] == adopt.MADE
    after = (root / "params.yaml").read_text().splitlines()
    changed = [(a, b) for a, b in zip(before, after, strict=True) if a != b]
    assert len(changed) == 5
    assert all(b.split(" # ", 1)[1:] == a.split(" # ", 1)[1:] for a, b in changed)  # comments stay
    assert "1 houses, 1 models" in capsys.readouterr().out
    assert len(inventory.read(root / inventory.FOLDER / "front.csv")) == 3


def test_going_back_restores_the_file(root, tmp_path):
    before = (root / "params.yaml").read_bytes()
    adopt.main(root, [front(tmp_path / "copy")])
    adopt.main(root, [Path("embedded")])
    assert (root / "params.yaml").read_bytes() == before
    assert not list((root / inventory.FOLDER).glob("*.csv"))


def test_a_copy_that_changed_stops_the_stage(root, tmp_path):
    copy = front(tmp_path / "copy")
    adopt.main(root, [copy])
    (copy / "3D-FUTURE-model/m1/raw_model.obj").write_text("v 0 0 0")
    with pytest.raises(ContentError, match=r"raw_model.obj had 2 bytes, has 7.*doctor --use"):
        preprocess.main(root)


def test_a_copy_without_inventory_stops_the_stage(root, tmp_path):
    adopt.main(root, [front(tmp_path / "copy")])
    (root / inventory.FOLDER / "front.csv").unlink()
    with pytest.raises(ContentError, match=r"front\.csv is missing"):
        preprocess.main(root)


def test_two_copies_of_a_kind_are_refused_and_nothing_is_written(root, tmp_path):
    before = (root / "params.yaml").read_bytes()
    with pytest.raises(UsageError, match="both front"):
        adopt.main(root, [front(tmp_path / "a"), front(tmp_path / "b")])
    assert (root / "params.yaml").read_bytes() == before
    assert not (root / inventory.FOLDER).exists()


def test_dvc_sees_an_inventory_that_changed(tmp_path):
    """With DVC itself: preprocess is stale as soon as an inventory is written or changed."""
    for command in (["git", "init", "-q"], [sys.executable, "-m", "dvc", "init", "-q"]):
        subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
    stage = "stages: {read: {cmd: touch out, deps: [manifests/inventories], outs: [out]}}\n"
    assert "      - manifests/inventories\n" in (ROOT / "dvc.yaml").read_text()
    (tmp_path / "dvc.yaml").write_text(stage)
    shutil.copytree(ROOT / inventory.FOLDER, tmp_path / inventory.FOLDER)

    def dvc(*words):
        return subprocess.run([sys.executable, "-m", "dvc", *words], cwd=tmp_path, check=True, capture_output=True, text=True).stdout

    dvc("repro", "-q")
    assert "up to date" in dvc("status")
    (tmp_path / inventory.FOLDER / "front.csv").write_text("path,size,mtime_ns\n")
    assert "modified" in dvc("status")
