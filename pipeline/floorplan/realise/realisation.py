"""Grids → plan: walls leave the raster, rooms get their inner faces, stretches of wall their openings."""

import numpy as np
from numpy.typing import NDArray
from shapely import Polygon

from pipeline.entities.plan import Plan, Room, hops
from pipeline.floorplan.program.defaults import OUTSIDE
from pipeline.floorplan.program.floor_program import FloorProgram
from pipeline.floorplan.realise import wall_lines
from pipeline.floorplan.realise.chamfers import chamfer_corners
from pipeline.floorplan.realise.openings import Run, place
from pipeline.floorplan.search.grid import Halves, Labels
from pipeline.floorplan.search.storeys import EDGE, UNIT, Storey, is_flexible_hall

SHARES = (1.0, 0.4, 0.0)  # how much of their freedom the walls' lines use; less when openings then find no place
HALL_TRUST = 0.02  # how much the lines care for the area of an unstated hallway, beside that of a room
NARROW = 0.81  # no room is narrower anywhere [m]
STOREY_HEIGHT, CEILING = 3.0, 0.3  # floor to floor at least, thickness of what lies between [m]


def build(program: FloorProgram, storeys: list[tuple[Storey, Labels]], rng: np.random.Generator) -> Plan | None:
    """Turn the grids into rooms and openings; None when an opening finds no place."""
    depth = _depths(program)
    flights = _flights(storeys)
    draw = rng.bit_generator.state
    for share in SHARES:
        rng.bit_generator.state = draw
        rooms: list[Room] = []
        runs: list[Run] = []
        for request, grid in storeys:
            _realise(program, request, grid, share, rooms, runs, flights)
        if not _within(program, storeys, rooms) or any(_is_narrow(r) for r in rooms):
            continue
        openings = place(program, rooms, runs, depth, rng)
        if openings is not None:
            shell, entrance = program.shell, program.entrance.into or rooms[0].room_id
            storey_height = max(STOREY_HEIGHT, shell.ceiling + CEILING)
            plan = Plan(tuple(rooms), openings, entrance, shell.inner_wall, shell.outer_wall, round(storey_height, 3))
            if program.footprint.corners == "plain":
                return plan
            return chamfer_corners(program, plan, lambda new_rooms: _within(program, storeys, new_rooms))
    return None


def _flights(storeys: list[tuple[Storey, Labels]]) -> list[bool]:
    """Return which sides of a staircase have a room behind them on any storey: it is one room, and its walls stand above each other."""
    by_storey: list[list[bool]] = []
    for request, grid in storeys if len(storeys) > 1 else []:
        room = next(i for i, r in enumerate(request.rooms) if r.type == "staircase")
        by_storey.append(_inner_sides(grid, wall_lines.outline(grid, room), len(request.rooms)))
    return [any(sides) for sides in zip(*by_storey, strict=True)]


def _realise(
    program: FloorProgram, request: Storey, grid: Labels, share: float, rooms: list[Room], runs: list[Run], flights: list[bool]
) -> None:
    """Append a storey's rooms and the stretches of wall that openings can stand in; lines move by `share` of what they may."""
    spec, n = request.spec, len(request.rooms)
    corners = [wall_lines.outline(grid, i) for i in range(n)]
    sides = [flights if flights and r.type == "staircase" else _inner_sides(grid, corners[i], n) for i, r in enumerate(request.rooms)]
    lines = wall_lines.find_lines(grid, UNIT)
    tight = np.array([r.type == "hallway" or r.min_width is not None for r in request.rooms])
    spare = np.array([_across(c) for c in corners]) - NARROW - spec.half.inner - spec.half.outer
    slack = np.where(tight, (spec.strict * UNIT - request.clear) / 2, np.minimum(wall_lines.FARTHEST, spare / 2))
    trust = np.where([is_flexible_hall(r) for r in request.rooms], HALL_TRUST, 1.0)
    fixed = np.zeros(lines.at.size, dtype=bool)
    for i in (i for i, r in enumerate(request.rooms) if r.type == "staircase"):
        fixed |= wall_lines.outer(lines, grid, n)  # outside walls and stairs stand above each other
        fixed[wall_lines.corner_lines(lines, corners[i])] = True
    at = wall_lines.fit_lines(lines, corners, sides, spec.target, trust, np.maximum(slack, 0.0), fixed, share, spec.half)
    for i, room in enumerate(request.rooms):
        if room.type == "staircase" and request.level > 0:
            continue  # one room with its lowest level
        polygon = np.round(at[wall_lines.corner_lines(lines, corners[i])] + wall_lines.insets(corners[i], sides[i], spec.half), 3)
        rooms.append(Room(room.id, room.type, polygon, request.level, program.shell.ceiling, room.role, functions=room.functions))
    runs += _runs(request, wall_lines.walls(grid, n), rooms, lines, at)


def _across(corners: wall_lines.Corners) -> float:
    """Return the width of a rectangular outline [m]; any width of another: no line of it moves far enough to matter."""
    (x0, y0), (x1, y1) = np.min(corners, axis=0), np.max(corners, axis=0)
    return float(min(x1 - x0, y1 - y0)) * UNIT if len(corners) == 4 else np.inf


def _is_narrow(room: Room) -> bool:
    """Whether a room is narrower than `NARROW` somewhere."""
    if len(room.polygon) == 4:
        return bool(np.ptp(room.polygon, axis=0).min() < NARROW)
    whole, worn = Polygon(room.polygon), NARROW / 2 - 1e-6
    opened = whole.buffer(-worn, join_style="mitre").buffer(worn, join_style="mitre")
    return bool(opened.geom_type != "Polygon" or opened.area < whole.area - 1e-3)


def _within(program: FloorProgram, storeys: list[tuple[Storey, Labels]], rooms: list[Room]) -> bool:
    """Whether the rooms' true areas keep every bound."""
    area = {r.room_id: r.area for r in rooms}
    for request, _ in storeys:
        spec = request.spec
        areas = np.array([area[r.id] for r in request.rooms])
        if np.any(areas < spec.low / (1 + EDGE)) or np.any(areas > spec.high * (1 + EDGE)):
            return False
        if np.any(areas[:, None] * (1 + EDGE) < spec.order * areas[None, :]):
            return False
    wish = program.total_area
    inside = sum(r.area for r in rooms if r.type not in OUTSIDE)
    return not wish.stated or (wish.min or 0.0) <= inside <= (wish.max or np.inf)


def _inner_sides(grid: Labels, corners: wall_lines.Corners, n: int) -> list[bool]:
    """Whether each side of a room's outline has another room behind any part of it."""
    sides = []
    for (x0, y0), (x1, y1) in zip(corners, [*corners[1:], corners[0]], strict=True):
        if y0 == y1:
            row = y0 if x1 > x0 else y0 + 1
            behind = grid[row, min(x0, x1) + 1 : max(x0, x1) + 1]
        else:
            column = x0 + 1 if y1 > y0 else x0
            behind = grid[min(y0, y1) + 1 : max(y0, y1) + 1, column]
        sides.append(bool(np.any(behind != n)))
    return sides


def _runs(request: Storey, walls: list[wall_lines.Wall], rooms: list[Room], lines: wall_lines.Lines, at: NDArray[np.float64]) -> list[Run]:
    """Return the stretches of wall that openings can stand in: where both rooms' inner faces lie opposite each other."""
    by_id, half = {r.room_id: r for r in rooms}, request.spec.half
    runs: list[Run] = []
    for wall in walls:
        names = (request.rooms[wall.a].id,) + ((request.rooms[wall.b].id,) if wall.b >= 0 else ())
        axis = 1 if wall.vertical else 0
        line = float(at[lines.upright[wall.start, wall.at] if wall.vertical else lines.level[wall.at, wall.start]])
        ends = [_crossing(lines, at, wall, k) for k in (wall.start, wall.end)]
        middle = (ends[0] + ends[1]) / 2
        lows = (wall.a_low, not wall.a_low)
        faces = [_face(by_id[name].polygon, axis, line, middle, low, half) for name, low in zip(names, lows, strict=False)]
        if any(f is None for f in faces):
            continue
        spans = [f for f in faces if f is not None]
        start, end = max(f[0] for f in spans), min(f[1] for f in spans)
        if len(spans) == 1:  # a face may run on behind a room that the wall turns to
            start, end = max(start, ends[0] + half.inner), min(end, ends[1] - half.inner)
            line = spans[0][2] + (half.outer if wall.a_low else -half.outer)
        if end - start < 0.5:
            continue
        way, thick = -1.0 if wall.a_low else 1.0, half.inner if len(spans) == 2 else half.outer
        line, length = float(np.round(line, 3)), round(end - start, 3)
        runs.append(Run(names, wall.vertical, line, float(np.round(start, 3)), length, way, request.level, thick))
    return runs


def _crossing(lines: wall_lines.Lines, at: NDArray[np.float64], wall: wall_lines.Wall, k: int) -> float:
    """Return the coordinate [m] at which a wall's stretch ends: that of the line that meets it there."""
    beside = lines.level[k] if wall.vertical else lines.upright[:, k]
    ids = [beside[i] for i in (wall.at - 1, wall.at) if 0 <= i < beside.size and beside[i] >= 0]
    return float(at[ids[0]]) if ids else k * UNIT


def _face(
    polygon: NDArray[np.float64], axis: int, line: float, middle: float, low: bool, half: Halves
) -> tuple[float, float, float] | None:
    """Return (start, end, line) of the polygon's side that faces a wall; `low`: the room lies on its low side."""
    points = polygon.tolist()
    for p, q in zip(points, [*points[1:], points[0]], strict=True):
        if p[1 - axis] != q[1 - axis]:
            continue
        face, start, end = p[1 - axis], min(p[axis], q[axis]), max(p[axis], q[axis])
        distance = line - face if low else face - line
        if 0.5 * min(half) < distance < 1.5 * max(half) and start < middle < end:
            return start, end, face
    return None


def _depths(program: FloorProgram) -> dict[str, int]:
    """Return each room's distance from the entrance in openings."""
    depth = hops(((k.a, k.b) for k in program.links if k.opens), program.entrance.into or program.rooms[0].id)
    return {r.id: depth.get(r.id, 99) for r in program.rooms}
