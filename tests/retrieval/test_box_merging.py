import numpy as np
import pytest

from pipeline import seeds
from pipeline.retrieval.index import merged_boxes, volume
from pipeline.retrieval.wall_alignment import keep_at_walls


@pytest.mark.parametrize("most", [1, 2, 4])
def test_every_box_lies_in_a_merged_one(most):
    rng = seeds.generator(0, "boxes")
    for _ in range(20):
        low = rng.uniform(-1, 1, (9, 3))
        boxes = np.stack([low, low + rng.uniform(0.1, 0.5, (9, 3))], 1)
        merged = merged_boxes(boxes, most)
        assert len(merged) == most
        for box in boxes:
            assert any((m[0] <= box[0]).all() and (m[1] >= box[1]).all() for m in merged)


def test_few_boxes_stay_as_they_are():
    boxes = np.array([[[0, 0, 0], [1, 1, 1]], [[2, 0, 0], [3, 1, 1]]], float)
    np.testing.assert_array_equal(merged_boxes(boxes, 4), boxes)
    assert merged_boxes(np.zeros((0, 2, 3)), 4).shape == (0, 2, 3)


def test_neighbours_merge_before_strangers():
    boxes = np.array([[[0, 0, 0], [1, 1, 1]], [[5, 0, 0], [6, 1, 1]], [[0, 0, 1], [1, 1, 2]]], float)
    merged = merged_boxes(boxes, 2)
    assert sorted(volume(merged)) == [1, 2]


ROOM = np.array([[0, 0], [4, 0], [4, 3], [0, 3]], float)
ASKED, SMALLER = np.array([1.0, 0.6, 0.8]), np.array([0.8, 0.5, 0.8])


def test_a_back_at_the_wall_stays_at_the_wall():
    position = np.array([2.0, 2.7, 0.0])  # back flush with the wall y = 3
    np.testing.assert_allclose(keep_at_walls(position, 0.0, ASKED, SMALLER, ROOM), [2.0, 2.75, 0.0])


def test_a_corner_keeps_both_sides():
    position = np.array([0.5, 2.7, 0.0])
    np.testing.assert_allclose(keep_at_walls(position, 0.0, ASKED, SMALLER, ROOM), [0.4, 2.75, 0.0])


def test_in_the_middle_nothing_moves():
    position = np.array([2.0, 1.5, 0.3])
    np.testing.assert_allclose(keep_at_walls(position, 0.4, ASKED, SMALLER, ROOM), position)


@pytest.mark.parametrize("turn", [0.5, 1.5707963, 3.0])
def test_a_turned_room_turns_the_answer(turn):
    c, s = np.cos(turn), np.sin(turn)
    rotation = np.array([[c, -s], [s, c]])
    position = np.array([0.5, 2.7, 0.0])
    plain = keep_at_walls(position, 0.0, ASKED, SMALLER, ROOM)
    turned = keep_at_walls(np.array([*(rotation @ position[:2]), 0.0]), turn, ASKED, SMALLER, ROOM @ rotation.T)
    np.testing.assert_allclose(turned[:2], rotation @ plain[:2], atol=1e-9)
