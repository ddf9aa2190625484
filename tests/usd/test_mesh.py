"""Meshes that another validator takes: each corner once, one fan of faces about it."""

from __future__ import annotations

from collections import Counter

import numpy as np

from pipeline.rendering.boxes import box, join_meshes
from pipeline.usd.mesh import APART, split_nonmanifold, split_polygons, weld_vertices


def edges(faces):
    """How often each edge, of the points' places, is used."""
    return Counter(tuple(sorted(map(int, e))) for f in faces for e in ((f[0], f[1]), (f[1], f[2]), (f[2], f[0])))


def test_boxes_that_meet_in_an_edge_have_corners_of_their_own():
    mesh = join_meshes("boards", (box("a", (0, 0, 0), (1, 1, 1)), box("b", (1, 1, 0), (2, 2, 1))))
    points, faces, _ = weld_vertices(mesh)
    assert max(edges(faces).values()) == 4
    rows, made = split_nonmanifold(points, faces)
    assert set(edges(made).values()) == {2}
    assert len(np.unique(rows, axis=0)) == len(rows) == 16
    assert np.abs(rows[made] - points[faces]).max() <= 2 * APART


def test_faces_that_run_along_an_edge_the_same_way_are_of_two_surfaces():
    points = np.array([(0, 0, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0)], np.float32)
    rows, made = split_nonmanifold(points, np.array([(0, 1, 2), (0, 1, 3)], np.int32))
    assert len(rows) == 6
    assert not set(made[0]) & set(made[1])
    assert np.abs(rows[made[0]] - points[[0, 1, 2]]).max() <= APART


def test_points_of_faces_that_lie_on_each_other_do_not():
    triangle = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0)], np.float32)
    rows, made = split_nonmanifold(triangle, np.array([(0, 1, 2), (0, 1, 2)], np.int32))
    assert len(np.unique(rows, axis=0)) == len(rows) == 6
    assert np.abs(rows[made] - triangle[[0, 1, 2]]).max() <= 2 * APART


def test_what_is_whole_stays_as_it_is():
    points, faces, _ = weld_vertices(box("a", (0, 0, 0), (1, 1, 1)))
    rows, made = split_nonmanifold(points, faces)
    assert rows is points
    assert made is faces


def test_walls_above_each_other_that_share_a_corner_alone_have_one_each():
    points = np.array([(0, 0, 0), (3, 0, 0), (3, 0, 3), (0, 0, 3), (1, 0, 3), (1, 0, 6), (0, 0, 6), (5, 0, 0), (5, 0, 3)], np.float32)
    below, beside, above = [0, 1, 2, 3], [1, 7, 8, 2], [3, 4, 5, 6]  # a door beside the upper one: it meets no edge of the lower
    rows, made = split_polygons(points, np.full(3, 4, np.int32), np.array([*below, *beside, *above], np.int32))
    first, second, third = map(set, made.reshape(3, 4).tolist())
    assert (len(first & second), len(first & third), len(rows)) == (2, 0, 10)
    assert len(np.unique(rows, axis=0)) == 10
    assert np.abs(rows[made] - points[[*below, *beside, *above]]).max() <= 2 * APART
