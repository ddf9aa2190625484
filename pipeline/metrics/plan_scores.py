"""Scores of floor plans against ground-truth graphs and checks: S_node, S_constraint, S_edge, presence, adjacency, constraints.

The graph of a plan is read off its realised openings: two rooms are joined when a door, an open front or a portal leads from one
to the other; balconies and garages are rooms, outside doors are none. Where the paper (eqs. S_node, S_constraint, S_edge, and
its weighted benchmark score) leaves rules open, these hold:

- the matching of rooms by type is the one of largest |E_match|, ties broken by agreement of areas;
- edges that the truth marks `optional`, rooms that it marks `inferred`, circulation that stands for them, and edges of both are neither
  missing nor spurious (lenient); the strict values count everything as printed;
- presence = (sum over types of min(made, asked) + absent types kept out) / (sum asked + number of absent types);
- adjacency = met / asked, where `each` asks once for each room of the truth; rooms beyond those count in S_node and S_edge alone;
- numeric constraints lose credit linearly, to none at twice the tolerance.
"""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from pipeline.entities.plan import Plan
from pipeline.metrics.plan_checks import constraint
from pipeline.metrics.plan_graph import Scene, edges_of, match

CIRCULATION = frozenset({"hallway", "entry"})
WEIGHTS = (0.5, 0.3, 0.2)  # presence, adjacency, constraints: the paper's benchmark score


@dataclass(frozen=True, slots=True)
class PlanScores:
    """Scores in [0, 1]. `strict_*` count optional edges and inferred rooms; `success` says that every check is met exactly."""

    node: float
    constraint: float
    edge: float
    strict_node: float
    strict_edge: float
    presence: float
    adjacency: float
    constraints: float
    success: bool

    @property
    def benchmark(self) -> float:
        """The paper's weighted score."""
        return float(np.dot(WEIGHTS, (self.presence, self.adjacency, self.constraints)))


def score(plan: Plan, case: Mapping[str, Any]) -> PlanScores:
    """Score a plan against one case of a prompt set: its `graph` and its `checks`."""
    graph = case["graph"]
    matching = match(plan, graph)
    node, strict_node = _node(plan, graph, matching)
    edge, strict_edge = _edge(plan, graph, matching)
    presence, adjacency, constraints, success = score_checks(plan, case, {n: i for i, n in matching.items()})
    truth = graph.get("area_ratio") or areas_by_type((row["type"], row.get("area") or 0.0) for row in graph["rooms"])
    share = s_constraint(areas_by_type((room.type, room.area) for room in plan.rooms), truth)
    return PlanScores(node, share, edge, strict_node, strict_edge, presence, adjacency, constraints, success)


def score_checks(plan: Plan, case: Mapping[str, Any], names: Mapping[str, str] = MappingProxyType({})) -> tuple[float, float, float, bool]:
    """Return presence, adjacency, constraints and whether all are met exactly; `names` maps rooms of the truth to those of the plan."""
    checks, graph = case.get("checks", {}), case.get("graph", {"rooms": ()})
    scene = Scene(plan, names)
    presence = _presence(plan, checks)
    adjacent = [part for c in checks.get("adjacency", ()) for part in _adjacent(scene, graph, c)]
    met = [constraint(scene, c) for c in checks.get("constraints", ())]
    adjacency = float(np.mean(adjacent)) if adjacent else 1.0
    constraints = float(np.mean(met)) if met else 1.0
    return presence, adjacency, constraints, presence == 1.0 and adjacency == 1.0 and all(v >= 1.0 for v in met)


def s_constraint(areas: Mapping[str, float], truth: Mapping[str, float]) -> float:
    """1 - D_L1 / 2 of two distributions of area over room types (paper eq. constraint_score)."""
    keys = set(areas) | set(truth)
    a, b = sum(areas.values()), sum(truth.values())
    if not a or not b:
        return float(a == b)
    return 1.0 - 0.5 * sum(abs(areas.get(k, 0.0) / a - truth.get(k, 0.0) / b) for k in keys)


def areas_by_type(rooms: Iterable[tuple[str, float]]) -> dict[str, float]:
    """Sum the areas of rooms (type, area [m2]) per type."""
    total: dict[str, float] = {}
    for kind, area in rooms:
        total[kind] = total.get(kind, 0.0) + area
    return total


def _node(plan: Plan, graph: Mapping[str, Any], matching: Mapping[str, str]) -> tuple[float, float]:
    inferred = {r["id"] for r in graph["rooms"] if r.get("inferred")}
    strict = len(matching) / max(len(plan.rooms), len(graph["rooms"]))
    kept = [n for n in matching.values() if n not in inferred]
    room_count = len(plan.rooms) - (len(matching) - len(kept)) - len(_spare(plan, graph, matching))
    return len(kept) / max(room_count, len(graph["rooms"]) - len(inferred)), strict


def _spare(plan: Plan, graph: Mapping[str, Any], matching: Mapping[str, str]) -> set[str]:
    """Return circulation that the truth has no partner for, where it infers some or has none at all: it counts for nothing."""
    infers = any(r.get("inferred") for r in graph["rooms"]) or not any(r["type"] in CIRCULATION for r in graph["rooms"])
    return {r.room_id for r in plan.rooms if r.room_id not in matching and r.type in CIRCULATION} if infers else set()


def _edge(plan: Plan, graph: Mapping[str, Any], matching: Mapping[str, str]) -> tuple[float, float]:
    """Return S_edge, lenient and strict: met edges over the larger number of edges. No edges at all, where none are asked for, is 1."""
    truth = {frozenset((e["a"], e["b"])) for e in graph["edges"]}
    optional = {frozenset((e["a"], e["b"])) for e in graph["edges"] if e.get("optional")}
    free = {r["id"] for r in graph["rooms"] if r.get("inferred")} | {f"?{i}" for i in _spare(plan, graph, matching)}
    images = [frozenset(matching.get(i, f"?{i}") for i in e) for e in edges_of(plan)]
    firm = [e for e in images if e not in optional and not e & free]
    asked = [e for e in truth if e not in optional and not e & free]
    return _ratio(firm, asked), _ratio(images, list(truth))


def _ratio(edges: Sequence[frozenset[str]], asked: Sequence[frozenset[str]]) -> float:
    most = max(len(edges), len(asked))
    return len(set(edges) & set(asked)) / most if most else 1.0


def _adjacent(scene: Scene, graph: Mapping[str, Any], check: Mapping[str, Any]) -> list[float]:
    """Return what an adjacency check gives: one value (some), or one for each room of `a` that is to have the neighbour, 0 for one that is missing.

    Rooms that the truth has no partner for count for nothing, where others are there.
    """
    ones, others = scene.select(check["a"]), scene.select(check["b"])
    some, partners = check.get("quant") == "some", set(scene.names.values())
    asked = ones if some else [r for r in ones if r.room_id in partners] or ones
    met = [any(scene.joins(a, b, check.get("via", "any")) for b in others if b.room_id != a.room_id) for a in asked]
    if some:
        return [float(any(met))]
    named = any(check["a"] == r["id"] for r in graph["rooms"])  # an id goes before a type of that name
    wanted = 1 if named else sum(check["a"] == r["type"] for r in graph["rooms"])
    return [float(v) for v in met] + [0.0] * (max(wanted, 1) - len(met))


def _presence(plan: Plan, checks: Mapping[str, Any]) -> float:
    counts = Counter(r.type for r in plan.rooms)
    asked: Mapping[str, int] = checks.get("presence", {})
    absent = checks.get("absent", ())
    whole = sum(asked.values()) + len(absent)
    kept = sum(min(counts[t], n) for t, n in asked.items()) + sum(counts[t] == 0 for t in absent)
    return kept / whole if whole else 1.0
