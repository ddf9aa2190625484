"""Which rooms can lie outside together: the core of a graph is planar just when the graph is."""

import networkx as nx
import numpy as np

from pipeline.floorplan.program.daylight import core, is_flat
from pipeline.floorplan.program.floor_program import Link


def drawn(rng):
    rooms = ["", *(f"r{i}" for i in range(int(rng.integers(3, 10))))]
    return [tuple(rng.choice(rooms, 2, replace=False).tolist()) for _ in range(int(rng.integers(6, 3 * len(rooms))))]


def test_the_core_is_planar_just_when_the_graph_is():
    rng = np.random.default_rng(0)
    graphs = [drawn(rng) for _ in range(300)]
    planar = [nx.check_planarity(nx.Graph(g))[0] for g in graphs]
    assert len(set(planar)) == 2
    assert [nx.check_planarity(nx.Graph(core(g)))[0] for g in graphs] == planar


def test_what_is_joined_like_a_tree_has_no_core():
    assert core([("hall", room) for room in "abc"] + [(room, "") for room in "abc"]) == []


def test_four_rooms_that_are_all_joined_cannot_all_lie_outside():
    links = [Link(a=a, b=b) for a in "abcd" for b in "abcd" if a < b]
    assert is_flat(links, "abc")
    assert not is_flat(links, "abcd")
