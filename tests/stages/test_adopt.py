import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from pipeline import params
from pipeline.errors import ContentError, UsageError
from pipeline.sources import inventory
from pipeline.sources.articulated import source as articulated
from pipeline.sources.atiss.files import BOXES, STATS, stats, write_stats
from pipeline.sources.atiss.labels import KINDS
from pipeline.sources.registry import recognise_sources
from stages import adopt, doctor, preprocess
from tests.sources import making
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
    assert (section(root)["sources"]["front"], section(root)["sources"]["partnet"]) == tuple(str(c) for c in copies)
    assert "LicenseRef" in section(root)["licences"]["front"]
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
    with pytest.raises(ContentError, match=r"raw_model.obj changed.*doctor --use"):
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


def cached(root):
    """A folder with one room as the peers cache it."""
    room = root / "bedroom" / "house-1_Bedroom-2"
    room.mkdir(parents=True)
    write_stats(root / "bedroom" / STATS, stats([], KINDS["bedroom"].classes))
    (room / BOXES).write_bytes(b"")
    return root


def test_rooms_of_the_peers_have_an_inventory_too(root, tmp_path, capsys):
    rooms = cached(tmp_path / "rooms")
    adopt.main(root, [rooms])
    assert section(root)["sources"]["peers"] == str(rooms)
    assert "LicenseRef" in section(root)["licences"]["peers"]
    assert "1 rooms, 1 houses" in capsys.readouterr().out
    assert "+ peers: " in "\n".join(doctor.sources(root))
    making.write_library(root / "data/raw/3d-front")
    (root / "data/raw/3d-front/3D-FRONT").mkdir()
    (root / "data/raw/partnet").mkdir()
    (rooms / "bedroom" / "house-1_Bedroom-2" / BOXES).write_bytes(b"changed")
    with pytest.raises(ContentError, match=r"boxes.npz changed.*doctor --use"):
        preprocess.main(root)
    (root / inventory.FOLDER / "peers.csv").unlink()
    with pytest.raises(ContentError, match=r"peers\.csv is missing"):
        preprocess.main(root)


def test_houses_of_3d_front_take_the_place_of_cached_rooms(root, tmp_path):
    adopt.main(root, [cached(tmp_path / "rooms")])
    adopt.main(root, [front(tmp_path / "copy")])
    assert section(root)["sources"]["peers"] is None
    assert not (root / inventory.FOLDER / "peers.csv").exists()


def test_rooms_beside_3d_front_are_not_taken_for_it(tmp_path):
    both = cached(front(tmp_path / "both"))
    assert [s.key for s in recognise_sources(both)] == ["front"]
    assert [s.key for s in recognise_sources(both / "bedroom")] == ["peers"]


def test_rooms_of_unknown_classes_are_told(root, tmp_path):
    (tmp_path / "odd").mkdir()
    (tmp_path / "odd" / STATS).write_text('{"class_labels": ["spaceship"]}')
    with pytest.raises(ContentError, match="classes that are none of the peers'"):
        adopt.main(root, [tmp_path / "odd"])


def test_a_folder_of_objects_is_walked_once(root, tmp_path, monkeypatch):
    adopt.main(root, [partnet(tmp_path / "objects")])
    making.write_library(root / "data/raw/3d-front")
    making.write_house(root / "data/raw/3d-front", making.two_rooms())
    walks = []
    look = articulated.objects_in
    monkeypatch.setattr(articulated, "objects_in", lambda path: walks.append(path) or look(path))
    preprocess.main(root)
    assert len(walks) == 1
