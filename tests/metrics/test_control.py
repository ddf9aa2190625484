"""Quantity, walkable area, openable counts."""

import numpy as np
import pytest

from pipeline.metrics import control
from tests.metrics.rows_of import room_row


def test_quantity_counts_exact_hits():
    found = control.quantity([room_row(m, asked_objects=a) for a, m in ((8, 8), (5, 5), (5, 4), (5, 5))])
    assert list(found) == ["5", "8"]
    assert found["5"]["rate"] == pytest.approx(2 / 3, abs=1e-6)
    assert found["8"]["successes"] == 1


def test_quantity_reads_rooms_that_were_asked():
    rows = [room_row(5, asked_objects=5), room_row(6, asked_objects=5), room_row(3)]
    assert control.quantity(rows)["5"]["n"] == 2
    assert control.quantity([room_row(3)]) == {}


def test_walkable_success_falls_with_tau():
    rows = [room_row(3, walkable_free=ratio) for ratio in np.random.default_rng(0).uniform(size=60).tolist()]
    rates = [control.walkable(rows, "free", tau)["rate"] for tau in (0.1, 0.4, 0.7, 0.95)]
    assert rates == sorted(rates, reverse=True)
    assert control.walkable([room_row(3, walkable_free=0.8)], "free", 0.8)["rate"] == 1.0


def test_walkable_tells_both_meanings_apart():
    rows = [room_row(3, walkable_paper=0.8, walkable_free=0.5, walkable_target=0.7), room_row(3, walkable_target=None)]
    assert control.walkable(rows[:1], "paper", 0.7)["rate"] == 1.0
    below = {"rate": 0.0, "low": 0.0, "high": pytest.approx(0.793, abs=1e-3), "successes": 0, "n": 1}
    assert control.walkable(rows[:1], "free", 0.7) == below
    means = control.walkable_means(np.random.default_rng(0), rows)
    assert (means["paper"]["mean"], means["free"]["mean"]) == (0.9, 0.75)


def test_openable_before_and_after():
    rows = [room_row(4, openable=2, openable_sampled=3), room_row(4, openable=1, openable_sampled=1), room_row(0, layout_type="")]
    found = control.openable(np.random.default_rng(0), rows)
    assert (found["shipped"]["mean"], found["sampled"]["mean"], found["shipped"]["n"]) == (1.5, 2.0, 2)
