import math

import numpy as np
import pytest
import torch
from shapely import Polygon

from pipeline import seeds
from pipeline.baselines.boxes import Boxes, boxes_of, extend_front, iou, mates, overlaps, shared_area
from pipeline.geometry.boxes import footprints, iou_3d


def drawn(rng, count, *, square=False):
    """Random boxes (count, 8); `square` takes quarter turns and a coarse grid, so that sides coincide."""
    place, size, yaw = rng.uniform(-0.8, 0.8, (count, 3)), rng.uniform(0.2, 1.6, (count, 3)), rng.uniform(-3, 3, count)
    if square:
        place, size, yaw = np.round(place * 2) / 2, np.ceil(size), rng.integers(0, 4, count) * math.pi / 2
    return torch.from_numpy(np.concatenate([place, size, np.cos(yaw)[:, None], np.sin(yaw)[:, None]], 1))


def polygons(boxes):
    b = boxes.numpy()
    return [Polygon(p) for p in footprints(b[:, :2], np.arctan2(b[:, 7], b[:, 6]), b[:, 3:5])]


@pytest.mark.parametrize("square", [False, True])
def test_the_shared_area_is_that_of_the_polygons(square):
    rng = seeds.generator(0, "areas", int(square))
    a, b = drawn(rng, 400, square=square), drawn(rng, 400, square=square)
    found = shared_area(boxes_of(a), boxes_of(b)).numpy()
    wanted = np.array([p.intersection(q).area for p, q in zip(polygons(a), polygons(b), strict=True)])
    np.testing.assert_allclose(found, wanted, atol=1e-4)
    assert (wanted > 0.05).sum() > 150
    assert (wanted == 0).sum() > 10


def test_iou_agrees_with_the_judges():
    rng = seeds.generator(1, "ious")
    a, b = drawn(rng, 300), drawn(rng, 300)
    sides = []
    for x in (a.numpy(), b.numpy()):
        bottom = x[:, :3] - x[:, 3:6] * [0, 0, 0.5]
        sides += [bottom, np.arctan2(x[:, 7], x[:, 6]), x[:, 3:6]]
    np.testing.assert_allclose(iou(boxes_of(a), boxes_of(b)).numpy(), iou_3d(*sides), atol=1e-4)


def test_a_box_is_itself():
    own = boxes_of(drawn(seeds.generator(2, "own"), 50))
    torch.testing.assert_close(iou(own, own), torch.ones(50, dtype=torch.float64), atol=1e-3, rtol=0)


def test_gradients_are_those_of_finite_differences():
    rng = seeds.generator(3, "slopes")
    a, b = drawn(rng, 40), drawn(rng, 40)
    a.requires_grad_()
    (slope,) = torch.autograd.grad(iou(boxes_of(a), boxes_of(b)).sum(), a)
    step = 1e-6
    for channel in range(8):
        ahead, behind = a.detach().clone(), a.detach().clone()
        ahead[:, channel] += step
        behind[:, channel] -= step
        wanted = (iou(boxes_of(ahead), boxes_of(b)) - iou(boxes_of(behind), boxes_of(b))) / (2 * step)
        torch.testing.assert_close(slope[:, channel], wanted, atol=1e-5, rtol=1e-4)
    assert slope.abs().sum(0).min() > 0.1


def test_what_opens_grows_by_a_third_of_its_depth_to_the_front():
    box = torch.tensor([[1.0, 2.0, 0.5, 0.8, 0.6, 1.0, 1.0, 0.0]]).double()  # yaw 0: the front looks to -y
    (grown,) = polygons_of(extend_front(boxes_of(box), torch.tensor([True])))
    assert grown.bounds == pytest.approx((0.6, 1.5, 1.4, 2.3))
    (same,) = polygons_of(extend_front(boxes_of(box), torch.tensor([False])))
    assert same.bounds == pytest.approx((0.6, 1.7, 1.4, 2.3))


def polygons_of(boxes: Boxes):
    return polygons(torch.cat([boxes.centre, 2 * boxes.half, boxes.axis], -1))


def test_sums_over_pairs_are_those_of_a_loop():
    rng = seeds.generator(4, "pairs")
    rooms = drawn(rng, 15).view(3, 5, 8)
    there = torch.from_numpy(rng.random((3, 5)) < 0.7)
    boxes = boxes_of(rooms)
    found = overlaps(boxes, boxes, mates(there))
    for n in range(3):
        held = torch.nonzero(there[n])[:, 0]
        one = [iou(boxes.at(torch.tensor(n), i), boxes.at(torch.tensor(n), j)) for i in held for j in held if i != j]
        assert float(found[n]) == pytest.approx(float(sum(one)))
