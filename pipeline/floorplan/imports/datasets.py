"""Houses of datasets as sketches: the rooms of a 3D-FRONT house as `pipeline.sources` reads them, without the furniture, and ProcTHOR (AI2-THOR) houses.

In the latter y is up, metres, left-handed, so plan coordinates are (x, z) without a mirror. Rooms {id, roomType, floorPolygon [{x, y, z}]} share
their corners: walls have no thickness, polygons are centre lines. Doors and windows {room0, room1, wall0, wall1, holePolygon or
boundingBox} lie in `wall0`, whose `polygon` has its two floor corners first; x of the hole runs from the first of them, y up.
An outside door has the same room twice, or an exterior wall. A wall with `empty` is none: the rooms on both sides are open.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from pipeline.arrays import Floats
from pipeline.entities.plan import OpeningKind
from pipeline.errors import ContentError
from pipeline.floorplan.imports.sketch import MAX_OPENINGS, MAX_ROOMS, Sketch, SketchOpening, SketchRoom, identifiers, refuse
from pipeline.sources.reasons import REASONS, Row, SourceError
from pipeline.sources.settings import FrontFilters
from pipeline.sources.threed_front.house import openings_of, rooms_of
from pipeline.sources.threed_front.house_file import parse_house

REMEDY = "give a ProcTHOR house as procthor-10k has them"


def is_front(document: object) -> bool:
    """Whether a document looks like a 3D-FRONT house."""
    return isinstance(document, dict) and isinstance(document.get("scene"), dict) and "mesh" in document


def front_sketch(document: Mapping[str, Any], name: str) -> Sketch:
    """Read a house. Raises ContentError for a broken file, RefusedError for a house without a usable floor."""
    rejects: list[Row] = []
    limits = FrontFilters()
    try:
        house = parse_house(document, name)
        rooms = rooms_of(house, limits, rejects)
        if not rooms:
            raise refuse("the house has no room with a floor")
        openings, (inner, outer) = openings_of(house, rooms, limits, rejects)
    except SourceError as error:
        raise ContentError(f"3D-FRONT house {name}: {error.code}: {error.detail or error}", "see docs/reasons.md for the code") from error
    sketch = Sketch(
        [SketchRoom(r.room_id, r.record.type, r.floor.polygon, height=round(r.height, 3)) for r in rooms],
        [SketchOpening(o.opening_id, o.kind, o.rooms, o.segment, height=o.height, sill=o.sill) for o in openings],
        "inner",
        "some",  # most rooms of the release have no Door mesh at all
        next((r.room_id for r in rooms if r.record.instance in house.entry_rooms), ""),
        inner,
        outer,
        units="m",
        foreign=True,
    )
    for row in rejects:
        reason = REASONS[row["reason"]]
        sketch.repair(row["reason"], row["where"], f"{reason.effect}: {reason.doc}" + (f" ({row['detail']})" if row["detail"] else ""))
    return sketch


def is_procthor(document: object) -> bool:
    """Whether a document looks like a ProcTHOR house."""
    rooms = document.get("rooms") if isinstance(document, dict) else None
    return isinstance(rooms, list) and any(isinstance(r, dict) and "floorPolygon" in r for r in rooms)


def procthor_sketch(document: Mapping[str, Any]) -> Sketch:
    """Read a house. Raises ContentError for a broken one, RefusedError for counts that no home has."""
    records = _dicts(document, "rooms")
    doors, windows = _dicts(document, "doors"), _dicts(document, "windows")
    if len(records) > MAX_ROOMS or len(doors) + len(windows) > MAX_OPENINGS:
        raise refuse(f"it has {len(records)} rooms and {len(doors) + len(windows)} openings; {MAX_ROOMS} and {MAX_OPENINGS} are read")
    said = [str(r.get("id", f"room|{k}")) for k, r in enumerate(records)]
    if len(set(said)) < len(said):
        raise ContentError("ProcTHOR house: two rooms have the same id", REMEDY)
    names = dict(zip(said, identifiers(said, "room"), strict=True))
    rooms = [
        SketchRoom(names[i], str(r.get("roomType", "")), _points(r.get("floorPolygon"), i)[:, [0, 2]])
        for i, r in zip(said, records, strict=True)
    ]
    walls = {str(w.get("id", "")): w for w in _dicts(document, "walls")}
    top = max((float(_points(w.get("polygon"), k)[:, 1].max()) for k, w in walls.items() if w.get("polygon")), default=0.0)
    if 1.8 <= top <= 8.0:
        for room in rooms:
            room.height = round(top, 3)
    sketch = Sketch(rooms, [], "centre", units="m", foreign=True)
    for number, record in enumerate(doors):
        frame = "frame" in str(record.get("assetId", "")).lower() and not record.get("openable", False)
        sketch.openings.append(_opening(record, "portal" if frame else "door", f"door_{number}", names, walls))
    sketch.openings += [_opening(r, "window", f"window_{k}", names, walls) for k, r in enumerate(windows)]
    sketch.openings += _fronts(walls, names)
    return sketch


def _fronts(walls: Mapping[str, Mapping[str, Any]], names: Mapping[str, str]) -> list[SketchOpening]:
    """Return an open front for every empty wall; both sides of one wall are in the file, and one of them is kept."""
    fronts: list[SketchOpening] = []
    seen: set[tuple[float, ...]] = set()
    for key, wall in walls.items():
        if not wall.get("empty") or str(wall.get("roomId", "")) not in names:
            continue
        ends = _foot(wall, key)
        mark = tuple(np.round(sorted(ends.tolist()), 2).ravel().tolist())
        if mark not in seen:
            seen.add(mark)
            fronts.append(SketchOpening(f"open_{len(fronts)}", "open", (), ends))
    return fronts


def _opening(
    record: Mapping[str, Any], kind: OpeningKind, name: str, names: Mapping[str, str], walls: Mapping[str, Mapping[str, Any]]
) -> SketchOpening:
    rooms = tuple(dict.fromkeys(names[r] for r in (str(record.get("room0")), str(record.get("room1"))) if r in names))
    key = str(record.get("wall0", ""))
    if key not in walls or not rooms:
        raise ContentError(f"ProcTHOR house: {name} names no wall or no room of the house", REMEDY)
    ends = _foot(walls[key], key)
    along = (ends[1] - ends[0]) / max(float(np.linalg.norm(ends[1] - ends[0])), 1e-9)
    outline, box = record.get("holePolygon"), record.get("boundingBox")
    if isinstance(box, dict) and outline is None:
        outline = [box.get("min"), box.get("max")]
    corners = _points(outline, name)
    (low, bottom), (high, top) = corners[:, :2].min(axis=0), corners[:, :2].max(axis=0)
    segment = np.array([ends[0] + low * along, ends[0] + high * along])
    sill = round(float(bottom), 4) if kind == "window" else 0.0
    return SketchOpening(name, kind, rooms, segment, height=round(float(top) - sill, 4), sill=sill)


def _foot(wall: Mapping[str, Any], name: str) -> Floats:
    """Return the two floor corners (2, 2) of a wall, in the file's order."""
    points = _points(wall.get("polygon"), name)
    flat = list(dict.fromkeys((round(float(p[0]), 4), round(float(p[2]), 4)) for p in points))
    if len(flat) != 2:
        raise ContentError(f"ProcTHOR house: wall {name[:60]} is not upright", REMEDY)
    return np.array(flat)


def _points(value: Any, where: str) -> Floats:
    """Return [{x, y, z}] as (n, 3), z 0 where it is missing."""
    try:
        points = [(float(p["x"]), float(p.get("y", 0.0)), float(p.get("z", 0.0))) for p in value]
    except (TypeError, KeyError, ValueError, AttributeError, OverflowError) as error:
        raise ContentError(f"ProcTHOR house: {where[:60]} has no list of points x, y, z", REMEDY) from error
    if not points or not all(math.isfinite(v) for p in points for v in p):
        raise ContentError(f"ProcTHOR house: {where[:60]} has points that are missing or not finite", REMEDY)
    return np.array(points)


def _dicts(document: Mapping[str, Any], key: str) -> list[dict[str, Any]]:
    entries = document.get(key, [])
    if not isinstance(entries, list) or not all(isinstance(r, dict) for r in entries):
        raise ContentError(f"ProcTHOR house: {key} is no list of objects", REMEDY)
    return entries
