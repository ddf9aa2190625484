import pytest
import torch

from pipeline.diffusion.batch import moved_rooms, stacked
from pipeline.diffusion.codec import CONTINUOUS, Codec
from pipeline.diffusion.denoiser import Denoiser, from_target
from pipeline.diffusion.settings import ModelSettings
from tests.diffusion.small_world import LAYOUTS


@pytest.fixture(scope="module")
def net(norm):
    torch.manual_seed(0)
    made = Denoiser(norm, len(LAYOUTS), ModelSettings(width=32, layers=2, relation=8)).eval()
    with torch.no_grad():  # zero-initialised heads would make any test of equivariance pass
        for p in made.parameters():
            if p.abs().max() == 0:
                p.normal_(0, 0.1)
    return made


@pytest.fixture(scope="module")
def noisy(examples, norm):
    rooms, _ = stacked(examples[:6], Codec(norm), 24)
    x = torch.randn(6, 24, norm.channels, generator=torch.Generator().manual_seed(1))
    alpha = torch.tensor([0.05, 0.3, 0.6, 0.9, 0.99, 0.9999])
    return rooms, x, alpha, (1 - alpha**2).sqrt()


@torch.no_grad()
def test_a_permutation_of_slots_permutes_the_answer(net, noisy):
    rooms, x, alpha, sigma = noisy
    order = torch.randperm(24, generator=torch.Generator().manual_seed(2))
    whole, logits = net.expected(x, alpha, sigma, rooms)
    mixed, logits_mixed = net.expected(x[:, order], alpha, sigma, rooms)
    torch.testing.assert_close(mixed, whole[:, order], atol=2e-4, rtol=1e-4)
    torch.testing.assert_close(logits_mixed, logits[:, order], atol=2e-2, rtol=1e-4)


@torch.no_grad()
def test_a_turned_room_turns_the_answer(net, noisy):
    rooms, x, alpha, sigma = noisy
    angle = torch.tensor([0.3, 1.0, 1.5708, 2.0, -2.0, 3.1])
    turn = torch.stack([torch.stack([angle.cos(), -angle.sin()], -1), torch.stack([angle.sin(), angle.cos()], -1)], -2)

    def turned(v):
        v = v.clone()
        v[..., :2], v[..., 6:8] = v[..., :2] @ turn.transpose(1, 2), v[..., 6:8] @ turn.transpose(1, 2)
        return v

    whole = net.expected(x, alpha, sigma, rooms)[0]
    assert float(whole[..., :2].abs().mean()) > 0.05
    torch.testing.assert_close(net.expected(turned(x), alpha, sigma, moved_rooms(rooms, turn))[0], turned(whole), atol=2e-3, rtol=1e-3)


@torch.no_grad()
def test_the_order_of_walls_does_not_matter(net, noisy):
    rooms, x, alpha, sigma = noisy
    from dataclasses import replace

    order = torch.randperm(rooms.mask.shape[1], generator=torch.Generator().manual_seed(3))
    shuffled = replace(rooms, **{k: getattr(rooms, k)[:, order] for k in ("ends", "normal", "kind", "hinge", "sill", "mask")})
    torch.testing.assert_close(net.expected(x, alpha, sigma, shuffled)[0], net.expected(x, alpha, sigma, rooms)[0], atol=2e-4, rtol=1e-4)
    torch.testing.assert_close(
        net.expected(x, alpha, sigma, rooms.trimmed())[0], net.expected(x, alpha, sigma, rooms)[0], atol=2e-4, rtol=1e-4
    )


@torch.no_grad()
@pytest.mark.parametrize("what", ["kind", "layout", "count", "ends", "hinge"])
def test_the_answer_depends_on_the_room(net, noisy, what):
    from dataclasses import replace

    rooms, x, alpha, sigma = noisy
    value = getattr(rooms, what)
    other = {
        "kind": torch.where(value == 4, 1, value),
        "layout": 1 - value,
        "count": value + 3,
        "ends": value * 1.2,
        "hinge": -torch.ones_like(value),
    }
    changed = replace(rooms, **{what: other[what]})
    assert not torch.allclose(net.expected(x, alpha, sigma, changed)[0], net.expected(x, alpha, sigma, rooms)[0], atol=1e-5)


@pytest.mark.parametrize("target", ["v", "eps", "x0"])
def test_parametrisations_agree(target):
    rng = torch.Generator().manual_seed(4)
    x0, eps = torch.randn(5, 3, generator=rng), torch.randn(5, 3, generator=rng)
    alpha, sigma = torch.tensor(0.6), torch.tensor(0.8)
    raw = {"v": alpha * eps - sigma * x0, "eps": eps, "x0": x0}[target]
    torch.testing.assert_close(from_target(target, raw, alpha * x0 + sigma * eps, alpha, sigma), x0, atol=1e-5, rtol=1e-5)


@torch.no_grad()
def test_empty_slots_are_expected_to_stay_noise(net, noisy):
    rooms, x, alpha, sigma = noisy
    x = x.clone()
    x[..., CONTINUOUS:] = alpha[:, None, None] * net.codec.one_hot(torch.full((6, 24), net.codec.classes))
    x0, _ = net.expected(x, alpha, sigma, rooms)
    last = slice(-2, None)  # at low noise the empty channel alone decides
    torch.testing.assert_close(x0[last, :, :CONTINUOUS], (alpha[:, None, None] * x[..., :CONTINUOUS])[last], atol=1e-3, rtol=0)
