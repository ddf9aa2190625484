import numpy as np
import pytest
import shapely

from pipeline.geometry import boxes, polygons

ROOM = np.array([[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4.0]])  # an L


def shapes(seed, n=400):
    rng = np.random.default_rng(seed)
    return boxes.footprints(rng.uniform(0, 4, (n, 2)), rng.uniform(-3, 3, n), rng.uniform(0.1, 1.0, (n, 2)))


def test_excess_is_zero_just_for_what_is_inside():
    made = shapes(0)
    inside = shapely.contains(shapely.Polygon(ROOM).buffer(1e-9), shapely.polygons(made))
    assert np.array_equal([polygons.excess(shape, ROOM) < 1e-7 for shape in made], inside)


def test_excess_is_how_far_one_sticks_out():
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
    for shift in (0.02, 0.5, 3.0):
        assert polygons.excess(square + np.array([3 + shift, 0.5]), ROOM) == pytest.approx(shift)
    # The reflex corner pokes 1 cm into a square that has all its vertices in the room.
    corner = np.array([[2, 2.0]]) + np.array([[-0.3, -0.3]])
    turned = corner + 0.3 * np.array([[1, 0], [0, 1], [-1, 0], [0, -1.0]]) * 1.1
    assert polygons.excess(turned, ROOM) == 0
    assert polygons.excess(turned + 0.17, ROOM) > 0.005


def test_points():
    rng = np.random.default_rng(1)
    points = rng.uniform(-1, 5, (300, 2))
    wanted = shapely.contains_xy(shapely.Polygon(ROOM), points[:, 0], points[:, 1])
    assert np.array_equal([polygons.contains(x, y, ROOM) for x, y in points], wanted)
    distance = shapely.distance(shapely.LinearRing(ROOM), shapely.points(points))
    assert np.allclose([polygons.boundary_distance(x, y, ROOM) for x, y in points], distance)
