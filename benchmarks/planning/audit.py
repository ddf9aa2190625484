"""What must hold of every plan, looked at from outside: a list of faults, empty when there are none."""

from __future__ import annotations

import numpy as np
import shapely

from pipeline.entities.plan import Opening, Plan
from pipeline.floorplan.openings import leaf_sweep
from pipeline.floorplan.program import FloorProgram

DEAD = frozenset({"bathroom", "wc"})
TOLERANCE = 0.101  # of stated areas


def faults(program: FloorProgram, plan: Plan) -> list[str]:
    """Return what is wrong with the plan of a completed program."""
    shapes = {r.room_id: shapely.Polygon(r.polygon) for r in plan.rooms}
    if set(shapes) != {r.id for r in program.rooms}:
        return ["rooms are not those asked for"]
    return [*_shapes(plan, shapes), *_areas(program, plan), *_openings(program, plan, shapes), *_ways(plan)]


def _shapes(plan: Plan, shapes: dict[str, shapely.Polygon]) -> list[str]:
    found = [f"{i} is no valid polygon" for i, s in shapes.items() if not s.is_valid or not s.exterior.is_ccw]
    for k, a in enumerate(plan.rooms):
        for b in plan.rooms[:k]:
            same = a.level == b.level or "staircase" in {a.type, b.type}
            if same and shapes[a.room_id].distance(shapes[b.room_id]) < plan.inner_wall - 2e-3:
                found.append(f"{a.room_id} and {b.room_id} stand in each other's wall")
    return found


def _areas(program: FloorProgram, plan: Plan) -> list[str]:
    found = []
    for r in program.rooms:
        made, wish = plan.room(r.id).area, r.area
        if (wish.min is not None and made < wish.min - 1e-6) or (wish.max is not None and made > wish.max + 1e-6):
            found.append(f"{r.id} has {made:.2f} m2, bounds {wish.min}..{wish.max}")
        elif wish.stated and wish.min is None and wish.max is None and wish.target and abs(made / wish.target - 1) > TOLERANCE:
            found.append(f"{r.id} has {made:.2f} m2 of {wish.target:.2f}")
    return found


def _sweep(o: Opening, shapes: dict[str, shapely.Polygon]) -> shapely.Polygon:
    assert o.swing is not None
    wall = (o.segment[1] - o.segment[0]) / o.width
    normal = np.array([-wall[1], wall[0]])
    middle = o.segment.mean(axis=0)
    if shapes[o.swing.room_id].distance(shapely.Point(middle + 0.3 * normal)) > 0:
        normal = -normal
    return leaf_sweep(o.segment, o.swing.hinge, normal, o.width)


def _openings(program: FloorProgram, plan: Plan, shapes: dict[str, shapely.Polygon]) -> list[str]:
    found = []
    wanted = {frozenset((k.a, k.b)): k.kind for k in program.links if k.kind != "wall"}
    made = {frozenset(o.rooms): o.kind for o in plan.openings if len(o.rooms) == 2}
    if set(wanted) != set(made):
        found.append(f"openings differ from links: {sorted(map(sorted, set(wanted) ^ set(made)))}")
    found += [f"{sorted(e)} is {made[e]}, not {k}" for e, k in wanted.items() if e in made and k != "any" and made[e] != k]
    if [o.rooms for o in plan.openings if o.kind == "entrance"] != [(program.entrance.into,)]:
        found.append("the entrance is not where it was asked for")
    own = {r.id for s in program.entrance.separate for r in program.select(s)} - {program.entrance.into}
    doors = {o.rooms[0] for o in plan.openings if len(o.rooms) == 1 and o.kind == "door"}
    if not own <= doors or not doors <= own | {r.id for r in program.rooms if r.type == "garage" or r.exterior == "door"}:
        found.append("outside doors differ from those asked for")
    sweeps: list[tuple[str, shapely.Polygon]] = []
    for o in plan.openings:
        half = (plan.inner_wall if len(o.rooms) == 2 else plan.outer_wall) / 2
        line = shapely.LineString(o.segment)
        found += [f"{o.opening_id} stands off {i}" for i in o.rooms if abs(shapes[i].distance(line) - half) > 3e-3]
        if o.kind == "door" and o.swing and o.width < program.accessibility.min_door - 1e-6:
            found.append(f"{o.opening_id} is {o.width:.2f} m wide")
        if o.swing:
            sweep = _sweep(o, shapes)
            if sweep.difference(shapes[o.swing.room_id].buffer(half + 3e-3, join_style="mitre")).area > 2e-3:
                found.append(f"the leaf of {o.opening_id} hits a wall")
            sweeps.append((o.swing.room_id, sweep))
    for k, (room, one) in enumerate(sweeps):
        found += ["leaves collide" for other, two in sweeps[:k] if room == other and one.intersection(two).area > 1e-9]
    for k, a in enumerate(plan.openings):
        for b in plan.openings[:k]:
            if a.level == b.level and shapely.LineString(a.segment).distance(shapely.LineString(b.segment)) < 0.01:
                found.append(f"{a.opening_id} meets {b.opening_id}")
    return found


def _ways(plan: Plan) -> list[str]:
    kinds = {r.room_id: r.type for r in plan.rooms}
    reached, frontier = {plan.entrance}, [plan.entrance]
    while frontier:
        here = frontier.pop()
        if here != plan.entrance and kinds[here] in DEAD:
            continue
        for o in plan.openings:
            if here in o.rooms and len(o.rooms) == 2:
                other = o.rooms[0] if o.rooms[1] == here else o.rooms[1]
                if other not in reached:
                    reached.add(other)
                    frontier.append(other)
    return [f"{i} is cut off" for i in sorted(set(kinds) - reached)]
