"""A 3D-FRONT house file as records, whatever its dialect; nothing is interpreted yet.

Frame of everything here: the file's own (y up, metres, front +z; plan coordinates are (x, z)).
"""

import json
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pipeline.arrays import Floats
from pipeline.sources.reasons import Row, SourceError, reject

ORIGIN, NO_TURN, ONE = np.zeros(3), np.array([0.0, 0.0, 0.0, 1.0]), np.ones(3)
_ARRAYS = re.compile(rb'"(xyz|faces|normal|uv)"\s*:\s*\[([-+0-9.eEnul,\s]*)\]')  # numbers and null: NaN stays, to be refused
MAX_AREA = 1e5  # [m2] no room is larger: such a figure says nothing
FARTHEST = 1e4  # [m] from the origin; no house lies beyond


@dataclass(frozen=True, slots=True)
class Furniture:
    """A furniture record. `box` is the declared (w, d, h) [m] in our axis order, `foot` how high it is placed [m], where that is known."""

    uid: str
    jid: str
    valid: bool | None
    category: str
    title: str
    box: tuple[float, float, float] | None
    foot: float | None = None

    @property
    def kinds(self) -> tuple[str, str]:
        """Names that may be a super-category or a title group."""
        return self.category, self.title.split("/", 1)[0]


@dataclass(frozen=True, slots=True)
class MeshRecord:
    """A mesh of the building; `xyz` and `faces` stay lists, or the text between their brackets, until somebody needs them."""

    uid: str
    type: str
    xyz: Any
    faces: Any

    def vertices(self) -> Floats:
        """Return (V, 3) world coordinates. Raises SourceError for anything that is not finite triples."""
        where = f"mesh {self.uid}"
        values = floats(_parse_numbers(self.xyz, where), where)
        if len(values) % 3:
            raise SourceError("bad_structure", where, "xyz is not a list of triples")
        if np.abs(values).max(initial=0.0) > FARTHEST:
            raise SourceError("bad_number", where, "has coordinates beyond 10 km")
        return values.reshape(-1, 3)

    def triangles(self) -> Floats:
        """Return (T, 3, 3) corner coordinates."""
        vertices, where = self.vertices(), f"mesh {self.uid}"
        try:
            index = np.asarray(_parse_numbers(self.faces, where), dtype=np.int64)
        except (TypeError, ValueError, OverflowError) as error:
            raise SourceError("bad_structure", where, "faces are not integers") from error
        if index.ndim != 1 or len(index) % 3 or (len(index) and (index.min() < 0 or index.max() >= len(vertices))):
            raise SourceError("bad_structure", where, "faces do not index its vertices by triples")
        return vertices[index.reshape(-1, 3)]


@dataclass(frozen=True, slots=True)
class Child:
    """A reference of a room: `position` [m], `rotation` quaternion (x, y, z, w), `scale`.

    `replaced_by` is the model that stands there instead of the record's own, "" where it was not replaced.
    """

    ref: str
    instance: str
    position: Floats
    rotation: Floats
    scale: Floats
    replaced_by: str = ""


@dataclass(frozen=True, slots=True)
class RoomRecord:
    """A room: `instance` is unique in its house at best. `size` [m2] is what the file says, None where it says nothing."""

    instance: str
    type: str
    children: tuple[Child, ...]
    size: float | None = None


@dataclass(frozen=True, slots=True)
class HouseFile:
    """A house: records by uid (the first of each uid), rooms in file order, the rooms that an entry door names.

    `uid` is the file's name, `identity` the uid that it states: copies under other names share it.
    """

    uid: str
    furniture: Mapping[str, Furniture]
    meshes: Mapping[str, MeshRecord]
    rooms: tuple[RoomRecord, ...]
    entry_rooms: tuple[str, ...]
    rejects: tuple[Row, ...]
    identity: str = ""


def _parse_numbers(values: Any, where: str) -> Any:
    """Parse the text of a number array; anything else stays as it is."""
    if not isinstance(values, bytes):
        return values
    try:
        return json.loads(b"[" + values + b"]")
    except ValueError as error:
        raise SourceError("bad_number", where, "holds something that is no number") from error


def floats(values: Any, where: str) -> Floats:
    """Return a flat list of finite numbers as an array, or raise SourceError `bad_number`."""
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise SourceError("bad_number", where, "holds something that is no number") from error
    if array.ndim != 1 or not np.isfinite(array).all():
        raise SourceError("bad_number", where, "holds a number that is not finite")
    return array


def extract_arrays(data: bytes) -> tuple[bytes, list[bytes]]:
    """Return a house file with the number arrays of its meshes replaced by their positions in the returned list.

    They are most of the file, and only those of floors, ceilings, walls and openings are ever read: `MeshRecord` parses
    them when it is asked. Normals and texture coordinates, partly wrong or null in the release, are left out.
    """
    kept: list[bytes] = []

    def put(match: re.Match[bytes]) -> bytes:
        key, numbers = match.groups()
        if key in {b"normal", b"uv"}:
            return b'"uv":[]'
        kept.append(numbers)
        return b'"%s":%d' % (key, len(kept) - 1)

    return _ARRAYS.sub(put, data), kept


def parse_house(tree: Any, name: str, arrays: Sequence[bytes] = ()) -> HouseFile:
    """Read a parsed house file; `name` is the file's stem, `arrays` what `extract_arrays` took out of it. Raises SourceError `bad_structure` when the frame is missing."""
    scene = tree.get("scene") if isinstance(tree, dict) else None
    if not isinstance(scene, dict) or not isinstance(scene.get("room"), list):
        raise SourceError("bad_structure", name, "has no scene.room list; it is no 3D-FRONT house")
    rejects: list[Row] = []
    uid = _text(tree.get("uid"))
    if uid != name:
        rejects.append(reject("house", name, "uid_mismatch", f"the file says {uid!r}"))
    furniture = _first_by_uid(map(_furniture, _records(tree, "furniture")), name, "furniture", rejects)
    meshes = _first_by_uid((_mesh(r, arrays) for r in _records(tree, "mesh")), name, "mesh", rejects)
    rooms = tuple(_room(r, name, furniture, rejects) for r in scene["room"] if isinstance(r, dict))
    entries = (door for door in _records(tree.get("extension"), "door") if door.get("type") == "entryDoor")
    return HouseFile(name, furniture, meshes, rooms, tuple(_text(door.get("roomId")) for door in entries), tuple(rejects), uid)


def declared_box(record: Mapping[str, Any]) -> tuple[float, float, float] | None:
    """Return the declared (w, d, h) in our axis order, or None.

    3D-FRONT format: `size`, and a flat `bbox` beside a `size`, are (width, depth, height); a nested `bbox`, and a flat
    one without `size`, are (width, height, depth).
    """
    size, bbox = record.get("size"), record.get("bbox")
    nested = isinstance(bbox, list) and len(bbox) > 0 and isinstance(bbox[0], list)
    given: Any = bbox[0] if nested and bbox else bbox or size
    try:
        a, b, c = (abs(float(v)) for v in given)
    except (TypeError, ValueError, OverflowError):
        return None
    if not all(math.isfinite(v) and v > 0 for v in (a, b, c)):
        return None
    return (a, c, b) if nested or (bbox and not size) else (a, b, c)


def _records(tree: Any, key: str) -> list[dict[str, Any]]:
    """Return the records of a list that another dialect may lack."""
    entries = tree.get(key) if isinstance(tree, dict) else None
    return [r for r in entries if isinstance(r, dict)] if isinstance(entries, list) else []


def _first_by_uid(records: Iterable[Any], house: str, kind: str, rejects: list[Row]) -> dict[str, Any]:
    kept: dict[str, Any] = {}
    surplus = 0
    for record in records:
        first = kept.setdefault(record.uid, record)
        if first is not record:
            surplus += 1
            if getattr(record, "valid", None) and not first.valid:
                kept[record.uid] = record
    if surplus:
        rejects.append(reject("house", house, "duplicate_record", f"{surplus} surplus {kind} records"))
    return kept


def _furniture(record: Mapping[str, Any]) -> Furniture:
    """Return a furniture record of any variant; what is missing or of another type is empty."""
    uid, jid, category, title, kind = (_text(record.get(key)) for key in ("uid", "jid", "category", "title", "type"))
    valid = record["valid"] if isinstance(record.get("valid"), bool) else None
    return Furniture(uid, jid, valid, category, (title or kind).lower(), declared_box(record))


def _mesh(record: Mapping[str, Any], arrays: Sequence[bytes]) -> MeshRecord:
    def array(key: str) -> Any:
        value = record.get(key)
        return arrays[value] if type(value) is int and 0 <= value < len(arrays) else value or []

    return MeshRecord(_text(record.get("uid")), _text(record.get("type")), array("xyz"), array("faces"))


def _room(record: Mapping[str, Any], house: str, furniture: Mapping[str, Furniture], rejects: list[Row]) -> RoomRecord:
    instance = _text(record.get("instanceid")) or _text(record.get("type"))
    children = []
    for entry in _records(record, "children"):
        ref = _text(entry.get("ref"))
        if ref not in furniture:  # meshes are in world coordinates: their poses mean nothing
            children.append(Child(ref, _text(entry.get("instanceid")), ORIGIN, NO_TURN, ONE))
            continue
        try:
            children.append(_child(entry))
        except SourceError as error:
            rejects.append(reject("object", f"{house}/{instance}/{ref}", "bad_number", error.detail))
    size = record.get("size")
    stated = float(size) if isinstance(size, (int, float)) and not isinstance(size, bool) and 0 < size < MAX_AREA else None
    return RoomRecord(instance, _text(record.get("type")), tuple(children), stated)


def _child(record: Mapping[str, Any]) -> Child:
    ref = _text(record.get("ref"))

    def vector(key: str, usual: Floats) -> Floats:
        given = record.get(key)
        values = usual if given is None else floats(given, f"{key} of {ref}")
        if len(values) != len(usual):
            raise SourceError("bad_number", ref, f"{key} has {len(values)} numbers, not {len(usual)}")
        return values

    pose = vector("pos", ORIGIN), vector("rot", NO_TURN), vector("scale", ONE)
    return Child(ref, _text(record.get("instanceid")), *pose, _text(record.get("replace_jid")))


def _text(value: Any) -> str:
    if type(value) is str:
        return value
    return "" if value is None else str(value)[:80]
