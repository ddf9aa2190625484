import numpy as np
import pytest

from pipeline import seeds
from pipeline.entities.asset import Asset, Link, Material, Mesh
from pipeline.errors import ContentError
from pipeline.latents.surface import surface_points, triangles


def box_asset(size, meshes=True, name="a"):
    w, d, h = size
    v = np.array([[x, y, z] for x in (-w / 2, w / 2) for y in (-d / 2, d / 2) for z in (0, h)], np.float32)
    f = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    mesh = Mesh("box", v, np.array(f, np.int32))
    link = Link("base", (mesh,) if meshes else (), (), 1.0, np.zeros(3), np.eye(3))
    return Asset(name, "cabinet", np.array(size, float), (link,), (), (Material("m"),), "test", name, "CC0-1.0")


def test_the_shape_is_centred_and_its_largest_side_is_one():
    corners = triangles(box_asset((2.0, 1.0, 0.5))).reshape(-1, 3)
    np.testing.assert_allclose(corners.max(0), [0.5, 0.25, 0.125], atol=1e-6)
    np.testing.assert_allclose(corners.min(0), [-0.5, -0.25, -0.125], atol=1e-6)


def test_a_scaled_asset_has_the_same_shape():
    a, b = (triangles(box_asset(s)) for s in ((1.2, 0.6, 0.9), (2.4, 1.2, 1.8)))
    np.testing.assert_allclose(a, b, atol=1e-6)


def test_points_lie_on_the_surface_by_area():
    corners = triangles(box_asset((2.0, 1.0, 0.5)))
    points = surface_points(seeds.generator(0, "points"), corners, 4000)
    assert points.shape == (4000, 3)
    half = np.array([0.5, 0.25, 0.125])
    on = np.isclose(np.abs(points), half, atol=1e-5)
    assert on.any(1).all()
    top = on[:, 2].mean()  # 2 (2 x 1) of 2 (2 + 1 + 0.5)
    assert top == pytest.approx(2 / 3.5, abs=0.01)


def test_the_generator_alone_decides():
    corners = triangles(box_asset((1, 1, 1)))
    one, two, other = (surface_points(seeds.generator(0, "points", k), corners, 64) for k in (0, 0, 1))
    np.testing.assert_array_equal(one, two)
    assert not np.array_equal(one, other)


def test_degenerate_triangles_are_survived():
    flat = np.zeros((3, 3, 3))
    assert np.isfinite(surface_points(seeds.generator(0, "p"), flat, 10)).all()


def test_an_asset_without_surface_is_named():
    with pytest.raises(ContentError, match="bare"):
        triangles(box_asset((1, 1, 1), meshes=False, name="bare"))
