import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.geometry import boxes, convex


def random_boxes(seed, n=200):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(n, 3)) * 0.6, rng.uniform(-3.1, 3.1, n), rng.uniform(0.2, 1.5, (n, 3))


def test_overlap_areas_are_those_of_shapely():
    a, b = boxes.footprints(*random_boxes(0)), boxes.footprints(*random_boxes(1))
    wanted = shapely.area(shapely.intersection(shapely.polygons(a), shapely.polygons(b)))
    assert np.allclose(boxes.overlap_areas(a, b), wanted, atol=1e-12)


def test_separations_tell_who_is_apart_and_bound_the_distance():
    a, b = boxes.footprints(*random_boxes(2)), boxes.footprints(*random_boxes(3))
    gaps = np.array([convex.gap(p, q) for p, q in zip(a, b, strict=True)])
    distance = shapely.distance(shapely.polygons(a), shapely.polygons(b))
    assert np.array_equal(gaps > 0, distance > 0)
    assert np.all(gaps[gaps > 0] <= distance[gaps > 0] + 1e-12)


def test_depth_is_what_frees_a_shape():
    a, b = boxes.footprints(*random_boxes(4)), boxes.footprints(*random_boxes(5))
    deep = np.array([convex.gap(p, q) for p, q in zip(a, b, strict=True)]) < -1e-6
    # Moved apart by the depth along the right axis they touch: no direction needs less, one needs exactly that.
    angles = np.linspace(0, 2 * np.pi, 721)
    for k in np.flatnonzero(deep)[:10]:
        depth = -convex.gap(a[k], b[k])
        ways = np.stack([np.cos(angles), np.sin(angles)], 1)
        short = np.array([convex.gap(moved, b[k]) for moved in a[k] + 0.98 * depth * ways[:, None]])
        long = np.array([convex.gap(moved, b[k]) for moved in a[k] + 1.02 * depth * ways[:, None]])
        assert short.max() < 0 < long.max()


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**6), st.floats(-3, 3), st.floats(-5, 5), st.floats(-5, 5))
def test_iou_is_symmetric_bounded_and_invariant(seed, angle, dx, dy):
    (pa, ya, sa), (pb, yb, sb) = random_boxes(seed, 20), random_boxes(seed + 1, 20)
    iou = boxes.iou_3d(pa, ya, sa, pb, yb, sb)
    assert np.all((iou >= 0) & (iou <= 1))
    assert np.allclose(iou, boxes.iou_3d(pb, yb, sb, pa, ya, sa), atol=1e-12)
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    shift = np.array([dx, dy, 0.3])
    assert np.allclose(iou, boxes.iou_3d(pa @ turn + shift, ya + angle, sa, pb @ turn + shift, yb + angle, sb), atol=1e-9)


def test_iou_of_known_boxes():
    one = (np.zeros((1, 3)), np.zeros(1), np.ones((1, 3)))
    assert boxes.iou_3d(*one, *one)[0] == pytest.approx(1.0)
    assert boxes.iou_3d(*one, np.array([[0.5, 0, 0]]), np.zeros(1), np.ones((1, 3)))[0] == pytest.approx(1 / 3)
    assert boxes.iou_3d(*one, np.array([[0, 0, 1.0]]), np.zeros(1), np.ones((1, 3)))[0] == 0
    assert boxes.iou_3d(*one, np.zeros((1, 3)), np.array([np.pi / 2]), np.ones((1, 3)))[0] == pytest.approx(1.0)
    # A unit square turned by 45 degrees within itself: the shared octagon has area 2 (sqrt 2 - 1).
    shared = 2 * (np.sqrt(2) - 1)
    assert boxes.iou_3d(*one, np.zeros((1, 3)), np.array([np.pi / 4]), np.ones((1, 3)))[0] == pytest.approx(shared / (2 - shared))


def test_front_faces_minus_y_and_yaw_turns_left():
    corners = boxes.footprints(np.zeros((1, 3)), np.array([np.pi / 2]), np.array([[2.0, 1.0, 1.0]]))[0]
    front = corners[:2].mean(0)
    assert np.allclose(front, [0.5, 0.0])  # at yaw 90 degrees what faced -y faces +x


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.integers(3, 40))
def test_hull_is_that_of_shapely(seed, n):
    points = np.round(np.random.default_rng(seed).normal(size=(n, 2)), 2)
    found = convex.hull(np.ascontiguousarray(points))
    wanted = shapely.MultiPoint(points).convex_hull
    if wanted.geom_type == "Polygon":
        assert shapely.Polygon(found).area == pytest.approx(wanted.area, abs=1e-9)
        assert shapely.Polygon(found).exterior.is_ccw


def test_compiled_and_plain_agree():
    a, b = boxes.footprints(*random_boxes(6, 30)), boxes.footprints(*random_boxes(7, 30))
    for k in range(30):
        assert convex.gap.py_func(a[k], b[k]) == pytest.approx(convex.gap(a[k], b[k]), abs=1e-12)
        x, y = b[k].mean(0)
        assert convex.distance_to(x, y, a[k]) == pytest.approx(shapely.distance(shapely.Polygon(a[k]), shapely.Point(x, y)), abs=1e-12)
