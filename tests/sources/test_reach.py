"""What of a body is come to from outside."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull

from pipeline.sources.meshes.near_boxes import CORNERS
from pipeline.sources.meshes.reach import make_reach_test

SIDES = [
    ((0, 0, 0), (1, 1, 0.02)),
    ((0, 0, 0), (0.02, 1, 1)),
    ((0.98, 0, 0), (1, 1, 1)),
    ((0, 0.98, 0), (1, 1, 1)),
    ((0, 0, 0.98), (1, 1, 1)),
]
FRONT = ((0, 0, 0), (1, 0.02, 1))


def comes(boxes, points, cell=0.01):
    hulls = [np.array(low) + CORNERS * (np.array(high) - np.array(low)) for low, high in boxes]
    return make_reach_test(hulls, [ConvexHull(h).equations for h in hulls], cell)(np.array(points, float)).tolist()


def test_nothing_comes_into_a_cabinet_that_is_shut():
    within, before = [0.5, 0.5, 0.5], [0.5, -0.01, 0.5]
    assert comes([*SIDES, FRONT], [within, before]) == [False, True]
    assert comes(SIDES, [within, before]) == [True, True]


def test_a_gap_is_shut_where_it_is_narrower_than_a_cell_and_open_where_it_is_wider_than_two():
    below = ((0, 0, 0), (1, 0.02, 0.90))  # a front of 0.9 m under a lid at 0.98 m
    assert comes([*SIDES, below], [[0.5, 0.5, 0.5]], 0.1) == [False]
    assert comes([*SIDES, below], [[0.5, 0.5, 0.5]], 0.02) == [True]


def test_what_stands_is_not_come_to_from_below():
    tub = [*SIDES[1:4], FRONT, SIDES[4]]  # open towards the floor alone
    assert comes(tub, [[0.5, 0.5, 0.5]]) == [False]
