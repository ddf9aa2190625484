from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.affinity import rotate
from shapely.geometry import Polygon, box

from pipeline.geometry.tiling import convex_cover, convex_pieces

FRAME = box(0, 0, 6, 4).difference(box(0.24, 0.24, 3, 3.76)).difference(box(3.12, 0.24, 5.76, 3.76))


def is_convex(ring):
    a, b = np.roll(ring, -1, axis=0) - ring, np.roll(ring, -2, axis=0) - np.roll(ring, -1, axis=0)
    return bool(np.all(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] > -1e-9))


def assert_tiles(region, pieces):
    parts = [Polygon(p) for p in pieces]
    assert all(is_convex(p) for p in pieces)
    assert sum(p.area for p in parts) == pytest.approx(region.area, rel=1e-6)
    assert shapely.union_all(parts).symmetric_difference(region).area < 1e-6 * region.area


@pytest.mark.parametrize("angle", [0, 17, 90, 133])
def test_a_ring_with_two_holes_is_tiled(angle):
    region = rotate(FRAME, angle, origin=(0, 0))
    assert_tiles(region, convex_pieces(region))


def test_walls_stay_long_rectangles():
    pieces = convex_pieces(FRAME)
    assert len(pieces) == 5  # two long sides, two short ones, the wall between
    assert all(len(p) == 4 for p in pieces)


def test_walls_are_covered_by_fewer_rectangles_than_tile_them():
    crossing = shapely.union_all([box(0, 2, 9, 2.2), box(0, 5, 9, 5.2), box(3, 0, 3.2, 9), box(6, 0, 6.2, 9)])
    found = convex_cover(crossing)
    assert len(found) == 4 < len(convex_pieces(crossing))
    assert shapely.union_all([Polygon(p) for p in found]).symmetric_difference(crossing).area < 1e-6


rectangles = st.tuples(st.integers(0, 8), st.integers(0, 8), st.integers(1, 5), st.integers(1, 5))


@settings(max_examples=40, deadline=None)
@given(st.lists(rectangles, min_size=1, max_size=5), st.sampled_from([0.0, 30.0]))
def test_any_union_of_rectangles_is_tiled(rects, angle):
    region = rotate(shapely.union_all([box(x, y, x + w, y + h) for x, y, w, h in rects]), angle, origin=(0, 0))
    assert_tiles(region, convex_pieces(region))


@settings(max_examples=40, deadline=None)
@given(st.lists(rectangles, min_size=1, max_size=5), st.sampled_from([0.0, 30.0]))
def test_any_region_is_covered(blocks, angle):
    region = rotate(shapely.union_all([box(x, y, x + w, y + h) for x, y, w, h in blocks]), angle, origin=(0, 0))
    pieces = convex_cover(region)
    assert all(is_convex(p) for p in pieces)
    assert shapely.union_all([Polygon(p) for p in pieces]).symmetric_difference(region).area < 1e-6 * region.area
