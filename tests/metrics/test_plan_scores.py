"""Plan scores on plans drawn by hand."""

import itertools
from dataclasses import astuple
from pathlib import Path

import numpy as np
import pytest
import yaml

from pipeline.entities.plan import Opening, Plan, Room, Swing
from pipeline.metrics.plan_checks import CHECKS, constraint
from pipeline.metrics.plan_graph import Scene, edges_of, match
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


def plan_of(rooms, doors, entrance="l"):
    """Rooms (id, type, area) in a row, joined by doors (a, b); only types, areas and joints matter."""
    made, x = [], 0.0
    for name, kind, area in rooms:
        made.append(box(name, kind, x, 0, x + area / 4, 4))
        x += area / 4 + 0.12
    return Plan(
        tuple(made), tuple(Opening(f"o{k}", "door", pair, np.array([[0.0, 0], [1, 0]]), 2.0) for k, pair in enumerate(doors)), entrance
    )


def graph_of(rooms, edges):
    rows = [{"id": i, "type": t, "area": a, **({"inferred": True} if i.startswith("~") else {})} for i, t, a in rooms]
    return {"rooms": rows, "edges": [{"a": a, "b": b, "kind": "door", **({"optional": True} if more else {})} for a, b, *more in edges]}


def scored(plan, rooms, edges, **checks):
    return score(plan, {"graph": graph_of(rooms, edges), "checks": checks})


LIVING, BED, HALL, BATH = "living_room", "bedroom", "hallway", "bathroom"


def test_s_node_is_matched_over_the_larger_number():
    rooms = [("L", LIVING, 20), ("B", BED, 12), ("C", BED, 12), ("W", BATH, 5)]
    assert scored(plan_of([("l", LIVING, 20), ("b", BED, 12)], []), rooms, []).node == pytest.approx(2 / 4)
    more = [("l", LIVING, 20), ("b", BED, 12), ("c", BED, 12), ("w", BATH, 5), ("x", "office", 9)]
    assert scored(plan_of(more, []), rooms, []).node == pytest.approx(4 / 5)
    swapped = [("l", LIVING, 20), ("b", BED, 12), ("c", BED, 12), ("w", "wc", 5)]  # a room of another type is missing and spurious
    assert scored(plan_of(swapped, []), rooms, []).node == pytest.approx(3 / 4)


def test_s_edge_is_matched_over_the_larger_number():
    rooms = [("L", LIVING, 20), ("B", BED, 12), ("W", BATH, 5)]
    made = [("l", LIVING, 20), ("b", BED, 12), ("w", BATH, 5)]
    asked = [("L", "B"), ("B", "W")]
    assert scored(plan_of(made, [("l", "b"), ("b", "w")]), rooms, asked).edge == 1.0
    assert scored(plan_of(made, [("l", "b")]), rooms, asked).edge == pytest.approx(1 / 2)
    assert scored(plan_of(made, [("l", "b"), ("l", "w"), ("b", "w")]), rooms, asked).edge == pytest.approx(2 / 3)
    assert scored(plan_of(made, [("l", "w")]), rooms, asked).edge == 0.0


def test_without_edges_none_is_missing():
    assert scored(plan_of([("s", "studio_room", 20)], [], "s"), [("S", "studio_room", 20)], []).edge == 1.0
    assert scored(plan_of([("l", LIVING, 20), ("b", BED, 12)], [("l", "b")]), [("L", LIVING, 20), ("B", BED, 12)], []).edge == 0.0


def test_outside_doors_and_windows_are_no_edges():
    rooms = [("L", LIVING, 24), ("H", HALL, 8), ("A", BED, 16), ("B", BED, 15)]
    assert len(edges_of(PLAN)) == 3 < len(PLAN.openings)
    assert scored(PLAN, rooms, [("L", "H"), ("H", "A"), ("H", "B")]).edge == 1.0


def test_of_matchings_with_equal_edges_the_one_of_nearest_areas():
    rooms = [("L", LIVING, 20), ("B", BED, 10), ("C", BED, 16)]
    plan = plan_of([("l", LIVING, 20), ("x", BED, 16), ("y", BED, 10)], [("l", "x"), ("l", "y")])
    graph = graph_of(rooms, [("L", "B"), ("L", "C")])
    assert match(plan, graph) == {"l": "L", "x": "C", "y": "B"}
    # but edges come first: only one of them is met by the nearest areas
    assert match(plan, graph_of([*rooms, ("W", BATH, 5)], [("L", "B"), ("B", "W")]))["x"] == "C"
    other = plan_of([("l", LIVING, 20), ("x", BED, 16), ("y", BED, 10), ("w", BATH, 5)], [("l", "x"), ("x", "w")])
    assert match(other, graph_of([*rooms, ("W", BATH, 5)], [("L", "B"), ("B", "W")]))["x"] == "B"


def test_the_matching_is_exact():
    """Against every permutation, on random graphs with more and with fewer rooms than the truth."""
    rng = np.random.default_rng(5)
    for _ in range(60):
        kinds = [LIVING, BED, BATH]
        made = [(f"r{k}", str(rng.choice(kinds)), float(rng.integers(4, 20))) for k in range(int(rng.integers(2, 7)))]
        asked = [(f"T{k}", str(rng.choice(kinds)), float(rng.integers(4, 20))) for k in range(int(rng.integers(2, 7)))]
        doors = [(a[0], b[0]) for i, a in enumerate(made) for b in made[:i] if rng.random() < 0.5]
        edges = [(a[0], b[0]) for i, a in enumerate(asked) for b in asked[:i] if rng.random() < 0.5]
        found = match(plan_of(made, doors), graph_of(asked, edges))

        def value(pairs, made=made, asked=asked, doors=doors, edges=edges):
            size, want = {i: a for i, _, a in made}, {i: a for i, _, a in asked}
            near = {frozenset(e) for e in edges}
            hits = sum(a in pairs and b in pairs and frozenset((pairs[a], pairs[b])) in near for a, b in doors)
            return hits, -round(sum(abs(size[i] - want[n]) for i, n in pairs.items()), 6)

        options = []
        for kind in kinds:
            ours, theirs = [r[0] for r in made if r[1] == kind], [r[0] for r in asked if r[1] == kind]
            few, many = sorted((ours, theirs), key=len)
            pairs = [list(zip(few, p, strict=True)) for p in itertools.permutations(many, len(few))]
            options.append([dict(p) if few is ours else {b: a for a, b in p} for p in pairs])
        best = max(value({k: v for part in choice for k, v in part.items()}) for choice in itertools.product(*options))
        assert value(found) == best


def test_many_like_rooms_are_matched_at_once():
    rooms = [(f"b{k}", BED, 10.0 + k / 7) for k in range(14)] + [("h", HALL, 12)]
    plan = plan_of(rooms, [("h", f"b{k}") for k in range(14)], "h")
    truth = [(i.upper(), t, a) for i, t, a in rooms]
    assert match(plan, graph_of(truth, [("H", f"B{k}") for k in range(14)])) == {i: i.upper() for i, _, _ in rooms}


def test_circulation_that_is_inferred_is_neither_missing_nor_spurious():
    rooms = [("L", LIVING, 20), ("~H", HALL, 8), ("B", BED, 12), ("W", BATH, 5)]
    edges = [("L", "~H"), ("~H", "B"), ("~H", "W"), ("L", "B", "optional")]
    whole = plan_of([("l", LIVING, 20), ("h", HALL, 8), ("b", BED, 12), ("w", BATH, 5)], [("l", "h"), ("h", "b"), ("h", "w")])
    assert (scored(whole, rooms, edges).node, scored(whole, rooms, edges).edge) == (1.0, 1.0)
    without = plan_of([("l", LIVING, 20), ("b", BED, 12), ("w", BATH, 5)], [("l", "b")])
    assert (scored(without, rooms, edges).node, scored(without, rooms, edges).edge) == (1.0, 1.0)
    assert scored(without, rooms, edges).strict_node == pytest.approx(3 / 4)
    assert scored(without, rooms, edges).strict_edge == pytest.approx(1 / 4)
    # a hallway of the plan's own where the truth has none
    plain = [("L", LIVING, 20), ("B", BED, 12), ("W", BATH, 5)]
    assert scored(whole, plain, []).node == 1.0
    assert scored(whole, plain, []).edge == 1.0
    assert scored(whole, plain, []).strict_node == pytest.approx(3 / 4)
    assert scored(whole, plain, []).strict_edge == 0.0
    # but not where the truth names its circulation: then one more is one too many
    named = [*plain, ("H", HALL, 8)]
    double = plan_of([("l", LIVING, 20), ("h", HALL, 8), ("b", BED, 12), ("w", BATH, 5), ("e", "entry", 4)], [])
    assert scored(double, named, []).node == pytest.approx(4 / 5)


def test_s_constraint_counts_balcony_and_garage_and_shares_not_metres():
    rooms = [("L", LIVING, 20), ("O", "balcony", 10), ("G", "garage", 20)]
    plan = plan_of([("l", LIVING, 40), ("o", "balcony", 20), ("g", "garage", 40)], [])
    assert scored(plan, rooms, []).constraint == pytest.approx(1.0)  # twice as large, same shares
    plan = plan_of([("l", LIVING, 20), ("o", "balcony", 5), ("g", "garage", 20)], [])
    assert scored(plan, rooms, []).constraint == pytest.approx(1 - 0.5 * (2 * (20 / 45 - 0.4) + (0.2 - 5 / 45)))
    five = dict.fromkeys("abcde", 1.0)
    moved = {**five, "a": 1.25, "b": 1.25, "c": 0.75, "d": 0.75}  # 5 points of share on four types
    assert s_constraint(moved, five) == pytest.approx(1 - 0.5 * 4 * 0.05)


def test_presence_takes_no_notice_of_more_than_asked():
    plan = plan_of([("l", LIVING, 20), ("b", BED, 12), ("c", BED, 12), ("d", BED, 12)], [])
    assert scored(plan, [], [], presence={BED: 2, LIVING: 1}).presence == 1.0
    assert scored(plan, [], [], presence={BED: 4}).presence == pytest.approx(3 / 4)
    assert scored(plan, [], [], absent=[BED, "garage"]).presence == pytest.approx(1 / 2)
    assert scored(plan, [], []).presence == 1.0


def test_each_asks_once_for_each_room_of_the_truth():
    rooms = [("L", LIVING, 20), ("B", BED, 12), ("C", BED, 12), ("D", BED, 12)]
    check = [{"a": BED, "b": LIVING, "via": "door", "quant": "each"}]
    two = plan_of([("l", LIVING, 20), ("b", BED, 12), ("c", BED, 12)], [("l", "b"), ("l", "c")])
    assert scored(two, rooms, [], adjacency=check).adjacency == pytest.approx(2 / 3)  # the third bedroom is missing
    more = plan_of([("l", LIVING, 20), *((f"b{k}", BED, 12) for k in range(4))], [("l", f"b{k}") for k in range(3)])
    edges = [("L", "B"), ("L", "C"), ("L", "D")]
    assert scored(more, rooms, edges, adjacency=check).adjacency == 1.0  # the fourth was not asked for
    some = [{**check[0], "quant": "some"}]
    assert scored(two, rooms, [], adjacency=some).adjacency == 1.0


@pytest.mark.parametrize(("area", "credit"), [(60, 1.0), (66, 0.5), (69, 0.25), (72, 0.0), (80, 0.0), (40, 1.0), (36, 0.5), (32, 0.0)])
def test_numbers_lose_credit_linearly_to_none_at_twice_the_tolerance(area, credit):
    plan = plan_of([("l", LIVING, area)], [])
    checks = {"constraints": [{"type": "total_area", "min": 40, "max": 60, "tol": 0.1}, {"type": "storeys", "equals": 1}]}
    found = scored(plan, [("L", LIVING, area)], [], **checks)
    assert found.constraints == pytest.approx((credit + 1) / 2)
    assert found.success == (credit == 1.0)


def test_strict_success_wants_everything_exactly():
    rooms, door = [("L", LIVING, 20), ("B", BED, 12)], [("l", "b")]
    plan = plan_of([("l", LIVING, 20), ("b", BED, 12)], door)
    good = {
        "presence": {BED: 1},
        "adjacency": [{"a": BED, "b": LIVING, "quant": "each"}],
        "constraints": [{"type": "room_count", "equals": 2}],
    }
    assert scored(plan, rooms, [], **good).success
    assert scored(plan, [], [("X", "Y")], **good).success  # the graph's scores have no part in it
    for wrong in (
        {"presence": {BED: 2}},
        {"adjacency": [{"a": BED, "b": LIVING, "via": "open"}]},
        {"constraints": [{"type": "room_count", "equals": 3}]},
    ):
        assert not scored(plan, rooms, [], **(good | wrong)).success


def test_the_benchmark_score_is_the_papers_weighting():
    plan = plan_of([("l", LIVING, 20), ("b", BED, 12)], [])
    found = scored(plan, [], [], presence={BED: 2}, adjacency=[{"a": BED, "b": LIVING}], constraints=[{"type": "storeys", "equals": 1}])
    assert found.benchmark == pytest.approx(0.5 * 0.5 + 0.3 * 0.0 + 0.2 * 1.0)
