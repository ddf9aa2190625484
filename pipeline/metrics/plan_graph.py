"""The graph of a floor plan, read off its realised openings, and its matching with a ground-truth graph."""

from collections.abc import Mapping
from typing import Any

from pipeline.entities.plan import Plan, Room

PASSAGES = ("door", "open", "portal")
BUDGET = 200_000  # partial matchings that are looked at before the best so far is kept

Edge = frozenset[str]


def edges_of(plan: Plan) -> dict[Edge, set[str]]:
    """Return the pairs of rooms that an opening joins, with the kinds of their openings."""
    joined: dict[Edge, set[str]] = {}
    for opening in plan.openings:
        if opening.kind in PASSAGES and len(opening.rooms) == 2:
            joined.setdefault(frozenset(opening.rooms), set()).add(opening.kind)
    return joined


def match(plan: Plan, graph: Mapping[str, Any]) -> dict[str, str]:
    """Return the matching {room of the plan: room of the truth} of most common edges, then of nearest areas.

    As many rooms of each type are matched as there are in both. Exact, by branch and bound; among equals the first is taken.
    """
    search = _Search(plan, graph)
    search.branch(0, {}, 0, 0.0)
    return search.best


class _Search:
    """Branch and bound over the rooms, type by type: bounded by the edges that may yet be met and the areas that are left."""

    def __init__(self, plan: Plan, graph: Mapping[str, Any]) -> None:
        self.near = {frozenset((e["a"], e["b"])) for e in graph["edges"]}
        self.area = {r["id"]: r.get("area") for r in graph["rooms"]}
        names: dict[str, list[str]] = {}
        for row in graph["rooms"]:
            names.setdefault(row["type"], []).append(row["id"])
        self.names = names
        rooms = [r for r in plan.rooms if r.type in names]
        order = {t: k for k, t in enumerate(sorted({r.type for r in rooms}, key=lambda t: (sum(r.type == t for r in rooms), t)))}
        self.rooms = sorted(rooms, key=lambda r: (order[r.type], -r.area))
        self.joined = {r.room_id: [next(iter(e - {r.room_id})) for e in edges_of(plan) if r.room_id in e] for r in rooms}
        place = {r.room_id: k for k, r in enumerate(self.rooms)}
        # edges between matched types that are decided from room k on
        ends = [sorted(place[i] for i in e) for e in edges_of(plan) if all(i in place for i in e)]
        self.open = [sum(e[1] >= k for e in ends) for k in range(len(self.rooms) + 1)]
        self.best: dict[str, str] = {}
        self.score = (-1, 0.0)
        self.left = BUDGET

    def branch(self, k: int, assignment: dict[str, str], hits: int, gap: float) -> None:
        """Assign room k and those after it; `hits` edges are met so far, areas differ by `gap` [m2]."""
        self.left -= 1
        if self.left < 0 and self.best:
            return
        if k == len(self.rooms):
            if (hits, -gap) > self.score:
                self.best, self.score = dict(assignment), (hits, -gap)
            return
        most = hits + self.open[k]
        if most < self.score[0] or (most == self.score[0] and -(gap + self._least(k, assignment)) <= self.score[1] + 1e-12):
            return
        room = self.rooms[k]
        taken = set(assignment.values())
        free = [n for n in self.names[room.type] if n not in taken]
        waiting = sum(r.type == room.type for r in self.rooms[k:])
        for name in sorted(free, key=lambda n: (-self._met(room, n, assignment), self._gap(room, n))):
            assignment[room.room_id] = name
            self.branch(k + 1, assignment, hits + self._met(room, name, assignment), gap + self._gap(room, name))
            del assignment[room.room_id]
        if waiting > len(free):  # more rooms than the truth has: this one may stay alone
            self.branch(k + 1, assignment, hits, gap)

    def _met(self, room: Room, name: str, assignment: Mapping[str, str]) -> int:
        return sum(other in assignment and frozenset((name, assignment[other])) in self.near for other in self.joined[room.room_id])

    def _gap(self, room: Room, name: str) -> float:
        wanted = self.area[name]
        return 0.0 if wanted is None else abs(room.area - wanted)

    def _least(self, k: int, assignment: Mapping[str, str]) -> float:
        """Return the least sum of differences that rooms from k on can have: matched by size where there are as many names."""
        taken, total = set(assignment.values()), 0.0
        for kind in {r.type for r in self.rooms[k:]}:
            rooms = [r.area for r in self.rooms[k:] if r.type == kind]
            wanted = [self.area[n] for n in self.names[kind] if n not in taken]
            if len(rooms) == len(wanted) and None not in wanted:
                total += sum(abs(a - b) for a, b in zip(sorted(rooms), sorted(wanted), strict=True))
        return total
