from pathlib import Path

import numpy as np
import pytest
import torch

from pipeline.diffusion.batch import collate, moved_rooms, room_batch
from pipeline.diffusion.checkpoint import load_weights
from pipeline.diffusion.codec import CHANNELS, YAW, Codec
from pipeline.diffusion.context import RoomContext, floor_tokens
from pipeline.diffusion.poses import POSES, TURNED, UNTOLD
from pipeline.diffusion.set_transformer import SetTransformer
from pipeline.diffusion.settings import ModelSettings
from tests.diffusion.small_world import LAYOUTS

RELEASED = Path(__file__).parents[2] / "weights" / "denoiser.safetensors"


@pytest.fixture(scope="module", params=[1, 2])
def net(norm, request):
    torch.manual_seed(0)
    made = SetTransformer(norm, len(LAYOUTS), ModelSettings(width=32, passes=request.param, layers=1, relation=8)).eval()
    with torch.no_grad():  # zero-initialised heads would make any test of equivariance pass
        for p in made.parameters():
            if p.abs().max() == 0:
                p.normal_(0, 0.1)
        made.pose.weight[UNTOLD] = 0.0  # as it begins, and no gradient moves it
    return made


@pytest.fixture(scope="module")
def noisy(examples, norm):
    rooms, objects = collate(examples[:6], Codec(norm), 8)
    x = torch.randn(6, 8, CHANNELS, generator=torch.Generator().manual_seed(1))
    return rooms, objects.classes, x, torch.tensor([-5.0, -2.0, 0.0, 2.0, 4.0, 8.0])


@torch.no_grad()
def test_a_permutation_of_objects_permutes_the_answer(net, noisy):
    rooms, classes, x, level = noisy
    order = torch.randperm(8, generator=torch.Generator().manual_seed(2))
    whole = net.expected(x, classes, level, rooms)
    torch.testing.assert_close(net.expected(x[:, order], classes[:, order], level, rooms), whole[:, order], atol=2e-4, rtol=1e-4)


@torch.no_grad()
def test_a_turned_room_gets_the_turned_answer(net, noisy):
    rooms, classes, x, level = noisy
    angle = torch.tensor([0.3, 1.0, 2.0, -1.2, 0.7, 3.0])
    turn = torch.stack([torch.stack([angle.cos(), -angle.sin()], -1), torch.stack([angle.sin(), angle.cos()], -1)], -2)

    def turned(v):
        v = v.clone()
        v[..., :2], v[..., YAW] = v[..., :2] @ turn.transpose(1, 2), v[..., YAW] @ turn.transpose(1, 2)
        return v

    found = net.expected(turned(x), classes, level, moved_rooms(rooms, turn))
    torch.testing.assert_close(found, turned(net.expected(x, classes, level, rooms)), atol=5e-4, rtol=1e-3)


@torch.no_grad()
def test_padding_and_other_rooms_change_nothing(net, noisy):
    rooms, classes, x, level = noisy
    whole = net.expected(x, classes, level, rooms)
    spoilt = torch.where((classes == net.codec.classes)[..., None], 9.0, x)
    held = classes < net.codec.classes
    torch.testing.assert_close(net.expected(spoilt, classes, level, rooms)[held], whole[held], atol=1e-5, rtol=1e-5)
    first = torch.tensor([0])
    alone = net.expected(x[:1], classes[:1], level[:1], rooms.rows(first))
    torch.testing.assert_close(alone, whole[:1], atol=1e-4, rtol=1e-4)


@torch.no_grad()
def test_rooms_in_one_list_get_the_answers_of_padded_ones(net, noisy):
    rooms, classes, x, _ = noisy
    held = classes < net.codec.classes
    poses = torch.where(held, torch.arange(8) % len(POSES), UNTOLD)
    for level in (-5.0, 0.0, 2.0, 6.0):
        at = torch.full((len(x),), level)
        padded, expect = net.expected(x, classes, at, rooms, poses=poses), net.expectation(rooms, classes, poses)
        listed = expect(x, level)
        torch.testing.assert_close(listed[held], padded[held], atol=2e-3, rtol=1e-3)
        again = net.expected(
            x, classes, at, rooms, before=padded, poses=poses
        )  # what was expected is seen the next time; in units of the noise, rounding grows
        torch.testing.assert_close(expect(x, level)[held], again[held], atol=2e-2, rtol=1e-2)
        assert not listed[~held].any()
    assert held.any(1).all()
    assert not held.all()


@torch.no_grad()
def test_a_shared_code_saves_nothing_but_time(net, noisy):
    rooms, classes, x, level = noisy
    code = net.floor_code(rooms, classes)
    torch.testing.assert_close(net.expected(x, classes, level, rooms, code), net.expected(x, classes, level, rooms))


@torch.no_grad()
def test_a_pose_that_is_told_matters_and_one_that_is_not_says_nothing(net, noisy):
    rooms, classes, x, level = noisy
    whole = net.expected(x, classes, level, rooms)
    torch.testing.assert_close(net.expected(x, classes, level, rooms, poses=torch.full_like(classes, UNTOLD)), whole)
    assert not torch.allclose(net.expected(x, classes, level, rooms, poses=torch.full_like(classes, TURNED)), whole, atol=1e-3)


@torch.no_grad()
def test_classes_walls_and_doors_matter(net, noisy):
    rooms, classes, x, level = noisy
    whole = net.expected(x, classes, level, rooms)
    held = classes < net.codec.classes
    swapped = torch.where(held, (classes + 1) % net.codec.classes, classes)
    assert not torch.allclose(net.expected(x, swapped, level, rooms)[held], whole[held], atol=1e-4)
    moved = moved_rooms(rooms, 1.2 * torch.eye(2).expand(6, 2, 2))
    assert not torch.allclose(net.expected(x, classes, level, moved)[held], whole[held], atol=1e-4)


def test_every_pass_is_trained(net, noisy):
    rooms, classes, x, level = noisy
    answers = net(x, classes, level, rooms, poses=torch.full_like(classes, TURNED))
    assert len(answers) == net.settings.passes
    sum((a**2).mean() for a in answers).backward()
    assert all(p.grad is not None for p in net.parameters())
    assert not net.pose.weight.grad[UNTOLD].any()
    net.zero_grad()


@torch.no_grad()
def test_what_is_expected_stays_within_what_data_can_be(net, noisy):
    rooms, classes, x, level = noisy
    for far in (10.0, 1e4, 1e8):
        x0 = net.expected(far * x, classes, level, rooms)
        assert torch.isfinite(x0).all()
        assert x0.abs().max() <= 8


@torch.no_grad()
def test_codes_of_other_rooms_stay_within_those_of_the_training_rooms(net, noisy):
    rooms, classes = noisy[:2]
    net.unbound_rooms()
    own = net.floor_code(rooms, classes).room
    many = torch.zeros(6, 24, dtype=classes.dtype)
    free = net.floor_code(rooms, many).room
    net.bound_rooms(rooms, classes)
    assert torch.equal(net.floor_code(rooms, classes).room, own)
    bounded = net.floor_code(rooms, many).room
    net.unbound_rooms()
    low, high = own.aminmax(dim=0)
    assert not torch.equal(bounded, free)
    assert torch.equal(bounded, free.clamp(low, high))


UNSEEN = {
    "four chairs": ("dining_room", (7, 4.5), ["dining_table", *["dining_chair"] * 4]),
    "nine chairs": ("dining_room", (7, 4.5), ["dining_table", *["dining_chair"] * 9]),
    "16 chairs": ("dining_room", (7, 4.5), ["dining_table", *["dining_chair"] * 16]),
    "23 chairs": ("dining_room", (7, 4.5), ["dining_table", *["dining_chair"] * 23]),
    "a bathroom of 30 m2": ("bathroom", (6, 5), ["toilet", "vanity", "shower"]),
    "a bedroom of 120 m2": ("bedroom", (12, 10), ["double_bed", "nightstand", "wardrobe"]),
    "a corridor of 30 m": ("hallway", (30, 1.2), ["shoe_cabinet"]),
    "a kitchen without base cabinets": ("kitchen", (2.5, 1.9), ["refrigerator", "oven", "sink_cabinet", "ceiling_lamp"]),
    "a kitchen of wall cabinets": ("kitchen", (3, 3), ["sink_cabinet", *["wall_cabinet"] * 9]),
    "a bathroom of beds": ("bathroom", (4, 3), ["double_bed"] * 5),
}


@pytest.mark.parametrize("room", UNSEEN)
@torch.no_grad()
def test_released_weights_answer_rooms_unlike_any_that_they_were_trained_on(room):
    net, _, header = load_weights(RELEASED)
    layout, (w, d), categories = UNSEEN[room]
    context = RoomContext(layout, np.array([[0, 0], [w, 0], [w, d], [0, d]], float), ())
    rooms = room_batch([floor_tokens(context)], [header.layouts.index(layout)], [2.7])
    classes = torch.tensor([[header.norm.classes.index(name) for name in categories]])
    x = torch.randn(1, len(categories), CHANNELS, generator=torch.Generator().manual_seed(0))
    for level in (-4.0, -1.0, 1.0):
        assert net(x, classes, torch.tensor([level]), rooms)[-1].abs().max() < 30.0
