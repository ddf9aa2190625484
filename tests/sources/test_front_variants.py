"""One probe per variant, defect and vocabulary of 3D-FRONT's files, read through the whole of the stage's readers."""

import itertools
import json

import numpy as np
import pytest

from pipeline import taxonomy
from pipeline.entities.files import load_asset
from pipeline.sources.meshes.mesh_solids import signed_volume
from pipeline.sources.threed_front.poses import to_ours
from tests.sources import making
from tests.sources.making import BED, CHAIR, LAMP, STAND, chair_record, child, floor
from tests.sources.reading import read

ROOMS = [
    "LivingDiningRoom",
    "LivingRoom",
    "DiningRoom",
    "Bedroom",
    "MasterBedroom",
    "SecondBedroom",
    "KidsRoom",
    "ElderlyRoom",
    "NannyRoom",
    "Library",
    "Kitchen",
    "Bathroom",
    "MasterBathroom",
    "SecondBathroom",
    "Balcony",
    "Terrace",
    "Hallway",
    "Aisle",
    "Corridor",
    "Stairwell",
    "StorageRoom",
    "CloakRoom",
    "LaundryRoom",
    "EquipmentRoom",
    "Lounge",
    "Garage",
    "Courtyard",
    "Auditorium",
    "OtherRoom",
    "BedRoom",
    "livingroom",
]
CATEGORIES = {  # the 42 names, and the old ones that scene files still use
    "Children Cabinet", "Nightstand", "Bookcase / jewelry Armoire", "Wardrobe", "Coffee Table", "Tea Table", "Corner/Side Table",
    "Sideboard / Side Cabinet / Console Table", "Sideboard / Side Cabinet / Console", "Wine Cabinet", "Wine Cooler", "TV Stand",
    "Drawer Chest / Corner cabinet", "Shelf", "Round End Table", "Shoe Cabinet", "King-size Bed", "Double Bed", "Bunk Bed", "Bed Frame",
    "Single bed", "Kids Bed", "Couch Bed", "Dining Chair", "Lounge Chair / Cafe Chair / Office Chair",
    "Lounge Chair / Book-chair / Computer Chair", "Dressing Chair", "Classic Chinese Chair", "Barstool", "Hanging Chair", "Folding chair",
    "Dressing Table", "Dining Table", "Desk", "Bar", "Three-Seat / Multi-seat Sofa", "Three-Seat / Multi-person sofa", "armchair",
    "Loveseat Sofa", "Two-seat Sofa", "L-shaped Sofa", "Lazy Sofa", "Chaise Longue Sofa", "U-shaped Sofa",
    "Footstool / Sofastool / Bed End Stool / Stool", "Pendant Lamp", "Ceiling Lamp", "Floor Lamp", "Wall Lamp",
}  # fmt: skip
SUPERS = ("Cabinet/Shelf/Desk", "Bed", "Chair", "Table", "Sofa", "Pier/Stool", "Lighting")


def written(tmp_path, tree=None, *, jids=(BED, STAND, LAMP), entries=None):
    making.write_library(tmp_path / "front", jids, entries)
    making.write_house(tmp_path / "front", tree or making.two_rooms())
    return tmp_path


def sofa_obj(scale=1.0, at=(0.0, 0.0, 0.0)):
    """An L: a body along the width and a longer seat at the file's +x, of another height so that no two views are alike."""
    body = making.box_obj((2.4, 0.9, 0.8), at=at, group="body", uv=False, scale=scale)
    seat = making.box_obj((0.8, 0.7, 0.4), at=(at[0] + 0.8, at[1], at[2] + 0.8), group="seat", uv=False, scale=scale)
    lines = [x if not x.startswith("f") else "f " + " ".join(str(int(w) + 8) for w in x.split()[1:]) for x in seat.splitlines()[1:]]
    return body + "\n".join(lines) + "\n"


@pytest.mark.parametrize("kind", ROOMS)
def test_room_types_in_any_case(kind, tmp_path):
    words = taxonomy.load()
    assert kind.lower() in words.front_rooms
    tree = making.two_rooms()
    tree["scene"]["room"][0] |= {"type": kind, "instanceid": f"{kind}-1"}
    made = read(written(tmp_path, tree))
    assert made.rooms[0]["type"] == kind.lower()
    assert "unknown_room_type" not in made.reasons


def test_all_categories_have_a_meaning():
    words = taxonomy.load()
    unknown = {n for n in CATEGORIES if words.from_future(n) is None or words.from_future(n.lower().replace(" / ", "/")) is None}
    assert unknown == set()
    members = {c for name in SUPERS for c in words.of_kind(name)}
    assert {words.from_future(n) for n in CATEGORIES} <= members
    assert members <= set(words.categories)
    assert {words.from_title(f"sofa/ {t}") for c in words.categories.values() for t in c.names.titles} <= set(words.categories)
    assert len(words.styles) == 19
    assert len(words.materials) == 15


@pytest.mark.parametrize("name", SUPERS)
@pytest.mark.parametrize("where", ["model_info", "record", "title"])
def test_a_super_category_alone_is_settled_by_size(name, where, tmp_path):
    entries = [making.info(BED, "", **{"super-category": name if where == "model_info" else None}), making.info(STAND), making.info(LAMP)]
    record = {**chair_record("b/model", BED, "later"), "category": name if where == "record" else None}
    if where == "title":
        if name == "Pier/Stool":
            pytest.skip("titles have no such group")
        record["title"] = f"{name.lower().split('/')[0]}/something"
    tree = making.two_rooms()
    tree["furniture"][0] = record
    made = read(written(tmp_path, tree, entries=entries))
    words = taxonomy.load()
    asset = next(a for a in made.assets if a["source_id"] == BED)
    kinds = words.of_kind(name.lower().split("/")[0]) if where == "title" else words.of_kind(name)
    assert asset["category"] in kinds
    assert "category_inferred" in made.reasons


def test_a_null_category_is_taken_from_the_records(tmp_path):
    entries = [making.info(BED, ""), making.info(STAND, None), making.info(LAMP)]
    entries[1]["category"] = None
    tree = making.two_rooms(variant="later")
    tree["furniture"][1] |= {"category": None, "title": "table/night table"}
    made = read(written(tmp_path, tree, entries=entries))
    assert [o["category"] for o in made.objects] == ["double_bed", "nightstand", "pendant_lamp"]
    assert [r["where"] for r in made.rejects if r["reason"] == "category_inferred"] == [BED, STAND]


def test_a_model_without_an_entry_is_used_when_houses_name_it(tmp_path):
    made = read(written(tmp_path, making.two_rooms(variant="nested"), entries=[making.info(STAND), making.info(LAMP)]))
    assert {a["source_id"] for a in made.assets} == {BED, STAND, LAMP}
    assert made.reasons == {"category_inferred"}


def test_unknown_style_and_material_are_told(tmp_path):
    entries = [making.info(BED, style="MODERN", material="Unobtainium"), making.info(STAND), making.info(LAMP)]
    made = read(written(tmp_path, entries=entries))
    bed = next(a for a in made.assets if a["source_id"] == BED)
    assert (bed["style"], bed["material"]) == ("Modern", "")
    assert [(r["reason"], r["detail"]) for r in made.rejects] == [("unknown_name", "material 'Unobtainium'")]


@pytest.mark.parametrize("factor", [100.0, 0.01])
@pytest.mark.parametrize("variant", ["plain", "nested", "later"])
def test_another_unit_is_found_from_the_records(factor, variant, tmp_path):
    """A model whose own entry says nothing: the records tell its size, it is corrected once, and every placement agrees."""
    entries = [making.info(BED, ""), making.info(STAND), making.info(LAMP)]
    tree = making.two_rooms(variant=variant, extra=[child("b2/model", "furniture/9", (2, 0, 2.9), scale=(0.5, 0.5, 0.5))])
    tree["furniture"].append({**chair_record("b2/model", BED, variant)})
    for record in tree["furniture"]:
        if record["jid"] == BED:
            record["title"] = "bed/bed"
    written(tmp_path, tree, entries=entries)
    making.write_model(tmp_path / "front", BED, making.box_obj(making.SIZES[BED], scale=factor))
    made = read(tmp_path)
    (asset,) = [a for a in made.assets if a["source_id"] == BED]
    assert asset["size"] == [1.8, 2.2, 1.1]
    assert asset["unit_scale"] == pytest.approx(1 / factor)
    beds = [o for o in made.objects if o["asset_id"] == asset["asset_id"]]
    assert [(o["size"], o["scale"]) for o in beds] == [([1.8, 2.2, 1.1], [1, 1, 1]), ([0.9, 1.1, 0.55], [0.5, 0.5, 0.5])]
    assert [r["what"] for r in made.rejects if r["reason"] == "centimetres"] == ["model"]


@pytest.mark.parametrize(
    ("size", "category", "declared"),
    [
        ((80.0, 58.0, 4.0), "Coffee Table", (0.8, 0.58, 0.04)),
        ((80.0, 58.0, 4.0), "Pendant Lamp", None),
        ((180.0, 220.0, 110.0), "King-size Bed", None),
        ((30.0, 30.0, 12.0), "Ceiling Lamp", None),
    ],
)
def test_centimetre_models(size, category, declared, tmp_path):
    record = {
        "uid": "x/model",
        "jid": CHAIR,
        "valid": True,
        "title": "decor/x",
        **({"size": list(declared), "bbox": list(declared)} if declared else {}),
    }
    tree = making.two_rooms(more_furniture=[record], extra=[child("x/model", "furniture/9", (1, 0, 3.4))])
    written(tmp_path, tree, jids=(BED, STAND, LAMP, CHAIR), entries=[*map(making.info, (BED, STAND, LAMP)), making.info(CHAIR, category)])
    making.write_model(tmp_path / "front", CHAIR, making.box_obj(size))
    made = read(tmp_path)
    asset = next(a for a in made.assets if a["source_id"] == CHAIR)
    assert np.allclose(asset["size"], np.array(size) / 100)


def test_a_metre_model_stays_whatever_its_record_says(tmp_path):
    """A declared box that is nowhere near any unit does not change a model of a usual size."""
    tree = making.two_rooms()
    tree["furniture"][0] |= {"size": [18.0, 22.0, 11.0], "bbox": [18.0, 22.0, 11.0]}
    made = read(written(tmp_path, tree))
    assert made.objects[0]["size"] == [1.8, 2.2, 1.1]
    assert made.reasons == set()


@pytest.mark.parametrize("signs", [(-1, 1, 1), (1, 1, -1), (-1, 1, -1), (1, 1, 1)])
@pytest.mark.parametrize("yaw", [0.0, 0.7, np.pi / 2])
def test_what_stands_there_is_the_mirrored_shape(signs, yaw, tmp_path):
    """The placed asset's vertices are the file's, transformed by the format's own rule: v' = R(rot) (scale . v) + pos."""
    at, magnitude = (0.4, 0.0, -0.2), np.array([1.1, 0.9, 1.2])
    scale = magnitude * signs
    tree = making.two_rooms(more_furniture=[chair_record("x/model", CHAIR)])
    tree["mesh"].append(floor("f9", 10, 0, 18, 8))
    tree["scene"]["room"].append(
        {
            "type": "Lounge",
            "instanceid": "Lounge-3",
            "children": [child("f9", "mesh/0"), child("x/model", "furniture/9", (14, 0.1, 4), yaw, scale)],
        }
    )
    written(
        tmp_path, tree, jids=(BED, STAND, LAMP, CHAIR), entries=[*map(making.info, (BED, STAND, LAMP)), making.info(CHAIR, "L-shaped Sofa")]
    )
    making.write_model(tmp_path / "front", CHAIR, sofa_obj(at=at))
    made = read(tmp_path)
    placed = next(o for o in made.objects if o["source_id"].endswith(CHAIR))
    mirrored = signs[0] * signs[2] < 0
    assert placed["asset_id"].endswith("_mirrored") == mirrored
    assert ("mirrored" in made.reasons) == mirrored
    row = next(a for a in made.assets if a["asset_id"] == placed["asset_id"])
    asset = load_asset(tmp_path / "assets" / row["file"])
    points = np.concatenate([m.vertices for m in asset.meshes()]) * placed["scale"]
    c, s = np.cos(placed["yaw"]), np.sin(placed["yaw"])
    points = points @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]).T + placed["position"]
    raw = np.array([[float(v) for v in line.split()[1:]] for line in sofa_obj(at=at).splitlines() if line.startswith("v ")])
    c, s = np.cos(yaw), np.sin(yaw)
    want = to_ours((raw * scale) @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T + (14, 0.1, 4))
    gaps = np.linalg.norm(points[:, None] - want[None], axis=2)
    assert gaps.min(axis=0).max() < 1e-3
    assert gaps.min(axis=1).max() < 1e-3
    assert all(signed_volume(p.vertices.astype(float), p.faces) > 0 for p in asset.links[0].colliders)
    assert np.linalg.eigvalsh(asset.links[0].inertia).min() > 0


def test_one_mirrored_asset_serves_all_its_placements(tmp_path):
    more = [
        child("b/model", "furniture/8", (2, 0, 2.8), scale=(-0.5, 0.5, 0.5)),
        child("b/model", "furniture/9", (2, 0, 3.4), scale=(0.3, 0.3, -0.3)),
    ]
    made = read(written(tmp_path, making.two_rooms(extra=more)))
    twins = [a for a in made.assets if a["asset_id"].endswith("_mirrored")]
    assert len(twins) == 1
    assert [o["asset_id"] == twins[0]["asset_id"] for o in made.objects if o["category"] == "double_bed"] == [False, True, True]
    origin = next(a for a in made.assets if a["source_id"] == BED and a is not twins[0])
    assert {k for k in origin if origin[k] != twins[0][k]} == {"asset_id", "file", "sha256"}


def test_replaced_models(tmp_path):
    """`replace_jid` names what stands there; its scale maps it to the size of what it replaces."""
    placed = {
        **child("x/model", "furniture/9", (1, 0, 3.4), scale=(2, 1, 2)),
        "replace_jid": STAND,
        "replace_bbox": {"xLen": 50, "yLen": 40, "zLen": 50},
    }
    made = read(written(tmp_path, making.two_rooms(extra=[placed], more_furniture=[chair_record("x/model", "gone", "nested")])))
    stand = made.objects[-1]
    assert (stand["category"], stand["size"], stand["source_id"].rsplit("#")[-1]) == ("nightstand", [1.0, 0.8, 0.5], STAND)


def test_the_valid_one_of_several_records_is_used(tmp_path):
    tree = making.two_rooms()
    tree["furniture"].insert(0, {"uid": "b/model", "jid": BED, "valid": False, "category": "Others"})
    made = read(written(tmp_path, tree))
    assert made.reasons == {"duplicate_record"}
    assert made.objects[0]["category"] == "double_bed"


@pytest.mark.parametrize("pieces", range(1, 9))
def test_floors_in_pieces_are_one_outline(pieces, tmp_path):
    tree = making.two_rooms()
    tree["mesh"] = [m for m in tree["mesh"] if m["uid"] != "f1"]
    edges = np.linspace(0, 4, pieces + 1)
    strips = [floor(f"p{k}", float(a), 0, float(b), 4) for k, (a, b) in enumerate(itertools.pairwise(edges))]
    strips[0]["xyz"] += [0, 0, 0, 1, 0, 0, 2, 0, 0]  # a triangle without area
    strips[0]["faces"] += [6, 7, 8]
    strips[-1]["faces"] = strips[-1]["faces"][::-1]  # looks down
    tree["mesh"] += strips
    room = tree["scene"]["room"][0]
    room["children"] = [c for c in room["children"] if c["ref"] != "f1"] + [child(f"p{k}", f"mesh/{k + 9}") for k in range(pieces)]
    room["size"] = 16.0
    made = read(written(tmp_path, tree))
    assert made.rooms[0]["area"] == 16.0
    assert len(made.rooms[0]["polygon"]) == 4
    assert made.reasons == set()


def test_files_with_a_byte_order_mark(tmp_path):
    root = written(tmp_path)
    for path in [*root.rglob("*.json"), *root.rglob("*.obj"), *root.rglob("*.mtl")]:
        path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    made = read(root)
    assert made.reasons == set()
    assert len(made.objects) == 3
    assert all(load_asset(root / "assets" / a["file"]).textures for a in made.assets)


@pytest.mark.parametrize("key", ["jobid", "lights", "groups", "materialList", "material", "extension", "north_vector", "version"])
def test_keys_that_a_dialect_may_lack(key, tmp_path):
    tree = making.two_rooms()
    tree.pop(key, None)
    made = read(written(tmp_path, tree))
    assert len(made.objects) == 3
    assert made.reasons == set()


def test_a_model_info_of_the_toolbox_is_named(tmp_path):
    root = written(tmp_path)
    (root / "front" / "3D-FUTURE-model" / "model_info.json").write_text(json.dumps({BED: {"category_id": 1}}))
    with pytest.raises(Exception, match="ToolBox"):
        read(root)


@pytest.mark.parametrize("key", ["pos", "rot", "scale"])
def test_a_pose_that_is_null_is_the_usual_one(key, tmp_path):
    tree = making.two_rooms()
    bed = next(c for c in tree["scene"]["room"][0]["children"] if c["ref"] == "b/model")
    tree["scene"]["room"][0]["children"].append({**bed, "pos": [2, 0, 1.1], "instanceid": "furniture/9"})
    bed |= {"pos": [2, 0, 1.1], key: None}
    tree["scene"]["room"][0]["children"].pop()
    made = read(written(tmp_path, tree))
    assert "bad_number" not in made.reasons
    assert (BED in {o["source_id"].rpartition("#")[2] for o in made.objects}) == (key != "pos")  # at 0, 0 it is half outside


def test_a_ref_in_both_tables_is_the_furniture_and_the_mesh(tmp_path):
    tree = making.two_rooms(more_furniture=[chair_record("f1", STAND)])
    next(c for c in tree["scene"]["room"][0]["children"] if c["ref"] == "f1")["pos"] = [1, 0, 3]
    made = read(written(tmp_path, tree))
    assert made.rooms[0]["area"] == 16.0  # meshes are in world coordinates whatever the pose
    assert [o["position"][:2] for o in made.objects if o["category"] == "nightstand"] == [[1.0, -3.0], [3.4, -0.3]]


@pytest.mark.parametrize(("at", "reason"), [(1e30, "bad_number"), (2e4, "bad_number"), (900.0, "too_large")])
def test_floors_at_the_end_of_the_world(at, reason, tmp_path):
    """They cost the room, or the house, never the memory of a raster that holds both."""
    tree = making.two_rooms()
    tree["mesh"] = [floor("f2", at, 0, at + 3, 4) if m["uid"] == "f2" else m for m in tree["mesh"]]
    made = read(written(tmp_path, tree))
    assert made.reasons == {reason} or (reason == "bad_number" and reason in made.reasons)
    assert len(made.scenes) == (0 if reason == "too_large" else 1)
