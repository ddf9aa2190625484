"""The stage on tiny folders: tables with their schemas, splits by house, the same bytes whatever the workers, clear errors."""

import re
from pathlib import Path

import pytest
import yaml

from pipeline import params, tables
from pipeline.entities.files import load_asset
from pipeline.errors import ContentError
from pipeline.manifest import sha256_file
from pipeline.relations.model import Relations
from pipeline.sources.settings import PreprocessSettings
from schemas import ASSET_JOINTS, ASSET_PARTS, ASSETS, OBJECTS, OPENINGS, REJECTS, ROOMS, SCENES
from stages.preprocess import main
from tests.sources import making

ALL = (SCENES, ROOMS, OPENINGS, OBJECTS, ASSETS, ASSET_JOINTS, ASSET_PARTS, REJECTS)
ID = re.compile(r"^[a-z][a-z0-9_]*$")


VERIFY = params.read(Path(__file__).resolve().parents[2] / "params.yaml")["verify"]  # the robot that rooms are measured for


def checkout(root, houses=6, **settings):
    front, partnet = root / "data/raw/3d-front", root / "data/raw/partnet"
    making.write_library(front)
    for k in range(houses):
        making.write_house(front, making.two_rooms(f"house-{k}", "0.4" if k % 2 else "0.11"))
    (front / "3D-FRONT").mkdir(exist_ok=True)
    (front / "3D-FRONT" / "house-broken.json").write_text("<html>")
    making.write_partnet(partnet)
    making.write_partnet(partnet, "40001", gapartnet=False)
    write_params(root, **settings)
    return root


KEYS = {"front": "data/raw/3d-front", "partnet": "data/raw/partnet", "peers": None}


def write_params(root, **settings):
    """`front`, `partnet` and `peers` are where these sources lie."""
    where = {key: settings.pop(key, path) for key, path in KEYS.items()}
    settings = {"sources": where, "licences": dict.fromkeys(("front", "partnet"), "CC0-1.0"), **settings}
    (root / "params.yaml").write_text(
        yaml.safe_dump({"preset": "quick", "presets": {"quick": {}}, "verify": VERIFY, "preprocess": {"workers": 1, **settings}})
    )


def read_all(root):
    return {t.name: tables.read(root / "data/tables" / f"{t.name}.parquet", t) for t in ALL}


def digests(root):
    return {p.name: sha256_file(p) for folder in ("tables", "assets") for p in sorted((root / "data" / folder).iterdir())}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    root = checkout(tmp_path_factory.mktemp("checkout"))
    main(root)
    return root


def test_tables_agree_with_each_other(made):
    rows = read_all(made)
    assert len(rows["scenes"]) == 6
    assert [s["index"] for s in rows["scenes"]] == list(range(6))
    scenes = {s["scene_id"] for s in rows["scenes"]}
    rooms = {(r["scene_id"], r["room_id"]) for r in rows["rooms"]}
    assets = {a["asset_id"]: a for a in rows["assets"]}
    assert {s for s, _ in rooms} == scenes
    for o in rows["objects"]:
        assert (o["scene_id"], o["room_id"]) in rooms
        asset = assets[o["asset_id"]]
        assert o["size"] == pytest.approx([a * b for a, b in zip(asset["size"], o["scale"], strict=True)], abs=1e-3)
        assert asset["category"] == o["category"]
    for o in rows["openings"]:
        assert {(o["scene_id"], r) for r in o["rooms"]} <= rooms
    assert {j["asset_id"] for j in rows["asset_joints"]} == {a["asset_id"] for a in rows["assets"] if a["articulated"]}
    assert [r["where"] for r in rows["rejects"] if r["reason"] == "not_json"] == ["house-broken"]


def test_ids_are_usd_names_and_unique(made):
    rows = read_all(made)
    keys = {"scenes": ("scene_id",), "rooms": ("scene_id", "room_id"), "objects": ("scene_id", "object_id")}
    keys |= {"openings": ("scene_id", "opening_id"), "assets": ("asset_id",), "asset_joints": ("asset_id", "joint_id")}
    for name, columns in keys.items():
        found = [tuple(r[c] for c in columns) for r in rows[name]]
        assert len(set(found)) == len(found)
        assert all(ID.match(part) for ids in found for part in ids)


def test_assets_are_whole(made):
    for row in read_all(made)["assets"]:
        path = made / "data/assets" / row["file"]
        assert sha256_file(path) == row["sha256"]
        asset = load_asset(path)
        assert len(asset.joints) == row["joints"]
        assert asset.licence == row["licence"] == "CC0-1.0"
        assert all(link.colliders and link.mass > 0 for link in asset.links)


def test_splits_are_by_house_and_by_model(made):
    rows = read_all(made)
    split = {s["scene_id"]: s["split"] for s in rows["scenes"]}
    assert set(split.values()) <= {"train", "val", "test"}
    by_source = {}
    for a in rows["assets"]:
        assert by_source.setdefault(a["source_id"], a["split"]) == a["split"]


def test_workers_and_repetition_change_no_byte(made, tmp_path):
    root = checkout(tmp_path, workers=2)
    main(root)
    assert digests(root) == digests(made)


def test_assets_of_earlier_runs_go(tmp_path):
    root = checkout(tmp_path, houses=2)
    (root / "data/assets").mkdir(parents=True)
    (root / "data/assets/ff_old.safetensors").write_bytes(b"x")
    main(root)
    assert not (root / "data/assets/ff_old.safetensors").exists()


def test_without_partnet(tmp_path):
    root = checkout(tmp_path, houses=1, partnet=None)
    main(root)
    assert {a["source"] for a in read_all(root)["assets"]} == {"3d-future"}


@pytest.mark.parametrize("front", ["nowhere", "params.yaml", "data/raw"])
def test_wrong_folder_names_key_and_remedy(tmp_path, front):
    root = checkout(tmp_path, houses=1, front=front)
    with pytest.raises(ContentError, match=r"preprocess\.sources\.front"):
        main(root)
    assert not (root / "data/tables").exists()


def test_nothing_usable_is_an_error(tmp_path):
    root = checkout(tmp_path, houses=0)
    with pytest.raises(ContentError, match="no usable house"):
        main(root)


def test_settings_are_strict(tmp_path):
    write_params(tmp_path, filters={"min_insidee": 0.5})
    with pytest.raises(ContentError, match="min_inside"):
        params.section(PreprocessSettings, params.read(tmp_path / "params.yaml"), "preprocess")


def test_relations_are_written_beside_the_tables(made):
    known = Relations.load(made / "data/tables/relations.json")
    assert not known.pairs  # six houses are too few to know anything


def test_objects_without_models_need_no_folder_of_models(tmp_path):
    making.write_house(tmp_path / "data/raw/3d-front", making.two_rooms(variant="nested"))
    write_params(tmp_path, partnet=None)
    with pytest.raises(ContentError, match="3D-FUTURE-model is missing"):
        main(tmp_path)
    write_params(tmp_path, partnet=None, filters={"keep_without_model": True})
    main(tmp_path)
    assert [o["category"] for o in read_all(tmp_path)["objects"]] == ["double_bed", "nightstand", "pendant_lamp"]
