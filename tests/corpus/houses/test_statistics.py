"""The figures: computed right on a house that one can count by hand, and near the reference on many."""

import numpy as np
import pytest
from sample_houses import Box, houses

from pipeline.corpus.houses.records import House, Item
from pipeline.corpus.houses.statistics import PEERS, statistics
from pipeline.entities.plan import Plan, Room


def test_one_room_counted_by_hand():
    square = Room("room_0", "Bedroom", np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]))
    bed, stand = Box("b", "double_bed", (2.0, 2.0, 1.0), "", "", ""), Box("n", "nightstand", (0.5, 0.4, 0.5), "", "", "")
    items = (Item(bed, 0, (2.0, 3.0, 0.0), 0.0), Item(stand, 0, (0.5, 3.5, 0.0), 0.0), Item(stand, 0, (3.5, 3.5, 0.0), 0.0))
    figures = statistics([House("u", 0, Plan((square,), (), "room_0"), items, (False,))])
    assert figures["walkable"]["ours"] == pytest.approx(1 - (4.0 + 0.4) / 16)
    assert figures["rectangular"]["ours"] == 1.0
    assert figures["areas"]["Bedroom"]["ours"] == pytest.approx(16.0)
    assert figures["bedroom"]["objects_per_room"]["ours"] == 3
    assert figures["bedroom"]["frequencies"]["nightstand"]["ours"] == pytest.approx(2 / 3)


def test_reference_frequencies_are_shares():
    for peers in PEERS.values():
        assert sum(peers.counts.values()) == pytest.approx({"bed": 19372, "living": 7265}[peers.word], abs=1)


def test_the_corpus_is_near_the_reference():
    figures = statistics(houses(24))
    assert 0.55 < figures["walkable"]["ours"] < 0.78
    for name, least in (("bedroom", 20), ("living", 10)):
        assert figures[name]["rooms"] >= least
        assert figures[name]["total_variation"] < 0.16  # of few rooms; the whole corpus is held to 0.05
        assert figures[name]["objects_per_room"]["ours"] == pytest.approx(figures[name]["objects_per_room"]["reference"], rel=0.25)
