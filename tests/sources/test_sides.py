"""No hull has more sides than PhysX takes."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from pipeline.sources.meshes.mesh_solids import hull
from pipeline.sources.meshes.near_boxes import SIDES, count_sides, with_few_sides


def disc(count=16, radius=0.6):
    """A round table's top with an edge that is rounded, its corners in turn."""
    a = 2 * np.pi * np.arange(count) / count
    rings = [(radius - 0.004, 0.0, 0.0), (radius, 0.004, 0.5), (radius, 0.029, 0.0), (radius - 0.004, 0.033, 0.5)]
    turned = [(r, z, a + 2 * np.pi * turn / count) for r, z, turn in rings]
    return np.concatenate([np.column_stack([r * np.cos(b), r * np.sin(b), np.full(count, z)]) for r, z, b in turned])


def test_a_round_top_stays_level_and_wide():
    corners, faces, _ = hull(disc())
    assert count_sides(ConvexHull(corners)) > SIDES
    found, _ = with_few_sides(corners, faces, 0.02)
    top = found[found[:, 2] > found[:, 2].max() - 1e-9]
    assert count_sides(ConvexHull(found)) <= SIDES
    assert found[:, 2].max() == pytest.approx(0.033)
    assert (ConvexHull(top[:, :2]).equations[:, 2] < -0.53).all()  # no side of the level top is nearer to its middle


def test_what_would_lose_more_than_it_may_stays():
    corners, faces, _ = hull(disc())
    assert with_few_sides(corners, faces, 0.001)[0] is corners


def test_a_plain_piece_stays():
    box, faces, _ = hull(np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float))
    assert with_few_sides(box, faces, 0.02)[0] is box


def test_a_rod_that_leans_has_corners_all_around():
    a = 2 * np.pi * np.arange(16) / 16
    shape = [(0.003, 0.0), (0.005, 0.002), (0.005, 0.4), (0.003, 0.402)]
    rod = np.concatenate([np.column_stack([r * np.cos(a), r * np.sin(a), np.full(16, z)]) for r, z in shape])
    turn = np.linalg.qr(np.array([[1.0, 0.3, 0.9], [0.2, 1.0, 0.8], [0.5, 0.4, 1.0]]))[0]
    corners, faces, volume = hull(rod @ turn.T)
    found, _ = with_few_sides(corners, faces, 0.02)
    assert count_sides(ConvexHull(found)) <= SIDES
    assert ConvexHull(found).volume > 0.7 * volume
