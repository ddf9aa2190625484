"""Retrieved assets are moved out of walls and of what they stand flush with, and nothing else is moved."""

import numpy as np
import pytest

from pipeline.relations.walls import STRAIGHT
from pipeline.retrieval.wall_alignment import CLEAR, part, put_before_walls, straightened

ROOM = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]])
SIZE = np.array([1.0, 0.6, 0.9])


@pytest.mark.parametrize("yaw", [0.0, np.pi / 2, np.pi, -np.pi / 2])
@pytest.mark.parametrize("deep", [0.003, 0.05, 0.11])
def test_what_sticks_into_a_wall_comes_to_stand_before_it(yaw, deep):
    back = np.array([-np.sin(yaw), np.cos(yaw)])
    middle = np.array([2.0, 1.5])
    to_wall = 1.5 if abs(back[1]) > 0.5 else 2.0
    moved = put_before_walls(np.array([*(middle + back * (to_wall - SIZE[1] / 2 + deep)), 0.0]), yaw, SIZE, ROOM)
    np.testing.assert_allclose(moved, [*(middle + back * (to_wall - SIZE[1] / 2 - CLEAR)), 0.0], atol=1e-9)


def test_what_is_in_the_room_or_far_beyond_a_wall_or_too_large_stays():
    for position, size in (([2.0, 2.6, 0.0], SIZE), ([2.0, 3.2, 0.0], SIZE), ([2.0, 1.5, 0.0], np.array([1.0, 3.1, 1.0]))):
        np.testing.assert_array_equal(put_before_walls(np.array(position), 0.0, size, ROOM), position)


def test_flush_neighbours_part_along_the_side_by_which_they_meet():
    centres = np.array([[1.0, 1.0, 0.0], [1.95, 1.1, 0.0], [1.0, 1.55, 0.0]])
    yaws, sizes = np.array([0.0, np.pi, np.pi / 2]), np.array([[1.0, 0.6, 0.9], [1.0, 0.6, 0.9], [0.6, 1.0, 0.9]])
    moved = part(centres[:2], yaws[:2], sizes[:2], ROOM)
    np.testing.assert_allclose(moved, [[1.0 - 0.026, 1.0, 0.0], [1.95 + 0.026, 1.1, 0.0]], atol=1e-9)
    moved = part(centres[[0, 2]], yaws[[0, 2]], sizes[[0, 2]], ROOM)
    np.testing.assert_allclose(moved[1] - moved[0], [0.0, 0.6 + CLEAR, 0.0], atol=1e-9)


def test_who_stands_in_a_corner_stays_there_and_the_next_makes_room():
    """A refrigerator at the wall, then two units: all three end flush, none in the wall."""
    centres = np.array([[0.505, 2.6, 0.0], [1.45, 2.6, 0.0], [2.4, 2.6, 0.0]])
    moved = part(centres, np.zeros(3), np.tile(SIZE, (3, 1)), ROOM)
    assert moved[0, 0] - 0.5 >= CLEAR - 1e-9
    assert np.all(np.diff(moved[:, 0]) >= 1.0 - 1e-4)
    assert np.all(np.diff(moved[:, 0]) <= 1.0 + 2 * CLEAR)


def test_what_reaches_deep_or_stands_askew_or_apart_or_above_stays():
    for second, yaw in (([1.6, 1.0, 0.0], 0.0), ([1.95, 1.0, 0.0], 0.4), ([2.05, 1.0, 0.0], 0.0), ([1.95, 1.0, 1.4], 0.0)):
        centres = np.array([[1.0, 1.0, 0.0], second])
        np.testing.assert_array_equal(part(centres, np.array([0.0, yaw]), np.tile(SIZE, (2, 1)), ROOM), centres)


def test_what_is_hardly_turned_stands_straight_and_what_is_turned_stays_so():
    askew = np.array([[0.0, 0.0], [4.0, 1.0], [3.2, 4.2], [-0.8, 3.2]])  # no wall along an axis
    wall = np.arctan2(1.0, 4.0)
    little, much = STRAIGHT * 0.9, STRAIGHT * 1.1
    asked = wall + np.array([little, -little, np.pi / 2 + little, np.pi - little, much, -much])
    straight = wall + np.array([0.0, 0.0, np.pi / 2, np.pi, much, -much])
    np.testing.assert_allclose(straightened(asked, askew), straight, atol=1e-12)


def test_units_that_touch_get_their_clearance():
    centres = np.array([[1.0, 2.6, 0.0], [2.0, 2.6, 0.0]])
    moved = part(centres, np.zeros(2), np.tile(SIZE, (2, 1)), ROOM)
    assert moved[1, 0] - moved[0, 0] == pytest.approx(SIZE[0] + CLEAR)
