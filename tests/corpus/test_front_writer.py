"""Scene files: the shape of both dialects, frames, and the mess of real files when it is asked for."""

import json
import math
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from shapely.geometry import Polygon
from shapely.ops import unary_union

sys.path.insert(0, str(Path(__file__).parent / "houses"))
from sample_houses import house, houses, stock

from pipeline.corpus.front_writer import DIALECTS, quaternion, scene_json
from pipeline.corpus.houses import corruption
from pipeline.seeds import generator


def scene(index=0, dialect="0.4", litter=None):
    return scene_json(house(index), dialect, generator(5, "front", index), litter or corruption.Litter())


def floor_area(record):
    xyz = np.array(record["xyz"]).reshape(-1, 3)
    faces = np.array(record["faces"]).reshape(-1, 3)
    cross = np.cross(xyz[faces[:, 1]] - xyz[faces[:, 0]], xyz[faces[:, 2]] - xyz[faces[:, 0]])
    return cross[:, 1] / 2


@pytest.mark.parametrize("dialect", DIALECTS)
def test_top_level_keys(dialect):
    keys = set(scene(dialect=dialect))
    both = {"uid", "design_version", "code_version", "north_vector", "version", "furniture", "mesh", "material", "extension", "scene"}
    assert keys == both | ({"jobid", "lights", "groups", "materialList"} if dialect == "0.11" else set())
    assert scene(dialect=dialect)["code_version"] == dialect


@pytest.mark.parametrize("dialect", DIALECTS)
@pytest.mark.parametrize("index", range(4))
def test_references_resolve_and_ids_are_unique_without_mess(dialect, index):
    tree = scene(index, dialect)
    uids = [r["uid"] for r in tree["furniture"] + tree["mesh"]]
    assert len(uids) == len(set(uids))
    children = [c for room in tree["scene"]["room"] for c in room["children"]]
    refs = Counter(c["ref"] for c in children)
    assert set(refs) <= set(uids)
    assert all(refs[m["uid"]] == 1 for m in tree["mesh"])
    assert len({r["instanceid"] for r in tree["scene"]["room"]}) == len(tree["scene"]["room"])
    materials = {m["uid"] for m in tree["material"]}
    assert all(m["material"] in materials for m in tree["mesh"])


@pytest.mark.parametrize("index", range(6))
def test_floors_lie_at_zero_face_up_and_have_the_rooms_shape(index):
    tree, home = scene(index, "0.11"), house(index)
    meshes = {m["uid"]: m for m in tree["mesh"]}
    for record, room in zip(tree["scene"]["room"], home.plan.rooms, strict=True):
        floors = [meshes[c["ref"]] for c in record["children"] if c["ref"] in meshes and meshes[c["ref"]]["type"] == "Floor"]
        assert floors
        assert record["size"] == pytest.approx(room.area, abs=1e-3)
        triangles = []
        for floor in floors:
            assert set(floor["xyz"][1::3]) == {0}
            areas = floor_area(floor)
            assert np.all(areas > 0)
            xyz = np.array(floor["xyz"]).reshape(-1, 3)
            triangles += [Polygon([(xyz[i, 0], -xyz[i, 2]) for i in face]) for face in np.array(floor["faces"]).reshape(-1, 3)]
        assert unary_union(triangles).symmetric_difference(Polygon(room.polygon)).area < 1e-3


@pytest.mark.parametrize("index", range(6))
def test_meshes_are_arrays_of_matching_lengths_and_inner_walls_face_the_room(index):
    tree, home = scene(index), house(index)
    owner = {c["ref"]: k for k, room in enumerate(tree["scene"]["room"]) for c in room["children"]}
    for mesh in tree["mesh"]:
        n = len(mesh["xyz"]) // 3
        assert len(mesh["xyz"]) == len(mesh["normal"]) == 3 * n
        assert len(mesh["uv"]) == 2 * n
        assert max(mesh["faces"]) < n
        if mesh["type"] == "WallInner":
            middle = np.array(mesh["xyz"][:3]) / 2 + np.array(mesh["xyz"][6:9]) / 2
            front = middle + 0.05 * np.array(mesh["normal"][:3])
            shape = Polygon(home.plan.rooms[owner[mesh["uid"]]].polygon)
            from shapely.geometry import Point

            assert shape.contains(Point(front[0], -front[2]))


@pytest.mark.parametrize("dialect", DIALECTS)
def test_poses_sizes_and_the_order_of_axes(dialect):
    home, tree = house(2), scene(2, dialect)
    records = {f["uid"]: f for f in tree["furniture"]}
    placed = [(records[c["ref"]], c) for room in tree["scene"]["room"] for c in room["children"] if records.get(c["ref"], {}).get("valid")]
    assert len(placed) == len(home.items)
    for item, (record, child) in zip(sorted(home.items, key=lambda i: i.room), placed, strict=True):
        x, y, z = item.position
        assert child["pos"] == pytest.approx([x, z, -y], abs=1e-4)
        assert record["jid"] == item.model.model_id
        qx, qy, qz, qw = child["rot"]
        assert (qx, qz) == (0, 0)
        assert abs(math.remainder(2 * math.atan2(qy, qw) - item.yaw, 2 * math.pi)) < 1e-4
        w, d, h = item.size
        if "size" in record:
            assert record["size"] == pytest.approx([w, d, h], abs=1e-4)
            if item.scale != (1.0, 1.0, 1.0):  # fitted to its window: told like a replaced model
                assert record["bbox"] == [pytest.approx([w, h, d], abs=1e-4)]
                continue
            assert record["bbox"] == record["size"]
            assert "category" not in record
        else:
            assert record["bbox"] == pytest.approx([w, h, d], abs=1e-4)
            assert record["category"] == item.model.future_name
        assert record["aid"] == []


def test_quaternions_have_five_decimals_and_unit_length():
    for yaw in (0.0, math.pi / 2, math.pi, -math.pi / 2, 0.3):
        q = quaternion(yaw)
        assert all(round(v, 5) == v for v in q)
        assert math.hypot(*q) == pytest.approx(1.0, abs=1e-4)
    assert quaternion(math.pi / 2) == [0, 0.70711, 0, 0.70711]


def test_doors_and_windows_are_furniture_without_a_valid_flag_at_their_reveals():
    home, tree = house(1), scene(1, "0.11")
    leaves = {f["uid"]: f for f in tree["furniture"] if "valid" not in f}
    poses = {c["ref"]: c["pos"] for room in tree["scene"]["room"] for c in room["children"] if c["ref"] in leaves}
    wanted = [o for o in home.plan.openings if o.kind in {"door", "entrance", "window"}]
    assert len(leaves) == len(wanted)
    middles = sorted((round(float(x), 3), round(float(y), 3)) for x, y in (o.segment.mean(axis=0) for o in wanted))
    assert np.allclose(sorted((round(p[0], 3), round(-p[2], 3)) for p in poses.values()), middles, atol=2e-3)
    assert {f["title"].split("/")[0] for f in leaves.values()} <= {"door", "window"}
    kinds = Counter(m["type"] for m in tree["mesh"])
    assert kinds["Door"] + kinds["Window"] + kinds["Hole"] == len(home.plan.openings)
    uids = {r["uid"] for r in tree["furniture"] + tree["mesh"]}
    assert all(set(d["ref"]) <= uids for d in tree["extension"]["door"])
    assert sum(d["type"] == "entryDoor" for d in tree["extension"]["door"]) == 1


def test_the_scene_bounds_have_z_swapped_like_the_real_ones():
    box = scene(0, "0.11")["scene"]["boundingBox"]
    assert box["min"][2] > box["max"][2]
    assert "boundingBox" not in scene(0, "0.4")["scene"]


def test_litter_is_all_there_and_changes_nothing_real():
    litter = corruption.Litter(dangling=30, invalid=3, duplicates=2, double_children=1, other_room=True, shaft_room=True)
    tree = scene(3, "0.11", litter)
    uids = Counter(r["uid"] for r in tree["furniture"] + tree["mesh"])
    children = [c for room in tree["scene"]["room"] for c in room["children"]]
    assert sum(c["ref"] not in uids for c in children) >= 30
    assert sum(f.get("valid") is False for f in tree["furniture"]) >= 3
    assert sum(n - 1 for n in uids.values()) == 2
    others = [r for r in tree["scene"]["room"] if r["type"] == "OtherRoom"]
    assert {r["instanceid"] == "OtherRoom" for r in others} == {True, False}
    assert sum(f.get("valid") is True for f in tree["furniture"]) >= len(house(3).items)


def test_disturbed_houses_have_replaced_mirrored_and_misplaced_pieces_at_their_rates():
    rng = generator(1, "test-mess")
    homes = houses(24) * 4  # one in 250 pieces is mirrored
    pairs = [(a, b) for home in homes for a, b in zip(home.items, corruption.disturb(rng, home, stock()).items, strict=True)]
    replaced = np.mean([a.model is not b.model for a, b in pairs if a.support < 0])
    moved = np.mean([a.position != b.position for a, b in pairs if a.support < 0])
    assert 0.02 < replaced < 0.15
    assert 0.05 < moved < 0.35
    assert any(b.scale[0] < 0 for _, b in pairs)
    for a, b in pairs:
        assert b.size == pytest.approx(a.size, abs=1e-6)


def test_replaced_models_are_told_as_such():
    rng = generator(1, "test-mess")
    home = next(h for h in (corruption.disturb(rng, h, stock()) for h in houses(8)) if any(abs(i.scale[1]) != 1 for i in h.items))
    tree = scene_json(home, "0.4", generator(5, "front", 0), corruption.Litter())
    records = {f["uid"]: f for f in tree["furniture"]}
    swapped = [c for room in tree["scene"]["room"] for c in room["children"] if "replace_jid" in c]
    assert swapped
    for child in swapped:
        record = records[child["ref"]]
        assert record["jid"] == child["replace_jid"]
        (w, h, d), s, box = record["bbox"][0], child["scale"], child["replace_bbox"]
        assert [abs(s[0]) * box["xLen"] / 100, s[1] * box["zLen"] / 100, s[2] * box["yLen"] / 100] == pytest.approx([w, h, d], abs=1e-3)


@pytest.mark.parametrize("index", range(4))
def test_files_are_deterministic_finite_and_small(index):
    litter = corruption.litter(generator(5, "litter", index), house(index))
    texts = [json.dumps(scene(index, "0.11", litter), allow_nan=False) for _ in range(2)]
    assert texts[0] == texts[1]
    assert len(texts[0]) < 400_000
