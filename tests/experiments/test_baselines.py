import numpy as np
import pytest

from pipeline import seeds
from pipeline.diffusion.context import Proposal, RoomContext
from pipeline.experiments.baselines import Case, figures, holds, liveable, rooms_with_target, success
from pipeline.relations.model import Relations

OPENS = {"nightstand": True, "chair": False}


def judged(cases, drafts):
    return figures(seeds.generator(0, "t"), cases, drafts, [case.real for case in cases], OPENS, [2, 3])


def square(side):
    return RoomContext("bedroom", np.array([[0, 0], [side, 0], [side, side], [0, side]], float))


def thing(name, x, y=1.0):
    return Proposal(name, np.array([x, y, 0.0]), 0.0, np.array([0.5, 0.5, 0.5]), np.zeros(32, np.float32))


@pytest.fixture
def cases():
    return [Case(square(side), [thing("nightstand", 1), thing("chair", 2)], f"h{side}/r") for side in (2.0, 3.0, 4.0)]


def test_a_copy_of_the_truth_has_the_truths_figures(cases):
    found = judged(cases, [case.real for case in cases])
    assert found["ckl"]["real_to_generated"] == 0
    assert found["r_acoll"]["objects"]["rate"] == 0
    assert found["chance"]["2"]["rate"] == 1
    assert found["chance"]["3"]["rate"] == 0


def test_harm_is_seen(cases):
    found = judged(cases, [[thing("nightstand", 1), thing("nightstand", 1.1), thing("chair", 1, 0.45)]] * 3)
    assert found["r_acoll"]["objects"]["rate"] == 1
    assert found["collision"]["col_obj"]["rate"] > 0.6
    assert found["objects"]["mean"] == 3
    assert found["ckl"]["real_to_generated"] > 0
    assert found["chance"]["2"]["successes"] == 0


def test_a_way_that_is_blocked_only_when_opened_counts(cases):
    found = judged(cases, [[thing("nightstand", 1), thing("chair", 1, 0.45)]] * 3)  # 5 cm before a front that opens by 17
    assert found["r_acoll"]["objects"]["rate"] == 1
    assert found["collision"]["col_obj"]["rate"] == 0


def test_numbers_are_asked_of_rooms_that_can_hold_them(cases):
    assert [holds(c, 7) for c in cases] == [False, True, True]
    assert [r.n_target for r in rooms_with_target(cases, 7, 10)] == [7, 7]
    assert [r.n_target for r in rooms_with_target(cases, 100, 10)] == [100] * 3  # none can: all are asked
    assert len(rooms_with_target(cases, 2, 2)) == 2
    assert success([[thing("chair", 1)] * n for n in (2, 3, 2, 0)], 2)["rate"] == 0.5


def test_relations_and_the_forest_tell_a_jumble_from_the_truth():
    def bedroom(side, at, yaw):
        bed = Proposal("double_bed", np.array([side / 2, side - 1.05, 0.0]), 0.0, np.array([1.8, 2.0, 0.5]), np.zeros(32, np.float32))
        stand = Proposal("nightstand", np.array([*at, 0.0]), yaw, np.array([0.5, 0.4, 0.5]), np.zeros(32, np.float32))
        return [bed, stand]

    sides = np.linspace(3.6, 5.0, 20)
    true = [bedroom(s, (s / 2 - 1.2, s - 0.25), 0.0) for s in sides]
    jumble = [bedroom(s, (0.6 + k % 3, 0.6), 2.0) for k, s in enumerate(sides)]
    rooms = [Case(square(s), t, f"h{s}/r") for s, t in zip(sides, true, strict=True)]
    found = liveable(seeds.generator(0, "t"), 0, rooms, {"real": true, "copy": true, "jumble": jumble}, Relations({}, {}))
    assert found["real"]["relations"]["nightstand at the bed"]["rate"] == 1
    assert found["jumble"]["relations"]["nightstand at the bed"]["rate"] == 0
    assert found["jumble"]["sca"]["rate"] > 0.9
    assert found["copy"]["sca"]["rate"] <= 0.6
    assert "sca" not in found["real"]
