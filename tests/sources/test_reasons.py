"""Every reason code has a fixture that brings it about, and stands in docs/reasons.md."""

import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.sources.atiss.labels import KINDS
from pipeline.sources.atiss.source import read_peers
from pipeline.sources.atiss.writer import rooms_with_objects, write_kind
from pipeline.sources.reasons import REASONS, SourceError, reject
from pipeline.sources.settings import PreprocessSettings
from pipeline.sources.source import Reading, Task
from pipeline.sources.threed_front import source
from tests.sources import making, mobility
from tests.sources.making import BED, CHAIR, LAMP, STAND, TABLE, chair_record, child, floor, slab
from tests.sources.reading import WALKER, read
from tests.sources.test_budget import SPENT

BAD_OBJ = "v 0 0 0\nv 1 0 0\nf 1 2 9\n"


def front(tmp, tree=None, jids=(BED, STAND, LAMP), entries=None):
    making.write_library(tmp / "front", jids, entries)
    making.write_house(tmp / "front", tree or making.two_rooms())


def with_child(tmp, placed, record=None, jids=(BED, STAND, LAMP), **options):
    """A house whose bedroom has one more child, and perhaps one more furniture record."""
    front(tmp, making.two_rooms(extra=[placed], more_furniture=[record] if record else []), jids)
    return read(tmp, **options)


def floating_cup(tmp):
    """A cup at the height of a table that is not there."""
    cup = child("x/model", "furniture/9", (1, 0.75, 3.5))
    tree = making.two_rooms(extra=[cup], more_furniture=[chair_record("x/model", CHAIR)])
    front(tmp, tree, (BED, STAND, LAMP, CHAIR), [making.info(CHAIR, "Cup"), *map(making.info, (BED, STAND, LAMP))])
    return read(tmp)


def with_stand(tmp, **placing):
    return with_child(tmp, child("x/model", "furniture/9", **{"pos": (1, 0, 3.5), **placing}), chair_record("x/model", STAND))


def with_rooms(tmp, rooms, meshes):
    tree = making.two_rooms(more_meshes=meshes)
    tree["scene"]["room"] += [{"type": t, "instanceid": n, "children": c} for t, n, c in rooms]
    front(tmp, tree)
    return read(tmp)


def with_house_text(tmp, text):
    making.write_library(tmp / "front", (BED,))
    (tmp / "front" / "3D-FRONT").mkdir()
    (tmp / "front" / "3D-FRONT" / "house-a.json").write_text(text)
    return read(tmp)


def with_model(tmp, text, **more):
    making.write_library(tmp / "front", (BED,))
    making.write_model(tmp / "front", BED, text, **more)
    return read(tmp)


def with_joint(tmp, xml, extra=""):
    hinge = (-making.W / 2, 0.0, making.D / 2)
    making.write_partnet(tmp / "partnet", urdf=making.partnet_urdf(hinge, xml).replace("</robot>", extra + "</robot>"))
    return read(tmp)


def joint_xml(kind, limit, name="joint_0", link="link_0"):
    return f'<joint name="{name}" type="{kind}"><child link="{link}"/><parent link="link_2"/><axis xyz="0 -1 0"/>{limit}</joint>'


FIXED_DRAWER = '<joint name="joint_1" type="fixed"><child link="link_1"/><parent link="link_2"/></joint>'


def door(kind, limit):
    return joint_xml(kind, limit) + FIXED_DRAWER


def unsafe_path(tmp):
    making.write_partnet(tmp / "partnet", urdf=making.partnet_urdf((0, 0, 0)).replace("textured_objs/door.obj", "../../door.obj"))
    return read(tmp)


def missing_file(tmp):
    making.write_library(tmp / "front", (BED,))
    (tmp / "front" / "3D-FUTURE-model" / BED / "raw_model.obj").unlink()
    return read(tmp)


def bad_number(tmp):
    front(tmp, making.two_rooms(extra=[child("s/model", "furniture/9", pos=(float("1e400"), 0, 0))]))
    path = tmp / "front" / "3D-FRONT" / "house-a.json"
    path.write_text(path.read_text().replace("Infinity", "1e400"))
    return read(tmp)


def internal(tmp, monkeypatch):
    front(tmp)
    monkeypatch.setattr(source, "read_house", lambda *_: 1 // 0)
    return read(tmp)


def no_rooms(tmp):
    tree = making.two_rooms()
    tree["mesh"] = []
    front(tmp, tree)
    return read(tmp)


def no_objects(tmp):
    tree = making.two_rooms()
    tree["furniture"] = []
    front(tmp, tree)
    return read(tmp)


def uid_mismatch(tmp):
    front(tmp)
    making.write_house(tmp / "front", making.two_rooms("another"), "house-b")
    return read(tmp)


def duplicate_record(tmp):
    front(tmp, making.two_rooms(more_furniture=[chair_record("b/model", BED)]))
    return read(tmp)


def area_mismatch(tmp):
    tree = making.two_rooms()
    tree["scene"]["room"][0]["size"] = 9.0
    front(tmp, tree)
    return read(tmp)


def no_model_info(tmp):
    front(tmp)
    making.write_model(tmp / "front", CHAIR)
    return read(tmp)


def partnet_limits(tmp):
    folder = making.write_partnet(tmp / "partnet", joints=door("revolute", ""), gapartnet=False)
    data = {"axis": {"direction": [0, 1, 0]}, "limit": {"a": 0, "b": -90, "noLimit": False}}
    (folder / "mobility_v2.json").write_text(json.dumps([{"id": 0, "joint": "hinge", "name": "door", "jointData": data}]))
    return read(tmp)


def part_box_refused(tmp):
    folder = making.write_partnet(tmp / "partnet")
    entry = {"link_name": "link_0", "is_gapart": True, "category": "hinge_door", "bbox": [[0, 0, 0]] * 8}
    (folder / "link_annotation_gapartnet.json").write_text(json.dumps([entry]))
    return read(tmp)


def looks_differ(tmp):
    folder = making.write_partnet(tmp / "partnet")
    text = (folder / "mobility_annotation_gapartnet.urdf").read_text()
    (folder / "mobility_texture_gapartnet.urdf").write_text(text.replace('xyz="-0', 'xyz="-1'))
    return read(tmp)


def household(tmp, text):
    (tmp / "partnet").mkdir()
    (tmp / "partnet" / "cabinet.urdf").write_text(f'<robot name="r">{text}</robot>')
    return read(tmp)


CASE = '<geometry><box size="0.4 0.9 0.9"/></geometry>'
INERTIAL = '<inertial><mass value="40"/><inertia ixx="3" ixy="0" ixz="0" iyy="3" iyz="0" izz="3"/></inertial>'


def missing_texture(tmp):
    making.write_library(tmp / "front", (BED,))
    (tmp / "front" / "3D-FUTURE-model" / BED / "texture.png").unlink()
    return read(tmp)


def missing_mesh(tmp):
    (making.write_partnet(tmp / "partnet") / "textured_objs" / "back.obj").unlink()
    return read(tmp)


def duplicate(tmp):
    return with_child(tmp, child("s/model", "furniture/9", (3.4, 0, 0.3)))


def centimetres(tmp):
    return with_model(tmp, making.box_obj(making.SIZES[BED], scale=100.0))


def no_metric_fit(tmp):
    making.write_partnet(tmp / "partnet", model_cat="Toilet", parts=dict.fromkeys(PARTS, ((-9, 0, -0.1), (9, 0.1, 0.1))))
    return read(tmp)


PARTS = ("back", "left", "right", "door", "drawer", "handle")


def made_object(tmp, category, links):
    mobility.write(tmp / "partnet", "1", category, links)
    return read(tmp)


def no_base(tmp):
    urdf = making.partnet_urdf((0, 0, 0)).replace(making.link_xml("link_2", ["back", "left", "right"]), '<link name="link_2"/>')
    making.write_partnet(tmp / "partnet", urdf=urdf)
    return read(tmp)


def moves_nothing(tmp):
    extra = '<link name="empty"/><joint name="j9" type="revolute"><child link="empty"/><parent link="link_2"/><limit lower="0" upper="1"/></joint>'
    return with_joint(tmp, None, extra)


def screw(tmp):
    helper = joint_xml("prismatic", '<limit lower="0" upper="0.1"/>', "slide", "helper")
    turn = '<joint name="turn" type="continuous"><child link="link_0"/><parent link="helper"/><axis xyz="0 1 0"/></joint>'
    return with_joint(tmp, helper + turn + FIXED_DRAWER, '<link name="helper"/>')


def open_box(tmp):
    text = making.box_obj(making.SIZES[BED])
    making.write_library(tmp / "front", (BED,))
    making.write_model(tmp / "front", BED, "\n".join(text.splitlines()[:-1]) + "\n")
    return read(tmp, limits={"cut": "none"})


def peers(tmp, *, filtered):
    """The codes of `sfgen peers`, from a bedroom whose stand is a thing that the peers do not know."""
    front(tmp, entries=[making.info(BED), making.info(STAND, "Shoe Cabinet"), making.info(LAMP)])
    made = read(tmp)
    rooms = rooms_with_objects(made.rooms, made.objects, {s["scene_id"]: s["split"] for s in made.scenes})
    rejects = write_kind(tmp / "out", rooms, KINDS["bedroom"], filtered=filtered).rejects
    return SimpleNamespace(rejects=rejects, reasons={r["reason"] for r in rejects})


def bad_boxes(tmp):
    (tmp / "h_Bedroom-1").mkdir()
    (tmp / "h_Bedroom-1" / "boxes.npz").write_bytes(b"PK")
    task = Task(tmp, Reading(PreprocessSettings(), "CC0-1.0", tmp, WALKER, 1))
    rejects = read_peers(task, ("h", ((KINDS["bedroom"], "h_Bedroom-1/boxes.npz"),))).rejects
    return SimpleNamespace(rejects=rejects, reasons={r["reason"] for r in rejects})


CASES = {
    "unsafe_path": unsafe_path,
    "missing_file": missing_file,
    "too_large": lambda t: with_house_text(t, "[" * 500_000),
    "not_json": lambda t: with_house_text(t, '{"uid": "house-a", "scene": {"room": ['),
    "bad_structure": lambda t: with_house_text(t, '{"uid": "house-a"}'),
    "not_obj": lambda t: with_model(t, BAD_OBJ),
    "not_urdf": lambda t: (making.write_partnet(t / "partnet", urdf="<robot"), read(t))[1],
    "bad_number": bad_number,
    "no_rooms": no_rooms,
    "no_objects": no_objects,
    "uid_mismatch": uid_mismatch,
    "duplicate_record": duplicate_record,
    "no_floor": lambda t: with_rooms(t, [("OtherRoom", "OtherRoom", [])], []),
    "too_small": lambda t: with_rooms(t, [("OtherRoom", "OtherRoom-9", [child("f9", "mesh/0")])], [floor("f9", 9, 0, 9.3, 0.3)]),
    "duplicate_room": lambda t: with_rooms(t, [("Bathroom", "Bathroom-9", [child("f9", "mesh/0")])], [floor("f9", 0, 0, 4, 4)]),
    "unknown_room_type": lambda t: with_rooms(t, [("Ballroom", "Ballroom-9", [child("f9", "mesh/0")])], [floor("f9", 9, 0, 12, 3)]),
    "floor_pieces": lambda t: with_rooms(
        t,
        [("Bathroom", "Bathroom-9", [child("f9", "mesh/0"), child("f8", "mesh/1")])],
        [floor("f9", 9, 0, 12, 3), floor("f8", 13, 0, 14, 1)],
    ),
    "dangling_ref": lambda t: with_child(t, child("nothing", "furniture/9")),
    "built_in": lambda t: with_child(
        t, child("x/model", "furniture/9"), {"uid": "x/model", "jid": "c", "aid": [], "title": "curtain/curtain"}
    ),
    "invalid_flag": lambda t: with_child(t, child("x/model", "furniture/9"), {**chair_record("x/model", STAND, valid=False)}),
    "unknown_category": lambda t: with_child(
        t, child("x/model", "furniture/9"), {**chair_record("x/model", "none"), "category": "Others", "title": "decor/x"}
    ),
    "no_model_info": no_model_info,
    "category_inferred": lambda t: (
        front(t, entries=[making.info(BED, "", **{"super-category": "Bed"}), *map(making.info, (STAND, LAMP))]),
        read(t),
    )[1],
    "unknown_name": lambda t: (front(t, entries=[making.info(j, style="Martian") for j in (BED, STAND, LAMP)]), read(t))[1],
    "area_mismatch": area_mismatch,
    "missing_model": lambda t: with_child(t, child("x/model", "furniture/9", (1, 0, 3)), chair_record("x/model", CHAIR, "nested")),
    "size_from_bbox": lambda t: with_child(
        t, child("x/model", "furniture/9", (1, 0, 3.2)), chair_record("x/model", CHAIR, "nested"), filters={"keep_without_model": True}
    ),
    "bad_scale": lambda t: with_stand(t, scale=(1, 0, 1)),
    "bad_size": lambda t: with_model(t, making.box_obj((9.5, 2.0, 1.0))),
    "tilted": lambda t: with_stand(t, rot=(0.38268, 0, 0, 0.92388)),
    "bad_height": lambda t: with_stand(t, pos=(1, 5.0, 3.5)),
    "outside_room": lambda t: with_stand(t, pos=(2, 0, 4.2)),
    "duplicate_house": lambda t: (making.write_house(t / "front", making.two_rooms(), "copy"), front(t), read(t))[2],
    "other_room": lambda t: with_child(t, child("x/model", "furniture/9", (5, 0, 1)), chair_record("x/model", STAND)),
    "not_placed": lambda t: (front(t, making.two_rooms(more_furniture=[chair_record("x/model", STAND)])), read(t))[1],
    "duplicate": duplicate,
    "overlap": lambda t: with_stand(t, pos=(2, 0, 1.5)),
    "no_support": floating_cup,
    "moved": lambda t: with_stand(t, pos=(0.2, 0, 3)),
    "mirrored": lambda t: with_stand(t, scale=(-1, 1, 1)),
    "centimetres": centimetres,
    "opening_unresolved": lambda t: (front(t, making.two_rooms(more_meshes=[slab("far", "Window", (50, 1, 50), (52, 2, 50.2))])), read(t))[
        1
    ],
    "missing_texture": missing_texture,
    "colliders_capped": lambda t: (making.write_partnet(t / "partnet"), read(t, limits={"max_pieces": 1}))[1],
    "hull_collider": open_box,
    "missing_mesh": missing_mesh,
    "looks_differ": looks_differ,
    "looks_from_colliders": lambda t: household(t, f'<link name="a"><collision>{CASE}</collision></link>'),
    "base_made": lambda t: household(
        t,
        f'<link name="a"/><link name="b"><visual>{CASE}</visual></link><joint name="j" type="revolute"><parent link="a"/><child link="b"/>'
        '<axis xyz="0 0 1"/><limit lower="0" upper="1"/></joint>',
    ),
    "mass_used": lambda t: household(t, f'<link name="a"><inertial><mass value="40"/></inertial><visual>{CASE}</visual></link>'),
    "refitted": lambda t: made_object(t, "Toaster", mobility.toaster(np.random.default_rng(0))),
    "inertial_used": lambda t: household(t, f'<link name="a">{INERTIAL}<visual>{CASE}</visual></link>'),
    "inertial_refused": lambda t: household(t, f'<link name="a">{INERTIAL.replace("40", "-40")}<visual>{CASE}</visual></link>'),
    "angle_snapped": lambda t: household(t, f'<link name="a"><visual><origin rpy="0 0 1.565"/>{CASE}</visual></link>'),
    "part_box_refused": part_box_refused,
    "joint_limits_found": partnet_limits,
    "no_metric_fit": no_metric_fit,
    "no_base": no_base,
    "bad_boxes": bad_boxes,
    "peers_filter": lambda t: peers(t, filtered=True),
    "peers_class": lambda t: peers(t, filtered=False),
    "joint_unsupported": lambda t: with_joint(t, door("floating", "")),
    "joint_no_range": lambda t: with_joint(t, door("revolute", '<limit lower="0" upper="0"/>')),
    "joint_flipped_limits": lambda t: with_joint(t, door("revolute", '<limit lower="1.2" upper="-0.0"/>')),
    "joint_rest_shifted": lambda t: with_joint(t, door("revolute", '<limit lower="0.2" upper="1.2"/>')),
    "joint_mimic": lambda t: with_joint(t, door("revolute", '<mimic joint="joint_1" multiplier="2"/><limit lower="0" upper="1"/>')),
    "joint_moves_nothing": moves_nothing,
    "screw_collapsed": screw,
}


@pytest.mark.parametrize("code", sorted(CASES))
def test_fixture_of_code(code, tmp_path):
    made = CASES[code](tmp_path)
    assert code in made.reasons, made.rejects
    assert "internal" not in made.reasons, made.rejects


def test_internal(tmp_path, monkeypatch):
    assert "internal" in internal(tmp_path, monkeypatch).reasons


def test_clean_house_has_no_rejects(tmp_path):
    front(tmp_path)
    made = read(tmp_path)
    assert made.rejects == []
    assert len(made.objects) == 3


def test_all_codes_have_a_fixture_and_a_line_in_the_docs():
    assert set(CASES) | {"internal"} | SPENT == set(REASONS)
    text = (Path(__file__).parents[2] / "docs" / "reasons.md").read_text()
    for code, reason in REASONS.items():
        assert f"| `{code}` | {reason.what} | {reason.effect} | {reason.doc} |" in text


def test_unknown_code_is_an_error():
    with pytest.raises(KeyError):
        reject("house", "x", "no_such_code")


def test_source_error_survives_pickling():
    import pickle

    error = pickle.loads(pickle.dumps(SourceError("not_json", "a.json", "is empty")))
    assert (error.code, error.where, error.detail) == ("not_json", "a.json", "is empty")


def test_rejects_name_the_thing(tmp_path):
    made = with_stand(tmp_path, pos=(1, 5.0, 3.5))
    (row,) = made.rejects
    assert row["what"] == "object"
    assert row["where"] == "house-a/MasterBedroom-1/furniture/9"
    assert json.dumps(row)
    assert np.isfinite([o["yaw"] for o in made.objects]).all()


def test_tucked_chair_stays_and_a_table_in_a_bed_goes(tmp_path):
    more = [chair_record("t/model", TABLE), chair_record("c/model", CHAIR)]
    placed = [child("t/model", "furniture/8", (1.2, 0, 3.3)), child("c/model", "furniture/9", (1.2, 0, 3.0))]
    front(tmp_path, making.two_rooms(extra=placed, more_furniture=more), (BED, STAND, LAMP, TABLE, CHAIR))
    made = read(tmp_path)
    assert {"dining_table", "dining_chair"} <= {o["category"] for o in made.objects}
