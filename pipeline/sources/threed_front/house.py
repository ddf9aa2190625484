"""One 3D-FRONT house file to rows of scenes, rooms, openings, objects and rejects."""

import contextlib
import functools
import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import shapely
from shapely.geometry import Polygon

from pipeline import taxonomy
from pipeline.entities.plan import Opening, Room
from pipeline.manifest import sha256
from pipeline.sources.guarded import MAX_JSON, Folder, parse_json
from pipeline.sources.reasons import Row, SourceError, reject
from pipeline.sources.rows import HouseRows, slug
from pipeline.sources.settings import FrontFilters
from pipeline.sources.source import Task
from pipeline.sources.threed_front import wall_openings
from pipeline.sources.threed_front.floors import Floor, outline
from pipeline.sources.threed_front.house_file import HouseFile, MeshRecord, RoomRecord, extract_arrays, parse_house
from pipeline.sources.threed_front.house_rows import ReadRoom, object_row, opening_row, room_row, scene_row
from pipeline.sources.threed_front.opening_evidence import MESHES, OpeningEvidence, from_furniture, from_mesh
from pipeline.sources.threed_front.poses import to_ours, yaw_and_tilt
from pipeline.sources.threed_front.room_assignment import fill

# Absurd counts: real houses have up to some 30 rooms, 60 openings, 60 objects in a room, 2,000 floor triangles.
MAX_ROOMS, MAX_CHILDREN, MAX_HOLES = 300, 20_000, 1000
MAX_TRIANGLES = 20_000  # of one room
MAX_EXTENT = 100.0  # [m] of a house
WALLS = frozenset({"WallInner", "WallOuter"})
CEILINGS = (1.8, 8.0)  # [m] heights of ceilings that are believed
AREA_TOLERANCE = 0.15  # of the room's size in the file, up to which floors of it differ by their strips under doors
SWITCH = 1.1  # [m] above the floor: walls are cut here to see where they stand
INNER_WALL, OUTER_WALL = 0.12, 0.24  # [m] 3D-FRONT's usual thicknesses, where no reveal tells


def load_house(root: Path, file: str) -> HouseFile:
    """Return the records of a house file. Raises SourceError for one that cannot be read."""
    folder = Folder.at(root)
    text, arrays = extract_arrays(folder.read(file, MAX_JSON))
    try:
        tree = parse_json(text, file)
    except SourceError:
        parse_json(folder.read(file, MAX_JSON), file)  # says where in the file itself, whose arrays `extract_arrays` took out
        raise
    return parse_house(tree, Path(file).stem, arrays)


def read_house(task: Task, file: str) -> HouseRows:
    """Read one house; `known` of the task are the models. A file that is refused gives one reject row with its reason."""
    try:
        house = load_house(task.root, file)
        rows = HouseRows(house.uid, rejects=list(house.rejects))
        rooms = rooms_of(house, task.reading.settings.filters, rows.rejects)
        if rooms:
            fill(house, rooms, task, rows.rejects)
        if not any(room.objects for room in rooms):
            rows.rejects.append(reject("house", house.uid, "no_objects" if rooms else "no_rooms"))
            return rows
        rows = rows_of(house, rooms, rows, task)
        rows.content = _content(house.identity, rows)
    except SourceError as error:
        return HouseRows.refused(Path(file).stem, error.code, error.detail)
    return rows


def _content(identity: str, rows: HouseRows) -> str:
    """Return a digest of what a house is but for its file's name: the uid that it states, its floors and what stands on them."""
    floors = sorted(json.dumps([r["type"], r["polygon"]]) for r in rows.rooms)
    things = sorted(json.dumps([o["source_id"].rpartition("#")[2], o["position"], o["yaw"], o["size"]]) for o in rows.objects)
    return sha256("\n".join([identity, *floors, *things]).encode())


def rows_of(house: HouseFile, rooms: list[ReadRoom], rows: HouseRows, task: Task) -> HouseRows:
    """Complete the rows of a house whose rooms and objects are known; its meshes and built-in furniture give the openings.

    Raises SourceError `too_large` for a house that no raster holds.
    """
    extent = np.ptp(np.concatenate([room.floor.polygon for room in rooms]), axis=0).max()
    if extent > MAX_EXTENT:
        raise SourceError("too_large", house.uid, f"{extent:.0f} m across")
    scene_id = slug("h", house.uid)
    openings, walls = openings_of(house, rooms, task.reading.settings.filters, rows.rejects)
    boxes = ((np.asarray(o.footprint().exterior.coords)[:4], o.span) for r in rooms for o in r.objects)
    shares = task.reading.walker.shares([Room(r.room_id, r.type, r.floor.polygon) for r in rooms], openings, boxes)
    rows.rooms = [room_row(scene_id, house.uid, room, share) for room, share in zip(rooms, shares, strict=True)]
    rows.openings = [opening_row(scene_id, o) for o in openings]
    rows.objects = [object_row(scene_id, house.uid, room, k) for room in rooms for k in range(len(room.objects))]
    rows.scenes = [scene_row(scene_id, house, rooms, rows.rooms, openings, walls, task.reading.licence)]
    return rows


def rooms_of(house: HouseFile, limits: FrontFilters, rejects: list[Row]) -> list[ReadRoom]:
    """Return the rooms with a usable floor, in file order."""
    children = sum(len(record.children) for record in house.rooms)
    if len(house.rooms) > MAX_ROOMS or children > MAX_CHILDREN:
        raise SourceError("too_large", house.uid, f"{len(house.rooms)} rooms with {children} children")
    rooms: list[ReadRoom] = []
    for number, record in enumerate(house.rooms):
        where = f"{house.uid}/{record.instance or number}"
        try:
            floor = _floor(house, record, limits.min_room_area)
        except SourceError as error:
            rejects.append(reject("room", where, error.code, error.detail))
            continue
        polygon = Polygon(floor.polygon)
        double = next((r for r in rooms if r.polygon.intersection(polygon).area > 0.5 * min(r.polygon.area, polygon.area)), None)
        if double:
            rejects.append(reject("room", where, "duplicate_room", f"same floor as {double.record.instance}"))
            continue
        kind = record.type.lower().replace(" ", "")
        notes = {
            "floor_pieces": (floor.pieces > 1 or floor.lost > 0.05) and f"{floor.pieces} pieces, {floor.lost:.2f} m2 left out or filled",
            "area_mismatch": record.size and abs(floor.area - record.size) > AREA_TOLERANCE * record.size
            and f"{floor.area:.2f} m2, the file says {record.size:.2f}",
            "unknown_room_type": kind not in taxonomy.load().front_rooms and f"type {record.type!r}",
        }  # fmt: skip
        rejects += [reject("room", where, reason, detail) for reason, detail in notes.items() if detail]
        room_id = slug("r", record.instance or record.type or str(number))
        room_id = room_id if all(room_id != room.room_id for room in rooms) else f"{room_id}_{number}"
        rooms.append(ReadRoom(record, room_id, kind, floor, polygon, _height(house, record, limits.ceiling), []))
    return rooms


def _meshes(house: HouseFile, record: RoomRecord) -> Iterator[MeshRecord]:
    """Yield the meshes of a room, each once."""
    yield from {child.ref: house.meshes[child.ref] for child in record.children if child.ref in house.meshes}.values()


def _floor(house: HouseFile, record: RoomRecord, least: float) -> Floor:
    """Return the floor of a room. Raises SourceError, naming the reason, where there is none of `least` m2."""
    triangles = np.concatenate([np.zeros((0, 3, 3)), *(m.triangles() for m in _meshes(house, record) if m.type == "Floor")])
    if len(triangles) > MAX_TRIANGLES:
        raise SourceError("too_large", record.instance, f"a floor of {len(triangles)} triangles")
    floor = outline(triangles)
    if floor is None:
        raise SourceError("no_floor", record.instance, f"type {record.type!r}, {len(record.children)} children")
    if floor.area < least:
        raise SourceError("too_small", record.instance, f"{floor.area:.2f} m2")
    return floor


def _height(house: HouseFile, record: RoomRecord, default: float) -> float:
    """Return the room's height: the middle height of its Ceiling meshes, else the top of its walls, else the default."""
    ceilings, walls = [0.0], [0.0]
    for mesh in _meshes(house, record):
        if mesh.type == "Ceiling" or mesh.type in WALLS:
            try:
                up = mesh.vertices()[:, 1]
            except SourceError:
                continue  # a broken wall: the other meshes tell
            if len(up):
                (ceilings if mesh.type == "Ceiling" else walls).append(float(np.median(up) if mesh.type == "Ceiling" else up.max()))
    believed = (h for h in (max(ceilings), max(walls)) if CEILINGS[0] < h < CEILINGS[1])
    return next((round(h, 4) for h in believed), default)


def openings_of(
    house: HouseFile, rooms: list[ReadRoom], limits: FrontFilters, rejects: list[Row]
) -> tuple[list[Opening], tuple[float, float]]:
    """Return the openings, and the thickness of inner and outer walls as the reveals show it."""
    evidence = _evidence(house, rejects)
    if len(evidence) > MAX_HOLES:
        raise SourceError("too_large", house.uid, f"{len(evidence)} doors, windows and holes")
    height = float(np.median([room.height for room in rooms]))
    outlines = {room.room_id: room.polygon for room in rooms}
    openings, depths, rest = wall_openings.openings(evidence, outlines, height, limits.wall_reach, functools.cache(lambda: _faces(house)))
    for hole in rest:
        what = "threshold" if hole.flat else f"leaf of a {hole.evidence}" if hole.origin == "record" else hole.evidence
        at = ", ".join(f"{v:.2f}" for v in hole.centre)
        rejects.append(reject("opening", house.uid, "opening_unresolved", f"{what} at ({at}), {hole.width:.2f} m wide"))
    inner = round(float(np.median(depths[2])), 4) if depths[2] else INNER_WALL
    outer = round(float(np.median(depths[1])), 4) if depths[1] else OUTER_WALL
    return openings, (inner, outer)


def _faces(house: HouseFile) -> shapely.Geometry:
    """Return where the inner walls' faces stand, in plan: those that are cut at the height of a switch."""
    lines = []
    for mesh in house.meshes.values():
        if mesh.type != "WallInner":
            continue
        try:
            corners = to_ours(mesh.triangles())
        except SourceError:
            continue  # a broken wall: the others tell
        for triangle in corners[(corners[..., 2].min(axis=1) < SWITCH) & (corners[..., 2].max(axis=1) > SWITCH)]:
            flat = triangle[np.lexsort((triangle[:, 1], triangle[:, 0]))][:, :2]
            lines.append(flat[[0, -1]])
    return shapely.union_all(shapely.linestrings(np.array(lines))) if lines else shapely.MultiLineString()


def _evidence(house: HouseFile, rejects: list[Row]) -> list[OpeningEvidence]:
    """Return what meshes and records say of doors and windows; a mesh of which only the corners can be read gives its extent."""
    holes: list[OpeningEvidence | None] = []
    for mesh in house.meshes.values():
        if mesh.type not in MESHES:
            continue
        evidence, origin = MESHES[mesh.type]
        try:
            vertices = mesh.vertices()
        except SourceError as error:
            rejects.append(reject("opening", f"{house.uid}/{mesh.uid}", "opening_unresolved", error.detail))
            continue
        triangles = None
        with contextlib.suppress(SourceError):
            triangles = mesh.triangles()
        holes.append(from_mesh(evidence, vertices, triangles, origin))
    for child in (child for room in house.rooms for child in room.children):
        record = house.furniture.get(child.ref)
        if record is not None and not record.valid:
            holes.append(from_furniture(record.title, child.position, yaw_and_tilt(child.rotation)[0], record.box))
    return [hole for hole in holes if hole]
