"""One 3D-FRONT house file to rows of scenes, rooms, openings, objects and rejects."""

import functools
import json
from collections.abc import Mapping

import numpy as np
import shapely
from shapely.geometry import Polygon

from pipeline.entities.plan import Opening, Room
from pipeline.manifest import sha256
from pipeline.sources.guarded import MAX_JSON, Folder, parse_json
from pipeline.sources.house_rows import HouseRows
from pipeline.sources.identity import slug
from pipeline.sources.reasons import Row, SourceError, reject
from pipeline.sources.settings import FrontFilters
from pipeline.sources.threed_front import wall_openings
from pipeline.sources.threed_front.floors import Floor, outline
from pipeline.sources.threed_front.furniture import Model
from pipeline.sources.threed_front.house_file import HouseFile, RoomRecord, extract_arrays, parse_house
from pipeline.sources.threed_front.opening_evidence import MESHES, OpeningEvidence, from_furniture, from_mesh
from pipeline.sources.threed_front.poses import to_ours, yaw_and_tilt
from pipeline.sources.threed_front.room_assignment import fill
from pipeline.sources.threed_front.rows import ReadRoom, object_row, opening_row, room_row, scene_row
from pipeline.sources.walkable_share import Walker
from pipeline.taxonomy import Taxonomy

# Absurd counts: real houses have up to some 30 rooms, 60 openings, 60 objects in a room, 2,000 floor triangles.
MAX_ROOMS, MAX_CHILDREN, MAX_HOLES = 300, 20_000, 1000
MAX_TRIANGLES = 20_000  # of one room
MAX_EXTENT = 100.0  # [m] of a house
WALLS = frozenset({"WallInner", "WallOuter"})
AREA_TOLERANCE = 0.15  # of the room's size in the file, up to which floors of it differ by their strips under doors
SWITCH = 1.1  # [m] above the floor: walls are cut here to see where they stand
INNER_WALL, OUTER_WALL = 0.12, 0.24  # [m] 3D-FRONT's usual thicknesses, where no reveal tells


def read_house(
    folder: Folder, file: str, models: Mapping[str, Model], taxonomy: Taxonomy, limits: FrontFilters, licence: str, walker: Walker
) -> HouseRows:
    """Read one house. A file that is refused gives one reject row with its reason."""
    name = file.rsplit("/", 1)[-1].removesuffix(".json")
    try:
        text, arrays = extract_arrays(folder.read(file, MAX_JSON))
        try:
            tree = parse_json(text, file)
        except SourceError:
            parse_json(folder.read(file, MAX_JSON), file)  # says where in the file itself, whose arrays `extract_arrays` took out
            raise
        return house_rows(parse_house(tree, name, arrays), models, taxonomy, limits, licence, walker)
    except SourceError as error:
        return HouseRows(rejects=[reject("house", name, error.code, error.detail)])


def house_rows(
    house: HouseFile, models: Mapping[str, Model], taxonomy: Taxonomy, limits: FrontFilters, licence: str, walker: Walker
) -> HouseRows:
    """Turn a house's records into rows."""
    rows = HouseRows(house.uid, rejects=list(house.rejects))
    rooms = rooms_of(house, taxonomy, limits, rows.rejects)
    if not rooms:
        rows.rejects.append(reject("house", house.uid, "no_rooms"))
        return rows
    fill(house, rooms, models, taxonomy, limits, rows.rejects)
    if not any(room.objects for room in rooms):
        rows.rejects.append(reject("house", house.uid, "no_objects"))
        return rows
    rows = rows_of(house, rooms, rows, taxonomy, limits, licence, walker)
    rows.content = _content(house.identity, rows)
    return rows


def _content(identity: str, rows: HouseRows) -> str:
    """Return a digest of what a house is but for its file's name: the uid that it states, its floors and what stands on them."""
    floors = sorted(json.dumps([r["type"], r["polygon"]]) for r in rows.rooms)
    things = sorted(json.dumps([o["source_id"].rpartition("#")[2], o["position"], o["yaw"], o["size"]]) for o in rows.objects)
    return sha256("\n".join([identity, *floors, *things]).encode())


def rows_of(
    house: HouseFile, rooms: list[ReadRoom], rows: HouseRows, taxonomy: Taxonomy, limits: FrontFilters, licence: str, walker: Walker
) -> HouseRows:
    """Complete the rows of a house whose rooms and objects are known; its meshes and built-in furniture give the openings.

    Raises SourceError `too_large` for a house that no raster holds.
    """
    corners = np.concatenate([room.floor.polygon for room in rooms])
    if np.ptp(corners, axis=0).max() > MAX_EXTENT:
        raise SourceError("too_large", house.uid, f"{np.ptp(corners, axis=0).max():.0f} m across")
    scene_id = slug("h", house.uid)
    openings, walls = openings_of(house, rooms, limits, rows.rejects)
    rows.rooms = [room_row(scene_id, house.uid, room, taxonomy) for room in rooms]
    for row, share in zip(rows.rooms, _walkable(rooms, openings, walker), strict=True):
        row["walkable_free"] = share
    rows.openings = [opening_row(scene_id, o) for o in openings]
    rows.objects = [
        object_row(scene_id, room, k, f"{house.uid}/{o.filed or room.record.instance}/{o.child.instance}")
        for room in rooms
        for k, o in enumerate(room.objects)
    ]
    rows.scenes = [scene_row(scene_id, house, rooms, openings, walls, licence)]
    area = rows.scenes[0]["area"]
    rows.scenes[0]["walkable_free"] = round(sum(r["walkable_free"] * r["area"] for r in rows.rooms) / area, 4)
    return rows


def rooms_of(house: HouseFile, taxonomy: Taxonomy, limits: FrontFilters, rejects: list[Row]) -> list[ReadRoom]:
    """Return the rooms with a usable floor, in file order."""
    children = sum(len(record.children) for record in house.rooms)
    if len(house.rooms) > MAX_ROOMS or children > MAX_CHILDREN:
        raise SourceError("too_large", house.uid, f"{len(house.rooms)} rooms with {children} children")
    rooms: list[ReadRoom] = []
    taken: set[str] = set()
    for number, record in enumerate(house.rooms):
        where = f"{house.uid}/{record.instance or number}"
        try:
            floor = _floor(house, record)
        except SourceError as error:
            rejects.append(reject("room", where, error.code, error.detail))
            continue
        if floor is None:
            rejects.append(reject("room", where, "no_floor", f"type {record.type!r}, {len(record.children)} children"))
            continue
        if floor.area < limits.min_room_area:
            rejects.append(reject("room", where, "too_small", f"{floor.area:.2f} m2"))
            continue
        polygon = Polygon(floor.polygon)
        room_id = slug("r", record.instance or record.type or str(number))
        room_id = room_id if room_id not in taken else f"{room_id}_{number}"
        double = next((r for r in rooms if r.polygon.intersection(polygon).area > 0.5 * min(r.polygon.area, polygon.area)), None)
        if double:
            rejects.append(reject("room", where, "duplicate_room", f"same floor as {double.record.instance}"))
            continue
        taken.add(room_id)
        if floor.pieces > 1 or floor.lost > 0.05:
            rejects.append(reject("room", where, "floor_pieces", f"{floor.pieces} pieces, {floor.lost:.2f} m2 left out or filled"))
        if record.size and abs(floor.area - record.size) > AREA_TOLERANCE * record.size:
            rejects.append(reject("room", where, "area_mismatch", f"{floor.area:.2f} m2, the file says {record.size:.2f}"))
        kind = record.type.lower().replace(" ", "")
        if kind not in taxonomy.front_rooms:
            rejects.append(reject("room", where, "unknown_room_type", f"type {record.type!r}"))
        rooms.append(ReadRoom(record, room_id, kind, floor, polygon, _height(house, record, limits.ceiling), []))
    return rooms


def _floor(house: HouseFile, record: RoomRecord) -> Floor | None:
    meshes = [house.meshes[c.ref] for c in record.children if c.ref in house.meshes]
    triangles = [m.triangles() for m in {m.uid: m for m in meshes}.values() if m.type == "Floor"]
    triangles = [t for t in triangles if len(t)]
    count = sum(map(len, triangles))
    if count > MAX_TRIANGLES:
        raise SourceError("too_large", record.instance, f"a floor of {count} triangles")
    return outline(np.concatenate(triangles)) if triangles else None


def _height(house: HouseFile, record: RoomRecord, default: float) -> float:
    """Return the room's height: the middle height of its Ceiling meshes, else the top of its walls, else the default."""
    tops: dict[str, list[float]] = {"ceiling": [], "wall": []}
    for child in record.children:
        mesh = house.meshes.get(child.ref)
        if mesh is None or (mesh.type != "Ceiling" and mesh.type not in WALLS):
            continue
        try:
            up = mesh.vertices()[:, 1]
        except SourceError:
            continue  # a broken wall: the other meshes tell
        if len(up):
            tops["ceiling" if mesh.type == "Ceiling" else "wall"].append(float(np.median(up) if mesh.type == "Ceiling" else up.max()))
    for heights in (tops["ceiling"], tops["wall"]):
        if heights and 1.8 < max(heights) < 8.0:
            return round(max(heights), 4)
    return default


def _walkable(rooms: list[ReadRoom], openings: list[Opening], walker: Walker) -> list[float]:
    plain = [Room(r.room_id, r.type, r.floor.polygon) for r in rooms]
    boxes = ((np.asarray(o.footprint().exterior.coords)[:4], o.span) for r in rooms for o in r.objects)
    return walker.shares(plain, openings, boxes)


def openings_of(
    house: HouseFile, rooms: list[ReadRoom], limits: FrontFilters, rejects: list[Row]
) -> tuple[list[Opening], tuple[float, float]]:
    """Return the openings, and the thickness of inner and outer walls as the reveals show it."""
    outlines = [wall_openings.Outline(room.room_id, room.polygon) for room in rooms]
    evidence = _evidence(house, rejects)
    if len(evidence) > MAX_HOLES:
        raise SourceError("too_large", house.uid, f"{len(evidence)} doors, windows and holes")
    height = float(np.median([room.height for room in rooms]))
    openings, depths, rest = wall_openings.openings(evidence, outlines, height, limits.wall_reach, functools.cache(lambda: _faces(house)))
    rejects += [_unresolved_reject(house, hole) for hole in rest]
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


def _unresolved_reject(house: HouseFile, hole: OpeningEvidence) -> Row:
    what = "threshold" if hole.flat else f"leaf of a {hole.evidence}" if hole.origin == "record" else hole.evidence
    at = ", ".join(f"{v:.2f}" for v in hole.centre)
    return reject("opening", house.uid, "opening_unresolved", f"{what} at ({at}), {hole.width:.2f} m wide")


def _evidence(house: HouseFile, rejects: list[Row]) -> list[OpeningEvidence]:
    """Return what meshes and records say of doors and windows; a mesh of which only the corners can be read gives its extent."""
    holes: list[OpeningEvidence] = []
    for mesh in house.meshes.values():
        if mesh.type not in MESHES:
            continue
        evidence, origin = MESHES[mesh.type]
        try:
            vertices = mesh.vertices()
            try:
                triangles = mesh.triangles()
            except SourceError:
                triangles = None
            hole = from_mesh(evidence, vertices, triangles, origin)
        except SourceError as error:
            rejects.append(reject("opening", f"{house.uid}/{mesh.uid}", "opening_unresolved", error.detail))
            continue
        if hole:
            holes.append(hole)
    for room in house.rooms:
        for child in room.children:
            record = house.furniture.get(child.ref)
            if record is None or record.valid:
                continue
            yaw, _ = yaw_and_tilt(child.rotation)
            hole = from_furniture(record.title, child.position, yaw, record.box)
            if hole:
                holes.append(hole)
    return holes
