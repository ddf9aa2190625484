import numpy as np

from pipeline import seeds
from pipeline.diffusion.context import OPENINGS, WALLS, RoomContext, RoomOpening, floor_tokens, simplify_polygon
from pipeline.diffusion.rooms import sets_of, sweeps_by_asset
from pipeline.entities.plan import Opening, Plan, Room, Swing
from tests.diffusion.small_world import CLASSES, LAYOUTS, room_rows, shapes


def tables(count):
    made = [room_rows(seeds.generator(0, "room", n), n) for n in range(count)]
    scenes = [{"scene_id": f"h{n}", "split": ("train", "val", "test")[n % 3], "storey_height": 3.0} for n in range(count)]
    return {
        "scenes": scenes, "rooms": [m[0] for m in made], "openings": [o for m in made for o in m[1]], "objects": [o for m in made for o in m[2]],
    }  # fmt: skip


def test_rooms_are_sorted_into_their_splits():
    sets = sets_of(tables(9), *shapes(), CLASSES, LAYOUTS, 24)
    assert [len(s) for s in (sets.train, sets.val, sets.test)] == [3, 3, 3]
    assert {e.key for e in sets.val} == {"h1/r0", "h4/r0", "h7/r0"}
    assert not sets.left_out


def test_rooms_are_left_out_with_a_reason():
    data = tables(6)
    data["rooms"][0] = {**data["rooms"][0], "layout_type": ""}
    data["objects"] = [o for o in data["objects"] if o["scene_id"] != "h1"]
    sets = sets_of(data, *shapes(), CLASSES, LAYOUTS, 5)
    assert sets.left_out == {"more-objects-than-slots": 2, "no-layout-type": 1, "no-objects": 1}


def test_an_upper_storey_stands_on_its_own_floor():
    data = tables(1)
    low = sets_of(data, *shapes(), CLASSES, LAYOUTS, 24).train[0]
    data["rooms"][0] = {**data["rooms"][0], "level": 1}
    data["objects"] = [{**o, "position": [*o["position"][:2], o["position"][2] + 3.0]} for o in data["objects"]]
    np.testing.assert_allclose(sets_of(data, *shapes(), CLASSES, LAYOUTS, 24).train[0].continuous, low.continuous)


def test_the_largest_sweeps_are_kept():
    joints = [{"asset_id": "a", "sweep_min": [0, 0, 0], "sweep_max": [i, 1, 1]} for i in range(1, 8)]
    assert sweeps_by_asset(joints)["a"][:, 1, 0].tolist() == [7, 6, 5, 4]


def test_a_context_comes_out_of_a_plan():
    square = np.array([[0, 0], [4, 0], [4, 3], [0, 3]], float)
    here, there = Room("a", "bedroom", square, level=1), Room("b", "hallway", square + np.array([0, -3.12]), level=1)
    door = Opening("d", "door", ("a", "b"), np.array([[1.0, -0.06], [1.9, -0.06]]), 2.0, swing=Swing("a", 1, 1.5), level=1)
    plan = Plan((here, there), (door,), "b")
    inside, outside = RoomContext.of(plan, "a", "bedroom", 4), RoomContext.of(plan, "b", "hallway")
    assert (inside.n_target, inside.elevation) == (4, 3.0)
    assert inside.openings[0].hinge == 1
    assert outside.openings[0].hinge == -1
    assert floor_tokens(inside).normal[WALLS].tolist() == [0, 1]
    assert floor_tokens(outside).normal[WALLS].tolist() == [0, -1]


def test_many_corners_and_openings_are_cut_to_what_fits():
    angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    polygon = np.stack([3 * np.cos(angle), 3 * np.sin(angle)], 1)
    openings = tuple(RoomOpening("window", np.array([[0, 2.9], [0.2 + 0.1 * i, 2.9]])) for i in range(20))
    floor = floor_tokens(RoomContext("bedroom", polygon, openings))
    assert int(floor.mask.sum()) == WALLS + OPENINGS
    widths = np.linalg.norm(floor.ends[WALLS:, 1] - floor.ends[WALLS:, 0], axis=1)
    assert widths.min() > 0.95
    assert len(simplify_polygon(polygon, WALLS)) == WALLS
