"""Writes a house as a scene file in 3D-FRONT's JSON, in either of the release's two dialects.

"3D-FRONT format": y up, metres; (x, y, z) of ours becomes (x, z, -y), yaw is unchanged; `rot` is a quaternion (x, y, z, w)
rounded to 5 decimals; only furniture children carry poses, meshes are in world coordinates.
"""

import math
import uuid
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

from pipeline.card import cards
from pipeline.corpus.houses import shell
from pipeline.corpus.houses.corruption import Litter
from pipeline.corpus.houses.records import House, Item
from pipeline.entities.plan import Opening

Dialect = Literal["0.4", "0.11"]
DIALECTS: tuple[Dialect, Dialect] = ("0.4", "0.11")
Json = dict[str, Any]
IDENTITY: Json = {"pos": [0, 0, 0], "rot": [0, 0, 0, 1], "scale": [1, 1, 1]}
# Share of each record variant among valid furniture: with size and no category, added later, model replaced.
VARIANTS = {"sized": 0.67, "late": 0.33}
# Colours [0-255] and file-level order of the materials that surfaces use.
MATERIALS = {
    "Floor": [203, 178, 145, 255],
    "WallInner": [236, 233, 226, 255],
    "WallOuter": [214, 208, 200, 255],
    "Ceiling": [248, 248, 246, 255],
    "Door": [168, 140, 108, 255],
    "Window": [220, 225, 228, 255],
}
GARBAGE_NORMAL = (-3.932, 1, -2.043)
"""What floors of the 0.4 dialect carry for normals."""


class Ids:
    """Draws the ids of one file: numbers of records, uuids of materials and models that were never released."""

    def __init__(self, rng: np.random.Generator, house: int) -> None:
        self.rng = rng
        self.number = int(rng.integers(10**12, 9 * 10**12)) * 1000
        self.house = house
        self.rooms = 0

    def uid(self, tail: str) -> str:
        """Return the next record id, e.g. "5271533262579975/0"."""
        self.number += int(self.rng.integers(1, 40))
        return f"{self.number}/{tail}"

    def uuid(self) -> str:
        """Return a random uuid."""
        return str(uuid.UUID(bytes=self.rng.bytes(16), version=4))

    def room(self, room_type: str) -> str:
        """Return a room's instance id; no two rooms of a corpus share one."""
        self.rooms += 1
        return f"{room_type}-{self.house * 64 + self.rooms + 101}"


def scene_json(house: House, dialect: Dialect, rng: np.random.Generator, litter: Litter) -> Json:
    """Return the scene file of a house as JSON. `rng` draws ids and record variants, `litter` says what defects it has."""
    ids = Ids(rng, house.index)
    materials = {name: _material(ids, color, dialect) for name, color in MATERIALS.items()}
    rooms = [
        {"type": room.type, "instanceid": ids.room(room.type)}
        | ({"size": round(room.area, 4)} if dialect == "0.11" else {})
        | _identity()
        | {"children": [], "empty": int(bare)}
        for room, bare in zip(house.plan.rooms, house.empty, strict=True)
    ]
    counter = {"furniture": 0, "mesh": 0}
    furniture: list[Json] = []
    meshes = _add_meshes(house, dialect, ids, materials, rooms, counter)
    doors = _add_leaves(house, dialect, ids, furniture, meshes, rooms, counter)
    _add_items(house, dialect, ids, furniture, rooms, counter)
    _add_litter(house, dialect, ids, litter, furniture, meshes, rooms, counter)
    return _top(house, dialect, ids, furniture, [m[0] for m in meshes], list(materials.values()), doors, rooms)


def _identity() -> Json:
    return {k: list(v) for k, v in IDENTITY.items()}


def _add_meshes(
    house: House, dialect: Dialect, ids: Ids, materials: dict[str, Json], rooms: list[Json], counter: dict[str, int]
) -> list[tuple[Json, shell.Surface]]:
    meshes = []
    for surface in shell.surfaces(house.plan):
        name = surface.type if surface.type in materials else "Door" if surface.type in {"Hole", "Pocket"} else "WallInner"
        record = mesh_record(surface, ids.uid("0"), materials[name]["uid"], dialect)
        meshes.append((record, surface))
        _child(rooms[surface.room], "mesh", record["uid"], counter)
    return meshes


def mesh_record(surface: shell.Surface, uid: str, material: str, dialect: Dialect) -> Json:
    """Return the record of a surface: unshared corners, y up, two triangles a quad."""
    xyz: list[float] = []
    normal: list[float] = []
    uv: list[float] = []
    faces: list[int] = []
    for k, quad in enumerate(surface.quads):
        n = GARBAGE_NORMAL if surface.type == "Floor" and dialect == "0.4" else _normal(quad)
        for x, y, z in quad:
            xyz += [round(x, 5), round(z, 5), round(0.0 - y, 5)]
            normal += n
        width, height = round(math.dist(quad[0], quad[1]), 3), round(math.dist(quad[1], quad[2]), 3)
        uv += [0, 0, width, 0, width, height, 0, height]
        faces += [4 * k, 4 * k + 1, 4 * k + 2, 4 * k, 4 * k + 2, 4 * k + 3]
    record = {
        "aid": [],
        "jid": "",
        "uid": uid,
        "xyz": xyz,
        "normal": normal,
        "uv": uv,
        "faces": faces,
        "material": material,
        "type": surface.type,
    }
    return record | ({"constructid": uid.split("/", maxsplit=1)[0], "instanceid": ""} if dialect == "0.11" else {})


def _normal(quad: shell.Quad) -> list[float]:
    """Return the unit normal of a quad in 3D-FRONT's frame."""
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = quad[:3]
    u, v = (bx - ax, by - ay, bz - az), (cx - ax, cy - ay, cz - az)
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.hypot(*n)
    return [round(n[0] / length), round(n[2] / length), round(-n[1] / length)]


def _add_leaves(
    house: House,
    dialect: Dialect,
    ids: Ids,
    furniture: list[Json],
    meshes: Sequence[tuple[Json, shell.Surface]],
    rooms: list[Json],
    counter: dict[str, int],
) -> list[Json]:
    """Add doors and windows as furniture without a released model; return the file's list of doors."""
    jids = {kind: ids.uuid() for kind in ("swing", "sliding", "entry", "window")}
    titles = {"swing": "door/single swing door", "sliding": "door/sliding door", "entry": "door/entrance door", "window": "window/window"}
    numbers = {room.room_id: k for k, room in enumerate(house.plan.rooms)}
    doors = []
    for k, opening in enumerate(house.plan.openings):
        refs = [record["uid"] for record, surface in meshes if surface.opening == k]
        if opening.kind not in {"open", "portal"}:
            kind = {"window": "window", "entrance": "entry"}.get(opening.kind, "swing" if opening.swing else "sliding")
            record: Json = {"uid": ids.uid("model"), "jid": jids[kind], "aid": []}
            if dialect == "0.11":
                record |= {"title": titles[kind], "type": "standard"}
            furniture.append(record)
            refs.insert(0, record["uid"])
            _child(rooms[numbers[opening.rooms[0]]], "furniture", record["uid"], counter, _leaf_pose(opening))
        if opening.kind in {"door", "entrance"}:
            home = opening.swing.room_id if opening.swing else opening.rooms[0]
            side = "Left" if opening.swing and opening.swing.hinge == 0 else "Right"
            doors.append(
                {
                    "type": "entryDoor" if opening.kind == "entrance" else "interiorDoor",
                    "roomId": rooms[numbers[home]]["instanceid"],
                    "dir": f"inner{side}",
                    "ref": refs,
                }
            )
    return doors


def _leaf_pose(opening: Opening) -> Json:
    (ax, ay), (bx, by) = opening.segment.tolist()
    yaw = 0.0 if abs(bx - ax) > abs(by - ay) else math.pi / 2
    return {"pos": [_r((ax + bx) / 2), _r(opening.sill), _r(-(ay + by) / 2)], "rot": quaternion(yaw), "scale": [1, 1, 1]}


def quaternion(yaw: float) -> list[float]:
    """Return the turn about the up axis as (x, y, z, w), 5 decimals, like the real files."""
    return [0, _r(math.sin(yaw / 2)), 0, _r(math.cos(yaw / 2))]


def _add_items(house: House, dialect: Dialect, ids: Ids, furniture: list[Json], rooms: list[Json], counter: dict[str, int]) -> None:
    for item in house.items:
        replaced = abs(abs(item.scale[0]) - 1) > 1e-9 or abs(item.scale[1] - 1) > 1e-9
        variant = "replaced" if replaced else str(ids.rng.choice(list(VARIANTS), p=list(VARIANTS.values())))
        record = furniture_record(item, variant, ids, dialect)
        furniture.append(record)
        x, y, z = item.position
        sx, sy, sz = item.scale
        pose: Json = {"pos": [_r(x), _r(z), _r(-y)], "rot": quaternion(item.yaw), "scale": [_s(sx), _s(sz), _s(sy)]}
        if replaced:
            w, d, h = item.model.size
            pose |= {"replace_jid": item.model.model_id, "replace_bbox": {"xLen": _r(100 * w), "yLen": _r(100 * d), "zLen": _r(100 * h)}}
        _child(rooms[item.room], "furniture", record["uid"], counter, pose)


def furniture_record(item: Item, variant: str, ids: Ids, dialect: Dialect) -> Json:
    """Return a furniture record. Mind the order of axes: flat sizes are width, depth, height, others width, height, depth."""
    w, d, h = (_r(v) for v in item.size)
    model = item.model
    if variant == "late":
        uid = f"2021{int(ids.rng.integers(10**17, 10**18))}/model"
        return {"jid": model.model_id, "uid": uid, "aid": [], "category": model.future_name, "bbox": [w, h, d], "valid": True}
    record: Json = {"uid": ids.uid("model"), "jid": model.model_id, "aid": [], "size": [w, d, h]}
    record["sourceCategoryId"] = str(uuid.uuid5(uuid.NAMESPACE_OID, model.category))
    record["title"] = cards()[model.category].corpus.title or f"{model.super_category}/{model.category.replace('_', ' ')}".lower()
    if dialect == "0.11":
        record["type"] = "standard"
    if variant == "replaced":
        # A model that was replaced: the category may be as coarse as the super-category.
        record["category"] = model.super_category if ids.rng.random() < 0.15 else model.future_name
        return record | {"bbox": [[w, h, d]], "valid": True}
    return record | {"bbox": [w, d, h], "valid": True}


def _add_litter(
    house: House,
    dialect: Dialect,
    ids: Ids,
    litter: Litter,
    furniture: list[Json],
    meshes: list[tuple[Json, shell.Surface]],
    rooms: list[Json],
    counter: dict[str, int],
) -> None:
    """Add what real files hold besides: references to nothing, invalid records, duplicates, rooms that are none."""
    rng = ids.rng
    real = [r for r in rooms if not r["empty"]] or rooms
    for _ in range(litter.dangling):
        _child(real[int(rng.integers(len(real)))], "furniture", ids.uid("model"), counter, _anywhere(rng, house))
    for _ in range(litter.invalid):
        w, d, h = (_r(v) for v in rng.uniform(0.1, 0.8, 3))
        record: Json = {"jid": ids.uuid(), "uid": ids.uid("model"), "aid": [], "category": "Others", "bbox": [w, h, d], "valid": False}
        furniture.append(record)
        _child(real[int(rng.integers(len(real)))], "furniture", record["uid"], counter, _anywhere(rng, house))
    if furniture:
        for _ in range(litter.duplicates):
            furniture.append(dict(furniture[int(rng.integers(len(furniture)))]))
    for _ in range(litter.double_children):
        children = real[int(rng.integers(len(real)))]["children"]
        if children:
            children.append(dict(children[int(rng.integers(len(children)))]))
    if litter.other_room:
        other = {"type": "OtherRoom", "instanceid": "OtherRoom"} | ({"size": 0} if dialect == "0.11" else {})
        rooms.append(other | _identity() | {"children": [], "empty": 1})
        for _ in range(int(rng.integers(1, 5))):
            _child(rooms[-1], "furniture", ids.uid("model"), counter, _anywhere(rng, house))
    if litter.shaft_room:
        x0, y0 = (float(v) for v in house.plan.rooms[0].polygon.max(axis=0) + 3.0)
        quad: shell.Quad = ((x0, y0, 0.0), (x0 + 0.3, y0, 0.0), (x0 + 0.3, y0 + 0.33, 0.0), (x0, y0 + 0.33, 0.0))
        surface = shell.Surface("Floor", len(rooms), (quad,))
        record = mesh_record(surface, ids.uid("0"), "", dialect)
        del record["material"]
        meshes.append((record, surface))
        shaft = {"type": "OtherRoom", "instanceid": ids.room("OtherRoom")} | ({"size": 0.1} if dialect == "0.11" else {})
        rooms.append(shaft | _identity() | {"children": [], "empty": 1})
        _child(rooms[-1], "mesh", record["uid"], counter)


def _anywhere(rng: np.random.Generator, house: House) -> Json:
    """Return a pose for something that is not there; some are mirrored (11 of 464 on 12 real scenes)."""
    room = house.plan.rooms[int(rng.integers(len(house.plan.rooms)))]
    low, high = room.polygon.min(axis=0), room.polygon.max(axis=0)
    x, y = (float(v) for v in rng.uniform(low, high))
    pos = [_r(x), _r(float(rng.uniform(0, 1.6))), _r(-y)]
    return {"pos": pos, "rot": quaternion(float(rng.uniform(-3, 3))), "scale": [-1 if rng.random() < 11 / 464 else 1, 1, 1]}


def _child(room: Json, kind: str, ref: str, counter: dict[str, int], pose: Json | None = None) -> None:
    counter[kind] += 1
    room["children"].append({"ref": ref, "instanceid": f"{kind}/{counter[kind]}"} | (pose or _identity()))


def _material(ids: Ids, color: list[int], dialect: Dialect) -> Json:
    record: Json = {"uid": ids.uid("material"), "aid": [], "jid": ids.uuid(), "texture": "", "normaltexture": "", "color": list(color)}
    if dialect == "0.11":
        record |= {"contentType": ["material", "paint"], "seamWidth": 0, "useColor": True}
        record |= {"UVTransform": [1, 0, 0, 0, 1, 0, 0, 0, 1], "normalUVTransform": [1, 0, 0, 0, 1, 0, 0, 0, 1]}
    return record


def _top(
    house: House,
    dialect: Dialect,
    ids: Ids,
    furniture: list[Json],
    meshes: list[Json],
    materials: list[Json],
    doors: list[Json],
    rooms: list[Json],
) -> Json:
    scene: Json = {"ref": "-1", **_identity(), "room": rooms}
    extension: Json = {"door": doors, "outdoor": "", "pano": [], "mini_map": "", "perspective_view": {}, "area": []}
    top: Json = {"uid": house.uid, "design_version": "0.1" if dialect == "0.4" else str(ids.rng.integers(1, 400)), "code_version": dialect}
    top |= {"north_vector": [0, 1, 0], "version": "2.0", "furniture": furniture, "mesh": meshes, "material": materials}
    if dialect == "0.11":
        low = np.min([r.polygon.min(axis=0) for r in house.plan.rooms], axis=0)
        high = np.max([r.polygon.max(axis=0) for r in house.plan.rooms], axis=0)
        # The real files negate y without swapping the bounds: min.z is the larger one.
        scene["boundingBox"] = {
            "min": [_r(float(low[0])), 0, _r(-float(low[1]))],
            "max": [_r(float(high[0])), house.plan.rooms[0].height, _r(-float(high[1]))],
        }
        extension |= {"snapshots": [], "temperature": 6500, "skybox": {}}
        top |= {"jobid": "", "groups": [], "materialList": [m["jid"] for m in materials], "lights": _lights(house, ids, rooms)}
    return top | {"extension": extension, "scene": scene}


def _lights(house: House, ids: Ids, rooms: Sequence[Json]) -> list[Json]:
    lights: list[Json] = [{"nodeType": "VraySun", "uid": ids.uid("light"), "roomId": "", "intensity": 0.05, "size": 10}]
    for room, record in zip(house.plan.rooms, rooms, strict=False):
        x, y = (float(v) for v in room.polygon.mean(axis=0))
        light = {
            "nodeType": "VRayLight",
            "uid": ids.uid("light"),
            "roomId": record["instanceid"],
            "intensity": 3,
            "color_temperature": 5000,
        }
        lights.append(light | {"src_position": [_r(x), _r(room.height - 0.1), _r(-y)], "direction": [0, -1, 0]})
    return lights


def _r(value: float) -> float:
    """Round to 5 decimals, without a negative zero; whole numbers as the real files have them."""
    rounded = round(value, 5) + 0.0
    return int(rounded) if rounded == int(rounded) else rounded


def _s(scale: float) -> float:
    return _r(scale) if abs(scale) != 1 else int(scale)
