import numpy as np
import pytest
from shapely.geometry import box

from pipeline.sources.threed_front.opening_evidence import MESHES, MIN_WIDTH, from_furniture, from_mesh
from pipeline.sources.threed_front.reveals import jambs, merge
from pipeline.sources.threed_front.wall_openings import passages_between, resolve
from tests.sources import making
from tests.sources.making import floor, slab
from tests.sources.reading import read

# Two rooms side by side in plan, a wall of 0.12 m between; the file's z is minus our y.
ROOMS = {"left": box(0, -4, 4, 0), "right": box(4.12, -4, 6, 0)}


def reveal(kind, low, high):
    return from_mesh(kind, np.array(slab("m", "Door", low, high)["xyz"]).reshape(-1, 3))


def opening(hole):
    return resolve(hole, ROOMS, "o", 0.4)


def test_door_between_two_rooms():
    made = opening(reveal("door", (4, 0, 1), (4.12, 2.1, 1.9)))
    assert (made.kind, made.rooms, made.sill, made.height) == ("door", ("left", "right"), 0.0, 2.1)
    assert np.allclose(made.segment, [[4.06, -1.9], [4.06, -1.0]])


@pytest.mark.parametrize(
    ("kind", "low", "high", "want", "rooms"),
    [
        ("door", (6, 0, 1), (6.24, 2.1, 2), "entrance", ("right",)),
        ("window", (0.5, 0.9, 0), (2, 2.1, -0.24), "window", ("left",)),
        ("hole", (0.5, 0.9, 0), (2, 2.1, -0.24), "window", ("left",)),
        ("hole", (4, 0, 1), (4.12, 2.1, 2), "portal", ("left", "right")),
        ("hole", (4, 0, 1), (4.12, 2.1, 3.4), "open", ("left", "right")),
    ],
)
def test_kinds(kind, low, high, want, rooms):
    made = opening(reveal(kind, low, high))
    assert (made.kind, made.rooms) == (want, rooms)


def test_far_and_narrow_are_nothing():
    assert opening(reveal("door", (50, 0, 1), (50.12, 2.1, 2))) is None
    assert reveal("door", (4, 0, 1), (4.12, 2.1, 1.2)).width < MIN_WIDTH
    assert from_mesh("door", np.zeros((6, 3))) is None


def test_leaf_in_its_reveal_is_one_door():
    hole = reveal("hole", (4, 0, 1), (4.12, 2.1, 1.9))
    leaf = from_furniture("door/single swing door", np.array([4.06, 0, 1.45]), 1.2, None)
    (both,) = merge([leaf, hole])
    assert opening(both).kind == "door"
    assert opening(both).width == pytest.approx(0.9)


def test_leaf_alone_takes_the_direction_of_the_wall():
    leaf = from_furniture("door/sliding door", np.array([4.05, 0, 2.0]), 0.4, None)
    made = opening(leaf)
    assert (made.kind, made.rooms) == ("door", ("left", "right"))
    assert abs(made.segment[1, 0] - made.segment[0, 0]) < 1e-6
    assert from_furniture("curtain/curtain", np.zeros(3), 0.0, None) is None


def test_reveals_of_both_sides_are_one():
    a, b = reveal("door", (4, 0, 1), (4.06, 2.1, 1.9)), reveal("door", (4.06, 0, 1), (4.12, 2.1, 1.9))
    (both,) = merge([a, b])
    assert both.depth == pytest.approx(0.12)
    assert np.allclose(both.centre, [4.06, -1.45])


def test_doors_side_by_side_stay_two():
    assert len(merge([reveal("door", (4, 0, 0.2), (4.12, 2.1, 1)), reveal("door", (4, 0, 1.2), (4.12, 2.1, 2))])) == 2


def test_oblique_wall():
    """A reveal turned by 30 degrees keeps its width and its direction."""
    points = np.array(slab("m", "Door", (-0.45, 0, -0.06), (0.45, 2.1, 0.06))["xyz"]).reshape(-1, 3)
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    hole = from_mesh("door", points @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T)
    assert hole.width == pytest.approx(0.9)
    assert abs(hole.along @ np.array([c, s])) == pytest.approx(1)


def test_rooms_without_a_wall_between_are_open():
    rooms = {"a": box(0, 0, 4, 4), "b": box(4, 1, 7, 3), "c": box(4.12, 5, 7, 8)}
    (made,) = passages_between(rooms, 2.7, [])
    assert (made.kind, made.rooms, made.opening_id) == ("open", ("a", "b"), "opening_0")
    assert made.width == pytest.approx(2, abs=0.1)


def test_floors_that_meet_under_a_door_are_that_door():
    """Real floors reach under their doors; where no door is told, a doorway it is all the same."""
    strip = box(4, -1.9, 4.12, -1.0)
    rooms = {"left": ROOMS["left"].union(strip), "right": ROOMS["right"]}
    door = resolve(reveal("door", (4, 0, 1), (4.12, 2.1, 1.9)), rooms, "o", 0.4)
    assert passages_between(rooms, 2.7, [door]) == []
    (made,) = passages_between(rooms, 2.7, [])
    assert (made.kind, made.rooms, made.height) == ("portal", ("left", "right"), 2.1)
    assert made.width == pytest.approx(0.9, abs=0.07)


def test_floors_that_touch_on_both_sides_of_a_door_are_not_open_to_each_other():
    """A reveal has a wall around it, although the floors meet in the middle of it."""
    rooms = {"left": box(0, -4, 4, 0), "right": box(4, -4, 6, 0)}
    door = resolve(reveal("door", (3.94, 0, 1), (4.06, 2.1, 1.9)), rooms, "o", 0.4)
    assert passages_between(rooms, 2.7, [door]) == []
    assert [o.kind for o in passages_between(rooms, 2.7, [])] == ["open"]


def test_jambs_by_themselves_make_a_door():
    """Reveals delivered jamb by jamb: two that face each other are an opening, one alone is told, beside a reveal it is part of it."""
    left, right = (reveal("door", (4, 0, z), (4.12, 2.1, z + 0.001)) for z in (1.0, 1.9))
    made, rest = jambs([left, right], [])
    assert rest == []
    (door,) = merge(made)
    assert opening(door).rooms == ("left", "right")
    assert door.width == pytest.approx(0.9, abs=0.01)
    assert door.depth == pytest.approx(0.12)
    whole = reveal("door", (4, 0, 1), (4.12, 2.1, 1.9))
    assert jambs([left, right], [whole])[0] == []
    assert whole.reaches(left.centre)
    assert jambs([left], []) == ([], [left])
    low = reveal("door", (4, 0, 1.9), (4.12, 1.2, 1.901))
    assert jambs([left, low], [])[0] == []


@pytest.mark.parametrize("depth", [0.12, 0.24, 0.3, 0.9])
def test_walls_and_bays_of_any_usual_depth(depth):
    made = opening(reveal("window", (0.5, 0.9, 0), (2.5, 2.1, -depth)))
    assert (made.kind, made.rooms, made.width) == ("window", ("left",), 2.0)


@pytest.mark.parametrize("thickness", [0.12, 0.2, 0.24, 0.3])
@pytest.mark.parametrize("side", [0.0, 0.5, 1.0])
def test_a_leaf_anywhere_in_a_wall_joins_its_rooms(thickness, side):
    rooms = {"left": box(0, -4, 4, 0), "right": box(4 + thickness, -4, 7, 0)}
    leaf = from_furniture("door/single swing door", np.array([4 + side * thickness, 0, 2.0]), np.pi / 2, None)
    assert resolve(leaf, rooms, "o", 0.4).rooms == ("left", "right")


def test_windows_without_a_size_stay_below_the_ceiling():
    made = opening(from_furniture("window/window", np.array([2.0, 0.9, 0.1]), 0.0, None))
    assert (made.kind, made.sill) == ("window", 0.9)
    assert made.sill + made.height < 2.5


def test_broken_mesh_is_told(tmp_path):
    bad = {**slab("d9", "Door", (4, 0, 3), (4.12, 2.1, 3.9)), "xyz": [0, 1, "x"]}
    making.write_library(tmp_path / "front")
    making.write_house(tmp_path / "front", making.two_rooms(more_meshes=[bad, floor("f9", 0, 0, 1, 1)]))
    made = read(tmp_path)
    assert made.reasons == {"opening_unresolved"}
    assert len(made.openings) == 3
    assert MESHES["Hole"] == ("hole", "hole")


def test_a_hole_within_one_room_joins_nothing():
    assert opening(reveal("door", (2, 0, 1), (2.12, 2.1, 1.9))) is None


def test_a_floor_that_reaches_under_the_entrance_makes_no_room_of_the_outside():
    rooms = {"left": box(0, -4, 4, 0).union(box(4, -1.9, 4.24, -1.0))}
    made = resolve(reveal("door", (4, 0, 1), (4.24, 2.1, 1.9)), rooms, "o", 0.4)
    assert (made.kind, made.rooms) == ("entrance", ("left",))
