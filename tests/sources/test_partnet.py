import json
import math
import re

import numpy as np
import pytest

from pipeline import taxonomy
from pipeline.corpus.furniture.catalogue import catalogue
from pipeline.corpus.partnet_writer import write_partnet
from pipeline.entities.files import load_asset
from pipeline.geometry.kinematics import handle_point, link_transforms
from pipeline.sources.articulated import metric_scale
from pipeline.sources.articulated.category_signs import Signs
from pipeline.sources.articulated.part_classes import box_corners
from pipeline.sources.articulated.partnet import read_shape
from pipeline.sources.guarded import Folder
from pipeline.sources.sizes import sizes
from tests.sources import making
from tests.sources.reading import read


def first(root, **more):
    making.write_partnet(root / "partnet", **more)
    made = read(root)
    assert made.assets, made.rejects
    return load_asset(root / "assets" / made.assets[0]["file"]), made


def moved(asset, joint, part=None):
    """Return the middle of what a joint moves, at rest and fully open."""
    j = next(k for k, v in enumerate(asset.joints) if v.part_class == joint)
    positions = np.zeros(len(asset.joints))
    link = asset.links[asset.joints[j].child]
    points = np.concatenate([m.vertices for m in link.visuals if part is None or m.part == part]).astype(float)
    positions[j] = asset.joints[j].upper
    T = link_transforms(asset, positions)[asset.joints[j].child]
    return points.mean(axis=0), (points @ T[:3, :3].T + T[:3, 3]).mean(axis=0)


@pytest.mark.parametrize("gapartnet", [True, False])
def test_door_and_drawer_open_towards_the_front(tmp_path, gapartnet):
    asset, made = first(tmp_path, gapartnet=gapartnet)
    assert [j.part_class for j in asset.joints] == ["hinge_door", "slider_drawer"]
    for kind in ("hinge_door", "slider_drawer"):
        rest, opened = moved(asset, kind)
        assert opened[1] < rest[1] - 0.1
    assert asset.joints[0].type == "revolute"
    assert asset.joints[0].upper == pytest.approx(1.57)
    assert asset.joints[1].lower == 0
    for row in made.joints:
        assert row["sweep_min"][1] < -0.5 * asset.size[1] < row["handle"][1] + 0.2
        assert row["handle"][1] < 0


def test_frame(tmp_path):
    """Mesh (x, y up, z front) is ours (x, -z, y): the hinge is left and in front, the drawer below the door."""
    asset, made = first(tmp_path)
    w, d, h = asset.size
    scale = made.assets[0]["unit_scale"]
    assert np.allclose([w, h], np.array([making.W, making.H]) * scale, atol=1e-3)
    hinge = asset.joints[0]
    assert hinge.origin[0] == pytest.approx(-w / 2, abs=1e-3)
    assert hinge.origin[1] < 0
    assert np.allclose(np.abs(hinge.axis), [0, 0, 1])
    drawer, door = moved(asset, "slider_drawer")[0], moved(asset, "hinge_door")[0]
    assert drawer[2] < door[2]
    points = np.concatenate([m.vertices for m in asset.meshes()])
    assert np.allclose([points.min(axis=0), points.max(axis=0)], [[-w / 2, -d / 2, 0], [w / 2, d / 2, h]], atol=1e-3)
    mass = sum(link.mass for link in asset.links)
    assert 5 < mass < 1000


def test_fixed_handle_is_merged_and_keeps_its_name(tmp_path):
    asset, _ = first(tmp_path)
    assert len(asset.links) == 3
    door = asset.links[asset.joints[0].child]
    assert [m.part for m in door.visuals] == ["", "line_fixed_handle"]
    rest, opened = moved(asset, "hinge_door", "line_fixed_handle")
    assert opened[1] < rest[1] - 0.3


@pytest.mark.parametrize(
    ("axis", "limit", "upper"),
    [
        ("0 -1 0", 'lower="0" upper="1.5"', 1.5),
        ("0 1 0", 'lower="-1.5" upper="0"', 1.5),
        ("0 1 0", 'lower="-0.0" upper="-1.5"', 1.5),
        ("0 -1 0", 'lower="0.3" upper="1.5"', 1.2),
        ("0 1 0", 'lower="-1.5" upper="-0.3"', 1.2),
        ("0 -1 0", 'lower="-0.2" upper="1.5"', 1.5),
    ],
)
def test_limits_and_signs_all_open_outwards(tmp_path, axis, limit, upper):
    hinge = f"{-making.W / 2} 0 {making.D / 2}"
    xml = (
        f'<joint name="joint_0" type="revolute"><child link="link_0"/><parent link="link_2"/><origin xyz="{hinge}"/>'
        f'<axis xyz="{axis}"/><limit {limit}/></joint>'
        '<joint name="joint_1" type="fixed"><child link="link_1"/><parent link="link_2"/></joint>'
    )
    asset, _ = first(tmp_path, joints=xml)
    (joint,) = asset.joints
    assert joint.lower <= 0 <= joint.upper == pytest.approx(upper)
    rest, opened = moved(asset, "hinge_door")
    assert opened[1] < rest[1]


def test_continuous(tmp_path):
    turn = '<joint name="joint_0" type="continuous"><child link="link_0"/><parent link="link_2"/><axis xyz="0 1 0"/></joint>'
    asset, _ = first(tmp_path, joints=turn + FIXED)
    assert [(j.type, j.part_class) for j in asset.joints] == [("continuous", "hinge_door")]
    assert math.isinf(asset.joints[0].upper)


FIXED = '<joint name="joint_1" type="fixed"><child link="link_1"/><parent link="link_2"/></joint>'
KNOB = '<joint name="joint_0" type="fixed"><child link="link_0"/><parent link="link_2"/></joint>'
SLIDE = (
    '<joint name="slide" type="prismatic"><child link="{}"/><parent link="{}"/><axis xyz="0 0 1"/><limit lower="0" upper="0.2"/></joint>'
)
TURN = '<joint name="turn" type="continuous"><child link="{}"/><parent link="{}"/><axis xyz="0 0 1"/></joint>'


@pytest.mark.parametrize("slide_first", [True, False])
@pytest.mark.parametrize(("word", "kept"), [("drawer", "prismatic"), ("knob", "continuous"), ("rotation_cap", "continuous")])
def test_of_a_screw_stays_what_the_part_is_used_by(tmp_path, slide_first, word, kept):
    """A slide and a turn through an empty link, in either order; nobody has annotated them."""
    outer, inner = ("link_1_helper", "link_2"), ("link_1", "link_1_helper")
    pair = SLIDE.format(*outer) + TURN.format(*inner) if slide_first else TURN.format(*outer) + SLIDE.format(*inner)
    urdf = making.partnet_urdf((0, 0, 0), KNOB + pair).replace("</robot>", '<link name="link_1_helper"/></robot>')
    folder = making.write_partnet(tmp_path / "p", urdf=urdf, gapartnet=False)
    (folder / "semantics.txt").write_text(f"link_1 slider+ {word}\nlink_2 heavy furniture_body\n")
    shape = read_shape(Folder.at(folder), "40000", 512)
    (joint,) = shape.joints
    assert joint.type == kept
    assert len(shape.bodies) == 2
    assert [n[1] for n in shape.notes] == ["screw_collapsed"]


def test_a_short_stroke_turns(tmp_path):
    pair = SLIDE.format("helper", "link_2").replace("0.2", "0.02") + TURN.format("link_1", "helper")
    urdf = making.partnet_urdf((0, 0, 0), KNOB + pair).replace("</robot>", '<link name="helper"/></robot>')
    folder = making.write_partnet(tmp_path / "p", urdf=urdf, gapartnet=False)
    (folder / "semantics.txt").unlink()
    assert [j.type for j in read_shape(Folder.at(folder), "40000", 512).joints] == ["continuous"]


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("limit", ["", '<limit lower="0" upper="0"/>', '<limit effort="1"/>'])
def test_limits_that_the_urdf_lacks_come_from_mobility_v2(tmp_path, limit, sign):
    """Degrees about PartNet's direction; the URDF may have turned the axis round."""
    hinge = f"{-making.W / 2} 0 {making.D / 2}"
    door = (
        f'<joint name="joint_0" type="revolute"><child link="link_0"/><parent link="link_2"/><origin xyz="{hinge}"/>'
        f'<axis xyz="0 {-sign} 0"/>{limit}</joint>'
    )
    folder = making.write_partnet(tmp_path / "p", joints=door + FIXED, gapartnet=False)
    data = {"axis": {"origin": [0, 0, 0], "direction": [0, 1, 0]}, "limit": {"a": 0, "b": -90, "noLimit": False}}
    (folder / "mobility_v2.json").write_text(
        json.dumps([{"id": 0, "parent": 2, "joint": "hinge", "name": "door", "parts": [], "jointData": data}])
    )
    shape = read_shape(Folder.at(folder), "40000", 512)
    (joint,) = shape.joints
    assert (joint.lower, joint.upper) == pytest.approx((0, math.pi / 2))
    assert np.cross(joint.axis, shape.bodies[1].points().mean(axis=0) - joint.origin)[1] < 0  # outwards
    assert [n[1] for n in shape.notes] == ["joint_limits_found"]


def test_no_limit_in_mobility_v2_is_a_joint_without_limits(tmp_path):
    door = '<joint name="joint_0" type="revolute"><child link="link_0"/><parent link="link_2"/><axis xyz="0 1 0"/></joint>'
    folder = making.write_partnet(tmp_path / "p", joints=door + FIXED, gapartnet=False)
    data = {"axis": {"origin": [0, 0, 0], "direction": [0, 1, 0]}, "limit": {"a": 0, "b": 0, "noLimit": True}}
    (folder / "mobility_v2.json").write_text(
        json.dumps([{"id": 0, "parent": 2, "joint": "hinge", "name": "door", "jointData": data}, 7, {"id": "x"}])
    )
    assert [j.type for j in read_shape(Folder.at(folder), "40000", 512).joints] == ["continuous"]


def test_a_door_that_is_drawn_open_is_closed(tmp_path):
    """The link is turned by 80 degrees where it hangs: closed is the other limit, where the cabinet is smallest."""
    turned = (
        f'<joint name="joint_0" type="revolute"><child link="link_0"/><parent link="link_2"/>'
        f'<origin xyz="{-making.W / 2} 0 {making.D / 2}" rpy="0 -1.4 0"/><axis xyz="0 -1 0"/><limit lower="-1.4" upper="0"/></joint>'
    )
    asset, made = first(tmp_path, joints=turned + FIXED)
    assert {r["reason"] for r in made.rejects} == {"joint_rest_shifted"}
    assert asset.size[1] == pytest.approx(made.assets[0]["unit_scale"] * (making.D + 0.07), rel=0.02)
    assert asset.joints[0].lower == pytest.approx(0, abs=1e-6)
    assert asset.joints[0].upper == pytest.approx(1.4)
    rest, opened = moved(asset, "hinge_door")
    assert opened[1] < rest[1] - 0.1


def test_part_boxes_are_read_back_as_the_corpus_wrote_them(tmp_path):
    """Every annotated box of some embedded objects, corner by corner in GAPartNet's order, right-handed, in our frame."""
    models = catalogue(3, 0.1).partnet
    chosen = list({m.partnet_category: m for m in models}.values())
    write_partnet(chosen, tmp_path)
    count = 0
    for model in chosen:
        folder = tmp_path / model.model_id
        shape = read_shape(Folder.at(folder), model.model_id, 512)
        entries = [e for e in json.loads((folder / "link_annotation_gapartnet.json").read_text()) if e["is_gapart"]]
        parts = [p for p in shape.parts if p.annotated]
        assert len(parts) == len(entries) == len(shape.parts)
        for part, entry in zip(parts, entries, strict=True):
            X, Y, Z = np.array(entry["bbox"]).T
            assert np.allclose(box_corners(part.centre, part.axes, part.size), np.stack([-Y, X, Z], axis=1), atol=1e-6)
            assert np.linalg.det(part.axes) == pytest.approx(1)
            points = shape.bodies[part.link].points()
            assert (part.centre >= points.min(axis=0) - 1e-3).all()
            assert (part.centre <= points.max(axis=0) + 1e-3).all()
            count += 1
        assert {(j.part_class, j.inferred) for j in shape.joints} <= {(e["category"], False) for e in entries} | {("other", True)}
    assert count > 20


@pytest.mark.parametrize("box", [[[0, 0, 0]] * 8, [[0, 0]] * 8, "no", [[1e400] * 3] * 8, [[-1, 1, 1], *[[0, 0, 0]] * 7]])
def test_a_box_that_is_none_is_refused_and_made_from_the_geometry(tmp_path, box):
    folder = making.write_partnet(tmp_path / "p")
    path = folder / "link_annotation_gapartnet.json"
    path.write_text(
        json.dumps([{**e, "bbox": box} if e["category"] == "hinge_door" else e for e in json.loads(path.read_text())]).replace(
            "Infinity", "1e400"
        )
    )
    shape = read_shape(Folder.at(folder), "40000", 512)
    assert [n[1] for n in shape.notes] == ["part_box_refused"]
    door = next(p for p in shape.parts if p.part_class == "hinge_door")
    assert door.annotated
    assert door.size[:2] == pytest.approx([1.1, making.W], abs=1e-6)
    assert np.allclose(door.axes[2], [0, -1, 0])


@pytest.mark.parametrize("semantic", [True, False])
def test_without_annotation_classes_are_inferred_and_say_so(tmp_path, semantic):
    folder = making.write_partnet(tmp_path / "p", gapartnet=False)
    if not semantic:
        (folder / "semantics.txt").unlink()
    text = (folder / "mobility.urdf").read_text()
    (folder / "mobility.urdf").write_text(text.replace('visual name="handle-1"', 'visual name="handle-7"'))
    shape = read_shape(Folder.at(folder), "40000", 512)
    assert [(j.part_class, j.inferred) for j in shape.joints] == [("hinge_door", True), ("slider_drawer", True)]
    assert sorted(p.part_class for p in shape.parts) == ["hinge_door", "line_fixed_handle", "slider_drawer"]
    assert not any(p.annotated for p in shape.parts)
    for part in shape.parts:
        assert np.linalg.det(part.axes) == pytest.approx(1)
        assert part.axes[2] @ [0, -1, 0] > 0.9


def test_the_handle_is_where_its_box_is(tmp_path):
    """A handle that is fused with its door has no mesh of its own: the annotated box says where to take hold."""
    folder = making.write_partnet(tmp_path / "partnet")
    low, high = (np.array(v) for v in making.HANDLE)
    x, y, z = np.stack([low, high], axis=1)
    signs = [(-1, 1, 1), (1, 1, 1), (1, -1, 1), (-1, -1, 1), (-1, 1, -1), (1, 1, -1), (1, -1, -1), (-1, -1, -1)]
    mesh = [(x[(1 - a) // 2], y[(1 + b) // 2], z[(1 + c) // 2]) for b, a, c in signs]  # part axes: x up, y to -x, z front
    world = [(-c, -a, b) for a, b, c in mesh]
    path = folder / "link_annotation_gapartnet.json"
    path.write_text(json.dumps([{**e, "bbox": world if "handle" in e["category"] else []} for e in json.loads(path.read_text())]))
    (folder / "textured_objs" / "handle.obj").write_text(making.corner_obj((0.0, 0.0, 0.2), (0.1, 0.1, 0.21)))
    made = read(tmp_path)
    asset = load_asset(tmp_path / "assets" / made.assets[0]["file"])
    (part,) = (p for p in asset.parts if p.part_class == "line_fixed_handle")
    assert part.annotated
    scale = made.assets[0]["unit_scale"]
    assert sorted(part.size / scale) == pytest.approx(sorted(high - low), abs=1e-3)
    assert handle_point(asset, 0)[0] / scale == pytest.approx((low + high)[0] / 2, abs=1e-3)


def test_looks_come_from_the_texture_urdf_where_it_agrees(tmp_path):
    folder = making.write_partnet(tmp_path / "p")
    text = (folder / "mobility_annotation_gapartnet.urdf").read_text()
    for key in ("back", "door"):
        fine = (folder / "textured_objs" / f"{key}.obj").read_text().replace("original-0.mtl", "fine.mtl")
        (folder / "textured_objs" / f"{key}_fine.obj").write_text(fine)
    (folder / "textured_objs" / "fine.mtl").write_text("newmtl plain\nmap_Kd grain.png\n")
    (folder / "textured_objs" / "grain.png").write_bytes(making.png())
    looks = text.replace("back.obj", "back_fine.obj").replace("door.obj", "door_fine.obj")
    (folder / "mobility_texture_gapartnet.urdf").write_text(looks)
    shape = read_shape(Folder.at(folder), "40000", 512)
    assert shape.notes == []
    assert len(shape.palette.textures) == 1
    textured = {b.name for b in shape.bodies for m in b.visuals if shape.palette.materials[m.material].texture}
    assert textured == {"base", "link_0"}
    (folder / "mobility_texture_gapartnet.urdf").write_text(looks.replace(f'xyz="{-making.W / 2} 0.0 {making.D / 2}"', 'xyz="0 1 0"'))
    shape = read_shape(Folder.at(folder), "40000", 512)
    assert [n[1] for n in shape.notes] == ["looks_differ"]
    assert not any(shape.palette.materials[m.material].texture for b in shape.bodies for m in b.visuals)


@pytest.mark.parametrize("where", ["semantics", "folder"])
def test_category_without_meta(tmp_path, where):
    root = tmp_path / "partnet" / "Oven" if where == "folder" else tmp_path / "partnet"
    folder = making.write_partnet(root)
    (folder / "meta.json").unlink()
    words = {"semantics": "link_2 heavy oven_body\n"}.get(where, "link_2 heavy body\n")
    (folder / "semantics.txt").write_text("link_0 hinge door\n" + words)
    made = read(tmp_path, limits={"fit_rms": 30.0})
    assert [a["category"] for a in made.assets] == ["oven"], made.rejects


def test_signs_tell_a_nightstand_from_a_kitchen_unit():
    """The same proportions; the handles, boards and drawers would be far too large on the one."""
    extent = np.array([0.55, 0.45, 0.58])
    small = Signs({"leaf_width": (), "drawer_height": (0.2, 0.2), "handle_length": (0.12,), "board": (0.018,)}, 0, 2, False, 0.7, None)
    fits = [metric_scale.fit(extent, c, small) for c in ("nightstand", "kitchen_cabinet")]
    assert metric_scale.best_fits(fits, rms=9, keep=2, margin=99)[0].category == "nightstand"
    large = Signs({"leaf_width": (0.27,), "drawer_height": (0.1,), "handle_length": (0.09,), "board": (0.011,)}, 2, 1, False, 0.95, 0.4)
    fits = [metric_scale.fit(extent, c, large) for c in ("nightstand", "kitchen_cabinet")]
    assert metric_scale.best_fits(fits, rms=9, keep=2, margin=99)[0].category == "kitchen_cabinet"


def test_ids_that_collide_once_they_are_plain(tmp_path):
    for name in ("a-1", "a_1", "A 1", "\u0448\u043a\u0430\u0444", "b" * 200):
        making.write_partnet(tmp_path / "partnet", name)
    made = read(tmp_path)
    assert len({a["source_id"] for a in made.assets}) == 5
    assert len({a["asset_id"] for a in made.assets}) == len(made.assets)
    assert all(re.fullmatch("[a-z][a-z0-9_]{1,90}", a["asset_id"]) for a in made.assets)


def test_several_categories_share_object_and_split(tmp_path):
    _, made = first(tmp_path)
    assert 1 <= len(made.assets) <= 3
    assert len({a["split"] for a in made.assets}) == 1
    assert {a["asset_id"] for a in made.assets} == {f"ga_40000_{a['category']}" for a in made.assets}
    for row in made.assets:
        mean, std = sizes()[row["category"]].mean, sizes()[row["category"]].std
        assert (np.abs(np.array(row["size"]) - mean) < 4 * std + 0.3).all()


@pytest.mark.parametrize("category", sorted(c.name for c in taxonomy.load().categories.values() if c.names.partnet))
def test_metric_scale_recovers_a_mean_object(category):
    """An object of a category's mean proportions, normalised to any size, gets that category's mean size back."""
    mean = sizes()[category].mean
    fit = metric_scale.fit(mean / 3.7, category)
    assert np.allclose(mean / 3.7 * fit.scale, mean, rtol=0.15)
    assert fit.rms < 1
    assert metric_scale.best_fits([metric_scale.fit(np.array([1.0, 0.001, 30.0]), category)], rms=2.5, keep=3, margin=2.0) == ()


def test_nested_folders_are_found(tmp_path):
    making.write_partnet(tmp_path / "partnet" / "annotation" / "set")
    assert len({a["source_id"] for a in read(tmp_path).assets}) == 1


def test_texture_beside_the_meshes_folder(tmp_path):
    folder = making.write_partnet(tmp_path / "p")
    (folder / "images").mkdir()
    (folder / "images" / "texture_0.png").write_bytes(making.png())
    (folder / "textured_objs" / "original-0.mtl").write_text("newmtl plain\nmap_Kd ../images/texture_0.png\n")
    shape = read_shape(Folder.at(folder), "40000", 512)
    assert list(shape.palette.textures) == ["texture_0.png"]
    assert shape.palette.notes == []


def test_rows_say_how_the_scale_was_found_and_what_was_guessed(tmp_path):
    making.write_partnet(tmp_path / "partnet", "1")
    making.write_partnet(tmp_path / "partnet", "2", gapartnet=False)
    text = '<robot name="r"><link name="a"><visual><geometry><box size="0.6 0.9 0.85"/></geometry></visual></link></robot>'
    (tmp_path / "partnet" / "cabinet.urdf").write_text(text)
    made = read(tmp_path)
    for row in made.assets:
        own = row["source"] == "urdf"
        assert row["scale_from"] == ("file" if own else row["category"])
        assert own == (row["unit_scale"] == 1.0)
        assert row["scale_rms"] >= 0
        assert row["density"] > 0
    guessed = {row["asset_id"][:2]: set() for row in made.joints}
    for row in made.joints:
        guessed[row["asset_id"][:2]].add(row["inferred"])
    assert guessed == {"ga": {False}, "pm": {True}}
    for asset_id in {row["asset_id"] for row in made.joints}:
        parts = [row for row in made.parts if row["asset_id"] == asset_id]
        assert {row["joint_id"] for row in parts} == {"joint_0", "joint_1"}
        assert {row["annotated"] for row in parts if row["part_class"] != "line_fixed_handle"} == {asset_id.startswith("ga")}
        for row in parts:
            assert np.allclose(np.cross(row["axis_x"], row["axis_y"]), row["axis_z"], atol=1e-6)


def test_semantics_with_a_byte_order_mark(tmp_path):
    folder = making.write_partnet(tmp_path / "partnet", gapartnet=False)
    assert {j["part_class"] for j in read(tmp_path).joints} == {"hinge_door", "slider_drawer"}
    (folder / "semantics.txt").write_bytes(b"\xef\xbb\xbflink_0 hinge lid\r\nlink_1 slider drawer\r\nlink_2 heavy furniture_body\r\n")
    assert {j["part_class"] for j in read(tmp_path).joints} == {"hinge_lid", "slider_drawer"}


def test_without_collisions_the_looks_collide(tmp_path):
    text = re.sub(r"<collision.*?</collision>", "", making.partnet_urdf((-making.W / 2, 0.0, making.D / 2)))
    asset, made = first(tmp_path, urdf=text)
    assert all(link.colliders for link in asset.links)
    assert made.reasons <= {"hull_collider"}


def test_without_its_meshes_an_object_is_left_out(tmp_path):
    folder = making.write_partnet(tmp_path / "partnet")
    for path in (folder / "textured_objs").iterdir():
        path.unlink()
    made = read(tmp_path)
    assert made.assets == []
    assert [r["reason"] for r in made.rejects] == ["no_base"]


def test_a_stated_category_goes_before_what_proportions_tell(tmp_path):
    guessed, _ = first(tmp_path / "guessed")
    asset, tables = first(tmp_path / "stated", category="wardrobe")
    assert guessed.category != "wardrobe"
    assert asset.category == "wardrobe"
    assert {row["category"] for row in tables.assets} == {"wardrobe"}
    assert 1.6 < asset.size[2] < 2.8, "as tall as wardrobes are"


def test_a_stated_category_that_nobody_knows_is_refused(tmp_path):
    making.write_partnet(tmp_path / "partnet", category="throne")
    tables = read(tmp_path)
    assert tables.assets == []
    assert [(row["reason"], row["detail"]) for row in tables.rejects] == [("unknown_category", "40000: category 'throne' in meta.json")]
