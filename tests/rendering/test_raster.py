from __future__ import annotations

import numpy as np
import pytest

from pipeline.rendering import raster
from pipeline.rendering.raster import darken_edges, fill, oblique, render, shrink, top_down


def square(x0, y0, x1, y1, z):
    return np.array([[[x0, y0, z], [x1, y0, z], [x1, y1, z]], [[x0, y0, z], [x1, y1, z], [x0, y1, z]]], float)


VIEW = top_down(np.zeros(2), np.full(2, 4.0), 64, 64)
WHITE = np.ones((2, 3), np.float32)


def test_a_square_covers_exactly_its_pixels_with_no_seam():
    frame = render(VIEW, square(1, 1, 3, 3, 0.5), WHITE, np.array([7, 7], np.int32))
    assert (frame.item == 7).sum() == 32 * 32
    assert (frame.item[16:48, 16:48] == 7).all()
    assert np.isneginf(frame.depth[frame.item < 0]).all()


def test_bands_of_a_view_are_the_view():
    rng = np.random.Generator(np.random.Philox(5))
    triangles, colours = rng.uniform(0, 4, (40, 3, 3)), rng.uniform(0, 1, (40, 3)).astype(np.float32)
    for view in (VIEW, oblique(triangles.reshape(-1, 3), 0.6, 0.9, 64)):
        whole = render(view, triangles, colours)
        bands = [render(view.rows(*rows), triangles, colours) for rows in ((0, 10), (10, 38), (38, 64))]
        together = np.concatenate([band.item for band in bands])
        assert (together >= 0).any()
        assert (together != whole.item).mean() < 0.003  # edges that go through the centres of pixels


def test_areas_match_the_shoelace_formula():
    rng = np.random.Generator(np.random.Philox(3))
    for _ in range(20):
        corners = rng.uniform(4, 196, (3, 2))
        projected = np.concatenate([corners, np.zeros((3, 1))], axis=1)[None].astype(np.float32)
        frame = fill(projected, WHITE[:1], None, (200, 200), (0, 0, 0))
        (ax, ay), (bx, by) = corners[1] - corners[0], corners[2] - corners[0]
        around = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).sum()
        assert abs((frame.item == 0).sum() - abs(ax * by - ay * bx) / 2) <= around / 2 + 1


def test_the_higher_wins_whatever_the_order():
    low, high = square(0, 0, 4, 4, 0.1), square(1, 1, 3, 3, 0.9)
    for parts in ((low, high), (high, low)):
        heights = np.concatenate(parts)
        frame = render(VIEW, heights, np.ones((4, 3), np.float32))
        assert frame.depth[32, 32] == pytest.approx(0.9)
        assert frame.depth[2, 2] == pytest.approx(0.1)


def test_north_is_up_and_east_is_right():
    frame = render(VIEW, square(3, 3, 4, 4, 0), WHITE)
    rows, columns = np.nonzero(frame.item >= 0)
    assert rows.max() < 16
    assert columns.min() >= 48


def test_depth_is_interpolated_along_a_slope():
    slope = np.array([[[0, 0, 0], [4, 0, 4], [4, 4, 4]], [[0, 0, 0], [4, 4, 4], [0, 4, 0]]], float)
    depth = render(VIEW, slope, WHITE).depth
    assert np.allclose(depth, (np.arange(64) + 0.5) / 16, atol=1e-4)


def test_what_leaves_the_image_is_clipped():
    frame = render(VIEW, square(-50, -50, 50, 50, 0), WHITE)
    assert (frame.item >= 0).all()


def test_nothing_gives_the_background():
    frame = render(VIEW, np.zeros((0, 3, 3)), np.zeros((0, 3), np.float32), background=(0.0, 0.5, 1.0))
    assert (frame.colour == [0, 128, 255]).all()


def test_an_oblique_view_holds_all_points():
    points = np.random.Generator(np.random.Philox(1)).normal(size=(50, 3))
    view = oblique(points, -0.5, 0.4, 128)
    uv = view.project(points)[:, :2]
    assert uv.min() > 0
    assert uv.max() < 128
    assert np.allclose(view.axes @ view.axes.T, np.eye(3), atol=1e-12)


def test_shadows_fall_beside_what_stands_up_only():
    frame = render(VIEW, np.concatenate([square(0, 0, 4, 4, 0), square(1.5, 1.5, 2.5, 2.5, 1.0)]), np.ones((4, 3), np.float32))
    dark = darken_edges(frame, 6, 0.5, reach=0.5)
    assert dark.colour[32, 20, 0] < frame.colour[32, 20, 0]  # the floor beside the block
    assert (dark.colour[30:34, 30:34] == frame.colour[30:34, 30:34]).all()  # its top
    assert (dark.colour[2, 2] == frame.colour[2, 2]).all()  # the floor far away


def test_shrinking_averages():
    frame = render(VIEW, square(0, 0, 2, 4, 0), WHITE, background=(0, 0, 0))
    small = shrink(frame, 64)
    assert small.colour[0, 0, 0] == pytest.approx(frame.colour[..., 0].mean(), abs=1)


def test_compiled_and_plain_draw_the_same(monkeypatch):
    rng = np.random.Generator(np.random.Philox(8))
    projected = rng.uniform(-4, 36, (30, 3, 3)).astype(np.float32)
    colours = rng.uniform(0, 1, (30, 3)).astype(np.float32)
    fast = fill(projected, colours, None, (32, 32), (0, 0, 0))
    monkeypatch.setattr(raster, "_fill", raster._fill.py_func)
    slow = fill(projected, colours, None, (32, 32), (0, 0, 0))
    assert (fast.item == slow.item).all()
    assert (fast.colour == slow.colour).all()
