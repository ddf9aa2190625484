"""A floor plan as a test case sees it: its graph, read off its realised openings, matched with the truth; what its rooms touch and reach."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import shapely

from pipeline.entities.plan import Plan, Room, hops

PASSAGES = ("door", "open", "portal")
BUDGET = 200_000  # partial matchings that are looked at before the best so far is kept
OUTDOOR = frozenset({"balcony", "garage"})
TOUCH = 0.26  # rooms this near [m] along a wall share it: an inner wall, or one that is partly an outer one
RUN = 0.4  # of at least this length [m]

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


class Scene:
    """A plan with the names that a case uses for its rooms; answers the checks."""

    def __init__(self, plan: Plan, names: Mapping[str, str]) -> None:
        self.plan, self.names = plan, names
        self.edges = edges_of(plan)
        self.shapes = {r.room_id: shapely.Polygon(r.polygon) for r in plan.rooms}
        points = np.vstack([r.polygon for r in plan.rooms])
        self.diagonal = float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))

    def select(self, selector: object) -> list[Room]:
        """Return the rooms that a selector means: the matched room of that id, else all of the type. Ids may be numbers in a file."""
        selector = str(selector)
        if selector in self.names:
            return [self.plan.room(self.names[selector])]
        if selector == "all_interior":
            return [r for r in self.plan.rooms if r.type not in OUTDOOR]
        return [r for r in self.plan.rooms if r.type == selector]

    def touch(self, a: Room, b: Room) -> bool:
        """Whether two rooms share a wall."""
        if a.level != b.level and "staircase" not in {a.type, b.type}:
            return False
        one, two = self.shapes[a.room_id], self.shapes[b.room_id]
        strip = one.buffer(TOUCH, join_style="mitre").intersection(two)
        return not strip.is_empty and strip.area > 0.02 * RUN and max(extent(strip)) > RUN

    def joins(self, a: Room, b: Room, via: str) -> bool:
        """Whether an adjacency of the kind `via` holds between two rooms."""
        kinds = self.edges.get(frozenset((a.room_id, b.room_id)), set())
        if via == "wall":
            return bool(kinds) or self.touch(a, b)
        if via == "open":
            return bool(kinds & {"open", "portal"})
        return bool(kinds)

    def reachable(self, target: Room, avoid: set[str]) -> bool:
        """Whether one can walk from the entrance to a room without entering any of `avoid`."""
        ways = (edge for edge in self.edges if not edge & avoid)
        return target.room_id not in avoid and target.room_id in hops(ways, self.plan.entrance)

    def hops(self, a: Room, b: Room) -> int:
        """Count the openings on the shortest way between two rooms."""
        return hops(self.edges, a.room_id).get(b.room_id, 99)

    def outside(self, room: Room) -> float:
        """Length of the room's walls that face the outside [m]."""
        beside = (r for r in self.plan.rooms if r.room_id != room.room_id and (r.level == room.level or r.type == "staircase"))
        rest = [self.shapes[r.room_id].buffer(TOUCH + 0.05, join_style="mitre") for r in beside]
        border = self.shapes[room.room_id].exterior
        return float(border.difference(shapely.union_all(rest)).length) if rest else float(border.length)


def extent(shape: shapely.Geometry) -> tuple[float, float]:
    """Return width and height of the shape's bounds [m]."""
    x0, y0, x1, y1 = shape.bounds
    return x1 - x0, y1 - y0
