"""Checks of a floor plan: how far each kind of constraint of a test case is met, in [0, 1]."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import shapely

from pipeline.metrics.plan_graph import OUTDOOR, PASSAGES, Scene, extent

TOLERANCE = 0.1  # of numeric checks that state none


def _credit(value: float, low: float | None, high: float | None, tolerance: float) -> float:
    """1 within [low, high], falling linearly to 0 at twice the tolerance beyond."""
    miss = 0.0
    if low is not None and value < low:
        miss = (low - value) / max(low, 1e-9)
    if high is not None and value > high:
        miss = (value - high) / max(high, 1e-9)
    return float(max(0.0, 1.0 - miss / max(2 * tolerance, 1e-9))) if miss > 1e-6 else 1.0


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
    zones = [{r.room_id for n in members for r in s.select(n)} for members in c["zones"].values()]
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
    sides = [any(s.joins(m, r, "any") for m in middle for r in s.select(c[k])) for k in ("a", "b")]
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
    return float(min(1.0, bent / max(c["min_nonrect_rooms"], 1)))


def _footprint(s: Scene, c: Mapping[str, Any]) -> float:
    ground = [sh for i, sh in s.shapes.items() if s.plan.room(i).level == 0]
    whole = shapely.union_all([sh.buffer(0.2, join_style="mitre") for sh in ground]).buffer(-0.2, join_style="mitre")
    w, h = extent(whole)
    if c.get("shape") == "rectangle":
        return float(whole.area > 0.97 * w * h)
    return _credit(max(w, h) / min(w, h), c.get("min_aspect"), c.get("max_aspect"), TOLERANCE)


def _level(s: Scene, c: Mapping[str, Any]) -> float:
    return _mean([float(r.level == c["equals"]) for r in s.select(c["room"])])


def _hallway_share(s: Scene, c: Mapping[str, Any]) -> float:
    halls = sum(r.area for r in s.plan.rooms if r.type in {"hallway", "entry"})
    return float(halls / sum(r.area for r in s.plan.rooms) <= c["max"] + 1e-9)


def _storeys(s: Scene, c: Mapping[str, Any]) -> float:
    return float(max(r.level for r in s.plan.rooms) + 1 == c["equals"])


def _room_count(s: Scene, c: Mapping[str, Any]) -> float:
    return float(len(s.plan.rooms) == c["equals"])


def _entrance_room(s: Scene, c: Mapping[str, Any]) -> float:
    return float(s.plan.entrance in {r.room_id for r in s.select(c["room"])})


def _min_hops(s: Scene, c: Mapping[str, Any]) -> float:
    return float(all(s.hops(a, b) >= c["min"] for a in s.select(c["a"]) for b in s.select(c["b"])))


CHECKS = {
    check.__name__[1:]: check
    for check in (
        _total_area, _room_area, _area_share, _area_order, _area_equal, _area_max_of, _not_adjacent, _not_open, _open_plan, _separation,
        _zone_split, _ensuite, _degree, _reachable_without, _between, _exterior_access, _exterior_wall, _exterior_length, _min_door_width,
        _min_corridor_width, _irregularity, _footprint, _level, _hallway_share, _storeys, _room_count, _entrance_room, _min_hops,
    )
}  # fmt: skip
NEEDS = {  # fields without which a check says nothing
    "room_area": ("room",), "area_share": ("room",), "area_order": ("larger", "smaller"), "area_equal": ("rooms", "tol"),
    "area_max_of": ("room", "among"), "not_adjacent": ("a", "b"), "not_open": ("a", "b"), "open_plan": ("rooms",),
    "separation": ("a", "b", "min_frac_diag"), "zone_split": ("zones",), "ensuite": ("bath", "bedroom"), "degree": ("room", "equals"),
    "reachable_without": ("target", "avoid"), "between": ("mid", "a", "b"), "exterior_wall": ("room",), "exterior_length": ("room", "min_m"),
    "min_door_width": ("value",), "min_corridor_width": ("value",), "irregularity": ("min_nonrect_rooms",), "level": ("room", "equals"),
    "hallway_share": ("max",), "storeys": ("equals",), "room_count": ("equals",), "entrance_room": ("room",), "min_hops": ("a", "b", "min"),
}  # fmt: skip
MEASURES = (
    "min", "max", "tol", "min_ratio", "min_frac_diag", "min_m", "value", "equals", "min_aspect", "max_aspect", "min_nonrect_rooms", "max_crossings",
)  # fmt: skip


def constraint(scene: Scene, check: Mapping[str, Any]) -> float:
    """Return how far a constraint is met, in [0, 1]. Raises KeyError for a type that is unknown."""
    return CHECKS[check["type"]](scene, check)
