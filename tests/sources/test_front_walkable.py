import numpy as np
import pytest

from pipeline.entities.plan import Opening, Room
from tests.sources import making
from tests.sources.making import child, floor
from tests.sources.reading import WALKER, read

ROOMS = [
    Room("a", "x", np.array([[0.0, 0], [4, 0], [4, 4], [0, 4]])),
    Room("b", "x", np.array([[4.12, 0], [6.0, 0], [6, 4], [4.12, 4]])),
]
DOOR = Opening("d", "door", ("a", "b"), np.array([[4.06, 1.5], [4.06, 2.5]]), 2.1)


def test_empty_rooms_with_a_door_are_all_but_their_corners():
    assert WALKER.shares(ROOMS, [DOOR], []) == pytest.approx([1, 1], abs=0.03)


def test_without_a_door_only_the_larger_room_counts():
    assert WALKER.shares(ROOMS, [], []) == pytest.approx([1, 0], abs=0.03)


def test_a_box_takes_its_floor_and_a_wall_of_boxes_what_is_behind():
    middle = np.array([[1.0, 1], [3, 1], [3, 3], [1, 3]])
    assert WALKER.shares(ROOMS[:1], [], [(middle, (0.0, 1.0))])[0] == pytest.approx(0.75, abs=0.03)
    wall = np.array([[2.0, 0], [2.2, 0], [2.2, 4], [2, 4]])
    assert WALKER.shares(ROOMS[:1], [], [(wall, (0.0, 1.0))])[0] == pytest.approx(0.5, abs=0.03)
    assert WALKER.shares(ROOMS[:1], [], [(wall, (WALKER.robot.height, 2.0))])[0] > 0.97  # it passes below


def test_rows_carry_it_weighted_by_area(tmp_path):
    making.write_library(tmp_path / "front")
    making.write_house(tmp_path / "front", making.two_rooms())
    made = read(tmp_path)
    shares = {r["room_id"]: r["walkable_free"] for r in made.rooms}
    assert shares["r_hallway_2"] > 0.95
    assert 0.5 < shares["r_masterbedroom_1"] < 0.8
    assert made.scenes[0]["walkable_free"] == pytest.approx(
        (16 * shares["r_masterbedroom_1"] + 7.52 * shares["r_hallway_2"]) / 23.52, abs=1e-3
    )


def test_rooms_of_one_id_on_two_floors_are_two_rooms(tmp_path):
    tree = making.two_rooms(more_meshes=[floor("f8", 10, 0, 12, 2), floor("f9", 14, 0, 16, 2)])
    tree["scene"]["room"] += [{"type": "OtherRoom", "instanceid": "OtherRoom", "children": [child(f, "mesh/0")]} for f in ("f8", "f9")]
    making.write_library(tmp_path / "front")
    making.write_house(tmp_path / "front", tree)
    assert [r["room_id"] for r in read(tmp_path).rooms][2:] == ["r_otherroom", "r_otherroom_3"]
