"""The peers' cached format: what we write is what their loaders take, what we read is what stood there."""

import io
import json
import zipfile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline import taxonomy
from pipeline.errors import ContentError
from pipeline.sources.atiss.files import BOXES, STATS, read_room, write_stats
from pipeline.sources.atiss.labels import KINDS, kind_of
from pipeline.sources.atiss.source import kinds_of, peers_houses, read_peers
from pipeline.sources.atiss.writer import floor_mesh, rooms_with_objects, to_cached_room, write_kind
from pipeline.sources.guarded import Folder
from pipeline.sources.reasons import SourceError
from pipeline.sources.rows import split_of
from pipeline.sources.settings import PreprocessSettings
from pipeline.sources.source import Reading, Task
from pipeline.sources.threed_front.furniture import Model
from pipeline.sources.threed_front.poses import Box
from tests.sources.reading import WALKER

L_SHAPE = [[-1.5, -2.25], [2.5, -2.25], [2.5, 1.0], [0.5, 1.0], [0.5, 2.75], [-1.5, 2.75]]
FIELDS = ("translations", "sizes", "angles", "classes", "vertices", "faces", "centroid", "layout")


def room(scene, name, kind="masterbedroom", polygon=L_SHAPE):
    return {"scene_id": f"h_{scene}", "room_id": f"r_{name}", "type": kind, "polygon": polygon, "source_id": f"{scene}/{name}"}


def thing(scene, name, category="double_bed", position=(0.1, -0.2, 0.0), yaw=0.0, size=(1.8, 2.2, 1.1), jid="j1"):
    source = f"{scene}/{name}/furniture/{abs(hash((category, position))) % 99}#{jid}"
    return {
        "scene_id": f"h_{scene}",
        "room_id": f"r_{name}",
        "category": category,
        "position": list(position),
        "yaw": yaw,
        "size": list(size),
        "source_id": source,
    }


def bedroom(scene="a1-b2", name="MasterBedroom-7"):
    return room(scene, name), [
        thing(scene, name),
        thing(scene, name, "nightstand", (1.3, 0.3, 0.0), 1.5708, (0.5, 0.4, 0.5)),
        thing(scene, name, "pendant_lamp", (0.1, 0.2, 1.9), 3.14159, (0.6, 0.6, 0.5)),
    ]


def written(tmp_path, rooms, kind="bedroom", *, filtered=False):
    rows, objects = [r for r, _ in rooms], [o for _, things in rooms for o in things]
    splits = {r["scene_id"]: split_of(r["source_id"].split("/")[0]) for r in rows}
    return write_kind(tmp_path, rooms_with_objects(rows, objects, splits), KINDS[kind], filtered=filtered)


def read_all(source, models=None):
    task = Task(source, Reading(PreprocessSettings(), "CC0-1.0", source, WALKER, 1), models or {})
    return [read_peers(task, house) for house in peers_houses(source, kinds_of(source))]


def test_conventions_of_the_format(tmp_path):
    """Half extents (w, h, d), middles relative to the floor's, y up, +z front; one-hot with start and end behind."""
    written(tmp_path, [bedroom()])
    with np.load(tmp_path / "bedroom" / "a1-b2_MasterBedroom-7" / BOXES, allow_pickle=False) as file:
        assert set(file.files) == {
            "uids", "jids", "scene_id", "scene_uid", "scene_type", "json_path", "room_layout", "floor_plan_vertices",
            "floor_plan_faces", "floor_plan_centroid", "class_labels", "translations", "sizes", "angles",
        }  # fmt: skip
        assert str(file["scene_uid"]) == "a1-b2_MasterBedroom-7"
        assert (str(file["scene_id"]), str(file["scene_type"]), str(file["json_path"])) == ("MasterBedroom-7", "masterbedroom", "a1-b2")
        assert np.allclose(file["floor_plan_centroid"], [0.5, 0, -0.25])
        assert np.allclose(file["translations"][0], [0.1 - 0.5, 0.55, 0.2 + 0.25])
        assert np.allclose(file["sizes"][0], [0.9, 0.55, 1.1])
        assert file["class_labels"].shape == (3, 23)
        assert file["class_labels"].sum() == 3
        mask = file["room_layout"]
        assert (mask.shape, mask.dtype, set(np.unique(mask))) == ((256, 256, 1), np.uint8, {0, 255})
        assert (mask > 0).mean() * 6.2**2 == pytest.approx(4 * 3.25 + 2 * 1.75, rel=0.01)
        corner = [round((v + 3.1) / 6.2 * 256) for v in (1.5 - 0.0, -2.0 + 0.25)]  # x, z relative to the centroid: cut out of the L
        assert mask[corner[1], corner[0], 0] == 0
        assert {file[k].dtype for k in ("translations", "sizes", "angles", "class_labels", "floor_plan_vertices")} == {np.dtype("f4")}
    assert (tmp_path / "bedroom_threed_front_splits.csv").read_text() == f"MasterBedroom-7,{split_of('a1-b2')}\n"


def test_faces_of_the_floor_look_up():
    vertices, faces = floor_mesh(np.array(L_SHAPE))
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    up = np.cross(b - a, c - a)[:, 1]
    assert (up > 0).all()
    assert up.sum() / 2 == pytest.approx(4 * 3.25 + 2 * 1.75)


numbers = st.floats(-6, 6, allow_nan=False, width=64)
yaws = st.one_of(st.floats(-3.14159, 3.14159), st.sampled_from([np.pi, 3.14159, -3.14159, 0.0]))


@settings(max_examples=40, deadline=None)
@given(
    st.lists(
        st.tuples(numbers, numbers, st.floats(0, 3), yaws, st.lists(st.floats(0.05, 3.9), min_size=3, max_size=3)), min_size=1, max_size=9
    )
)
def test_reading_what_was_written_and_writing_it_again_changes_nothing(tmp_path_factory, things):
    """Exact to float32, whatever the values: the second file equals the first, bit for bit."""
    tmp_path = tmp_path_factory.mktemp("peers")
    row, _ = bedroom()
    objects = [thing("a1-b2", "MasterBedroom-7", "double_bed", (x, y, z), yaw, size) for x, y, z, yaw, size in things]
    written(tmp_path, [(row, objects)])
    (house,) = read_all(tmp_path)
    assert len(house.objects) == len(objects)
    for o, was in zip(house.objects, objects, strict=True):
        assert np.allclose(o["position"], was["position"], atol=2e-6)
        assert np.allclose(o["size"], was["size"], atol=1e-6)
        assert abs(np.exp(1j * o["yaw"]) - np.exp(1j * was["yaw"])) < 1e-6
        assert -np.pi < o["yaw"] <= np.pi
        assert o["category"] == "double_bed"
    first = read_room(Folder.at(tmp_path), f"bedroom/a1-b2_MasterBedroom-7/{BOXES}")
    again = to_cached_room(house.rooms[0], house.objects, KINDS["bedroom"], first.scene_id)
    for name in FIELDS:
        assert np.array_equal(getattr(first, name), getattr(again, name)), name
    assert (first.uids, first.jids, first.scene_uid) == (again.uids, again.jids, again.scene_uid)


def test_classes_of_every_set_lead_to_categories_and_back():
    words = taxonomy.load()
    for kind in KINDS.values():
        for label in kind.classes:
            members = kind.categories(label)
            assert members, (kind.name, label)
            assert set(members) <= set(words.names)
            assert {kind.label(c) for c in members} == {label}
    assert [len(k.classes) for k in KINDS.values()] == [21, 24, 24, 25]


def test_stats_are_over_train_and_val(tmp_path):
    rooms = [bedroom(f"{k}-x", f"Bedroom-{k}") for k in range(40)]
    for k, (_, things) in enumerate(rooms):
        things[0]["size"][0] = 1.0 + 0.01 * k
    made = written(tmp_path, rooms)
    stats = json.loads((tmp_path / "bedroom" / STATS).read_text())
    kept = [k for k in range(40) if split_of(f"{k}-x") != "test"]
    assert 0 < len(kept) < 40
    assert made.rooms["train"] + made.rooms["val"] == len(kept)
    assert stats["bounds_sizes"][3] == pytest.approx((1.0 + 0.01 * max(kept)) / 2)
    assert stats["count_furniture"] == dict.fromkeys(("double_bed", "nightstand", "pendant_lamp"), len(kept))
    assert sum(stats["class_frequencies"].values()) == pytest.approx(1)
    assert stats["class_labels"][-2:] == ["start", "end"]
    assert [len(stats[f"bounds_{k}"]) for k in ("translations", "sizes", "angles")] == [6, 6, 2]
    assert kind_of(tuple(stats["class_labels"][:-2])) == KINDS["bedroom"]


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (lambda row, things: things.pop(), "2 objects"),
        (lambda row, things: things.extend(thing("a1-b2", "MasterBedroom-7", position=(0.01 * k, 0, 0)) for k in range(11)), "14 objects"),
        (lambda row, things: things[1].update(category="shoe_cabinet"), "shoe_cabinet"),
        (lambda row, things: things[0].update(category="desk"), "none of"),
        (lambda row, things: things[2].update(position=[0, 0, 3.9]), "4.400"),
        (lambda row, things: things[2].update(position=[0, 0, -0.01]), "-0.010"),
        (lambda row, things: row.update(polygon=[[0, 0], [6.1, 0], [6.1, 3], [0, 3]]), "6.1 x 3.0"),
        (lambda row, things: None, ""),
    ],
)
def test_filters_of_the_peers(change, word, tmp_path):
    row, things = bedroom()
    change(row, things)
    made = written(tmp_path, [(row, things)], filtered=True)
    assert [r["reason"] for r in made.rejects] == (["peers_filter"] if word else [])
    assert all(word in r["detail"] for r in made.rejects)
    assert sum(made.rooms.values()) == (not word)


def test_a_room_id_that_recurs_is_another_room(tmp_path):
    written(tmp_path, [bedroom("a", "Bedroom-1"), bedroom("b", "Bedroom-1")])
    assert sorted(p.parent.name for p in tmp_path.glob(f"bedroom/*/{BOXES}")) == ["a_Bedroom-1", "b_Bedroom-1-again"]
    assert len(set((tmp_path / "bedroom_threed_front_splits.csv").read_text().splitlines())) == 2


def test_rooms_of_a_house_are_one_scene_and_a_room_of_two_kinds_is_one(tmp_path):
    """A living-dining room stands in two sets; two rooms of a house that touch are open to each other."""
    square = [[2.5, -2.25], [6.0, -2.25], [6.0, 1.0], [2.5, 1.0]]
    living = (
        room("a1-b2", "LivingDiningRoom-3", "livingdiningroom", square),
        [thing("a1-b2", "LivingDiningRoom-3", "coffee_table", (4, 0, 0), size=(1, 0.6, 0.4))],
    )
    for kind in ("bedroom", "livingroom", "diningroom"):
        written(tmp_path, [bedroom(), living], kind)
    (house,) = read_all(tmp_path)
    assert [r["type"] for r in house.rooms] == ["masterbedroom", "livingdiningroom"]
    assert len(house.objects) == 4
    assert [(o["kind"], o["rooms"]) for o in house.openings] == [("open", ["r_livingdiningroom_3", "r_masterbedroom_7"])]
    assert house.scenes[0]["split"] == split_of("a1-b2")


def test_models_give_asset_and_category(tmp_path):
    row, things = bedroom()
    things[0]["category"] = "lounge_chair"
    written(tmp_path, [(row, things)])
    model = Model(Box((-1, 0, -1), (1, 1, 1)), "lounge_chair", "ff_j1", (0.9, 1.1, 0.55))
    (house,) = read_all(tmp_path, {"j1": model})
    chair = house.objects[0]
    assert (chair["category"], chair["asset_id"]) == ("lounge_chair", "ff_j1")
    assert np.allclose(chair["scale"], 2.0)
    (bare,) = read_all(tmp_path)
    assert bare.objects[0]["asset_id"] == ""
    assert bare.objects[0]["category"] in {"dining_chair", "lounge_chair", "chinese_chair"}
    assert [r["reason"] for r in bare.rejects] == ["size_from_bbox"]


def arrays(tmp_path):
    written(tmp_path, [bedroom()])
    path = tmp_path / "bedroom" / "a1-b2_MasterBedroom-7" / BOXES
    with np.load(path) as file:
        return path, dict(file)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (lambda a: a.update(jids=np.array(["x", None], object)), "pickle"),
        (lambda a: a.update(jids=np.array(["x"])), "1 jids"),
        (lambda a: a.pop("translations"), "lacks translations"),
        (lambda a: a.update(sizes=a["sizes"][:2]), "shape"),
        (lambda a: a.update(sizes=a["sizes"] * np.nan), "not finite"),
        (lambda a: a.update(angles=a["angles"].astype(str)), "type"),
        (lambda a: a.update(floor_plan_faces=a["floor_plan_faces"] + 99), "not there"),
        (lambda a: a.update(floor_plan_faces=a["floor_plan_faces"] * 0), "no area"),
        (lambda a: a.update(class_labels=a["class_labels"][:, :9]), "columns"),
        (lambda a: a.update(room_layout=np.zeros((9000, 9000))), "unpacks"),
    ],
)
def test_broken_arrays_are_refused_with_their_name(change, word, tmp_path):
    path, held = arrays(tmp_path)
    change(held)
    np.savez_compressed(path, **held)
    (house,) = read_all(tmp_path)
    assert [r["what"] for r in house.rejects] == ["room", "house"]
    assert word in house.rejects[0]["detail"]
    assert house.scenes == []


def test_files_that_are_no_npz(tmp_path):
    path, _ = arrays(tmp_path)
    whole = path.read_bytes()
    bomb = io.BytesIO()
    with zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("uids.npy", b"\0" * (80 << 20))
    for data in (b"", b"{}", whole[: len(whole) // 2], whole[:-30], bomb.getvalue(), b"\x80\x04N."):
        path.write_bytes(data)
        with pytest.raises(SourceError) as caught:
            read_room(Folder.at(path.parent), BOXES)
        assert caught.value.code == "bad_boxes"


def test_a_folder_of_something_else_is_named(tmp_path):
    with pytest.raises(ContentError, match=r"preprocess\.sources\.peers"):
        kinds_of(tmp_path)
    write_stats(tmp_path / STATS, {"class_labels": ["cat", "dog"]})
    with pytest.raises(ContentError, match="classes"):
        kinds_of(tmp_path)
    write_stats(tmp_path / STATS, {"class_labels": ["desk", "wardrobe", "start", "end"]})
    assert kinds_of(tmp_path)["."].classes == ("desk", "wardrobe")
