"""Demands for categories, imposed on expected slots."""

import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.diffusion.codec import CONTINUOUS
from pipeline.diffusion.context import Demand
from pipeline.diffusion.demands import impose

CLASSES = ("bed", "chair", "armchair", "lamp", "desk")
SLOTS = 12


def slots(seed, rooms=1):
    x0 = torch.randn(rooms, SLOTS, CONTINUOUS + len(CLASSES) + 1, generator=torch.Generator().manual_seed(seed))
    x0[..., CONTINUOUS:] *= 1.5
    return x0


def held(room):
    """Return the classes of the occupied slots of a room (N, D)."""
    labels, there = room[:, CONTINUOUS:-1].argmax(-1), room[:, -1] < 0
    return [CLASSES[c] for c, t in zip(labels.tolist(), there.tolist(), strict=True) if t]


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(("least", "most"), [(3, 3), (2, None), (0, 0), (0, 1), (12, None)])
def test_what_is_demanded_is_there(seed, least, most):
    made = impose(slots(seed), [(Demand(("chair",), least, most),)], CLASSES)[0]
    count = held(made).count("chair")
    assert count >= least
    assert most is None or count <= most


def test_the_narrow_demand_counts_for_the_wide_one():
    asked = (Demand(("chair", "armchair"), 3, 3), Demand(("armchair",), 2, 2), Demand(("lamp",), 0, 0))
    for seed in range(8):
        names = held(impose(slots(seed), [asked], CLASSES)[0])
        assert (names.count("armchair"), names.count("chair"), names.count("lamp")) == (2, 1, 0)


def test_rooms_without_demands_and_other_channels_stay():
    x0 = slots(1, rooms=2)
    made = impose(x0, [(), (Demand(("desk",), 2),)], CLASSES)
    assert torch.equal(made[0], x0[0])
    assert torch.equal(made[..., :CONTINUOUS], x0[..., :CONTINUOUS])
    assert impose(x0, [(), ()], CLASSES) is x0


def test_the_likeliest_slots_are_taken():
    x0 = slots(2)
    x0[0, 5, CONTINUOUS + 4], x0[0, 5, -1] = 9.0, -3.0
    made = impose(x0, [(Demand(("desk",), 1, 1),)], CLASSES)[0]
    assert made[5, CONTINUOUS:-1].argmax() == 4
    assert torch.equal(made[5, CONTINUOUS:-1] > 0, torch.tensor([False, False, False, False, True]))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    st.integers(0, 50),
    st.lists(st.tuples(st.sampled_from(CLASSES), st.integers(0, 3), st.integers(0, 2)), max_size=4, unique_by=lambda d: d[0]),
)
def test_separate_demands_are_all_met(seed, asked):
    demands = tuple(Demand((name,), least, least + more) for name, least, more in asked)
    made = impose(slots(seed), [demands], CLASSES)
    names = held(made[0])
    assert torch.isfinite(made).all()
    assert all(d.least <= names.count(d.categories[0]) <= d.most for d in demands)


def test_categories_that_the_model_does_not_know_are_left_alone():
    x0 = slots(3)
    assert torch.equal(impose(x0, [(Demand(("sauna",), 2),)], CLASSES), x0)
