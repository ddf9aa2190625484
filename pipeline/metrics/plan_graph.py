"""The graph of a floor plan, read off its realised openings, and its matching with a ground-truth graph."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import Any

from pipeline.entities.plan import Plan, Room

PASSAGES = ("door", "open", "portal")
BUDGET = 40_000  # matchings that are tried before the greedy one is kept

Edge = frozenset[str]


def edges_of(plan: Plan) -> dict[Edge, set[str]]:
    """Return the pairs of rooms that an opening joins, with the kinds of their openings."""
    joined: dict[Edge, set[str]] = {}
    for opening in plan.openings:
        if opening.kind in PASSAGES and len(opening.rooms) == 2:
            joined.setdefault(frozenset(opening.rooms), set()).add(opening.kind)
    return joined


def match(plan: Plan, graph: Mapping[str, Any]) -> dict[str, str]:
    """Return the matching {room of the plan: room of the truth} of most common edges, then of nearest areas."""
    wanted = {(e["a"], e["b"]) for e in graph["edges"]}
    near = {frozenset(e) for e in wanted}
    made = set(edges_of(plan))
    truth = {r["id"]: r for r in graph["rooms"]}
    by_type: dict[str, tuple[list[Room], list[str]]] = {}
    for room in plan.rooms:
        by_type.setdefault(room.type, ([], []))[0].append(room)
    for name, row in truth.items():
        by_type.setdefault(row["type"], ([], []))[1].append(name)
    groups = [(a, b) for a, b in by_type.values() if a and b]
    groups.sort(key=lambda g: len(g[0]) * len(g[1]))

    def gain(found: Mapping[str, str]) -> tuple[int, float]:
        hits = sum(1 for e in made if frozenset(found.get(i, "") for i in e) in near)
        gap = sum(abs(room.area - truth[found[room.room_id]].get("area", room.area)) for room in plan.rooms if room.room_id in found)
        return hits, -gap

    current: dict[str, str] = {}
    for rooms, names in groups:  # a first guess: by size
        ordered = sorted(names, key=lambda n: -truth[n].get("area", 0.0))
        current.update({r.room_id: n for r, n in zip(sorted(rooms, key=lambda r: -r.area), ordered, strict=False)})
    total = 1
    for rooms, names in groups:
        total *= len(list(itertools.islice(_injections(rooms, names), BUDGET)))
    if total <= BUDGET:
        best, score = current, gain(current)
        for choice in itertools.product(*(list(_injections(a, b)) for a, b in groups)):
            found = {i: n for part in choice for i, n in part.items()}
            value = gain(found)
            if value > score:
                best, score = found, value
        return best
    # too many: improve one type after the other until nothing changes
    score = gain(current)
    improved = True
    while improved:
        improved = False
        for rooms, names in groups:
            for part in itertools.islice(_injections(rooms, names), BUDGET):
                trial = {**{k: v for k, v in current.items() if k not in {r.room_id for r in rooms}}, **part}
                value = gain(trial)
                if value > score:
                    current, score, improved = trial, value, True
    return current


def _injections(rooms: Sequence[Room], names: Sequence[str]) -> Any:
    """Yield every way to match the smaller of two sets into the larger."""
    if len(rooms) <= len(names):
        for chosen in itertools.permutations(names, len(rooms)):
            yield {r.room_id: n for r, n in zip(rooms, chosen, strict=True)}
    else:
        for picked in itertools.permutations(rooms, len(names)):
            yield {r.room_id: n for r, n in zip(picked, names, strict=True)}
