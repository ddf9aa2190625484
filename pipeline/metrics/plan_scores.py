"""Scores of floor plans against ground-truth graphs and checks: S_node, S_constraint, S_edge, presence, adjacency, constraints.

The graph of a plan is read off its realised openings: two rooms are joined when a door, an open front or a portal leads from one
to the other; balconies and garages are rooms, outside doors are none. Where the paper (eqs. S_node, S_constraint, S_edge, and
its weighted benchmark score) leaves rules open, these hold:

- the matching of rooms by type is the one of largest |E_match|, ties broken by agreement of areas;
- edges that the truth marks `optional`, and rooms that it marks `inferred`, are neither missing nor spurious (lenient); the
  strict values count everything as printed;
- presence = (sum over types of min(made, asked) + absent types kept out) / (sum asked + number of absent types);
- numeric constraints lose credit linearly, to none at twice the tolerance.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pipeline.entities.plan import Plan, Room
from pipeline.metrics.plan_checks import constraint
from pipeline.metrics.plan_graph import edges_of, match
from pipeline.metrics.plan_scene import Scene

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
    graph, checks = case["graph"], case.get("checks", {})
    found = match(plan, graph)
    node, strict_node = _node(plan, graph, found)
    edge, strict_edge = _edge(plan, graph, found)
    truth: dict[str, float] = {}
    for row in graph["rooms"]:
        truth[row["type"]] = truth.get(row["type"], 0.0) + row["area"]
    scene = Scene(plan, {n: i for i, n in found.items()})
    presence = _presence(plan, checks)
    adjacent = [part for c in checks.get("adjacency", ()) for part in scene.adjacency(c)]
    met = [constraint(scene, c) for c in checks.get("constraints", ())]
    adjacency = float(np.mean(adjacent)) if adjacent else 1.0
    constraints = float(np.mean(met)) if met else 1.0
    success = presence == 1.0 and adjacency == 1.0 and all(v >= 1.0 for v in met)
    share = s_constraint(areas_by_type(plan.rooms), graph.get("area_ratio") or truth)
    return PlanScores(node, share, edge, strict_node, strict_edge, presence, adjacency, constraints, success)


def s_constraint(made: Mapping[str, float], truth: Mapping[str, float]) -> float:
    """1 - D_L1 / 2 of two distributions of area over room types (paper eq. constraint_score)."""
    keys = set(made) | set(truth)
    a, b = sum(made.values()), sum(truth.values())
    return 1.0 - 0.5 * sum(abs(made.get(k, 0.0) / a - truth.get(k, 0.0) / b) for k in keys)


def areas_by_type(rooms: Sequence[Room]) -> dict[str, float]:
    """Sum the areas of rooms per type [m2]."""
    total: dict[str, float] = {}
    for room in rooms:
        total[room.type] = total.get(room.type, 0.0) + room.area
    return total


def _node(plan: Plan, graph: Mapping[str, Any], found: Mapping[str, str]) -> tuple[float, float]:
    inferred = {r["id"] for r in graph["rooms"] if r.get("inferred")}
    strict = len(found) / max(len(plan.rooms), len(graph["rooms"]))
    kept = [n for n in found.values() if n not in inferred]
    circulation = {"hallway", "entry"}
    free = inferred or not any(r["type"] in circulation for r in graph["rooms"])
    spare = {r.room_id for r in plan.rooms if r.room_id not in found and r.type in circulation} if free else set()
    made = len(plan.rooms) - (len(found) - len(kept)) - len(spare)
    return len(kept) / max(made, len(graph["rooms"]) - len(inferred)), strict


def _edge(plan: Plan, graph: Mapping[str, Any], found: Mapping[str, str]) -> tuple[float, float]:
    made = set(edges_of(plan))
    truth = {frozenset((e["a"], e["b"])) for e in graph["edges"]}
    loose = {frozenset((e["a"], e["b"])) for e in graph["edges"] if e.get("optional")}
    images = [frozenset(found.get(i, f"?{i}") for i in e) for e in made]
    hits = [e for e in images if e in truth]
    strict = len(hits) / max(len(made), len(truth), 1)
    firm = [e for e in images if e not in loose]
    return len([e for e in firm if e in truth]) / max(len(firm), len(truth - loose), 1), strict


def _presence(plan: Plan, checks: Mapping[str, Any]) -> float:
    counts = Counter(r.type for r in plan.rooms)
    asked: Mapping[str, int] = checks.get("presence", {})
    absent = checks.get("absent", ())
    whole = sum(asked.values()) + len(absent)
    kept = sum(min(counts[t], n) for t, n in asked.items()) + sum(counts[t] == 0 for t in absent)
    return kept / whole if whole else 1.0
