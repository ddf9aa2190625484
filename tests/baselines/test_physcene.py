import numpy as np
import pytest
import torch
from shapely import Polygon

from pipeline.baselines.boxes import boxes_of
from pipeline.baselines.physcene import CLIP, MOVES, Guidance, Obstacles, beyond, handles, robots, ways
from pipeline.geometry.boxes import footprints
from tests.baselines.conftest import OPENS

SQUARE = np.array([[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]])
CORNERED = np.array([[0, 0], [6, 0], [6, 4], [4, 4], [4, 2], [2, 2], [2, 4], [0, 4]], float)  # a U that opens upwards


def room(*boxes):
    """Boxes (1, n, 8) of (x, y, w, d), 1 m high on the floor."""
    return torch.tensor([[[x, y, 0.5, w, d, 1.0, 1.0, 0.0] for x, y, w, d in boxes]])


def guidance(scaling, *polygons):
    return Guidance(scaling, polygons, OPENS)


def slope(guide, boxes, opens=None):
    boxes = boxes.requires_grad_()
    there = torch.ones(boxes.shape[:2], dtype=torch.bool)
    total = guide.penalty(boxes, there, there & False if opens is None else opens)
    return torch.autograd.grad(total.sum(), boxes)[0]


def test_what_lies_beyond_the_walls_is_outside_and_as_deep_as_there_is_room():
    for polygon in (SQUARE, CORNERED):
        walls = beyond(polygon)
        plans = [Polygon(p) for p in footprints(walls[:, :2], np.arctan2(walls[:, 7], walls[:, 6]), walls[:, 3:5])]
        assert all(p.intersection(Polygon(polygon)).area < 1e-6 for p in plans)
    assert sorted(walls[:, 4].round(3).tolist()) == [2, 2, *[50] * 6]  # the two walls of the notch see each other


def test_the_room_term_pushes_in_and_collisions_push_apart(scaling):
    guide = guidance(scaling, SQUARE)
    assert float(slope(guide, room((1.9, 0, 0.6, 0.6)))[0, 0, 0]) > 0.1  # descending moves it to smaller x
    two = slope(guide, room((-0.2, 0.0, 0.6, 0.6), (0.2, 0.0, 0.6, 0.6)))
    assert float(two[0, 0, 0]) > 1e-3
    assert float(two[0, 1, 0]) < -1e-3


def test_robots_stand_in_what_cuts_the_room_in_two():
    bar = Obstacles(np.array([[0.0, 0.0, 0.5]]), np.array([[4.2, 0.5, 1.0]]), np.zeros(1), np.zeros(1, bool))
    at = robots(SQUARE, bar)
    assert 2 <= len(at) <= 4
    assert (abs(at[:, 1]) <= 0.3).all()
    gap = Obstacles(bar.centre + np.array([0.8, 0, 0]), bar.size, bar.yaw, bar.opens)
    assert len(robots(SQUARE, gap)) == 0
    assert len(robots(SQUARE, Obstacles(bar.centre + np.array([0, 0, 2]), *bar[1:]))) == 0  # it hangs over the robot


def test_robots_go_to_what_opens():
    centre, size = np.array([[0.0, 1.7, 0.5], [0.0, 1.05, 0.4]]), np.array([[1.0, 0.6, 1.0], [3.98, 0.4, 0.8]])
    opens = np.array([True, False])
    assert len(robots(SQUARE, Obstacles(centre, size, np.zeros(2), opens))) > 0
    handle = handles(Obstacles(centre, size, np.zeros(2), opens))
    assert handle.tolist() == [[0.0, pytest.approx(1.7 - 0.3 - 0.2 - 0.1 - 0.05)]]


def test_the_third_term_pushes_furniture_off_the_way(scaling):
    guide = guidance(scaling, SQUARE)
    boxes = room((0.3, 0.0, 4.4, 0.5)).requires_grad_()
    there = torch.ones(1, 1, dtype=torch.bool)
    blocked = guide.way_overlap(boxes_of(boxes), there, ~there)
    assert float(blocked.detach()) > 0
    (pushed,) = torch.autograd.grad(blocked.sum(), boxes)
    assert pushed[..., :2].abs().max() > 0


def test_ways_go_round_what_is_dear():
    cost = np.full((9, 9), 0.01)
    cost[4, :8] = 1.0
    (way,) = ways(cost, (0, 0), [(8, 0)])
    assert way[0].tolist() == [8, 0]
    assert way[-1].tolist() == [0, 0]
    assert cost[way[:, 0], way[:, 1]].max() == 0.01
    assert (abs(np.diff(way, axis=0)).max(1) == 1).all()


def test_only_places_and_yaws_move_by_a_bounded_step_at_the_last_levels(world, scaling):
    x = scaling.encode(world[1].rows(torch.arange(6)))
    x[..., :2] *= 1.6
    guide = guidance(scaling, *[SQUARE] * 6)
    assert guide(x, 10, 1e-4).abs().max() == 0
    shift = guide(x, 9, 1e-4)
    assert 0 < float(shift.abs().max()) <= CLIP + 1e-6
    still = [c for c in range(x.shape[-1]) if c not in MOVES]
    assert shift[..., still].abs().max() == 0
    assert shift[~scaling.occupied(x)].abs().max() == 0
    alone = Guidance(scaling, [SQUARE], OPENS)(x[3:4], 9, 1e-4)
    torch.testing.assert_close(alone, shift[3:4], atol=1e-5, rtol=1e-4)
