"""Furniture as real houses have it: filed under other rooms, in the notch of a sofa, lamps that stand, houses that come twice."""

import json

import numpy as np
import pytest

from pipeline.sources.rows import split_of
from pipeline.sources.threed_front.notches import CELLS, occupancy_bits, overlap_share
from pipeline.sources.threed_front.poses import Pose
from tests.sources import making
from tests.sources.making import BED, CHAIR, LAMP, STAND, TABLE, chair_record, child, floor
from tests.sources.reading import read
from tests.sources.test_front_variants import sofa_obj

SOFA = CHAIR  # a model id that is free for it


def written(root, tree, jids=(BED, STAND, LAMP), entries=None):
    making.write_library(root / "front", jids, entries)
    making.write_house(root / "front", tree)
    return root


def lounge(placed, records):
    """Return the usual two rooms and a lounge of 8 x 8 m beside them, with furniture in it."""
    tree = making.two_rooms(more_furniture=records)
    tree["mesh"].append(floor("f9", 10, 0, 18, 8))
    tree["scene"]["room"].append({"type": "Lounge", "instanceid": "Lounge-3", "children": [child("f9", "mesh/0"), *placed]})
    return tree


@pytest.mark.parametrize("yaw", [0.0, np.pi / 2, 2.1])
@pytest.mark.parametrize("mirror", [1, -1])
def test_a_coffee_table_stands_in_the_notch_of_a_sofa(yaw, mirror, tmp_path):
    """The table's box lies in the sofa's by 88 %; where the sofa is it lies by nothing, or, on the other side, by most of it."""
    c, s = np.cos(yaw), np.sin(yaw)

    def at(x, z):
        return (14 + c * x + s * z, 0, 4 - s * x + c * z)

    # the sofa's long seat is at its +x; its box reaches from z = -0.4 to 1.2
    notch, seat = at(mirror * -0.45, 0.85), at(mirror * 0.8, 0.7)
    for place, there in ((notch, True), (seat, False)):
        root = tmp_path / str(there)
        records = [chair_record("x/model", SOFA), chair_record("t/model", TABLE)]
        placed = [child("x/model", "furniture/8", (14, 0, 4), yaw, (mirror, 1, 1)), child("t/model", "furniture/9", place, yaw)]
        tables = [*map(making.info, (BED, STAND, LAMP)), making.info(SOFA, "L-shaped Sofa"), making.info(TABLE, "Coffee Table")]
        written(root, lounge(placed, records), (BED, STAND, LAMP, SOFA, TABLE), tables)
        making.write_model(root / "front", SOFA, sofa_obj())
        making.write_model(root / "front", TABLE, making.box_obj((0.7, 0.6, 0.4)))
        made = read(root)
        assert ("coffee_table" in {o["category"] for o in made.objects}) == there, made.rejects
        assert ("overlap" in made.reasons) != there


def test_shapes_are_what_models_fill():
    """A table is open below its top, an L leaves its notch, a box is full; a shape shares itself wholly."""

    class Box:
        def __init__(self, low, high):
            corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])], float)
            sides = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
            self.vertices = corners
            self.faces = np.array([t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))])

    def mask(parts, size):
        bits = np.frombuffer(occupancy_bits(parts, np.array(size)), np.uint8)
        return np.unpackbits(bits, count=int(np.prod(CELLS))).reshape(CELLS).astype(bool)

    assert mask([Box((-0.5, -0.5, 0), (0.5, 0.5, 1))], (1, 1, 1)).all()
    table = mask([Box((-0.5, -0.5, 0.9), (0.5, 0.5, 1)), Box((-0.5, -0.5, 0), (-0.45, -0.45, 0.9))], (1, 1, 1))
    assert table[..., -1].all()
    assert not table[4:, 4:, : CELLS[2] - 1].any()
    both = [Box((-1, -0.5, 0), (1, 0, 0.8)), Box((0.4, 0, 0), (1, 0.5, 0.4))]
    bits = occupancy_bits(both, np.array((2.0, 1.0, 0.8)))
    pose = Pose(np.array([1.0, 2.0, 0.0]), 0.3, np.array([2.0, 1.0, 0.8]), mirrored=False)
    assert overlap_share((pose, bits), (pose, bits)) == 1.0
    far = Pose(np.array([9.0, 2.0, 0.0]), 0.3, np.array([2.0, 1.0, 0.8]), mirrored=False)
    assert overlap_share((pose, bits), (far, b"")) == 0.0


def test_what_lies_in_another_room_is_there(tmp_path):
    """Filed under the bedroom, or under a room without a floor, it lies in the hall: there it goes, and a note says so."""
    records = [chair_record(f"{k}/model", STAND) for k in "xyz"]
    tree = making.two_rooms(extra=[child("x/model", "furniture/9", (5, 0, 1))], more_furniture=records)
    leftovers = [child("y/model", "furniture/10", (5, 0, 2)), child("z/model", "furniture/11", (1e31, 0, 1e31))]
    tree["scene"]["room"].append({"type": "OtherRoom", "instanceid": "OtherRoom", "children": leftovers})
    made = read(written(tmp_path, tree))
    hall = [(o["position"][:2], o["source_id"].split("#")[0]) for o in made.objects if o["room_id"] == "r_hallway_2"]
    assert hall == [([5.0, -1.0], "house-a/MasterBedroom-1/furniture/9"), ([5.0, -2.0], "house-a/OtherRoom/furniture/10")]
    notes = [(r["reason"], r["where"], r["detail"]) for r in made.rejects if r["what"] == "object"]
    assert notes == [
        ("bad_number", "house-a/OtherRoom/furniture/11", "stands 1e+31 m from the origin"),
        ("other_room", "house-a/MasterBedroom-1/furniture/9", "filed under MasterBedroom-1, lies in Hallway-2"),
        ("other_room", "house-a/OtherRoom/furniture/10", "filed under OtherRoom, lies in Hallway-2"),
    ]


@pytest.mark.parametrize(("out", "there"), [(0.1, True), (0.11, False)])
def test_a_share_at_the_limit_passes(out, there, tmp_path):
    """A nightstand 50 cm wide that sticks 10 cm out of its room lies in it by 80 %, which is the limit where nothing is moved."""
    tree = making.two_rooms(
        extra=[child("x/model", "furniture/9", (-0.15 - out + 0.4, 0, 3))], more_furniture=[chair_record("x/model", STAND)]
    )
    made = read(written(tmp_path, tree), filters={"max_shift": 0.0})
    assert ("outside_room" not in made.reasons) == there


@pytest.mark.parametrize(("out", "moved"), [(0.11, 0.11), (0.25, 0.25), (0.32, None)])
def test_a_piece_half_in_a_wall_is_moved_out_of_it_and_one_that_is_more_so_is_left_out(out, moved, tmp_path):
    tree = making.two_rooms(
        extra=[child("x/model", "furniture/9", (-0.15 - out + 0.4, 0, 3))], more_furniture=[chair_record("x/model", STAND)]
    )
    made = read(written(tmp_path, tree))
    there = {o["source_id"].split("#")[0]: o["position"][0] for o in made.objects}
    assert ("outside_room" in made.reasons) == (moved is None)
    assert there.get("house-a/MasterBedroom-1/furniture/9") == (None if moved is None else pytest.approx(0.25 + 0.003, abs=2e-4))
    notes = [r["detail"] for r in made.rejects if r["reason"] == "moved"]
    assert notes == ([] if moved is None else [f"nightstand by {moved + 0.003:.2f} m"])


def lamp(tmp_path, category, foot, beside=()):
    tree = making.two_rooms()
    tree["furniture"] = [r for r in tree["furniture"] if r["uid"] != "l/model"]
    tree["furniture"] += [
        {**chair_record("l/model", LAMP, "later"), "category": "Lighting", "bbox": [1.3, 2.3, 1.3]},
        *(r for r, _ in beside),
    ]
    for entry in tree["scene"]["room"][0]["children"]:
        if entry["ref"] == "l/model":
            entry["pos"] = [1.2, foot, 3.0]
    tree["scene"]["room"][0]["children"] += [c for _, c in beside]
    entries = [making.info(BED), making.info(STAND), making.info(LAMP, category, **{"super-category": "Lighting"}), making.info(CHAIR)]
    written(tmp_path, tree, (BED, STAND, LAMP, CHAIR), entries)
    # an arc: a foot, a pole, a shade that hangs over
    arc = making.box_obj((0.3, 0.3, 0.05), at=(-0.5, 0, -0.5), uv=False)
    for size, at in (((0.05, 0.05, 2.3), (-0.5, 0, -0.5)), ((1.3, 1.3, 0.05), (0, 2.25, 0)), ((0.4, 0.4, 0.3), (0.4, 1.9, 0.4))):
        lines, base = making.box_obj(size, at=at, uv=False).splitlines()[1:], arc.count("\nv ")
        arc += "\n".join("f " + " ".join(str(int(w) + base) for w in x.split()[1:]) if x[0] == "f" else x for x in lines) + "\n"
    making.write_model(tmp_path / "front", LAMP, arc)
    return read(tmp_path)


def test_a_tall_lamp_that_stands_is_no_pendant_and_evicts_nobody(tmp_path):
    """What calls itself lighting is a pendant by its height of 2.3 m; the house stands it on the floor, with a chair under its arc."""
    beside = [(chair_record("c/model", CHAIR), child("c/model", "furniture/9", (1.35, 0, 3.15)))]
    made = lamp(tmp_path, "", 0.0, beside)
    assert {"floor_lamp", "dining_chair"} <= {o["category"] for o in made.objects}
    assert next(a["category"] for a in made.assets if a["source_id"] == LAMP) == "floor_lamp"
    assert "overlap" not in made.reasons


def test_a_pendant_that_stands_is_taken_as_what_it_is(tmp_path):
    made = lamp(tmp_path, "Pendant Lamp", 0.0)
    assert "floor_lamp" in {o["category"] for o in made.objects}
    assert [r["detail"] for r in made.rejects if r["what"] == "object"] == [
        "floor_lamp, for a pendant_lamp of 2.30 m that stands on the floor"
    ]


def test_one_house_under_two_names_is_one(tmp_path):
    making.write_library(tmp_path / "front", (BED, STAND, LAMP))
    tree = making.two_rooms("house-a")
    for name in ("house-a", "copy", "zz"):
        making.write_house(tmp_path / "front", tree, name)
    other = json.loads(json.dumps(tree))
    other["scene"]["room"][0]["children"][4]["pos"][0] += 0.05  # an edition of it: another house, in the same split
    making.write_house(tmp_path / "front", other, "edition")
    made = read(tmp_path)
    assert [s["scene_id"] for s in made.scenes] == ["h_copy", "h_edition"]
    assert {s["split"] for s in made.scenes} == {split_of("house-a")}
    assert [(r["where"], r["detail"]) for r in made.rejects if r["reason"] == "duplicate_house"] == [
        ("house-a", "the same as copy"),
        ("zz", "the same as copy"),
    ]


def test_objects_without_models_need_no_models(tmp_path):
    making.write_house(tmp_path / "front", making.two_rooms(variant="nested"))
    made = read(tmp_path, filters={"keep_without_model": True})
    assert [o["category"] for o in made.objects] == ["double_bed", "nightstand", "pendant_lamp"]
    assert made.assets == []


def test_what_is_filed_under_a_room_without_a_floor_is_counted_too(tmp_path):
    making.write_library(tmp_path / "front", (BED, STAND, LAMP))
    tree = making.two_rooms("house-a", more_furniture=[making.chair_record("gone/model", STAND, valid=False)])
    tree["scene"]["room"].append(
        {"type": "OtherRoom", "instanceid": "OtherRoom", "children": [making.child("nothing", f"furniture/{k}") for k in (1, 2)]}
    )
    making.write_house(tmp_path / "front", tree, "house-a")
    told = {(r["where"], r["reason"], r["detail"]) for r in read(tmp_path).rejects}
    assert ("house-a/OtherRoom", "dangling_ref", "2 of 2 children") in told
    assert ("house-a/gone/model", "not_placed", f"model {STAND}") in told
