from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull

from pipeline.entities.asset import Mesh
from pipeline.sources.meshes.mesh_solids import distances_outside, hull
from pipeline.usd.corners import ALIKE, with_distinct_corners


def mesh_of(points):
    corners, faces, _ = hull(np.asarray(points, float))
    return Mesh("piece", corners.astype(np.float32), faces.astype(np.int32))


def bevelled(size, edge):
    """A box of a size (3,) whose edges are cut off by `edge` [m]."""
    half = np.array(size) / 2
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    cut = [half - edge * (1 - np.eye(3)[k]) for k in range(3)]
    return mesh_of(np.concatenate([signs * inner for inner in cut]))


def test_a_box_with_fine_edges_stands_on_four_corners_on_the_same_level():
    box = bevelled((0.38, 0.34, 0.25), 0.001)
    assert len(box.vertices) == 24
    fewer = with_distinct_corners(box)
    z = fewer.vertices[:, 2]
    for level in (z.min(), z.max()):
        assert (np.abs(z - level) < 1e-6).sum() == 4
    assert np.ptp(z) == np.ptp(box.vertices[:, 2])


def test_what_is_left_is_as_large_as_corners_are_alike():
    for seed in range(5):
        rng = np.random.default_rng(seed)
        shape = mesh_of(rng.normal(size=(60, 3)) * [0.01, 0.02, 0.03])
        fewer = with_distinct_corners(shape)
        left_out = distances_outside(shape.vertices.astype(np.float64), ConvexHull(fewer.vertices.astype(np.float64)).equations)
        assert left_out.max() <= ALIKE
        away = np.linalg.norm(fewer.vertices[:, None] - fewer.vertices[None], axis=2)
        assert away[~np.eye(len(away), dtype=bool)].min() > ALIKE


def test_coarse_edges_and_thin_sheets_stay_as_they_are():
    for shape in (bevelled((0.3, 0.2, 0.1), 0.005), bevelled((0.3, 0.2, 0.003), 0.0005)):
        assert with_distinct_corners(shape) is shape
