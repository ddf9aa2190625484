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

import itertools
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from pipeline.entities.plan import Plan, Room

WEIGHTS = (0.5, 0.3, 0.2)  # presence, adjacency, constraints: the paper's benchmark score
PASSAGES = ("door", "open", "portal")
OUTDOOR = frozenset({"balcony", "garage"})
TOLERANCE = 0.1  # of numeric checks that state none
TOUCH = 0.26  # rooms this near [m] along a wall share it: an inner wall, or one that is partly an outer one
RUN = 0.4  # of at least this length [m]
BUDGET = 40_000  # matchings that are tried before the greedy one is kept


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


Edge = frozenset[str]


def edges_of(plan: Plan) -> dict[Edge, set[str]]:
    """Return the pairs of rooms that an opening joins, with the kinds of their openings."""
    joined: dict[Edge, set[str]] = {}
    for opening in plan.openings:
        if opening.kind in PASSAGES and len(opening.rooms) == 2:
            joined.setdefault(frozenset(opening.rooms), set()).add(opening.kind)
    return joined


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
    met = [scene.constraint(c) for c in checks.get("constraints", ())]
    adjacency = float(np.mean(adjacent)) if adjacent else 1.0
    constraints = float(np.mean(met)) if met else 1.0
    success = presence == 1.0 and adjacency == 1.0 and all(v >= 1.0 for v in met)
    share = s_constraint(areas_by_type(plan.rooms), graph.get("area_ratio") or truth)
    return PlanScores(node, share, edge, strict_node, strict_edge, presence, adjacency, constraints, success)


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


class Scene:
    """A plan with the names that a case uses for its rooms; answers the checks."""

    def __init__(self, plan: Plan, names: Mapping[str, str]) -> None:
        self.plan, self.names = plan, names
        self.edges = edges_of(plan)
        self.shapes = {r.room_id: shapely.Polygon(r.polygon) for r in plan.rooms}
        points = np.vstack([r.polygon for r in plan.rooms])
        self.diagonal = float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))

    def select(self, selector: str) -> list[Room]:
        """Return the rooms that a selector means: the matched room of that id, else all of the type."""
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
        return not strip.is_empty and strip.area > 0.02 * RUN and max(_extent(strip)) > RUN

    def joined(self, a: Room, b: Room, via: str) -> bool:
        """Whether an adjacency of the kind `via` holds between two rooms."""
        kinds = self.edges.get(frozenset((a.room_id, b.room_id)), set())
        if via == "wall":
            return bool(kinds) or self.touch(a, b)
        if via == "open":
            return bool(kinds & {"open", "portal"})
        return bool(kinds)

    def adjacency(self, check: Mapping[str, Any]) -> list[float]:
        """Return 1 or 0 for each room of `a` (each), or one value (some)."""
        ones, others = self.select(check["a"]), self.select(check["b"])
        met = [any(self.joined(a, b, check.get("via", "any")) for b in others if b.room_id != a.room_id) for a in ones]
        if check.get("quant") == "some" or not met:
            return [float(any(met))]
        return [float(v) for v in met]

    def reachable(self, target: Room, avoid: set[str]) -> bool:
        """Whether one can walk from the entrance to a room without entering any of `avoid`."""
        found, frontier = {self.plan.entrance} - avoid, [self.plan.entrance]
        while frontier:
            here = frontier.pop()
            if here in avoid:
                continue
            for edge in self.edges:
                if here in edge:
                    (other,) = edge - {here}
                    if other not in found and other not in avoid:
                        found.add(other)
                        frontier.append(other)
        return target.room_id in found

    def hops(self, a: Room, b: Room) -> int:
        """Count the openings on the shortest way between two rooms."""
        seen, ring, count = {a.room_id}, {a.room_id}, 0
        while ring:
            if b.room_id in ring:
                return count
            ring = {i for e in self.edges if e & ring for i in e} - seen
            seen |= ring
            count += 1
        return 99

    def outside(self, room: Room) -> float:
        """Length of the room's walls that face the outside [m]."""
        rest = [s.buffer(TOUCH + 0.05, join_style="mitre") for i, s in self.shapes.items() if i != room.room_id and self._level(i, room)]
        border = self.shapes[room.room_id].exterior
        return float(border.difference(shapely.union_all(rest)).length) if rest else float(border.length)

    def _level(self, other: str, room: Room) -> bool:
        return self.plan.room(other).level == room.level or self.plan.room(other).type == "staircase"

    def constraint(self, check: Mapping[str, Any]) -> float:
        """Return how far a constraint is met, in [0, 1]. Raises KeyError for a type that is unknown."""
        return CHECKS[check["type"]](self, check)


def _extent(shape: shapely.Geometry) -> tuple[float, float]:
    x0, y0, x1, y1 = shape.bounds
    return x1 - x0, y1 - y0


def _credit(value: float, low: float | None, high: float | None, tolerance: float) -> float:
    """1 within [low, high], falling linearly to 0 at twice the tolerance beyond."""
    miss = 0.0
    if low is not None and value < low:
        miss = (low - value) / max(low, 1e-9)
    if high is not None and value > high:
        miss = (value - high) / max(high, 1e-9)
    return float(max(0.0, 1.0 - miss / (2 * tolerance))) if miss > 1e-6 else 1.0


def _mean(values: Sequence[float]) -> float:
    return float(np.mean(values)) if values else 0.0


def _total_area(s: Scene, c: Mapping[str, Any]) -> float:
    rooms = [r for r in s.plan.rooms if r.type not in OUTDOOR | set(c.get("exclude", ()))]
    return _credit(sum(r.area for r in rooms), c.get("min"), c.get("max"), c.get("tol", TOLERANCE))


def _room_area(s: Scene, c: Mapping[str, Any]) -> float:
    # a check's own tolerance widens its bounds; credit falls beyond them
    slack = c.get("tol", 0.0)
    low = c["min"] * (1 - slack) if "min" in c else None
    high = c["max"] * (1 + slack) if "max" in c else None
    values = [_credit(r.area, low, high, TOLERANCE) for r in s.select(c["room"])]
    return _mean(values) if c.get("each") else max(values, default=0.0)


def _area_share(s: Scene, c: Mapping[str, Any]) -> float:
    whole = sum(r.area for r in s.plan.rooms)
    return _credit(sum(r.area for r in s.select(c["room"])) / whole, c.get("min"), c.get("max"), TOLERANCE)


def _area_order(s: Scene, c: Mapping[str, Any]) -> float:
    pairs = [a.area / b.area for a in s.select(c["larger"]) for b in s.select(c["smaller"]) if a.room_id != b.room_id]
    return _mean([_credit(v, c.get("min_ratio", 1.0), None, TOLERANCE) for v in pairs])


def _area_equal(s: Scene, c: Mapping[str, Any]) -> float:
    areas = [r.area for name in c["rooms"] for r in s.select(name)]
    return _credit(max(areas) / min(areas) - 1.0, None, c["tol"], 0.5) if areas else 0.0


def _area_max_of(s: Scene, c: Mapping[str, Any]) -> float:
    own = max((r.area for r in s.select(c["room"])), default=0.0)
    most = max((r.area for r in s.select(c["among"])), default=1.0)
    return _credit(own / most, 1.0, None, TOLERANCE)


def _not_adjacent(s: Scene, c: Mapping[str, Any]) -> float:
    pairs = [(a, b) for a in s.select(c["a"]) for b in s.select(c["b"]) if a.room_id != b.room_id]
    return float(bool(pairs) and not any(s.touch(a, b) for a, b in pairs))


def _not_open(s: Scene, c: Mapping[str, Any]) -> float:
    pairs = [frozenset((a.room_id, b.room_id)) for a in s.select(c["a"]) for b in s.select(c["b"])]
    return float(not any(s.edges.get(p, set()) & {"open", "portal"} for p in pairs))


def _open_plan(s: Scene, c: Mapping[str, Any]) -> float:
    ids = {r.room_id for name in c["rooms"] for r in s.select(name)}
    wide = [e for e, kinds in s.edges.items() if kinds & {"open", "portal"} and e <= ids]
    reached = set(sorted(ids)[:1])
    for _ in ids:
        reached |= {i for e in wide if e & reached for i in e}
    return float(bool(ids) and reached == ids)


def _separation(s: Scene, c: Mapping[str, Any]) -> float:
    gaps = [
        s.shapes[a.room_id].centroid.distance(s.shapes[b.room_id].centroid) / s.diagonal
        for a in s.select(c["a"])
        for b in s.select(c["b"])
        if a.room_id != b.room_id
    ]
    return _credit(min(gaps), c["min_frac_diag"], None, TOLERANCE) if gaps else 0.0


def _zone_split(s: Scene, c: Mapping[str, Any]) -> float:
    zones = [{s.names[n] for n in members if n in s.names} for members in c["zones"].values()]
    crossings = sum(1 for e in s.edges if len([z for z in zones if e & z]) > 1)
    return float(crossings <= c.get("max_crossings", 0))


def _ensuite(s: Scene, c: Mapping[str, Any]) -> float:
    baths, beds = s.select(c["bath"]), {r.room_id for r in s.select(c["bedroom"])}
    if not baths:
        return 0.0
    mates = [next(iter(e - {baths[0].room_id})) for e in s.edges if baths[0].room_id in e]
    return float(bool(mates) and set(mates) <= beds)


def _degree(s: Scene, c: Mapping[str, Any]) -> float:
    rooms = s.select(c["room"])
    return float(bool(rooms) and all(sum(r.room_id in e for e in s.edges) == c["equals"] for r in rooms))


def _reachable_without(s: Scene, c: Mapping[str, Any]) -> float:
    avoid = {r.room_id for name in c["avoid"] for r in s.select(name)}
    targets = s.select(c["target"])
    return float(bool(targets) and all(s.reachable(t, avoid) for t in targets))


def _between(s: Scene, c: Mapping[str, Any]) -> float:
    middle = s.select(c["mid"])
    sides = [any(s.joined(m, r, "any") for m in middle for r in s.select(c[k])) for k in ("a", "b")]
    return float(bool(middle) and all(sides))


def _exterior_access(s: Scene, c: Mapping[str, Any]) -> float:
    ids = {r.room_id for name in c.get("any_room", [c.get("room", "")]) for r in s.select(name)}
    return float(any(o.kind in {"door", "entrance", *PASSAGES} and len(o.rooms) == 1 and o.rooms[0] in ids for o in s.plan.openings))


def _exterior_wall(s: Scene, c: Mapping[str, Any]) -> float:
    return _mean([float(s.outside(r) > 0.8) for r in s.select(c["room"])])


def _exterior_length(s: Scene, c: Mapping[str, Any]) -> float:
    return max((_credit(s.outside(r), c["min_m"], None, TOLERANCE) for r in s.select(c["room"])), default=0.0)


def _min_door_width(s: Scene, c: Mapping[str, Any]) -> float:
    widths = [o.width for o in s.plan.openings if o.kind in {"door", "entrance", *PASSAGES}]
    return _credit(min(widths) + 1e-6, c["value"], None, TOLERANCE) if widths else 0.0


def _min_corridor_width(s: Scene, c: Mapping[str, Any]) -> float:
    """Compare the widest square brush that paints all of a corridor with the asked width [m]."""
    values = []
    for room in s.select("hallway"):
        half = 0.5 * c["value"] - 0.005
        shape = s.shapes[room.room_id]
        opened = shape.buffer(-half, join_style="mitre").buffer(half, join_style="mitre")
        values.append(1.0 if opened.area > 0.98 * shape.area else max(0.0, 1.0 - 5 * (1 - opened.area / shape.area)))
    return min(values, default=1.0)


def _irregularity(s: Scene, c: Mapping[str, Any]) -> float:
    bent = sum(len(r.polygon) != 4 for r in s.plan.rooms)
    return float(min(1.0, bent / c["min_nonrect_rooms"]))


def _footprint(s: Scene, c: Mapping[str, Any]) -> float:
    ground = [sh for i, sh in s.shapes.items() if s.plan.room(i).level == 0]
    whole = shapely.union_all([sh.buffer(0.2, join_style="mitre") for sh in ground]).buffer(-0.2, join_style="mitre")
    w, h = _extent(whole)
    if c.get("shape") == "rectangle":
        return float(whole.area > 0.97 * w * h)
    return _credit(max(w, h) / min(w, h), c.get("min_aspect"), c.get("max_aspect"), TOLERANCE)


def _level(s: Scene, c: Mapping[str, Any]) -> float:
    return _mean([float(r.level == c["equals"]) for r in s.select(c["room"])])


def _hallway_share(s: Scene, c: Mapping[str, Any]) -> float:
    halls = sum(r.area for r in s.plan.rooms if r.type in {"hallway", "entry"})
    return float(halls / sum(r.area for r in s.plan.rooms) <= c["max"] + 1e-9)


CHECKS = {
    "total_area": _total_area,
    "room_area": _room_area,
    "area_share": _area_share,
    "area_order": _area_order,
    "area_equal": _area_equal,
    "area_max_of": _area_max_of,
    "not_adjacent": _not_adjacent,
    "not_open": _not_open,
    "open_plan": _open_plan,
    "separation": _separation,
    "zone_split": _zone_split,
    "ensuite": _ensuite,
    "degree": _degree,
    "reachable_without": _reachable_without,
    "between": _between,
    "exterior_access": _exterior_access,
    "exterior_wall": _exterior_wall,
    "exterior_length": _exterior_length,
    "min_door_width": _min_door_width,
    "min_corridor_width": _min_corridor_width,
    "irregularity": _irregularity,
    "footprint": _footprint,
    "level": _level,
    "hallway_share": _hallway_share,
    "storeys": lambda s, c: float(max(r.level for r in s.plan.rooms) + 1 == c["equals"]),
    "room_count": lambda s, c: float(len(s.plan.rooms) == c["equals"]),
    "entrance_room": lambda s, c: float(s.plan.entrance in {r.room_id for r in s.select(c["room"])}),
    "min_hops": lambda s, c: float(all(s.hops(a, b) >= c["min"] for a in s.select(c["a"]) for b in s.select(c["b"]))),
}
