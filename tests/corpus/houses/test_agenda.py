"""Which rooms are furnished, and decisions dealt in strata."""

from collections import Counter

import numpy as np
import pytest
from sample_houses import house

from pipeline.corpus import front_statistics
from pipeline.corpus.houses import rates
from pipeline.corpus.houses.planner import BLOCK, KINDS, MOST_PRIVATE, PRIVATE, agenda, chances
from pipeline.corpus.houses.rates import Deal


def test_furnished_rooms_come_in_the_observed_shares_and_types():
    rooms = [agenda(3, index).rooms for index in range(10 * BLOCK)]
    wanted = np.array(front_statistics.load().furnished_rooms) / sum(front_statistics.load().furnished_rooms)
    counted = Counter(len(r) for r in rooms)
    assert [counted[n + 1] / len(rooms) for n in range(len(wanted))] == pytest.approx(wanted.tolist(), abs=0.01)
    types = Counter(t for r in rooms for t in r)
    known = front_statistics.load().room_types
    for name in ("MasterBedroom", "LivingDiningRoom", "LivingRoom", "Library", "DiningRoom"):
        assert types[name] / len(rooms) == pytest.approx(known[name.lower()] / 5727, abs=0.06), name
    assert all(sum(t in PRIVATE for t in r) <= MOST_PRIVATE for r in rooms)


def test_chances_are_in_proportion_and_at_most_one():
    made = chances(np.array([4.0, 1.0, 1.0, 2.0]), 2)
    assert made.sum() == pytest.approx(2)
    assert made.max() == 1.0
    assert made[3] == pytest.approx(2 * made[1])


def test_a_block_deals_a_decision_evenly():
    marks = np.sort([Deal(1, "bedroom", 0, k, 40).mark("wardrobe") for k in range(40)])
    assert (np.floor(marks * 40) == np.arange(40)).all()
    picked = Counter(Deal(1, "bedroom", 0, k, 40).choose("bed", {"a": 3, "b": 1}) for k in range(40))
    assert picked == {"a": 30, "b": 10}
    other = [Deal(1, "bedroom", 0, k, 40).mark("desk") for k in range(40)]
    assert abs(np.corrcoef(other, [Deal(1, "bedroom", 0, k, 40).mark("wardrobe") for k in range(40)])[0, 1]) < 0.5


def test_every_room_type_has_rates():
    assert set(KINDS.values()) <= set(rates.load())


def test_houses_have_the_rooms_of_their_agenda():
    met = 0
    for index in range(24):
        wanted = Counter(t for t in agenda(5, index).rooms if t in PRIVATE or t.startswith("Living"))
        met += not wanted - Counter(r.type for r in house(index).plan.rooms)
    assert met >= 23
