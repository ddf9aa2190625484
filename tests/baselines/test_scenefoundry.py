import math
from dataclasses import replace

import pytest
import torch

from pipeline import seeds
from pipeline.baselines import diffuscene
from pipeline.baselines.diffuscene import Denoiser, Levels, sample
from pipeline.baselines.job import Trainer
from pipeline.baselines.scenefoundry import Constraints, articulated_collision, loss, quantity, quantity_target
from tests.baselines.conftest import OPENS
from tests.diffusion.small_world import LAYOUTS


def clutter(seed, rooms=4, slots=6):
    """Boxes (rooms, slots, 8) [m] that meet."""
    rng = seeds.generator(seed, "clutter")
    yaw = torch.from_numpy(rng.uniform(-3, 3, (rooms, slots, 1)))
    place, size = torch.from_numpy(rng.uniform(-0.9, 0.9, (rooms, slots, 3))), torch.from_numpy(rng.uniform(0.3, 1.0, (rooms, slots, 3)))
    return torch.cat([place, size, yaw.cos(), yaw.sin()], -1), torch.from_numpy(rng.random((rooms, slots)) < 0.5)


def test_the_target_leaves_the_least_empty_slots():
    logits = torch.tensor([[3.0, -1.0, 0.5, 0.4, 9.0]])
    assert quantity_target(logits, torch.tensor([3])).tolist() == [[1, 0, 0, 0, 1]]
    assert quantity_target(torch.zeros(1, 4), torch.tensor([2])).tolist() == [[0, 0, 1, 1]]  # ties: the earlier slot
    assert quantity_target(logits, torch.tensor([0])).tolist() == [[1] * 5]
    assert quantity_target(logits, torch.tensor([9])).tolist() == [[0] * 5]


def test_quantity_is_the_cross_entropy_of_the_print():
    logits, count = torch.tensor([[2.0, -1.0, 0.5]]), torch.tensor([1])
    chance = [1 / (1 + math.exp(-v)) for v in (2.0, -1.0, 0.5)]
    wanted = -(math.log(chance[0]) + math.log(1 - chance[1]) + math.log(chance[2])) / 3
    assert float(quantity(logits, count)) == pytest.approx(wanted)
    assert float(quantity(logits, torch.tensor([-1]))) == 0


@pytest.mark.parametrize("count", [0, 5, 12, 24])
def test_descending_the_quantity_gives_the_exact_number_and_the_printed_sign_does_not(count, scaling, settings):
    x = torch.zeros(6, 24, scaling.channels)
    x[..., scaling.empty] = torch.randn(6, 24, generator=torch.Generator().manual_seed(count))
    counts = torch.full((6,), count)
    asked = Constraints(scaling, replace(settings, quantity_scale=24.0, articulation_scale=0.0), counts, OPENS)
    down, up = x, x
    for _ in range(30):
        before = quantity(down[..., scaling.empty], counts)
        down = down + 0.3 * asked.descent(down)
        assert (quantity(down[..., scaling.empty], counts) < before).all()
        up = up - 0.3 * asked.descent(up)
    assert (scaling.occupied(down).sum(1) == count).all()
    if count in {5, 12}:
        assert not (scaling.occupied(up).sum(1) == count).any()


def test_no_number_no_guidance(scaling, settings):
    asked = Constraints(scaling, replace(settings, articulation_scale=0.0), torch.tensor([-1, -1]), OPENS)
    assert asked.descent(torch.randn(2, 8, scaling.channels)).abs().max() == 0


def test_collision_counts_ordered_pairs_of_extended_and_resting_boxes():
    two = torch.tensor([[[0.0, 0.0, 0.5, 1.0, 0.6, 1.0, 1.0, 0.0], [0.0, -0.45, 0.5, 1.0, 0.2, 1.0, 1.0, 0.0]]]).double()
    there = torch.ones(1, 2, dtype=torch.bool)
    assert float(articulated_collision(two, there, torch.tensor([[False, False]]))) == 0
    shared = 0.15  # depth .6 becomes .8, to y = -.5; the second reaches from -.55 to -.35
    wanted = shared / (0.8 + 0.2 - shared)
    assert float(articulated_collision(two, there, torch.tensor([[True, False]]))) == pytest.approx(wanted, abs=1e-4)
    assert float(articulated_collision(two, there & torch.tensor([[True, False]]), torch.tensor([[True, True]]))) == 0


def test_collision_does_not_know_where_the_room_lies_nor_in_which_order_things_stand():
    boxes, opens = clutter(0)
    there = torch.ones(opens.shape, dtype=torch.bool)
    phi = articulated_collision(boxes, there, opens)
    assert phi.sum() > 0.5
    angle = torch.tensor(0.7, dtype=torch.float64)
    turn = torch.stack([torch.stack([angle.cos(), -angle.sin()]), torch.stack([angle.sin(), angle.cos()])])
    moved = boxes.clone()
    moved[..., :2] = boxes[..., :2] @ turn.T + torch.tensor([3.0, -2.0])
    moved[..., 6:8] = boxes[..., 6:8] @ turn.T
    torch.testing.assert_close(articulated_collision(moved, there, opens), phi, atol=1e-4, rtol=1e-4)
    mixed = torch.randperm(6, generator=torch.Generator().manual_seed(1))
    torch.testing.assert_close(articulated_collision(boxes[:, mixed], there, opens[:, mixed]), phi)


def test_the_gradient_is_that_of_finite_differences():
    boxes, opens = clutter(1, rooms=2, slots=4)
    there = torch.ones(opens.shape, dtype=torch.bool)
    boxes.requires_grad_()
    (slope,) = torch.autograd.grad(articulated_collision(boxes, there, opens).sum(), boxes)
    step = 1e-6
    for slot in range(4):
        for channel in range(8):
            ahead, behind = boxes.detach().clone(), boxes.detach().clone()
            ahead[:, slot, channel] += step
            behind[:, slot, channel] -= step
            wanted = (articulated_collision(ahead, there, opens) - articulated_collision(behind, there, opens)) / (2 * step)
            torch.testing.assert_close(slope[:, slot, channel], wanted, atol=1e-5, rtol=1e-3)


def test_descending_the_collision_lowers_it_and_the_printed_sign_climbs(world, scaling, settings):
    x = scaling.encode(world[1])
    x[..., :2] *= 0.4  # crowded
    asked = Constraints(scaling, replace(settings, articulation_scale=0.02), torch.full((len(x),), -1), OPENS)

    def phi(slots):
        return articulated_collision(scaling.metric(slots[..., :8]), scaling.occupied(slots), OPENS[scaling.labels(slots)])

    start, down, up = phi(x), x, x
    for _ in range(20):
        down, up = down + asked.descent(down), up - asked.descent(up)
    assert float(phi(down).sum()) < 0.8 * float(start.sum())
    assert float(phi(up).sum()) > 1.1 * float(start.sum())
    assert torch.equal(down[..., 8:], x[..., 8:])


def test_guidance_is_sigma_times_the_descent(world, scaling, settings):
    x = scaling.encode(world[1])
    asked = Constraints(scaling, settings, torch.full((len(x),), 3), OPENS)
    torch.testing.assert_close(asked(x, 20, 0.01), 0.01 * asked.descent(x))
    assert asked(x, 20, 0.01).abs().max() > 0


def test_steps_between_levels_are_those_of_the_posterior():
    levels = Levels.linear(1000)
    assert diffuscene.levels_of(levels, 1000) == list(range(1000, 0, -1))
    few = diffuscene.levels_of(levels, 100)
    assert (few[0], few[-1]) == (1000, 1)
    assert set(range(1, 10)) <= set(few)  # PhyScene's window
    assert 80 <= len(few) <= 100
    assert few == sorted(few, reverse=True)


@pytest.fixture(scope="module")
def trained(world, scaling, settings):
    """A denoiser that learnt the small rooms."""
    torch.manual_seed(0)
    net = Denoiser(scaling, len(LAYOUTS), settings)
    trainer = Trainer("toy", net, diffuscene.loss, settings, 0)
    losses = [trainer.step(*world, torch.ones(len(world[0]))).loss for _ in range(250)]
    assert sum(losses[-50:]) < 0.8 * sum(losses[:50])
    return trainer.average


def test_guidance_alone_gives_the_number_that_is_asked_for(trained, world, scaling, settings):
    rooms = world[0].rows(torch.arange(24))
    counts = torch.arange(24) % 4 + 2
    free = scaling.occupied(sample(trained, rooms, torch.Generator().manual_seed(1))).sum(1)
    s = replace(settings, quantity_scale=400.0, articulation_scale=0.0)
    guide = Constraints(scaling, s, counts, OPENS)
    made = scaling.occupied(sample(trained, rooms, torch.Generator().manual_seed(1), guide)).sum(1)
    assert (free == counts).float().mean() < 0.6
    assert (made == counts).float().mean() >= 0.9


def test_without_penalty_eq_1_is_plain_denoising_and_with_it_the_target_moves_down(world, scaling, settings):
    torch.manual_seed(1)
    net = Denoiser(scaling, len(LAYOUTS), replace(settings, iou_weight=0.0))
    plain = diffuscene.loss(net, *world, torch.Generator().manual_seed(2)).detach()
    net.settings = replace(net.settings, train_quantity_scale=0.0, train_articulation_scale=0.0)
    torch.testing.assert_close(loss(net, *world, torch.Generator().manual_seed(2), OPENS), plain)
    net.settings = replace(net.settings, train_quantity_scale=500.0)
    assert abs(float(loss(net, *world, torch.Generator().manual_seed(2), OPENS).detach() - plain)) > 1e-3


def test_an_exact_prediction_has_no_loss_and_gives_x0_back(world, scaling, settings):
    torch.manual_seed(3)
    net = Denoiser(scaling, len(LAYOUTS), settings)
    x0, t, noise, x = diffuscene.add_noise(net, world[1], torch.Generator().manual_seed(4))
    alpha, sigma = net.levels.of(t)
    raw = alpha * noise - sigma * x0
    assert float(diffuscene.denoising(net, raw, x0, noise, t)) < 1e-9
    torch.testing.assert_close(diffuscene.clean(raw, x, alpha, sigma), x0, atol=2e-3, rtol=0)
    off = diffuscene.denoising(net, raw + 0.1, x0, noise, t)
    assert float(off) == pytest.approx(3 * 0.01 * float((alpha**2).mean()), rel=1e-3)
