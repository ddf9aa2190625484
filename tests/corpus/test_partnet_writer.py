import json
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from pipeline.corpus.furniture.assembly import shape_of
from pipeline.corpus.furniture.catalogue import catalogue
from pipeline.corpus.furniture.shape import colliders
from pipeline.corpus.partnet_writer import write_partnet
from pipeline.sources.articulated.partnet import read_shape
from pipeline.sources.guarded import Folder
from pipeline.sources.meshes.mesh_solids import parts

CHOSEN = ("wardrobe", "cabinet", "oven", "washing_machine", "toilet", "trash_can", "desk", "sink_cabinet")
WORLD = np.array([[0, 0, -1], [-1, 0, 0], [0, 1, 0]])  # mesh frame to world: up +z, front -x
PART_CLASSES = {
    "line_fixed_handle",
    "round_fixed_handle",
    "slider_button",
    "hinge_door",
    "slider_drawer",
    "slider_lid",
    "hinge_lid",
    "hinge_knob",
    "hinge_handle",
}
URDFS = ("mobility.urdf", "mobility_annotation_gapartnet.urdf")


@pytest.fixture(scope="module")
def chosen():
    return tuple(next(m for m in catalogue(0).partnet if m.category == c) for c in CHOSEN)


@pytest.fixture(scope="module")
def folders(chosen, tmp_path_factory):
    root = tmp_path_factory.mktemp("partnet")
    write_partnet(chosen, root)
    return [(m, root / m.model_id) for m in chosen]


def numbers(text):
    return np.array([float(x) for x in text.split()])


def vertices(path):
    return np.array([[float(x) for x in line.split()[1:]] for line in path.read_text().splitlines() if line.startswith("v ")])


def joints(urdf):
    return {j.find("child").get("link"): j for j in urdf.findall("joint")}


def origin(urdf, link):
    """Where a link's frame lies in the mesh frame at rest."""
    at, tree = np.zeros(3), joints(urdf)
    while tree[link].find("parent").get("link") != "base":
        at, link = at + numbers(tree[link].find("origin").get("xyz")), tree[link].find("parent").get("link")
    return at


def placed(folder, urdf, link):
    """All vertices of a link's visuals in the mesh frame."""
    parts = []
    for visual in next(k for k in urdf.findall("link") if k.get("name") == link).findall("visual"):
        shift = numbers(visual.find("origin").get("xyz"))
        parts.append(vertices(folder / visual.find("geometry/mesh").get("filename")) + shift)
    return np.concatenate(parts) + origin(urdf, link)


@pytest.mark.parametrize("name", URDFS)
def test_urdf_has_the_quirks_of_the_real_ones(folders, name):
    for model, folder in folders:
        urdf = ET.parse(folder / name).getroot()
        assert urdf.get("name").startswith("partnet_")
        links = urdf.findall("link")
        assert links[0].get("name") == "base"
        assert len(links[0]) == 0
        assert not urdf.findall(".//inertial")
        root = [j for j in urdf.findall("joint") if j.find("parent").get("link") == "base"]
        assert len(root) == 1
        assert root[0].get("type") == "fixed"
        assert root[0].find("origin").get("rpy") == "1.570796326794897 0 -1.570796326794897"
        for joint in urdf.findall("joint"):
            tags = [e.tag for e in joint]
            assert tags.index("child") < tags.index("parent")
            if joint.get("type") == "fixed":
                assert "axis" not in tags
                assert "limit" not in tags
            else:
                assert set(joint.find("limit").attrib) == {"lower", "upper"}
                assert float(joint.find("limit").get("lower")) <= 0 < float(joint.find("limit").get("upper"))
                assert np.linalg.norm(numbers(joint.find("axis").get("xyz"))) == pytest.approx(1)
        for link in links[1:]:
            meshes = [[e.find("geometry/mesh").get("filename") for e in link.findall(kind)] for kind in ("visual", "collision")]
            convex = [name.replace("/convex-", "/original-") for name in meshes[1]]  # panels and handles collide by their hulls
            assert meshes[0] == convex != []
            for visual in link.findall("visual"):
                assert np.allclose(numbers(visual.find("origin").get("xyz")), -origin(urdf, link.get("name")), atol=1e-8)
                stem, number = visual.get("name").rsplit("-", 1)
                assert stem
                assert visual.find("geometry/mesh").get("filename") == f"textured_objs/original-{number}.obj"
        assert model.partnet_category == json.loads((folder / "meta.json").read_text())["model_cat"]


def test_both_urdfs_place_the_same_meshes_and_gapartnets_cuts_the_handles_off(folders):
    for model, folder in folders:
        plain, cut = (ET.parse(folder / name).getroot() for name in URDFS)
        files = [sorted(m.get("filename") for m in u.findall(".//visual//mesh")) for u in (plain, cut)]
        assert files[0] == files[1]
        handles = {p.name + m.name for m in shape_of(model).movers for p in m.pieces if p.part}
        assert len(cut.findall("link")) == len(plain.findall("link")) + len(handles)
        assert len(plain.findall("link")) == len(shape_of(model).movers) + 2


def test_bounding_box_is_that_of_the_meshes_and_about_the_unit_sphere(folders):
    for _, folder in folders:
        box = json.loads((folder / "bounding_box.json").read_text())
        urdf = ET.parse(folder / "mobility.urdf").getroot()
        points = np.concatenate([placed(folder, urdf, k.get("name")) for k in urdf.findall("link")[1:]])
        assert np.allclose(points.min(axis=0), box["min"], atol=2e-5)
        assert np.allclose(points.max(axis=0), box["max"], atol=2e-5)
        assert 1.86 <= np.linalg.norm(np.array(box["max"]) - box["min"]) <= 2.6


def test_proportions_are_those_of_the_model(folders):
    for model, folder in folders:
        box = json.loads((folder / "bounding_box.json").read_text())
        w, up, front = np.array(box["max"]) - box["min"]
        assert np.allclose(np.array([w, front, up]) / up, np.array(model.size) / model.size[2], atol=1e-6)


def test_moving_to_the_upper_limit_opens_towards_minus_x_of_the_world(folders):
    for model, folder in folders:
        urdf = ET.parse(folder / "mobility.urdf").getroot()
        words = {line.split()[0]: line.split()[2] for line in (folder / "semantics.txt").read_text().splitlines()}
        for link, joint in joints(urdf).items():
            if not any(word in words[link] for word in ("drawer", "door")):
                continue
            points = placed(folder, urdf, link)
            axis, upper = numbers(joint.find("axis").get("xyz")), float(joint.find("limit").get("upper"))
            if joint.get("type") == "prismatic":
                moved = points + upper * axis
            else:
                p = points - origin(urdf, link)
                c, s = np.cos(upper), np.sin(upper)
                moved = p * c + np.cross(axis, p) * s + np.outer(p @ axis, axis) * (1 - c) + origin(urdf, link)
            assert (WORLD @ (moved.mean(axis=0) - points.mean(axis=0)))[0] < -0.05, (model.category, link)


def test_semantics_name_every_link(folders):
    for model, folder in folders:
        urdf = ET.parse(folder / "mobility.urdf").getroot()
        lines = [line.split() for line in (folder / "semantics.txt").read_text().splitlines()]
        assert {line[0] for line in lines} == {k.get("name") for k in urdf.findall("link")} - {"base"}
        assert sum(line[1] == "heavy" for line in lines) == 1
        kinds = {"revolute": "hinge", "prismatic": "slider", "fixed": "heavy"}
        assert all(kinds[joints(urdf)[line[0]].get("type")] == line[1] for line in lines)
        cut = [line.split() for line in (folder / "semantics_gapartnet.txt").read_text().splitlines()]
        assert {line[2] for line in cut if line[1] != "heavy"} <= PART_CLASSES
        assert len(cut) >= len(lines), model


def test_mobility_agrees_with_the_urdf_even_where_b_is_below_a(folders):
    backwards = 0
    for _, folder in folders:
        urdf = ET.parse(folder / "mobility.urdf").getroot()
        for entry in json.loads((folder / "mobility_v2.json").read_text()):
            assert set(entry) == {"id", "parent", "joint", "name", "parts", "jointData"}
            joint = joints(urdf)[f"link_{entry['id']}"]
            if entry["parent"] == -1:
                assert entry["jointData"] == {}
                continue
            assert joint.find("parent").get("link") == f"link_{entry['parent']}"
            data, limit = entry["jointData"], entry["jointData"]["limit"]
            assert np.allclose(data["axis"]["origin"], origin(urdf, f"link_{entry['id']}"), atol=1e-8)
            sign = 1 if limit["b"] >= limit["a"] else -1
            backwards += sign < 0
            upper = np.radians(limit["b"]) if entry["joint"] == "hinge" else limit["b"]
            assert upper * sign == pytest.approx(float(joint.find("limit").get("upper")), abs=1e-8)
            assert np.allclose(np.array(data["axis"]["direction"]) * sign, numbers(joint.find("axis").get("xyz")), atol=1e-8)
    assert backwards > 3


def test_annotation_has_oriented_boxes_in_gapartnets_vertex_order(folders):
    seen = set()
    for _, folder in folders:
        urdf = ET.parse(folder / "mobility_annotation_gapartnet.urdf").getroot()
        entries = json.loads((folder / "link_annotation_gapartnet.json").read_text())
        assert [e["link_name"] for e in entries] == ["base"] + [k.get("name") for k in urdf.findall("link")[1:]]
        for entry in entries:
            assert set(entry) == {"link_name", "is_gapart", "category", "bbox"}
            if not entry["is_gapart"]:
                assert entry["category"] == ""
                assert entry["bbox"] == []
                continue
            kind = entry["category"]
            assert kind in PART_CLASSES
            seen.add(kind)
            b = np.array(entry["bbox"])
            R = np.stack([b[1] - b[0], b[1] - b[2], b[0] - b[4]], axis=1)
            R = R / np.linalg.norm(R, axis=0)
            assert np.linalg.det(R) == pytest.approx(1)
            assert np.allclose([b[3] - b[2], b[7] - b[6], b[4] - b[5]], np.outer([1, 1, 1], b[0] - b[1]), atol=1e-6)
            points = placed(folder, urdf, entry["link_name"]) @ WORLD.T
            assert np.allclose([b.min(axis=0), b.max(axis=0)], [points.min(axis=0), points.max(axis=0)], atol=3e-5)
            joint = joints(urdf)[entry["link_name"]]
            if kind == "hinge_door":
                assert np.allclose(R[:, 2], (-1, 0, 0)), "z looks outwards"
                assert np.allclose(R[:, 0], WORLD @ numbers(joint.find("axis").get("xyz"))), "x is the axis in the opening sense"
                hinge = WORLD @ origin(urdf, entry["link_name"])
                assert np.dot(b.mean(axis=0) - hinge, R[:, 1]) > 0, "y goes from the hinge to the free edge"
            if kind == "line_fixed_handle":
                lengths = np.abs([np.dot(b[1] - b[0], R[:, 0]), np.dot(b[1] - b[2], R[:, 1])])
                assert lengths[0] >= lengths[1], "x is the long axis"
                assert joint.get("type") == "fixed"
            if kind in {"hinge_lid", "slider_lid"}:
                assert np.allclose(R[:, 2], (0, 0, 1)) or np.allclose(R[:, 2], (-1, 0, 0)), "up, or a sliding door's front"
    assert {"hinge_door", "slider_drawer", "hinge_knob", "slider_button", "hinge_lid", "line_fixed_handle"} <= seen


def test_the_reader_finds_the_same_joints_and_colliders(tmp_path):
    """One model of every form, through the files and back."""
    forms = {(m.category, m.form): m for m in catalogue(1).partnet}
    write_partnet(tuple(forms.values()), tmp_path)
    for model in forms.values():
        shape = shape_of(model)
        read = read_shape(Folder.at(tmp_path / model.model_id), model.model_id, 64)
        low, high = read.bounds()
        unit = float(max(model.size) / (high - low).max())
        middle = np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])
        assert not read.notes, (model, read.notes)
        assert len(read.joints) == len(shape.movers)
        by_name = {joint.name: joint for joint in read.joints}
        for k, mover in enumerate(shape.movers):
            joint = by_name[f"joint_{k}"]
            reach = unit if mover.type == "prismatic" else 1.0
            assert (joint.type, joint.part_class) == (mover.type, mover.part_class), (model, mover.name)
            assert np.allclose([joint.lower * reach, joint.upper * reach], [0.0, mover.upper], rtol=1e-4), (model, mover.name)
            assert np.allclose(joint.axis, mover.axis, atol=1e-9), (model, mover.name)
            assert np.allclose((joint.origin - middle) * unit, mover.origin, atol=1e-4 * unit), (model, mover.name)
        made = [part for body in read.bodies for vertices, faces in body.collisions for part in parts(vertices, faces)]
        assert len(made) == len(colliders(shape.base)) + sum(len(colliders(m.pieces)) for m in shape.movers), model
        assert min(part.fill for part in made) > 0.95, model


def test_meta_values_are_strings(folders):
    for model, folder in folders:
        meta = json.loads((folder / "meta.json").read_text())
        assert set(meta) == {"user_id", "model_cat", "category", "model_id", "version", "anno_id", "time_in_sec"}
        assert all(isinstance(v, str) for v in meta.values())
        assert meta["anno_id"] == model.model_id
        assert len(meta["model_id"]) == 32


def test_folders_are_moderate(folders):
    for model, folder in folders:
        files = [p for p in folder.rglob("*") if p.is_file()]
        assert len(files) < 120, model
        assert sum(p.stat().st_size for p in files) < 600_000, model
        objects = sorted((folder / "textured_objs").glob("original-*.obj"))
        assert all(p.with_suffix(".mtl").exists() for p in objects)


def test_same_bytes_again(chosen, folders, tmp_path):
    write_partnet(chosen[:3], tmp_path)
    for model, folder in folders[:3]:
        for path in sorted(p for p in folder.rglob("*") if p.is_file()):
            assert (tmp_path / model.model_id / path.relative_to(folder)).read_bytes() == path.read_bytes()
