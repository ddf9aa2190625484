"""Plan scores on plans drawn by hand."""

import itertools
from dataclasses import astuple
from pathlib import Path

import numpy as np
import pytest
import yaml

from pipeline.entities.plan import Opening, Plan, Room, Swing
from pipeline.metrics.plan_checks import CHECKS, constraint
from pipeline.metrics.plan_graph import edges_of, match
from pipeline.metrics.plan_scene import Scene
from pipeline.metrics.plan_scores import s_constraint, score


def box(name, kind, x0, y0, x1, y1, level=0):
    return Room(name, kind, np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], float), level)


def opening(name, kind, rooms, x0, y0, x1, y1):
    swing = Swing(rooms[0], 0, 1.5) if kind in {"door", "entrance"} else None
    return Opening(name, kind, rooms, np.array([[x0, y0], [x1, y1]], float), 2.05, swing=swing)


#   +---------+----+----+
#   | living  | h  | b1 |   living 6 x 4, hall 2 x 4, two bedrooms 4 x 4
#   +---------+----+----+
#                  b2 above the hall
PLAN = Plan(
    (
        box("l", "living_room", 0, 0, 6, 4),
        box("h", "hallway", 6.12, 0, 8.12, 4),
        box("x", "bedroom", 8.24, 0, 12.24, 4),
        box("y", "bedroom", 6.12, 4.12, 10.12, 7.87),
    ),
    (
        opening("d0", "door", ("l", "h"), 6.06, 1, 6.06, 1.8),
        opening("d1", "door", ("h", "x"), 8.18, 1, 8.18, 1.8),
        opening("d2", "door", ("h", "y"), 7, 4.06, 7.8, 4.06),
        opening("e", "entrance", ("l",), -0.12, 1, -0.12, 1.9),
        opening("w", "window", ("x",), 12.36, 1, 12.36, 2),
    ),
    "l",
)
GRAPH = {
    "entrance": "living",
    "rooms": [
        {"id": "living", "type": "living_room", "area": 24},
        {"id": "hall", "type": "hallway", "area": 8},
        {"id": "b1", "type": "bedroom", "area": 16},
        {"id": "b2", "type": "bedroom", "area": 15},
    ],
    "edges": [{"a": "living", "b": "hall", "kind": "door"}, {"a": "hall", "b": "b1", "kind": "door"}, {"a": "hall", "b": "b2", "kind": "door"}],
}  # fmt: skip


def case(**changes):
    return {"graph": {**GRAPH, **changes.pop("graph", {})}, "checks": changes}


def test_a_perfect_plan_scores_one():
    scores = score(PLAN, case(presence={"bedroom": 2, "living_room": 1}, absent=["balcony"]))
    assert (scores.node, scores.edge, scores.presence, scores.success) == (1.0, 1.0, 1.0, True)
    assert scores.constraint == pytest.approx(1.0)
    assert scores.benchmark == pytest.approx(1.0)


def test_edges_come_from_openings_between_rooms_only():
    assert set(edges_of(PLAN)) == {frozenset("lh"), frozenset("hx"), frozenset("hy")}


def test_a_missing_room_and_an_extra_room():
    fewer = Plan(PLAN.rooms[:3], PLAN.openings[:2], "l")
    scores = score(fewer, case())
    assert scores.node == pytest.approx(3 / 4)
    assert scores.edge == pytest.approx(2 / 3)
    more = case(graph={"rooms": GRAPH["rooms"][:3], "edges": GRAPH["edges"][:2]})
    scores = score(PLAN, more)
    assert scores.node == pytest.approx(3 / 4)
    assert scores.edge == pytest.approx(2 / 3)


def test_the_matching_is_the_one_with_most_edges_whatever_the_order():
    edges = [{"a": "living", "b": "hall"}, {"a": "living", "b": "b1"}, {"a": "hall", "b": "b2"}]
    joined = [("l", "h"), ("l", "y"), ("h", "x")]  # y must be b1 although x comes first
    for order in itertools.permutations(range(4)):
        openings = tuple(Opening(f"o{i}", "door", pair, np.array([[0.0, 0], [1, 0]]), 2.0) for i, pair in enumerate(joined))
        plan = Plan(tuple(PLAN.rooms[i] for i in order), openings, "l")
        found = match(plan, {**GRAPH, "edges": edges})
        assert (found["y"], found["x"]) == ("b1", "b2")
        assert score(plan, case(graph={"edges": edges})).edge == 1.0


def test_optional_edges_are_neither_missing_nor_spurious():
    optional = [*GRAPH["edges"], {"a": "living", "b": "b2", "kind": "door", "optional": True}]
    scores = score(PLAN, case(graph={"edges": optional}))
    assert scores.edge == 1.0
    assert scores.strict_edge == pytest.approx(3 / 4)
    kept = [{**e, "optional": e["b"] == "b2"} for e in GRAPH["edges"]]
    assert score(PLAN, case(graph={"edges": kept})).edge == 1.0


def test_inferred_rooms_are_lenient():
    rooms = [{**r, "inferred": r["id"] == "hall"} for r in GRAPH["rooms"]]
    assert score(PLAN, case(graph={"rooms": rooms})).node == 1.0
    without = Plan((PLAN.rooms[0], *PLAN.rooms[2:]), (), "l")
    assert score(without, case(graph={"rooms": rooms})).node == 1.0
    assert score(without, case(graph={"rooms": rooms})).strict_node == pytest.approx(3 / 4)


def test_s_constraint_by_hand():
    assert s_constraint({"a": 1, "b": 1}, {"a": 3, "b": 1}) == pytest.approx(0.75)
    assert s_constraint({"a": 5}, {"b": 5}) == 0.0
    assert s_constraint({"a": 2, "b": 6}, {"a": 25, "b": 75}) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("check", "value"),
    [
        ({"type": "total_area", "min": 60, "max": 70}, 1.0),
        ({"type": "total_area", "min": 90}, 0.0),
        ({"type": "total_area", "max": 60}, 1 - (3 / 60) / 0.2),
        ({"type": "room_area", "room": "bedroom", "min": 14, "max": 17, "each": True}, 1.0),
        ({"type": "room_area", "room": "living", "min": 30}, 0.0),
        ({"type": "room_area", "room": "living", "min": 26, "tol": 0.08}, 1.0),
        ({"type": "area_share", "room": "living", "min": 0.3}, 1.0),
        ({"type": "area_order", "larger": "living", "smaller": "b1", "min_ratio": 1.5}, 1.0),
        ({"type": "area_order", "larger": "hall", "smaller": "b1"}, 0.0),
        ({"type": "area_equal", "rooms": ["b1", "b2"], "tol": 0.07}, 1.0),
        ({"type": "area_max_of", "room": "living", "among": "all_interior"}, 1.0),
        ({"type": "not_adjacent", "a": "living", "b": "bedroom"}, 1.0),
        ({"type": "not_adjacent", "a": "hall", "b": "living"}, 0.0),
        ({"type": "not_open", "a": "hall", "b": "living"}, 1.0),
        ({"type": "open_plan", "rooms": ["hall", "living"]}, 0.0),
        ({"type": "degree", "room": "hall", "equals": 3}, 1.0),
        ({"type": "degree", "room": "b1", "equals": 2}, 0.0),
        ({"type": "reachable_without", "target": "b1", "avoid": ["living"]}, 0.0),
        ({"type": "reachable_without", "target": "b1", "avoid": ["b2"]}, 1.0),
        ({"type": "between", "mid": "hall", "a": "living", "b": "b1"}, 1.0),
        ({"type": "between", "mid": "living", "a": "hall", "b": "b1"}, 0.0),
        ({"type": "ensuite", "bath": "b1", "bedroom": "bedroom"}, 0.0),
        ({"type": "exterior_access", "room": "living"}, 1.0),
        ({"type": "exterior_access", "room": "b1"}, 0.0),
        ({"type": "exterior_wall", "room": "bedroom"}, 1.0),
        ({"type": "exterior_length", "room": "living", "min_m": 15}, 1.0),
        ({"type": "min_door_width", "value": 0.8}, 1.0),
        ({"type": "min_door_width", "value": 0.9}, 1 - (0.1 / 0.9) / 0.2),
        ({"type": "min_corridor_width", "value": 1.9}, 1.0),
        ({"type": "irregularity", "min_nonrect_rooms": 1}, 0.0),
        ({"type": "footprint", "shape": "rectangle"}, 0.0),
        ({"type": "footprint", "min_aspect": 1.4}, 1.0),
        ({"type": "level", "room": "bedroom", "equals": 0}, 1.0),
        ({"type": "hallway_share", "max": 0.0}, 0.0),
        ({"type": "storeys", "equals": 1}, 1.0),
        ({"type": "room_count", "equals": 4}, 1.0),
        ({"type": "entrance_room", "room": "living"}, 1.0),
        ({"type": "min_hops", "a": "living", "b": "bedroom", "min": 2}, 1.0),
        ({"type": "min_hops", "a": "living", "b": "bedroom", "min": 3}, 0.0),
        ({"type": "separation", "a": "b1", "b": "living", "min_frac_diag": 0.45}, 1.0),
        ({"type": "separation", "a": "hall", "b": "living", "min_frac_diag": 0.9}, 0.0),
        ({"type": "zone_split", "zones": {"day": ["living"], "night": ["b1", "b2"]}, "max_crossings": 0}, 1.0),
        ({"type": "zone_split", "zones": {"day": ["living", "hall"], "night": ["b1", "b2"]}, "max_crossings": 1}, 0.0),
    ],
)
def test_checks(check, value):
    scene = Scene(PLAN, {n: i for i, n in match(PLAN, GRAPH).items()})
    assert constraint(scene, check) == pytest.approx(value, abs=2e-3)


def test_adjacency_counts_each_room():
    checks = [
        {"a": "bedroom", "b": "hallway", "via": "door", "quant": "each"},
        {"a": "bedroom", "b": "living_room", "via": "any", "quant": "each"},
        {"a": "hallway", "b": "living_room", "via": "open", "quant": "each"},
        {"a": "hallway", "b": "living_room", "via": "wall", "quant": "some"},
    ]
    scores = score(PLAN, case(adjacency=checks))
    assert scores.adjacency == pytest.approx((1 + 1 + 0 + 0 + 0 + 1) / 6)
    assert not scores.success


def test_presence_counts_absent_types():
    scores = score(PLAN, case(presence={"bedroom": 3, "kitchen": 1}, absent=["hallway", "balcony"]))
    assert scores.presence == pytest.approx((2 + 0 + 0 + 1) / 6)


def test_scores_do_not_change_when_the_plan_is_turned():
    def turned(points):
        return points @ np.array([[0.0, 1.0], [-1.0, 0.0]]) + [3.0, -7.0]

    rooms = tuple(Room(r.room_id, r.type, turned(r.polygon)) for r in PLAN.rooms)
    openings = tuple(Opening(o.opening_id, o.kind, o.rooms, turned(o.segment), o.height, swing=o.swing) for o in PLAN.openings)
    checks = case(
        constraints=[
            {"type": "separation", "a": "b1", "b": "living", "min_frac_diag": 0.6},
            {"type": "exterior_length", "room": "living", "min_m": 20},
        ]
    )
    assert astuple(score(Plan(rooms, openings, "l"), checks)) == pytest.approx(astuple(score(PLAN, checks)))


def test_every_check_of_the_benchmark_is_known():
    cases = yaml.safe_load(Path("manifests/prompts/benchmark.yaml").read_text(encoding="utf-8"))
    assert {c["type"] for case in cases for c in case["checks"]["constraints"]} <= set(CHECKS)
