from itertools import product

import numpy as np
import pytest
import torch

from pipeline import seeds
from pipeline.diffusion.repeats import COUNTED, Bounds, bound, bounded


def chosen_in_turn(chance: np.ndarray, group: list[int], most: int) -> np.ndarray:
    """The chances (N, C + 1) when slots choose in turn, the surest of the group first, which is closed once `most` have taken it: all outcomes counted."""
    share = chance[:, group].sum(1)
    found = np.zeros_like(chance)
    order = np.argsort(-share, kind="stable")
    closed = np.array([0.0 if c in group else 1.0 for c in range(chance.shape[1])])
    for i in range(len(order)):
        slot = order[i]
        for takes in product([True, False], repeat=i):
            p = np.prod([share[order[j]] if t else 1 - share[order[j]] for j, t in enumerate(takes)])
            found[slot] += p * (chance[slot] if sum(takes) < most else chance[slot] * closed)
    return found / found.sum(-1, keepdims=True)


@pytest.mark.parametrize("most", [1, 2, 3])
@pytest.mark.parametrize("group", [[0], [0, 2]])
def test_one_group_is_exact(group, most):
    rng = seeds.generator(0, "repeats")
    members = torch.tensor([[float(c in group)] for c in range(3)])
    for _ in range(5):
        chance = rng.dirichlet([0.4, 0.4, 0.4, 0.4], size=5)
        found = bounded(torch.from_numpy(chance)[None], members, torch.tensor([[most]]))[0].numpy()
        np.testing.assert_allclose(found, chosen_in_turn(chance, group, most), rtol=1e-6, atol=1e-9)


def test_of_two_that_are_sure_one_keeps_it():
    chance = torch.tensor([[[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]], dtype=torch.double)
    found = bounded(chance, torch.eye(2), torch.tensor([[1, 1]]))
    torch.testing.assert_close(found[0, 0, 0].item(), 1.0)
    torch.testing.assert_close(found[0, 2, 1].item(), 1.0)
    assert torch.isfinite(found).all()


def test_the_surer_slot_keeps_it():
    chance = torch.tensor([[[0.9, 0.05, 0.05], [0.999, 0.0, 0.001]]], dtype=torch.double)
    found = bounded(chance, torch.eye(2), torch.tensor([[1, 9]]))
    torch.testing.assert_close(found[0, 1], chance[0, 1])
    assert found[0, 0, 0] < 0.02


def test_what_may_stand_often_is_left_alone():
    chance = torch.from_numpy(seeds.generator(1, "repeats").dirichlet([1, 1, 1], size=(2, 6)))
    torch.testing.assert_close(bounded(chance, torch.eye(2), torch.full((2, 2), COUNTED + 1)), chance)


def test_slots_in_another_order_get_the_same_chances():
    rng = seeds.generator(2, "repeats")
    chance = torch.from_numpy(rng.dirichlet([1, 1, 1, 1], size=6))[None]
    limits = torch.tensor([[1, 2, 1]])
    shuffle = torch.from_numpy(rng.permutation(6))
    torch.testing.assert_close(bounded(chance, torch.eye(3), limits)[:, shuffle], bounded(chance[:, shuffle], torch.eye(3), limits))


def test_bounds_of_rooms():
    held = [(((0,), 1), ((0, 1), 2), ((1,), 1)), ()]
    made = Bounds.of(held, [[([2], 2)], []], classes=3)
    assert made.never.tolist() == [[False, False, False, False], [False] * 4]  # class 2 is not held, but demanded
    assert made.most.tolist() == [[1, 2, 1], [COUNTED + 1] * 3]
    assert made.members.T.tolist() == [[1, 0, 0], [1, 1, 0], [0, 1, 0]]
    wished = Bounds.of(held[:1], [[([0, 1], 3)]], classes=3)
    assert wished.most.tolist() == [[3, 3, 3]]
    assert wished.never[0, 2]


def test_the_bound_leaves_out_only_the_rarest_rooms():
    assert bound([1] * 300 + [2], 1000) == 1  # one of a thousand
    assert bound([1] * 300 + [2] * 30, 1000) == 2
    assert bound([1] * 10 + [4], 40) == 4  # of few rooms all count
    assert bound([], 10) == 1
