import math

import torch

from pipeline.baselines.rooms import outline, outlines
from tests.diffusion.small_world import CLASSES, make_examples


def test_the_outline_lies_on_the_walls_and_looks_inwards(settings):
    example = make_examples(1)[0]
    points = outline(example.floor, 40)
    half = abs(points[:, :2]).max(0)
    assert (abs(abs(points[:, :2]) - half) < 1e-6).any(1).all()
    assert ((points[:, :2] * points[:, 2:]).sum(1) < 0).all()  # the origin is the middle of the room


def test_four_quarters_are_none_and_one_is_a_quarter(world):
    rooms, things = world
    ones = torch.ones(len(rooms), dtype=torch.long)
    turned, there = rooms.turned(ones), things.turned(ones)
    torch.testing.assert_close(rooms.turned(4 * ones).points, rooms.points)
    torch.testing.assert_close(things.turned(4 * ones).boxes, things.boxes)
    torch.testing.assert_close(turned.points[..., 0], -rooms.points[..., 1])
    torch.testing.assert_close(there.boxes[..., 1], things.boxes[..., 0])
    yaw = torch.atan2(there.boxes[..., 7], there.boxes[..., 6]) - torch.atan2(things.boxes[..., 7], things.boxes[..., 6])
    held = things.classes < len(CLASSES)
    torch.testing.assert_close(torch.cos(yaw[held] - math.pi / 2), torch.ones(int(held.sum())))


def test_slots_decode_to_what_was_encoded(world, scaling):
    _, things = world
    for quarters in range(4):
        turned = things.turned(torch.full((len(things.classes),), quarters))
        x = scaling.encode(turned)
        assert x.shape[-1] == scaling.channels
        assert float(x.abs().max()) <= 1
        found, held = scaling.decode(x), turned.classes < len(CLASSES)
        assert torch.equal(found.occupied, held)
        assert torch.equal(found.labels[held], turned.classes[held])
        torch.testing.assert_close(found.boxes[held], turned.boxes[held], atol=1e-5, rtol=0)
        assert x[~held][:, :8].abs().max() == 0


def test_boxes_hang_on_their_centres(world):
    _, things = world
    lamp = things.boxes[things.classes == CLASSES.index("pendant_lamp")]
    assert lamp[:, 2].min() > 1.8 + 0.2
    bed = things.boxes[things.classes == CLASSES.index("double_bed")]
    torch.testing.assert_close(bed[:, 2], bed[:, 5] / 2)


def test_rooms_stack(settings):
    examples = make_examples(3)
    found = outlines([e.floor for e in examples], [0, 1, 0], 9)
    assert found.points.shape == (3, 9, 4)
    assert len(found.rows(torch.tensor([2]))) == 1
