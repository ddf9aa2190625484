"""A floor plan under the names of a test case: which rooms a selector means, what touches, joins and reaches what."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import shapely

from pipeline.entities.plan import Plan, Room, hops
from pipeline.metrics.plan_graph import edges_of

OUTDOOR = frozenset({"balcony", "garage"})
TOUCH = 0.26  # rooms this near [m] along a wall share it: an inner wall, or one that is partly an outer one
RUN = 0.4  # of at least this length [m]


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

    def adjacency(self, check: Mapping[str, Any]) -> list[float]:
        """Return 1 or 0 for each room of `a` (each), of those that the truth has a partner for; or one value (some)."""
        ones, others = self.select(check["a"]), self.select(check["b"])
        known = set(self.names.values())
        if check.get("quant") != "some":
            ones = [r for r in ones if r.room_id in known] or ones
        met = [any(self.joins(a, b, check.get("via", "any")) for b in others if b.room_id != a.room_id) for a in ones]
        if check.get("quant") == "some" or not met:
            return [float(any(met))]
        return [float(v) for v in met]

    def reachable(self, target: Room, avoid: set[str]) -> bool:
        """Whether one can walk from the entrance to a room without entering any of `avoid`."""
        ways = (edge for edge in self.edges if not edge & avoid)
        return target.room_id not in avoid and target.room_id in hops(ways, self.plan.entrance)

    def hops(self, a: Room, b: Room) -> int:
        """Count the openings on the shortest way between two rooms."""
        return hops(self.edges, a.room_id).get(b.room_id, 99)

    def outside(self, room: Room) -> float:
        """Length of the room's walls that face the outside [m]."""
        rest = [s.buffer(TOUCH + 0.05, join_style="mitre") for i, s in self.shapes.items() if i != room.room_id and self._level(i, room)]
        border = self.shapes[room.room_id].exterior
        return float(border.difference(shapely.union_all(rest)).length) if rest else float(border.length)

    def _level(self, other: str, room: Room) -> bool:
        return self.plan.room(other).level == room.level or self.plan.room(other).type == "staircase"


def extent(shape: shapely.Geometry) -> tuple[float, float]:
    """Return width and height of the shape's bounds [m]."""
    x0, y0, x1, y1 = shape.bounds
    return x1 - x0, y1 - y0
