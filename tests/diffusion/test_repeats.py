from itertools import product

import numpy as np
import pytest
import torch

from pipeline import seeds
from pipeline.diffusion.repeats import COUNTED, bound, bounded


def enumerated(chance: np.ndarray, of: int, most: int) -> np.ndarray:
    """The chances (N, C + 1) of each slot given that class `of` is taken at most `most` times, by counting over all outcomes."""
    slots, classes = chance.shape
    found = np.zeros_like(chance)
    for outcome in product(range(classes), repeat=slots):
        if sum(c == of for c in outcome) <= most:
            p = np.prod([chance[i, c] for i, c in enumerate(outcome)])
            for i, c in enumerate(outcome):
                found[i, c] += p
    return found / found.sum(-1, keepdims=True)


@pytest.mark.parametrize("most", [1, 2, 3])
def test_one_bounded_class_is_exact(most):
    rng = seeds.generator(0, "repeats")
    for _ in range(5):
        chance = rng.dirichlet([0.4, 0.4, 0.4], size=5)
        limits = torch.tensor([[most, COUNTED + 1]])
        np.testing.assert_allclose(bounded(torch.from_numpy(chance)[None], limits)[0].numpy(), enumerated(chance, 0, most), rtol=1e-6)


def test_two_that_are_sure_become_one_or_the_other():
    chance = torch.tensor([[[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]], dtype=torch.double)
    found = bounded(chance, torch.tensor([[1, 1]]))
    assert torch.isfinite(found).all()
    torch.testing.assert_close(found.sum(-1), torch.ones(1, 3, dtype=torch.double))
    torch.testing.assert_close(found[0, 2, 1].item(), 1.0)


def test_the_surer_slot_keeps_it():
    chance = torch.tensor([[[0.999, 0.0, 0.001], [0.9, 0.05, 0.05]]], dtype=torch.double)
    found = bounded(chance, torch.tensor([[1, 9]]))
    assert found[0, 0, 0] > 0.95
    assert found[0, 1, 0] < 0.2


def test_what_may_stand_often_is_left_alone():
    chance = torch.from_numpy(seeds.generator(1, "repeats").dirichlet([1, 1, 1], size=(2, 6)))
    torch.testing.assert_close(bounded(chance, torch.full((2, 2), COUNTED + 1)), chance)


def test_the_bound_leaves_out_only_the_rarest_rooms():
    assert bound([1] * 300 + [2], 1000) == 1  # one of a thousand
    assert bound([1] * 300 + [2] * 30, 1000) == 2
    assert bound([1] * 10 + [4], 40) == 4  # of few rooms all count
    assert bound([], 10) == 1
