import numpy as np
import pytest

from pipeline import seeds
from pipeline.diffusion.context import Proposal, RoomContext
from pipeline.experiments.baselines import Case, compare, controlled, holds

OPENS = {"nightstand": True, "chair": False}


def square(side):
    return RoomContext("bedroom", np.array([[0, 0], [side, 0], [side, side], [0, side]], float))


def thing(name, x, y=1.0):
    return Proposal(name, np.array([x, y, 0.0]), 0.0, np.array([0.5, 0.5, 0.5]), np.zeros(32, np.float32))


@pytest.fixture
def cases():
    return [Case(square(side), [thing("nightstand", 1), thing("chair", 2)]) for side in (2.0, 3.0, 4.0)]


def test_a_copy_of_the_truth_has_the_truths_figures(cases):
    found = compare(seeds.generator(0, "t"), {"copy": lambda rooms: [c.real for c in cases[: len(rooms)]]}, cases, OPENS, [2, 3])
    assert found["copy"]["ckl"] == found["real"]["ckl"]
    assert found["copy"]["ckl"]["real_to_generated"] == 0
    assert found["real"]["r_acoll"]["objects"]["rate"] == 0
    assert found["real"]["chance"]["2"]["rate"] == 1
    assert found["real"]["chance"]["3"]["rate"] == 0
    assert "cpu_seconds_per_room" in found["copy"]


def test_harm_is_seen(cases):
    def bad(rooms):
        return [[thing("nightstand", 1), thing("nightstand", 1.1), thing("chair", 1, 0.45)] for _ in rooms]

    found = compare(seeds.generator(0, "t"), {"bad": bad}, cases, OPENS, [2])["bad"]
    assert found["r_acoll"]["objects"]["rate"] == 1
    assert found["collision"]["col_obj"]["rate"] > 0.6
    assert found["objects"]["mean"] == 3
    assert found["ckl"]["real_to_generated"] > 0
    assert found["chance"]["2"]["successes"] == 0


def test_a_way_that_is_blocked_only_when_opened_counts(cases):
    def near(rooms):
        return [[thing("nightstand", 1), thing("chair", 1, 0.45)] for _ in rooms]  # 5 cm before a front that opens by 17

    found = compare(seeds.generator(0, "t"), {"near": near}, cases, OPENS, [2])["near"]
    assert found["r_acoll"]["objects"]["rate"] == 1
    assert found["collision"]["col_obj"]["rate"] == 0


def test_numbers_are_asked_of_rooms_that_can_hold_them(cases):
    asked = []

    def furnish(rooms):
        asked.append([r.n_target for r in rooms])
        return [[thing("chair", k) for k in range(r.n_target)] for r in rooms]

    found = controlled(furnish, cases, [2, 7], 10)
    assert asked == [[2, 2, 2], [7, 7]]
    assert found["7"] | {"low": 0} == {"rate": 1.0, "low": 0, "high": 1.0, "successes": 2, "n": 2}
    assert [holds(c, 7) for c in cases] == [False, True, True]
