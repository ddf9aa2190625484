"""Hulls that are nearly boxes become boxes: whichever way they lie, and never further out than NEAR; what is round stays as it is."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import nnls
from scipy.spatial.transform import Rotation

from pipeline.sources.meshes.colliders import build_link, solids
from pipeline.sources.meshes.mesh_solids import hull, signed_volume
from pipeline.sources.meshes.near_boxes import NEAR, simplify_to_box
from pipeline.sources.settings import ModelLimits
from tests.sources import mobility


def away(point, vertices):
    """Return how far a point is from the convex hull of vertices: a least-squares problem, no geometry of ours in it."""
    weights, _ = nnls(np.vstack([vertices.T, np.full(len(vertices), 1e3)]), np.append(point, 1e3))
    return float(np.linalg.norm(vertices.T @ (weights / weights.sum()) - point))


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000))
def test_a_rounded_board_is_a_box_that_holds_it_and_stands_out_by_less_than_the_bound(seed):
    rng = np.random.default_rng(seed)
    size = rng.uniform((0.2, 0.1, 0.015), (1.2, 0.6, 0.05))
    vertices, _ = mobility.board(-size / 2, size / 2, int(rng.integers(2, 8)), rng.uniform(0.0005, 0.004))
    R = Rotation.random(rng=rng).as_matrix() if seed % 3 else np.eye(3)
    corners, faces, volume = hull(vertices @ R.T + rng.uniform(-1, 1, 3))
    made, sides = simplify_to_box(corners, faces)
    assert (len(made), len(sides)) == (8, 12)
    assert signed_volume(made, sides) >= volume - 1e-12  # outwards, and no smaller
    assert trimesh.Trimesh(made, sides, process=False).is_watertight
    a = made[sides[:, 0]]
    normals = np.cross(made[sides[:, 1]] - a, made[sides[:, 2]] - a)
    heights = (corners @ normals.T - (normals * a).sum(axis=1)) / np.linalg.norm(normals, axis=1)
    assert heights.max() < 1e-9
    assert max(away(corner, corners) for corner in made) <= NEAR


@pytest.mark.parametrize(
    "mesh",
    [trimesh.creation.icosphere(2, 0.3), trimesh.creation.cylinder(0.2, 0.6), trimesh.creation.box((0.3, 0.3, 0.3)).slice_plane((0.1, 0.1, 0.1), (-1, -1, -1), cap=True),
     trimesh.creation.cylinder(0.005, 0.004)],
)  # fmt: skip
def test_what_is_round_or_cut_off_stays_as_it_is(mesh):
    corners, faces, _ = hull(np.asarray(mesh.vertices, float))
    made, sides = simplify_to_box(corners, faces)
    assert made is corners
    assert sides is faces


def test_colliders_of_a_cabinet_of_rounded_boards_have_eight_corners_and_weigh_the_same():
    meshes = mobility.cabinet(np.random.default_rng(0))[0].meshes
    made = build_link("body", (), solids("body", meshes, ModelLimits(), None), 600.0)
    assert {len(piece.vertices) for piece in made.colliders} == {8}
    assert made.mass == pytest.approx(600 * sum(abs(signed_volume(v, f)) for v, f in meshes[:4]), rel=0.2)
