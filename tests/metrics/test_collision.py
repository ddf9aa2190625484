import math
from unittest import mock

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from pipeline.geometry.kinematics import sweep_box
from pipeline.metrics import collision
from tests.geometry.furniture import LIBRARY
from tests.metrics.rows_of import joint_row, moved_rows, object_row, random_rows

SWEEPS = collision.sweeps_of(
    [
        {"asset_id": a.asset_id, "part_class": j.part_class, "sweep_min": box[0].tolist(), "sweep_max": box[1].tolist()}
        for a in LIBRARY.values()
        for k, j in enumerate(a.joints)
        for box in [sweep_box(a, k)]
    ]
)


def blocked_chest(gap):
    """A chest that opens towards -y, and a bed `gap` ahead of its front."""
    return [object_row("chest", 2.0, 2.5), object_row("bed", 2.0, 2.5 - 0.25 - gap - 1.0)]


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.floats(-3, 3), st.floats(-9, 9), st.floats(-9, 9))
def test_nothing_hangs_on_where_the_room_lies(seed, angle, dx, dy):
    here, there = random_rows(seed), moved_rows(random_rows(seed), angle, (dx, dy))
    assert np.array_equal(collision.bbox_hits(here), collision.bbox_hits(there))
    assert np.array_equal(collision.prism_hits(here, LIBRARY), collision.prism_hits(there, LIBRARY))
    for kind in ("heuristic", "joints"):
        assert collision.are_obstructed(here, kind, SWEEPS) == collision.are_obstructed(there, kind, SWEEPS)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6))
@example(452)  # a corner of 6 mm, less than EPSILON of either box
def test_prisms_collide_only_where_boxes_do_and_order_does_not_matter(seed):
    rows = random_rows(seed)
    boxes, prisms = collision.bbox_hits(rows), collision.prism_hits(rows, LIBRARY)
    # The chest's handle stands out of its box by 3 cm, so a hit there needs no box.
    chests = np.array([r["asset_id"] == "chest" for r in rows])
    if not prisms[chests].any():
        with mock.patch.object(collision, "EPSILON", 0.0):
            assert np.all(collision.bbox_hits(rows)[prisms])
    assert np.array_equal(collision.bbox_hits(rows[::-1])[::-1], boxes)
    assert np.array_equal(collision.prism_hits(rows[::-1], LIBRARY)[::-1], prisms)


def test_a_chair_under_a_table_collides_as_a_box_only():
    rows = [object_row("table", 2.0, 1.5), object_row("chair", 2.0, 1.1 - 0.25 + 0.3, math.pi)]
    found = collision.rates(rows, LIBRARY)
    assert found["bbox"]["col_obj"]["rate"] == 1.0
    assert found["prism"]["col_obj"]["rate"] == 0.0
    assert found["prism"]["col_scene"] == {"rate": 0.0, "low": 0.0, "high": pytest.approx(0.793, abs=1e-3), "successes": 0, "n": 1}


def test_rooms_are_apart():
    rows = [object_row("block", 1, 1, room="a"), object_row("block", 1, 1, room="b"), object_row("block", 1, 1, room="b", number=1)]
    found = collision.rates(rows)["bbox"]
    assert (found["col_obj"]["successes"], found["col_scene"]["successes"], found["col_scene"]["n"]) == (2, 1, 2)


def test_touching_boxes_do_not_collide():
    assert not collision.bbox_hits([object_row("block", 1, 1), object_row("block", 2, 1, number=1)]).any()


@pytest.mark.parametrize(("gap", "heuristic", "joints"), [(0.1, True, True), (0.3, False, True), (0.6, False, False)])
def test_a_blocked_drawer(gap, heuristic, joints):
    # The heuristic adds a third of the depth (17 cm), the drawer comes out by 40 cm and its handle by 3 more.
    rows = blocked_chest(gap)
    assert collision.are_obstructed(rows, "heuristic") == [heuristic]
    assert collision.are_obstructed(rows, "joints", SWEEPS) == [joints]


def test_extended_boxes_hold_the_sweep():
    rows = [object_row("cupboard", 1.0, 1.0, 0.7), object_row("bed", 3, 3)]
    (position, yaw, size), owners = collision.extended_boxes(rows, "joints", SWEEPS)
    assert owners.tolist() == [0, 1, *[0] * (len(owners) - 2)]
    assert size[:2].tolist() == [rows[0]["size"], rows[1]["size"]]
    # What the doors sweep lies ahead of the front, and reaches 60 cm.
    ahead = np.array([math.sin(0.7), -math.cos(0.7)])
    assert max(size[2:, 1]) == pytest.approx(0.6, abs=0.01)
    np.testing.assert_allclose((position[2:, :2] - [1.0, 1.0]) @ ahead - size[2:, 1] / 2, size[0, 1] / 2)
    assert (yaw[owners == 0] == 0.7).all()


def test_a_door_that_opens_wider_than_its_cupboard_does_not_block_the_one_beside_it():
    # The box of the whole way holds the shut door and the handle that later stands out beside the body: 2 cm of the neighbour, behind the front.
    past_side = {"cupboard": SWEEPS["cupboard"] + np.array([[-0.03, 0.0, 0.0], [0.03, 0.0, 0.0]])}
    beside, ahead = ([object_row("cupboard", 1.0, 1.0), object_row("small_block", 1.66, y)] for y in (1.05, 0.6))
    assert collision.are_obstructed(beside, "joints", past_side) == [False]
    assert collision.are_obstructed(ahead, "joints", past_side) == [True]


def test_acoll_is_a_mean_of_rooms():
    rows = [r | {"room_id": room} for room, gap in (("a", 0.1), ("b", 0.9)) for r in blocked_chest(gap)] + [
        object_row("bed", 1, 1, room="c")
    ]
    found = collision.acoll(np.random.default_rng(0), rows, "joints", SWEEPS)
    assert (found["rooms"]["mean"], found["rooms"]["n"]) == (0.5, 2)
    assert (found["objects"]["rate"], found["objects"]["n"]) == (0.5, 2)


def test_two_extended_boxes_meet_only_in_the_papers_metric():
    # Two chests face each other at 60 cm: each opens, both at once do not (b' against b', paper eq. acoll_metric).
    rows = [object_row("chest", 2.0, 2.0), object_row("chest", 2.0, 2.0 - 0.5 - 0.6, math.pi, number=1)]
    assert collision.are_obstructed(rows, "joints", SWEEPS) == [True, True]


def test_swept_counts_objects_joints_and_doors():
    rows = [
        joint_row("a", clear=False),
        joint_row("a"),
        joint_row("b"),
        joint_row("door", part="door_leaf", clear=False),
        joint_row("b", part="hinge_knob", clear=False),
    ]
    found = collision.swept(iter(rows))
    assert (found["objects"]["successes"], found["objects"]["n"]) == (1, 2)
    assert (found["joints"]["successes"], found["joints"]["n"]) == (1, 3)
    assert (found["doors"]["successes"], found["doors"]["n"]) == (1, 1)
