import math

import numpy as np
import pytest

from pipeline.metrics.collision import openable_reach
from pipeline.metrics.reach import reach, room_reach
from tests.metrics.rows_of import joint_row, moved_rows, object_row, room_row

ROOM = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]])


def test_what_stands_free_is_reached():
    assert room_reach(ROOM, [object_row("chest", 2.0, 2.74), object_row("chair", 1, 1)]) == pytest.approx(1.0)
    assert room_reach(ROOM, []) == 1.0


def test_a_part_that_is_cut_off_weighs_as_much_as_its_floor():
    # Beds end to end cut the room (3 m deep) at y = 0.8..2.4 into a lower and an upper strip; one object in each.
    wall = [object_row("bed", 1.0, 1.6, math.pi / 2, number=1), object_row("bed", 3.0, 1.6, math.pi / 2, number=2)]
    found = room_reach(ROOM, [*wall, object_row("nightstand", 0.3, 0.25), object_row("nightstand", 0.4, 2.75, number=3)])
    lower, upper = 0.8 - 0.3, 0.6 - 0.3  # of the strips, what the robot's centre can use
    assert 0.7 < found < 0.8  # of four objects three touch each strip
    only_lower = room_reach(ROOM, [*wall, object_row("nightstand", 0.3, 0.25)])
    assert only_lower == pytest.approx((lower + 2 / 3 * upper) / (lower + upper), abs=0.08)


def test_it_turns_with_the_room():
    rows = [object_row("bed", 1.2, 1.6, 0.3), object_row("chest", 3.0, 2.5), object_row("chair", 3.4, 0.6)]
    here = room_reach(ROOM, rows)
    turned = room_reach(np.stack([-ROOM[:, 1], ROOM[:, 0]], 1), moved_rows(rows, math.pi / 2, (0, 0)))
    shifted = room_reach(ROOM + np.array([7.3, -2.1]), moved_rows(rows, 0, (7.3, -2.1)))
    assert turned == pytest.approx(here, abs=0.02)
    assert shifted == pytest.approx(here, abs=0.02)


def test_the_mean_runs_over_furnished_rooms():
    rooms = [room_row(1), room_row(0, room="empty")]
    found = reach(np.random.default_rng(0), rooms, [object_row("chair", 1, 1)])
    assert (found["mean"], found["n"]) == (1.0, 1)


def test_openable_reach_wants_free_way_and_a_place_to_stand():
    rows = [joint_row("a"), joint_row("a", clear=False), joint_row("b", stand=None), joint_row("c", clear=False)]
    found = openable_reach([*rows, joint_row("door", part="door_leaf"), joint_row("d", part="hinge_knob")])
    assert (found["objects"]["successes"], found["objects"]["n"]) == (1, 3)
    assert (found["joints"]["successes"], found["joints"]["n"]) == (1, 4)
