"""What must hold of every plan, looked at by another hand than the solver's: a list of faults, empty when there are none.

Only polygons, openings and the completed program are looked at; nothing of the solver is used but the tables of defaults.
`apertures` looks at walls and openings; here are rooms, areas, relations, storeys and ways.
"""

from collections.abc import Iterator, Mapping

import numpy as np
import shapely

from pipeline.entities.plan import Plan, Room
from pipeline.floorplan.program.defaults import OUTSIDE
from pipeline.floorplan.program.floor_program import FloorProgram
from tests.floorplan import apertures

DEAD = frozenset({"bathroom", "wc"})
BEHIND_BEDROOMS = frozenset({"bathroom", "wc", "closet", "balcony", "storage", "office", "sunroom", "utility"})
STATED = 0.1001  # how far a stated target may be missed
USUAL, USUAL_HALL = (0.55, 1.45), (0.55, 2.65)  # factors on targets that nobody stated
THIN, VOID, OVERHANG = 0.4, 0.02, 0.35  # [m] half of what is passable; [m2] of nothing between rooms; [m] beyond the storey below
Shapes = Mapping[str, shapely.Polygon]


def faults(program: FloorProgram, plan: Plan) -> list[str]:
    """Return what is wrong with the plan of a completed program."""
    asked, actual = {r.id: r for r in program.rooms}, {r.room_id: r for r in plan.rooms}
    if set(actual) != set(asked) or len(plan.rooms) != len(asked):
        return ["rooms are not those asked for"]
    shapes = {r.room_id: shapely.Polygon(r.polygon) for r in plan.rooms}
    broken = list(_polygons(program, plan, shapes))
    if broken:
        return broken
    parts = (_storeys, _areas, _outline, _relations, _wishes, _ways)
    return [f for part in parts for f in part(program, plan, shapes)] + apertures.faults(program, plan, shapes)


def _polygons(program: FloorProgram, plan: Plan, shapes: Shapes) -> Iterator[str]:
    for r in program.rooms:
        room, shape = plan.room(r.id), shapes[r.id]
        if (room.type, room.role, room.level) != (r.type, r.role, r.level):
            yield f"{r.id} is a {room.type} {room.role!r} on level {room.level}"
        if not shape.is_valid or not shape.exterior.is_ccw:
            yield f"{r.id} is no valid polygon"
        ahead = np.roll(room.polygon, -1, axis=0) - room.polygon
        turn = np.cross(ahead, np.roll(ahead, -1, axis=0))
        if np.abs(turn).min() < 1e-6:
            yield f"{r.id} has a collinear vertex"
        straight = np.abs(ahead).min(axis=1) < 1e-9
        slanted = np.abs(np.abs(ahead[:, 0]) - np.abs(ahead[:, 1])) < 2e-3
        if not (straight | (slanted & (program.footprint.corners == "chamfered"))).all():
            yield f"{r.id} has a slanted wall"
        if np.abs(np.round(room.polygon, 3) - room.polygon).max() > 1e-9:
            yield f"{r.id} has corners finer than 1 mm"
        worn = shape.buffer(-THIN, join_style="mitre")
        if worn.geom_type != "Polygon" or worn.is_empty:
            yield f"{r.id} falls apart at a neck"


def on(plan: Plan, level: int) -> list[Room]:
    """Return the rooms of a storey; staircases go through all."""
    return [r for r in plan.rooms if r.level == level or r.type == "staircase"]


def _storeys(program: FloorProgram, plan: Plan, shapes: Shapes) -> Iterator[str]:
    """Overlaps, gaps, stairs above each other, nothing in the air."""
    below: shapely.Geometry | None = None
    for level in range(program.storeys):
        here = on(plan, level)
        for k, a in enumerate(here):
            for b in here[:k]:
                if shapes[a.room_id].distance(shapes[b.room_id]) < plan.inner_wall - 2e-3:
                    yield f"{a.room_id} and {b.room_id} stand in each other's wall"
        thick = max(plan.inner_wall, plan.outer_wall)
        filled = shapely.union_all([shapes[r.room_id].buffer(plan.inner_wall / 2 + 0.005, join_style="mitre") for r in here])
        closed = shapely.union_all([shapes[r.room_id].buffer(0.45, join_style="mitre") for r in here]).buffer(-0.45, join_style="mitre")
        if closed.geom_type != "Polygon" or closed.interiors:
            yield f"level {level} is not one piece without holes"
        # where a room's side lies partly outside, the wall beside it is up to a whole outer wall thick
        void = closed.difference(filled).buffer(-(thick - plan.inner_wall) / 2 - 0.01, join_style="mitre")
        if void.area > VOID:
            yield f"level {level} has a gap of {void.area:.2f} m2 between rooms"
        if below is not None and closed.difference(below.buffer(OVERHANG, join_style="mitre")).area > VOID:
            yield f"level {level} hangs over the storey below"
        below = closed
    flights = [r for r in plan.rooms if r.type == "staircase"]
    if program.storeys > 1 and not flights:
        yield "no staircase"
    for r in flights:
        if program.storeys > 1 and (r.level != 0 or len(r.polygon) != 4):
            yield f"{r.room_id} does not go through all storeys as one rectangle"
        reached = {o.level for o in plan.openings if r.room_id in o.rooms and len(o.rooms) == 2}
        if program.storeys > 1 and reached != set(range(program.storeys)):
            yield f"{r.room_id} is entered on levels {sorted(reached)} only"


def _areas(program: FloorProgram, plan: Plan, shapes: Shapes) -> Iterator[str]:
    for r in program.rooms:
        area, wish = shapes[r.id].area, r.area
        if abs(area - plan.room(r.id).area) > 1e-6:
            yield f"the area of {r.id} is not that of its polygon"
        if (wish.min is not None and area < wish.min - 1e-6) or (wish.max is not None and area > wish.max + 1e-6):
            yield f"{r.id} has {area:.2f} m2, bounds {wish.min}..{wish.max}"
        elif wish.stated and wish.min is None and wish.max is None and wish.target and abs(area / wish.target - 1) > STATED:
            yield f"{r.id} has {area:.2f} m2 of {wish.target:.2f}"
        elif not wish.stated and wish.target:
            low, high = USUAL_HALL if r.type in {"hallway", "entry"} else USUAL
            if not low <= area / wish.target <= high:
                yield f"{r.id} has {area:.2f} m2, usual are {wish.target:.2f}"
    wish, whole = program.total_area, sum(shapes[r.id].area for r in program.rooms if r.type not in OUTSIDE)
    if wish.stated and not (wish.min or 0.0) <= whole <= (wish.max or np.inf):
        yield f"the home has {whole:.1f} m2, bounds {wish.min}..{wish.max}"
    if wish.stated and wish.min is None and wish.max is None and wish.target and abs(whole / wish.target - 1) > STATED:
        yield f"the home has {whole:.1f} m2 of {wish.target}"


def _outline(program: FloorProgram, plan: Plan, shapes: Shapes) -> Iterator[str]:
    whole = shapely.union_all([s.buffer(0.3, join_style="mitre") for i, s in shapes.items() if plan.room(i).level == 0])
    whole = whole.buffer(plan.outer_wall - 0.3, join_style="mitre")
    x0, y0, x1, y1 = whole.bounds
    if program.footprint.stated:
        aspect = max(x1 - x0, y1 - y0) / min(x1 - x0, y1 - y0)
        if not 0.97 * program.footprint.min_aspect <= aspect <= 1.03 * program.footprint.max_aspect:
            yield f"the outline is {aspect:.2f} long"
        share = whole.area / ((x1 - x0) * (y1 - y0))
        if (program.footprint.shape == "rectangle") != (share > 0.97) and program.footprint.shape != "any":
            yield f"the outline fills {share:.2f} of its box, asked for is {program.footprint.shape}"
    if sum(len(r.polygon) != 4 for r in plan.rooms) < program.nonrect:
        yield f"fewer than {program.nonrect} rooms are not rectangles"


def _relations(program: FloorProgram, plan: Plan, shapes: Shapes) -> Iterator[str]:
    corners = np.vstack([r.polygon for r in plan.rooms])
    diagonal = float(np.linalg.norm(np.ptp(corners, axis=0)))
    for r in program.relations:
        ones = [x.id for x in program.select(r.a)]
        pairs = [(a, b.id) for a in ones for b in program.select(r.b or r.a) if a != b.id]
        for a, b in pairs:
            ratio = shapes[a].area / shapes[b].area
            gap = shapes[a].centroid.distance(shapes[b].centroid) / diagonal
            small = r.kind in {"area_order", "largest"} and ratio < r.value * (r.kind == "area_order") + (r.kind == "largest") - 1e-6
            alike = r.kind == "area_equal" and max(ratio, 1 / ratio) > 1 + r.value + 1e-6
            if small or alike or (r.kind == "separation" and gap < r.value - 1e-6):
                yield f"{r.kind} {a} {b}: ratio {ratio:.3f}, {gap:.3f} of the diagonal apart, asked for {r.value:g}"
        whole = sum(shapes[x.id].area for x in program.rooms if x.type not in OUTSIDE)
        if r.kind == "area_share" and sum(shapes[i].area for i in ones) < r.value * whole - 1e-6:
            yield f"{r.a} takes less than {r.value:g} of the area"
        for room in ones if r.kind == "degree" else ():
            doors = sum(room in o.rooms and len(o.rooms) == 2 and o.kind != "window" for o in plan.openings)
            if doors != r.value:
                yield f"{room} has {doors} openings, not {r.value:g}"


def _wishes(program: FloorProgram, plan: Plan, shapes: Shapes) -> Iterator[str]:
    """Widths that were asked for, and common walls that were ruled out."""
    for r in program.rooms:
        wide = r.min_width or (program.accessibility.min_corridor if r.type == "hallway" else None)
        if wide:
            half = wide / 2 - 0.006
            opened = shapes[r.id].buffer(-half, join_style="mitre").buffer(half, join_style="mitre")
            enough = opened.area > 0.985 * shapes[r.id].area if r.type == "hallway" else not opened.is_empty
            if not enough:
                yield f"{r.id} is narrower than {wide:g} m"
    near = plan.outer_wall + 0.02
    for f in program.forbids:
        for a in program.select(f.a):
            for b in program.select(f.b) if f.b else ():
                if a.id == b.id or (a.level != b.level and "staircase" not in {a.type, b.type}):
                    continue
                joined = {o.kind for o in plan.openings if set(o.rooms) == {a.id, b.id}} - {"window"}
                strip = shapes[a.id].buffer(near, join_style="mitre").intersection(shapes[b.id])
                x0, y0, x1, y1 = strip.bounds if not strip.is_empty else (0.0,) * 4
                touch = max(x1 - x0, y1 - y0) > 0.4
                hit = {"adjacent": touch or bool(joined), "connected": bool(joined), "open": bool(joined & {"open", "portal"})}
                if hit.get(f.what):
                    yield f"{f.what} {a.id} {b.id} is forbidden"


def _ways(program: FloorProgram, plan: Plan, shapes: Shapes) -> Iterator[str]:
    """Yield rooms that one cannot reach on ways that may be taken, or only through what is to be avoided."""
    del shapes
    stated = {frozenset((k.a, k.b)) for k in program.links if k.stated}
    kinds = {r.room_id: r.type for r in plan.rooms}

    def walk(avoid: frozenset[str]) -> set[str]:
        reached = {plan.entrance} - avoid
        frontier = list(reached)
        while frontier:
            here = frontier.pop()
            for o in plan.openings:
                if here not in o.rooms or len(o.rooms) != 2 or o.kind == "window":
                    continue
                other = o.rooms[0] if o.rooms[1] == here else o.rooms[1]
                through = here == plan.entrance or kinds[here] not in DEAD
                if kinds[here] == "bedroom" and here != plan.entrance:
                    through = kinds[other] in BEHIND_BEDROOMS or frozenset(o.rooms) in stated
                if through and other not in reached | avoid:
                    reached.add(other)
                    frontier.append(other)
        return reached

    if plan.entrance != program.entrance.into:
        yield f"one enters {plan.entrance}, not {program.entrance.into}"
    yield from (f"{i} is cut off" for i in sorted(set(kinds) - walk(frozenset())))
    for f in program.forbids:
        if f.what == "through" and f.avoid:
            avoid = frozenset(r.id for r in program.select(f.avoid))
            yield from (f"{r.id} lies behind {f.avoid}" for r in program.select(f.a) if r.id not in walk(avoid - {r.id}))
