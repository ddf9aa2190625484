import json

import numpy as np
import pytest

from pipeline import taxonomy
from pipeline.sources.reasons import SourceError
from pipeline.sources.threed_front.furniture import category_of
from pipeline.sources.threed_front.house_file import Furniture, declared_box, extract_arrays, parse_house
from tests.sources import making
from tests.sources.making import BED
from tests.sources.reading import read


@pytest.mark.parametrize("dialect", ["0.4", "0.11"])
@pytest.mark.parametrize("variant", ["plain", "nested", "later"])
def test_both_dialects_and_all_records_give_the_same_rows(dialect, variant, tmp_path):
    making.write_library(tmp_path / "front")
    making.write_house(tmp_path / "front", making.two_rooms(dialect=dialect, variant=variant))
    made = read(tmp_path)
    assert [(o["category"], o["position"], o["yaw"], o["size"]) for o in made.objects] == [
        ("double_bed", [2.0, -1.1, 0.0], 0.0, [1.8, 2.2, 1.1]),
        ("nightstand", [3.4, -0.3, 0.0], 0.0, [0.5, 0.4, 0.5]),
        ("pendant_lamp", [2.0, -2.0, 2.0], 0.0, [0.6, 0.6, 0.5]),
    ]
    assert [(r["type"], r["layout_type"], r["area"], r["height"]) for r in made.rooms] == [
        ("masterbedroom", "bedroom", 16.0, 2.8),
        ("hallway", "hallway", 7.52, 2.7),
    ]
    assert made.scenes[0]["entrance"] == "r_hallway_2"
    assert (made.scenes[0]["inner_wall"], made.scenes[0]["outer_wall"]) == (0.12, 0.24)


@pytest.mark.parametrize(
    ("record", "box"),
    [
        ({"size": [1.8, 2.2, 1.1]}, (1.8, 2.2, 1.1)),
        ({"size": [1.8, 2.2, 1.1], "bbox": [1.8, 2.2, 1.1]}, (1.8, 2.2, 1.1)),
        ({"size": [1.8, 2.2, 1.1], "bbox": [[1.8, 1.1, 2.2]]}, (1.8, 2.2, 1.1)),
        ({"bbox": [1.8, 1.1, 2.2]}, (1.8, 2.2, 1.1)),
        ({"bbox": [[1.8, 1.1, 2.2]]}, (1.8, 2.2, 1.1)),
        ({"bbox": [1.8, "x", 2.2]}, None),
        ({"bbox": [1.8, 0, 2.2]}, None),
        ({"bbox": [1.8, 2.2]}, None),
        ({"bbox": 7}, None),
        ({}, None),
    ],
)
def test_axis_order_of_declared_boxes(record, box):
    assert declared_box(record) == box


@pytest.mark.parametrize(
    ("category", "title", "want"),
    [
        ("King-size Bed", "", "double_bed"),
        ("Corner / Side Table", "", "corner_side_table"),
        ("Double Bed", "", "double_bed"),
        ("Tea Table", "", "coffee_table"),
        ("Others", "bed/king-size bed", "double_bed"),
        ("", "sofa/ multi seat sofa", "multi_seat_sofa"),
        ("", "table/night table", "nightstand"),
        ("", "storage unit/armoire", "wardrobe"),
        ("Lighting", "", None),
        ("", "", None),
    ],
)
def test_category_of_a_record(category, title, want):
    assert category_of(Furniture("u", BED, True, category, title, None), taxonomy.load()) == want


@pytest.mark.parametrize("tree", [[], {}, {"scene": []}, {"scene": {"room": 3}}, None, "text", 5])
def test_no_house(tree):
    with pytest.raises(SourceError) as caught:
        parse_house(tree, "x")
    assert caught.value.code == "bad_structure"


def test_odd_types_do_not_stop_it():
    """Everything that can be of another type is: the house is read, and empty."""
    tree = {
        "uid": 5,
        "furniture": [3, {"uid": None, "valid": "yes"}],
        "mesh": {"a": 1},
        "extension": [],
        "scene": {"room": [7, {"children": 3}]},
    }
    house = parse_house(tree, "x")
    assert house.furniture[""].valid is None
    assert house.rooms[0].children == ()


def test_same_room_id_in_two_houses_is_two_rooms(tmp_path):
    making.write_library(tmp_path / "front")
    for name in ("house-a", "house-b"):
        making.write_house(tmp_path / "front", making.two_rooms(name))
    made = read(tmp_path)
    assert len({(r["scene_id"], r["room_id"]) for r in made.rooms}) == 4
    assert [s["index"] for s in made.scenes] == [0, 1]


def test_a_broken_file_is_named_where_it_breaks(tmp_path):
    """Characters count in the file, whose arrays are taken out before it is parsed."""
    making.write_library(tmp_path / "front")
    text = json.dumps(making.two_rooms(), indent=1).replace('"scene":', '"scene";', 1)
    making.write_house(tmp_path / "front", text, "house-a")
    (row,) = [r for r in read(tmp_path).rejects if r["what"] == "house"]
    at = text.index('"scene";') + len('"scene"')
    line = text[:at].count("\n") + 1
    assert (
        row["detail"]
        == f"cannot be parsed (Expecting ':' delimiter: line {line}, column {at - text.rindex(chr(10), 0, at)}, character {at})"
    )


def test_deferred_arrays_are_the_arrays():
    """Taking the meshes' numbers out before parsing changes nothing of what is read, whatever stands between them."""
    tree = making.two_rooms()
    tree["mesh"][0]["uv"] = [None, 1.5e-3]
    tree["mesh"][1] |= {"xyz": [], "faces": []}
    plain = parse_house(json.loads(json.dumps(tree)), "house-a")
    for text in (json.dumps(tree), json.dumps(tree, indent=3), json.dumps(tree, separators=(",", ":"))):
        short, arrays = extract_arrays(text.encode())
        house = parse_house(json.loads(short), "house-a", arrays)
        assert house.meshes.keys() == plain.meshes.keys()
        for uid, mesh in plain.meshes.items():
            assert np.array_equal(house.meshes[uid].triangles(), mesh.triangles())


def test_a_number_in_place_of_an_array_is_no_mesh():
    tree = making.two_rooms()
    tree["mesh"][0] |= {"xyz": 10**9, "faces": "[0, 1, 2]"}
    with pytest.raises(SourceError):
        parse_house(tree, "house-a").meshes["f1"].triangles()
