import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import Polygon

from pipeline.sources.threed_front.floors import outline


def triangles(*quads):
    made = []
    for x0, z0, x1, z1 in quads:
        a, b, c, d = (x0, 0, z0), (x1, 0, z0), (x1, 0, z1), (x0, 0, z1)
        made += [[a, c, b], [a, d, c]]
    return np.array(made, float)


def test_rectangle():
    floor = outline(triangles((0, 0, 4, 3)))
    assert floor.polygon.tolist() == [[0, -3], [4, -3], [4, 0], [0, 0]]
    assert floor.area == 12


@given(st.permutations(range(8)), st.lists(st.booleans(), min_size=8, max_size=8))
def test_order_and_winding_do_not_matter(order, flips):
    """An L of four quads, triangles in any order and any winding."""
    whole = triangles((0, 0, 2, 2), (2, 0, 4, 2), (0, 2, 2, 4), (0, 4, 2, 5))
    mixed = np.array([t[::-1] if flip else t for t, flip in zip(whole[list(order)], flips, strict=True)])
    a, b = outline(whole), outline(mixed)
    assert a.polygon.tolist() == b.polygon.tolist()
    assert a.area == pytest.approx(14)
    assert len(a.polygon) == 6


def test_counter_clockwise_without_collinear_points():
    polygon = outline(triangles((0, 0, 1, 3), (1, 0, 4, 3))).polygon
    assert len(polygon) == 4
    assert Polygon(polygon).exterior.is_ccw


def test_slivers_gaps_and_pieces():
    sliver = np.array([[[0, 0, 0], [1, 0, 0], [2, 0, 0]]], float)  # no area
    floor = outline(np.concatenate([triangles((0, 0, 4, 3), (4.0001, 0, 6, 3), (9, 0, 10, 1)), sliver]))
    assert floor.area == pytest.approx(18, abs=0.01)
    assert floor.pieces == 2
    assert floor.lost == pytest.approx(1, abs=0.01)


def test_no_area():
    assert outline(np.zeros((3, 3, 3))) is None
    assert outline(np.zeros((0, 3, 3))) is None
