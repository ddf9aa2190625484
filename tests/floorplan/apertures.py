"""Walls and openings of a plan under audit: where each stands, what it joins, how wide it is, where its leaf turns."""

from collections import Counter
from collections.abc import Iterator, Mapping

import numpy as np
import shapely

from pipeline.entities.plan import Opening, Plan
from pipeline.floorplan.program.defaults import DEFAULTS
from pipeline.floorplan.program.floor_program import FloorProgram

BESIDE = 0.09  # [m] of wall beside an opening on both its sides
FREE_WALL = 1.0  # [m] of outside wall without another opening that a window finds place in
PASSAGES = frozenset({"door", "open", "portal", "entrance"})
Shapes = Mapping[str, shapely.Polygon]


def faults(program: FloorProgram, plan: Plan, shapes: Shapes) -> list[str]:
    """Return what is wrong with the openings; rooms are valid polygons."""
    parts = (_link_faults, _stand, _leaves, _windows)
    return [f for part in parts for f in part(program, plan, shapes)]


def _link_faults(program: FloorProgram, plan: Plan, shapes: Shapes) -> Iterator[str]:
    """Yield links without their opening, and openings that nobody asked for."""
    del shapes
    wanted = {frozenset((k.a, k.b)): k.kind for k in program.links if k.kind != "wall"}
    between = Counter(frozenset(o.rooms) for o in plan.openings if len(o.rooms) == 2)
    if set(wanted) != set(between) or max(between.values(), default=1) > 1:
        yield f"openings differ from links: {sorted(map(sorted, set(wanted) ^ set(between)))}"
    for o in plan.openings:
        kind = wanted.get(frozenset(o.rooms), "any")
        if len(o.rooms) == 2 and kind not in {"any", o.kind}:
            yield f"{o.opening_id} is no {kind}"
    if [o.rooms for o in plan.openings if o.kind == "entrance"] != [(program.entrance.into,)]:
        yield "the entrance is not where it was asked for"
    own = {r.id for s in program.entrance.separate for r in program.select(s)} | {r.id for r in program.rooms if r.exterior == "door"}
    doors = {o.rooms[0] for o in plan.openings if len(o.rooms) == 1 and o.kind == "door"}
    gates = {r.id for r in program.rooms if r.type == "garage"}
    if not own - {program.entrance.into} <= doors | gates or not gates <= doors or not doors <= own | gates:
        yield f"outside doors {sorted(doors)} differ from those asked for"
    if len({o.opening_id for o in plan.openings}) < len(plan.openings):
        yield "two openings have one id"


def _stand(program: FloorProgram, plan: Plan, shapes: Shapes) -> Iterator[str]:
    """Yield openings that do not stand in a wall of exactly their rooms, under the ceiling, wide enough, apart from the others."""
    for o in plan.openings:
        along, normal = axes(o)
        half = (plan.inner_wall if len(o.rooms) == 2 else plan.outer_wall) / 2
        levels = {plan.room(i).level for i in o.rooms if plan.room(i).type != "staircase"}
        if levels - {o.level} or not 0 <= o.level < program.storeys:
            yield f"{o.opening_id} is on level {o.level}, its rooms on {sorted(levels)}"
        longer = o.segment + BESIDE * np.array([-along, along])
        sides = [shapely.LineString(longer + sign * (half + 3e-3) * normal) for sign in (1.0, -1.0)]
        faces = [[i for i in o.rooms if shapes[i].buffer(2e-3).contains(s) and shapes[i].exterior.distance(s) < 6e-3] for s in sides]
        if sorted(map(len, faces)) != ([1, 1] if len(o.rooms) == 2 else [0, 1]) or len({i for f in faces for i in f}) != len(o.rooms):
            yield f"{o.opening_id} ({o.kind}) does not stand in the wall of {' and '.join(o.rooms)}"
        elif len(o.rooms) == 1:
            out = sides[0] if not faces[0] else sides[1]
            if any(s.distance(out) < half for i, s in shapes.items() if i not in o.rooms and o.level in _levels(plan, i)):
                yield f"{o.opening_id} ({o.kind}) leads into a room, not outside"
        if o.sill + o.height > min(plan.room(i).height for i in o.rooms) + 1e-9:
            yield f"{o.opening_id} is higher than its rooms"
        least = {"door": program.accessibility.min_door, "entrance": max(0.9, program.accessibility.min_door), "window": 0.5}.get(
            o.kind, 0.79
        )
        if o.width < least - 1e-3:
            yield f"{o.opening_id} ({o.kind}) is {o.width:.2f} m wide"
        if abs(float(along @ normal)) > 1e-9 or np.abs(np.round(o.segment, 3) - o.segment).max() > 1e-9:
            yield f"{o.opening_id} has a crooked segment"
    for k, a in enumerate(plan.openings):
        for b in plan.openings[:k]:
            if a.level == b.level and shapely.LineString(a.segment).distance(shapely.LineString(b.segment)) < BESIDE:
                yield f"{a.opening_id} meets {b.opening_id}"


def _levels(plan: Plan, room: str) -> range:
    top = max(r.level for r in plan.rooms)
    own = plan.room(room)
    return range(own.level, top + 1) if own.type == "staircase" else range(own.level, own.level + 1)


def axes(o: Opening) -> tuple[np.ndarray, np.ndarray]:
    """Return the unit vectors along and across an opening."""
    along = (o.segment[1] - o.segment[0]) / np.linalg.norm(o.segment[1] - o.segment[0])
    return along, np.array([-along[1], along[0]])


def sector(plan: Plan, o: Opening, shapes: Shapes) -> shapely.Polygon:
    """Return what the leaf sweeps: a sector of its angle about the hinge, on its room's side."""
    assert o.swing is not None
    _, normal = axes(o)
    half = (plan.inner_wall if len(o.rooms) == 2 else plan.outer_wall) / 2
    probe = shapely.Point(o.segment.mean(axis=0) + (half + 0.02) * normal)
    side = normal if shapes[o.swing.room_id].contains(probe) else -normal
    pivot, tip = o.segment[o.swing.hinge], o.segment[1 - o.swing.hinge]
    turns = np.linspace(0.0, o.swing.angle, 24)[:, None]
    return shapely.Polygon(np.vstack([pivot, pivot + np.cos(turns) * (tip - pivot) + np.sin(turns) * o.width * side]))


def _leaves(program: FloorProgram, plan: Plan, shapes: Shapes) -> Iterator[str]:
    del program
    swept: list[tuple[Opening, shapely.Polygon]] = []
    for o in plan.openings:
        gate = o.kind == "door" and len(o.rooms) == 1 and plan.room(o.rooms[0]).type == "garage"
        if (o.swing is not None) != (o.kind in {"door", "entrance"} and not gate):
            yield f"{o.opening_id} ({o.kind}) has {'a' if o.swing else 'no'} leaf"
        if o.swing is None:
            continue
        if o.swing.room_id not in o.rooms or not 1.2 <= o.swing.angle <= np.pi:
            yield f"{o.opening_id} swings into {o.swing.room_id} by {o.swing.angle}"
            continue
        sweep = sector(plan, o, shapes)
        half = (plan.inner_wall if len(o.rooms) == 2 else plan.outer_wall) / 2
        reveal = shapely.LineString(o.segment).buffer(half + 2e-3, cap_style="flat")
        if sweep.difference(shapes[o.swing.room_id]).difference(reveal).area > 2e-3:
            yield f"the leaf of {o.opening_id} hits a wall"
        for other, two in swept:
            if other.swing and other.swing.room_id == o.swing.room_id and other.level == o.level and two.distance(sweep) < 0.01:
                yield f"the leaves of {o.opening_id} and {other.opening_id} collide"
        for other in plan.openings:
            passage = other.kind in PASSAGES and other is not o and other.level == o.level and o.swing.room_id in other.rooms
            if passage and shapely.LineString(other.segment).distance(sweep) < 0.01:
                yield f"the leaf of {o.opening_id} stands in {other.opening_id}"
        swept.append((o, sweep))


def _windows(program: FloorProgram, plan: Plan, shapes: Shapes) -> Iterator[str]:
    """Yield rooms without the light that they are to have, or without a window in a free outside wall."""
    for r in program.rooms:
        mine = [o for o in plan.openings if o.kind == "window" and o.rooms == (r.id,)]
        takes = r.window != "forbidden" and (r.window == "required" or DEFAULTS[r.type].window)
        if mine and not takes:
            yield f"{r.id} has a window"
        bare = free_wall(plan, r.id, shapes)
        if not mine and r.window == "required":
            yield f"{r.id} has no window"
        elif takes and not mine and bare >= FREE_WALL:
            yield f"{r.id} has no window in {bare:.2f} m of free outside wall"
        if r.exterior in {"wall", "corner"} and outside(plan, r.id, shapes).length < 0.9:
            yield f"{r.id} lies at no outside wall"
        if r.exterior_length and outside(plan, r.id, shapes).length < r.exterior_length - 1e-6:
            yield f"{r.id} has less outside wall than asked for"
        if r.exterior == "corner" and not _corner(outside(plan, r.id, shapes)):
            yield f"{r.id} owns no corner of the outline"


def outside(plan: Plan, room: str, shapes: Shapes) -> shapely.Geometry:
    """Return the sides of a room (its inner faces) with nothing but the outside behind them."""
    level = plan.room(room).level
    near = [s for i, s in shapes.items() if i != room and level in _levels(plan, i)]
    others = shapely.union_all([s.buffer(plan.outer_wall + 0.12, join_style="mitre") for s in near])
    return shapely.line_merge(shapes[room].exterior.difference(others))


def _corner(walls: shapely.Geometry) -> bool:
    """Whether outside walls of two directions meet."""
    for part in getattr(walls, "geoms", [walls]):
        steps = np.abs(np.diff(np.asarray(part.coords), axis=0)) if not part.is_empty else np.zeros((0, 2))
        if (steps[:, 0] > 0.3).any() and (steps[:, 1] > 0.3).any():
            return True
    return False


def free_wall(plan: Plan, room: str, shapes: Shapes) -> float:
    """Return the longest straight outside wall of a room without an opening or a corner nearby [m]."""
    taken = [shapely.LineString(o.segment).buffer(plan.outer_wall / 2 + 0.05 + 0.1) for o in plan.openings if room in o.rooms]
    rest = outside(plan, room, shapes).difference(shapely.union_all(taken))
    longest = 0.0
    for part in getattr(rest, "geoms", [rest]):
        steps = np.diff(np.asarray(part.coords), axis=0) if not part.is_empty else np.zeros((0, 2))
        longest = max(longest, float(np.hypot(*steps.T).max(initial=0.0)))
    return longest - 0.2
