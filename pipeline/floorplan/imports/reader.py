"""A file → a plan that can be furnished, with the repairs that it took; or a clear refusal."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pipeline.entities.plan import Opening, Plan, Room, hops
from pipeline.errors import ContentError, UsageError
from pipeline.floorplan.imports.datasets import front_sketch, is_front, is_procthor, procthor_sketch
from pipeline.floorplan.imports.native import native_sketch
from pipeline.floorplan.imports.rings import clean_rings, shrink_rooms, to_metres, trim_overlaps
from pipeline.floorplan.imports.sketch import Repair, Sketch, refuse
from pipeline.floorplan.imports.thresholds import cut_back, put_walls
from pipeline.floorplan.imports.types import resolve_types
from pipeline.floorplan.imports.wall_openings import Fitted, fit_openings, hang_leaves, put_door
from pipeline.floorplan.imports.wall_stretches import TOUCH, Stretch, stretches, touching_share
from pipeline.floorplan.program.defaults import INTO, OUTSIDE
from pipeline.floorplan.program.floor_program import Entrance, FloorProgram, Link, Range, RoomReq, Shell
from pipeline.sources.guarded import Folder, parse_json
from pipeline.sources.reasons import SourceError

MAX_BYTES = 64 << 20
INNER, OUTER, STOREY = 0.12, 0.24, 3.0  # [m] where the file does not say
THINNEST, THICKEST = 0.05, 0.6  # [m] of walls
PASSAGES = frozenset({"door", "open", "portal"})


@dataclass(frozen=True, slots=True)
class OwnPlan:
    """A plan of the user's own, ready to be furnished, and what was repaired to make it so."""

    plan: Plan
    repairs: tuple[Repair, ...]

    def repairs_json(self) -> list[dict[str, str]]:
        """Return the repairs as plain data."""
        return [dataclasses.asdict(r) for r in self.repairs]

    def and_found(self, findings: Iterable[Repair]) -> OwnPlan:
        """Return it with what a judge has found besides."""
        return OwnPlan(self.plan, (*self.repairs, *findings))


def describe_repairs(repairs: Iterable[Mapping[str, str]]) -> str:
    """Return repairs and findings, as plain data, in lines for the terminal."""
    return "".join(f"{'found' if r['code'] == 'closed' else 'repaired'}: {r['where']}: {r['text']}\n" for r in repairs)


def read_own(path: Path, house: str | None = None) -> OwnPlan:
    """Read a plan from a file; `house` is the line (from 0) or the id of one house in a file of many (.jsonl).

    Raises UsageError for a path that is missing or no file, ContentError for a broken file, RefusedError for a plan that
    cannot be built.
    """
    if not path.is_file():
        raise UsageError(f"{path} is {'not a file' if path.exists() else 'missing'}", "give a JSON file with a plan")
    try:
        data = Folder.at(path.parent).read(path.name, MAX_BYTES)
        if house is not None and path.suffix != ".jsonl":
            raise UsageError(f"--house is given, and {path} holds one plan", "leave it out, or give a .jsonl file of houses")
        document = _line(data, house, path) if path.suffix == ".jsonl" else parse_json(data, path.name)
    except SourceError as error:
        raise ContentError(f"{path}: {error.detail}", "give a JSON file with a plan; docs/floorplan.md shows one") from error
    return read_own_json(document, path.stem)


def _line(data: bytes, house: str | None, path: Path) -> Any:
    """Return the house on a line of its own, parsed; messages count lines and characters in the file."""
    lines, start = [], 0
    for number, line in enumerate(data.splitlines(keepends=True)):
        if line.strip():
            lines.append((line, number, start))
        start += len(line.decode("utf-8", "replace"))
    if house is None:
        raise UsageError(f"{path} holds {len(lines)} houses", "choose one with --house, a line from 0 or an id")
    if house.isdecimal() and int(house) < len(lines):
        line, number, start = lines[int(house)]
        return parse_json(line, path.name, number, start)
    for line, number, start in lines:
        if house.encode() not in line:
            continue
        candidate = parse_json(line, path.name, number, start)
        if isinstance(candidate, dict) and house in {candidate.get("id"), candidate.get("uid"), candidate.get("name")}:
            return candidate
    raise UsageError(f"{path} has no house {house[:60]!r}", f"choose a line from 0 to {len(lines) - 1}")


def read_own_json(document: Any, name: str = "plan") -> OwnPlan:
    """Read a parsed document: ours, a 3D-FRONT house or a ProcTHOR house. Errors as `read_own`."""
    if is_front(document):
        sketch = front_sketch(document, name)
    elif is_procthor(document):
        sketch = procthor_sketch(document)
    elif isinstance(document, dict) and "rooms" in document:
        sketch = native_sketch(document)
    else:
        kind = "a list" if isinstance(document, list) else type(document).__name__ if not isinstance(document, dict) else "no known format"
        raise ContentError(f"{name} is {kind}, not a plan: it has no `rooms`", "see docs/floorplan.md for the formats that are read")
    return OwnPlan(_build_plan(sketch), tuple(sketch.repairs))


def _build_plan(sketch: Sketch) -> Plan:
    """Check and repair a sketch, step by step, until it is a plan."""
    resolve_types(sketch)
    to_metres(sketch)
    clean_rings(sketch)
    inner = _thickness(sketch, "inner_wall", INNER)
    outer = _thickness(sketch, "outer_wall", OUTER)
    if sketch.foreign and sketch.faces == "inner":
        cut_back(sketch, inner, outer)
    trim_overlaps(sketch)
    if sketch.foreign and sketch.faces == "inner":
        put_walls(sketch, inner)
    _to_inner_faces(sketch, inner)
    rooms = [r.room() for r in sketch.rooms]
    levels = sorted({r.level for r in rooms})
    if levels != list(range(len(levels))):
        raise refuse(f"its storeys are {', '.join(map(str, levels))}; they count from 0 without gaps")
    walls = _walls(rooms, levels, outer)
    widest = max((s.thickness for s in walls if len(s.rooms) == 2), default=0.0)
    if widest > 2 * outer:  # outside walls stand around every room: thinner ones would not meet between rooms
        outer = math.ceil(1000 * widest / 2) / 1000
        text = f"rooms are {widest:.2f} m apart: outside walls are taken as {outer:.3f} m thick, so that they meet"
        sketch.repair("outer_wall", "plan", text)
        walls = _walls(rooms, levels, outer)
    fitted = fit_openings(sketch, rooms, walls)
    _open_where_touching(sketch, walls, fitted)
    if sketch.foreign:
        _keep_main_part(sketch, rooms, walls, fitted)
    entrance = _entrance(sketch, rooms, walls, fitted)
    _join(sketch, rooms, walls, fitted, entrance)
    between = [f.stretch.thickness for f in fitted if len(f.stretch.rooms) == 2 and f.opening.kind != "window"]
    inner = round(float(max((t for t in between if t >= TOUCH), default=inner)), 4)
    openings = hang_leaves(sketch, fitted, rooms, hops(_passages(fitted), entrance), max(inner, outer))
    high = max(r.height for r in rooms)
    storeys = sketch.storey_height or max(STOREY, high + 0.3)
    if storeys < high + 0.05:
        sketch.repair("storey_height", "plan", f"{storeys:.2f} m is less than its rooms are high; {high + 0.3:.2f} m is taken")
        storeys = high + 0.3
    return Plan(tuple(rooms), tuple(openings), entrance, inner, outer, round(storeys, 3))


def _walls(rooms: list[Room], levels: list[int], outer: float) -> list[Stretch]:
    return [s for level in levels for s in stretches(storey(rooms, level), level, outer)]


def storey(rooms: list[Room], level: int) -> list[Room]:
    """Return the rooms of a storey; a staircase that begins below goes through it."""
    return [r for r in rooms if r.level == level or (r.type == "staircase" and r.level < level)]


def _thickness(sketch: Sketch, name: str, usual: float) -> float:
    value = getattr(sketch, name)
    if value is None:
        return usual
    if not THINNEST <= value <= THICKEST:
        raise refuse(f"{name} is {value:g} m; walls are {THINNEST:g} to {THICKEST:g} m thick")
    return float(value)


def _to_inner_faces(sketch: Sketch, inner: float) -> None:
    """Move walls into the rooms where polygons are centre lines: stated, or seen by rooms that touch and none with a wall between."""
    faces = sketch.faces
    text = f"corners lie on walls' centre lines; walls are {inner:g} m thick"
    if not faces:
        rooms = [r.room() for r in sketch.rooms]
        shares = (touching_share(storey(rooms, k), k) for k in sorted({r.level for r in rooms}))
        thin, thick = map(sum, zip(*shares, strict=True))
        faces = "centre" if thin and not thick else "inner"
        text = f"its rooms touch: corners are taken as walls' centre lines, walls are {inner:g} m thick"
    if faces == "centre":
        sketch.repair("centre_lines", "plan", text)
        shrink_rooms(sketch, inner / 2)


def _open_where_touching(sketch: Sketch, walls: list[Stretch], fitted: list[Fitted]) -> None:
    """Rooms that touch have no wall: they are open to each other, which the plan then says."""
    said = {frozenset(f.stretch.rooms) for f in fitted if f.opening.kind in PASSAGES}
    for stretch in walls:
        pair = frozenset(stretch.rooms)
        if len(pair) == 2 and stretch.thickness < TOUCH and pair not in said and stretch.length >= 0.6:
            said.add(pair)
            opening = Opening(_fresh("open", fitted), "open", stretch.rooms, stretch.at(0.0, stretch.length), 2.4, level=stretch.level)
            fitted.append(Fitted(opening, stretch))
            sketch.repair("touching", opening.opening_id, f"{' and '.join(stretch.rooms)} touch: they are open to each other")


def _entrance(sketch: Sketch, rooms: list[Room], walls: list[Stretch], fitted: list[Fitted]) -> str:
    """Return the room that one enters; where no door leads outside, one is put, and that is stated."""
    ground = {r.room_id: r for r in rooms if r.level == 0}
    if sketch.entrance and sketch.entrance not in ground:
        raise refuse(f"the entrance {sketch.entrance} is not on level 0")
    marked = [f for f in fitted if f.opening.kind == "entrance" and f.opening.rooms[0] in ground]
    outward = [f for f in fitted if f.opening.kind == "door" and len(f.opening.rooms) == 1 and f.opening.rooms[0] in ground]
    mine = [f for f in [*marked, *outward] if not sketch.entrance or f.opening.rooms[0] == sketch.entrance]
    if mine:
        order = {kind: k for k, kind in enumerate(INTO)}
        best = min(mine, key=lambda f: (f not in marked, order.get(ground[f.opening.rooms[0]].type, 99)))
        for item in marked:
            if item is not best:
                item.opening = dataclasses.replace(item.opening, kind="door")
                sketch.repair("entrance", item.opening.opening_id, f"{best.opening.opening_id} is the entrance: this is a door")
        best.opening = dataclasses.replace(best.opening, kind="entrance")
        return best.opening.rooms[0]
    wanted = [sketch.entrance] if sketch.entrance else [r.room_id for kind in INTO for r in ground.values() if r.type == kind]
    if sketch.foreign or not wanted:
        wanted += [room for room in ground if room not in wanted]
    for room in wanted:
        door = put_door(_fresh("entrance", fitted), (room,), [s for s in walls if s.level == 0], fitted, 0.9)
        if door:
            fitted.append(door)
            sketch.repair("entrance", room, "no door leads outside from it: an entrance is put into its longest outside wall")
            return room
    raise refuse(f"no outside wall of {', '.join(wanted)} has room for an entrance")


def _keep_main_part(sketch: Sketch, rooms: list[Room], walls: Iterable[Stretch], fitted: list[Fitted]) -> None:
    """Leave rooms out that stand apart from the largest part which hangs together by openings, or by walls that may get doors."""
    area = {r.room_id: r.area for r in rooms}
    pairs = [s.rooms for s in walls if len(s.rooms) == 2] + _passages(fitted)
    main = max((set(hops(pairs, room)) for room in area), key=lambda part: (round(sum(area[room] for room in part), 3), min(part)))
    _leave_out(sketch, rooms, fitted, [room for room in area if room not in main], "it stands apart")
    if sketch.entrance not in main:
        sketch.entrance = ""


def _join(sketch: Sketch, rooms: list[Room], walls: list[Stretch], fitted: list[Fitted], entrance: str) -> None:
    """Put doors where the file leaves them open; refuse a plan in which a room cannot be reached."""
    while lost := [r.room_id for r in rooms if r.room_id not in (reached := hops(_passages(fitted), entrance))]:
        door = None
        if sketch.doors != "all":
            kinds = {r.room_id: r.type for r in rooms}
            pairs = [s for s in walls if len(s.rooms) == 2 and len(reached.keys() & s.rooms) == 1]
            # through a hall rather than through a bedroom or a bathroom, then through the longest wall
            pairs.sort(key=lambda s: (_rank(kinds[next(r for r in s.rooms if r in reached)]), -round(s.length, 3)))
            door = next((f for s in pairs if (f := put_door(_fresh("door", fitted), s.rooms, [s], fitted))), None)
        if door is None:
            if sketch.foreign and 2 * sum(r.area for r in rooms if r.room_id in lost) <= sum(r.area for r in rooms):
                _leave_out(sketch, rooms, fitted, lost, "nothing leads to it")
                continue
            _explain(rooms, walls, lost)
            raise refuse(f"there is no way from {entrance} to {', '.join(lost)}", "add doors between them")
        fitted.append(door)
        beyond = " or ".join(set(door.opening.rooms) - reached.keys())
        sketch.repair("door", door.opening.opening_id, f"no door leads to {beyond}: one is put")


def _leave_out(sketch: Sketch, rooms: list[Room], fitted: list[Fitted], lost: list[str], why: str) -> None:
    """Leave rooms out, stating it."""
    for room in lost:
        sketch.repair("left_out", room, f"left out: {why}")
    rooms[:] = [r for r in rooms if r.room_id not in lost]
    fitted[:] = [f for f in fitted if not set(f.opening.rooms) & set(lost)]


def _explain(rooms: list[Room], walls: list[Stretch], lost: list[str]) -> None:
    """Refuse what is out of reach for a plainer reason than a missing door."""
    if len({r.level for r in rooms}) > 1 and not any(r.type == "staircase" for r in rooms):
        raise refuse("it has two storeys and no staircase", "add a room of type staircase on level 0 that goes through both")
    beside = {r for s in walls if len(s.rooms) == 2 for r in s.rooms}
    alone = [r for r in lost if r not in beside]
    if alone:
        raise refuse(f"{', '.join(alone)} touches no other room", "rooms share walls at most 0.65 m thick")


def _rank(kind: str) -> int:
    return 0 if kind in {"hallway", "entry"} else 1 if kind in INTO else 3 if kind in {"bathroom", "wc", "balcony"} else 2


def _passages(fitted: list[Fitted]) -> list[tuple[str, ...]]:
    """Return the pairs of rooms between which one can walk."""
    return [f.opening.rooms for f in fitted if f.opening.kind in PASSAGES and len(f.opening.rooms) == 2]


def _fresh(kind: str, fitted: list[Fitted]) -> str:
    taken = {f.opening.opening_id for f in fitted}
    return next(name for k in itertools.count() if (name := f"{kind}_{k}") not in taken)


def program_of(plan: Plan) -> FloorProgram:
    """Return the completed program that the plan answers to. Nothing in it was said in words."""
    own = ("type", "role", "functions", "level")
    rooms = [
        RoomReq.model_validate({name: getattr(r, name) for name in own} | {"id": r.room_id, "area": _stated(r.area), "stated": False})
        for r in plan.rooms
    ]
    pairs: dict[tuple[str, str], str] = {}
    for o in plan.openings:
        if o.kind in PASSAGES and len(o.rooms) == 2:
            pairs.setdefault((min(o.rooms), max(o.rooms)), o.kind)
    links = tuple(Link(a=a, b=b, kind=kind) for (a, b), kind in sorted(pairs.items()))  # type: ignore[arg-type]
    inside = sum(r.area for r in plan.rooms if r.type not in OUTSIDE)
    return FloorProgram(
        storeys=1 + max(r.level for r in plan.rooms),
        total_area=_stated(inside) if round(inside, 3) else Range(),
        rooms=tuple(rooms),
        links=links,
        entrance=Entrance(into=plan.entrance),
        shell=Shell(inner_wall=_wall(plan.inner_wall), outer_wall=_wall(plan.outer_wall), ceiling=max(r.height for r in plan.rooms)),
        only=True,
    )


def _stated(area: float) -> Range:
    return Range(target=round(area, 3), stated=True)


def _wall(thickness: float) -> float:
    return round(min(max(thickness, THINNEST), THICKEST), 4)
