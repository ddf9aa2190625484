"""Benchmark `ablations`: its solvers solve, its nets train and sample, and what it says of the layout model's own step is so."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import torch

from benchmarks.ablations.drawing import furnished
from benchmarks.ablations.nets import DiscreteChain, renoised
from benchmarks.ablations.solvers import SOLVERS
from benchmarks.ablations.train import part_of, trained
from benchmarks.ablations.variants import VARIANTS
from pipeline.diffusion.rooms import Sets
from pipeline.diffusion.schedule import denoise
from tests.diffusion.small_world import LAYOUTS
from tests.diffusion.test_schedule import MEAN, SPREAD, exact, noise, still

CPU = torch.device("cpu")


@pytest.mark.parametrize("name", [name for name in SOLVERS if name.endswith("-36")])
def test_every_solver_finds_a_known_distribution(name):
    own = SOLVERS[name]
    made = own.solve(exact, still, noise(), own.levels(36), 1.0)
    assert float(made.mean()) == pytest.approx(MEAN, abs=0.03)
    assert float(made.std()) == pytest.approx(SPREAD, abs=0.05)


def test_a_room_is_taken_on_as_the_sampler_takes_it():
    """`renoised` is one step of `denoise`, and is what training on the sampler's own states means."""
    torch.manual_seed(0)
    first, fresh = torch.randn(3, 5, 40), torch.randn(3, 5, 40)
    drawn = iter([first, fresh])
    seen = []

    def expect(x, level):
        seen.append(x)
        return torch.full_like(x, 0.25)

    denoise(expect, still, lambda: next(drawn), (-1.0, 2.0))
    at = torch.full((3,), -1.0), torch.full((3,), 2.0)
    torch.testing.assert_close(renoised(first, torch.full_like(first, 0.25), *at, fresh), seen[1], rtol=1e-4, atol=1e-5)


@pytest.mark.parametrize("name", ["plain", "x0v", "eps", "selfcond", "unrolled", "discrete", "middle", "share"])
def test_a_variant_trains_and_furnishes_the_rooms_it_is_given(examples, norm, name, monkeypatch):
    words = SimpleNamespace(names=norm.classes, layout_types=LAYOUTS)
    monkeypatch.setattr("benchmarks.ablations.train.taxonomy", SimpleNamespace(load=lambda: words))
    variant = replace(VARIANTS[name], model={"width": 16, "layers": 1, "heads": 2, "relation": 4}, train={"objects": 48})
    trainer, header = trained(variant, Sets(tuple(examples), (), tuple(examples), {}), 3, CPU)
    assert trainer.done == 3
    classes, rows = furnished(trainer.average, header, examples[:4], 0, 3, CPU)
    held = np.concatenate([np.sort(e.classes) for e in examples[:4]])
    assert rows.shape == (len(held), 40)
    assert np.isfinite(rows).all()
    assert (classes == held).all() or isinstance(trainer.net, DiscreteChain)
    assert (classes < len(norm.classes)).all()


def test_fewer_houses_are_fewer_rooms_of_whole_houses(examples):
    some = part_of(examples, 5)
    assert {e.key.split("/")[0] for e in some} == set(sorted({e.key.split("/")[0] for e in examples})[:5])
    assert part_of(examples, 0) == examples
