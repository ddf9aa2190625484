from __future__ import annotations

import numpy as np
import trimesh

from pipeline.rendering.boxes import box, triangles
from pipeline.rendering.normals import corner_normals, smooth_normals


def test_a_sphere_is_smooth():
    ball = trimesh.creation.icosphere(3)
    vertices, faces = np.asarray(ball.vertices), np.asarray(ball.faces, np.int32)
    normals = smooth_normals(vertices, faces)
    assert normals is not None
    assert np.allclose(normals, vertices[faces].reshape(-1, 3), atol=0.02)


def test_a_box_is_flat_even_with_many_vertices():
    loose = triangles(box("b", (0, 0, 0), (1, 2, 3)))
    assert smooth_normals(loose.reshape(-1, 3), np.arange(36, dtype=np.int32).reshape(-1, 3)) is None
    normals = corner_normals(loose)
    assert np.allclose(np.abs(normals).max(axis=2), 1.0)
    assert np.allclose(normals[:, 0], normals[:, 2])


def test_a_cylinder_is_smooth_around_and_sharp_at_its_rim():
    tube = trimesh.creation.cylinder(radius=1.0, height=2.0, sections=48)
    faces = np.asarray(tube.faces, np.int32)
    normals = smooth_normals(np.asarray(tube.vertices), faces).reshape(-1, 3, 3)
    cap = np.abs(tube.face_normals[:, 2]) > 0.9
    assert np.allclose(np.abs(normals[cap][..., 2]), 1.0, atol=1e-5)
    assert np.allclose(normals[~cap][..., 2], 0.0, atol=1e-5)
