import copy
import math
from dataclasses import replace

import torch
from torch import nn

from pipeline.diffusion.checkpoint import Header, build_net
from pipeline.diffusion.optimiser import Optimiser, is_hidden, orthogonalise, squares
from pipeline.diffusion.settings import ModelSettings, TrainSettings
from pipeline.tensors import advance
from tests.diffusion.small_world import LAYOUTS

SETTINGS = TrainSettings(ModelSettings(width=8))


class Layered(nn.Module):
    """One hidden matrix that stands for two, and one input."""

    def __init__(self):
        super().__init__()
        self.enter = nn.Linear(4, 8)
        self.blocks = nn.ModuleList([nn.Linear(8, 16, bias=False)])


def net(seed=0):
    torch.manual_seed(seed)
    return Layered()


def descend(made, optimiser, steps, rate=0.02):
    """Fit a random linear map; returns the losses."""
    x = torch.randn(64, 4, generator=torch.Generator().manual_seed(1))
    y = x @ torch.randn(4, 16, generator=torch.Generator().manual_seed(2))
    losses = []
    for _ in range(steps):
        loss = ((made.blocks[0](made.enter(x)) - y) ** 2).mean()
        loss.backward()
        advance(optimiser, rate, math.inf)
        losses.append(float(loss.detach()))
    return losses


def test_singular_values_come_near_1():
    made = torch.randn(5, 12, 20, generator=torch.Generator().manual_seed(0)) * torch.logspace(-3, 3, 5)[:, None, None]
    values = torch.linalg.svdvals(orthogonalise(made))
    assert values.min() > 0.7
    assert values.max() < 1.3
    assert torch.isfinite(orthogonalise(torch.zeros(1, 4, 4))).all()


def test_the_directions_of_a_matrix_stay():
    made = torch.randn(1, 8, 8, generator=torch.Generator().manual_seed(1))
    u, _, v = torch.linalg.svd(made)
    torch.testing.assert_close(u.transpose(1, 2) @ orthogonalise(made) @ v.transpose(1, 2), torch.eye(8)[None], atol=0.3, rtol=0)


def test_a_matrix_that_stands_for_several_is_moved_in_parts():
    made = net()
    optimiser = Optimiser(made, SETTINGS)
    assert list(optimiser.matrices) == ["blocks.0.weight"]
    before = made.blocks[0].weight.detach().clone()
    made.blocks[0].weight.grad = torch.cat([torch.randn(8, 8), 1e-3 * torch.randn(8, 8)])
    made.enter.weight.grad, made.enter.bias.grad = torch.zeros(8, 4), torch.zeros(8)
    advance(optimiser, 0.1, math.inf)
    upper, lower = (float(part.norm()) for part in squares(before - made.blocks[0].weight.detach(), 8))
    assert 0.8 < upper / lower < 1.25  # a small gradient moves its part as far as a large one
    assert made.blocks[0].weight.grad is None


def test_it_descends():
    made = net()
    losses = descend(made, Optimiser(made, SETTINGS), 100)
    assert losses[-1] < 0.1 * losses[0]


def test_adamw_throughout_has_no_matrices_of_muon():
    made = net()
    optimiser = Optimiser(made, replace(SETTINGS, optimiser="adamw"))
    assert not optimiser.matrices
    losses = descend(made, optimiser, 100)
    assert losses[-1] < 0.5 * losses[0]


def test_moments_come_back():
    whole, resumed = net(), net()
    ours, theirs = Optimiser(whole, SETTINGS), Optimiser(resumed, SETTINGS)
    descend(whole, ours, 3)
    descend(resumed, theirs, 3)
    again = Optimiser(resumed, SETTINGS)
    again.load_state_dict(copy.deepcopy(theirs.state_dict()))
    assert descend(whole, ours, 3) == descend(resumed, again, 3)


def test_hidden_matrices_of_the_denoiser(norm):
    made = build_net(Header(norm, LAYOUTS, 12, ModelSettings(32, 2, 1, 4, 8), 16))
    chosen = {name for name, p in made.named_parameters() if is_hidden(name, p, 32)}
    assert {"passes.0.blocks.0.look.weight", "passes.1.blocks.0.think.2.weight", "floor_keys.weight", "passes.1.point.weight"} <= chosen
    assert (
        not {
            "slot.weight",
            "kind.weight",
            "passes.0.head.weight",
            "passes.0.modulation.weight",
            "layout.weight",
            "passes.1.pair_bias.weight",
        }
        & chosen
    )
    assert all(part.shape[0] == 32 for name, p in made.named_parameters() if name in chosen for part in squares(p, 32))
