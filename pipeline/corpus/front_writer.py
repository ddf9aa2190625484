"""Writes a house as a scene file in 3D-FRONT's JSON, in either of the release's two dialects.

"3D-FRONT format": y up, metres; (x, y, z) of ours becomes (x, z, -y), yaw is unchanged; `rot` is a quaternion (x, y, z, w)
rounded to 5 decimals; only furniture children carry poses, meshes are in world coordinates.
"""

import math
import uuid
from typing import Any, Literal

import numpy as np

from pipeline.card import cards
from pipeline.corpus.furniture.finishes import one_of
from pipeline.corpus.houses import shell
from pipeline.corpus.houses.corruption import Litter
from pipeline.corpus.houses.records import House, Item
from pipeline.entities.plan import Opening

Dialect = Literal["0.4", "0.11"]
DIALECTS: tuple[Dialect, Dialect] = ("0.4", "0.11")
Json = dict[str, Any]
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
TITLES = {"swing": "door/single swing door", "sliding": "door/sliding door", "entry": "door/entrance door", "window": "window/window"}
GARBAGE_NORMAL = (-3.932, 1, -2.043)  # what floors of the 0.4 dialect carry for normals


class SceneFile:
    """A scene file in the making: its records, and the generator that draws their ids and variants."""

    def __init__(self, house: House, dialect: Dialect, rng: np.random.Generator) -> None:
        self.house, self.rng, self.dialect = house, rng, dialect
        self.number = int(rng.integers(10**12, 9 * 10**12)) * 1000
        self.counts = {"furniture": 0, "mesh": 0, "room": 0}
        self.materials = {name: self._material(color) for name, color in MATERIALS.items()}
        self.furniture: list[Json] = []
        self.meshes: list[tuple[Json, shell.Surface]] = []
        self.rooms: list[Json] = []
        for room, bare in zip(house.plan.rooms, house.empty, strict=True):
            self._room(room.type, self._room_id(room.type), round(room.area, 4), empty=bare)

    def newer(self, **fields: Any) -> Json:
        """Return fields that the newer dialect has and the older one has not."""
        return fields if self.dialect == "0.11" else {}

    def uid(self, tail: str) -> str:
        """Return the next record id, e.g. "5271533262579975/0"."""
        self.number += int(self.rng.integers(1, 40))
        return f"{self.number}/{tail}"

    def uuid(self) -> str:
        """Return a random uuid: of materials, and of models that were never released."""
        return str(uuid.UUID(bytes=self.rng.bytes(16), version=4))

    def _room_id(self, room_type: str) -> str:
        """Return a room's instance id; no two rooms of a corpus share one."""
        self.counts["room"] += 1
        return f"{room_type}-{self.house.index * 64 + self.counts['room'] + 101}"

    def _room(self, room_type: str, name: str, area: float, *, empty: bool = True) -> None:
        """Add a room of so many square metres."""
        room: Json = {"type": room_type, "instanceid": name} | self.newer(size=area)
        self.rooms.append(room | _identity() | {"children": [], "empty": int(empty)})

    def _material(self, color: list[int]) -> Json:
        flat = [1, 0, 0, 0, 1, 0, 0, 0, 1]
        paint: Json = {"uid": self.uid("material"), "aid": [], "jid": self.uuid(), "texture": "", "normaltexture": "", "color": color}
        return paint | self.newer(contentType=["material", "paint"], seamWidth=0, useColor=True, UVTransform=flat, normalUVTransform=flat)

    def child(self, room: Json, kind: str, ref: str, pose: Json | None = None) -> None:
        """List a record among the children of a room."""
        self.counts[kind] += 1
        room["children"].append({"ref": ref, "instanceid": f"{kind}/{self.counts[kind]}"} | (pose or _identity()))

    def add_mesh(self, surface: shell.Surface, material: str | None) -> None:
        """Add a surface: unshared corners, y up, two triangles a quad."""
        xyz: list[float] = []
        normal: list[float] = []
        uv: list[float] = []
        faces: list[int] = []
        for k, quad in enumerate(surface.quads):
            n = GARBAGE_NORMAL if surface.type == "Floor" and self.dialect == "0.4" else _normal(quad)
            for x, y, z in quad:
                xyz += [round(x, 5), round(z, 5), round(0.0 - y, 5)]
                normal += n
            width, height = round(math.dist(quad[0], quad[1]), 3), round(math.dist(quad[1], quad[2]), 3)
            uv += [0, 0, width, 0, width, height, 0, height]
            faces += [4 * k, 4 * k + 1, 4 * k + 2, 4 * k, 4 * k + 2, 4 * k + 3]
        uid = self.uid("0")
        record: Json = {"aid": [], "jid": "", "uid": uid, "xyz": xyz, "normal": normal, "uv": uv, "faces": faces}
        record |= ({} if material is None else {"material": material}) | {"type": surface.type}
        record |= self.newer(constructid=uid.split("/", maxsplit=1)[0], instanceid="")
        self.meshes.append((record, surface))
        self.child(self.rooms[surface.room], "mesh", uid)

    def add_shell(self) -> None:
        """Add floors, ceilings, walls and reveals."""
        for surface in shell.surfaces(self.house.plan):
            name = surface.type if surface.type in self.materials else "Door" if surface.type in {"Hole", "Pocket"} else "WallInner"
            self.add_mesh(surface, self.materials[name]["uid"])

    def add_leaves(self) -> list[Json]:
        """Add doors and windows as furniture without a released model; return the file's list of doors."""
        jids = {kind: self.uuid() for kind in TITLES}
        numbers = {room.room_id: k for k, room in enumerate(self.house.plan.rooms)}
        doors = []
        for k, opening in enumerate(self.house.plan.openings):
            refs = [record["uid"] for record, surface in self.meshes if surface.opening == k]
            if opening.kind not in {"open", "portal"}:
                kind = {"window": "window", "entrance": "entry"}.get(opening.kind, "swing" if opening.swing else "sliding")
                uid = self.uid("model")
                self.furniture.append({"uid": uid, "jid": jids[kind], "aid": []} | self.newer(title=TITLES[kind], type="standard"))
                refs.insert(0, uid)
                self.child(self.rooms[numbers[opening.rooms[0]]], "furniture", uid, _leaf_pose(opening))
            if opening.kind in {"door", "entrance"}:
                home = opening.swing.room_id if opening.swing else opening.rooms[0]
                side = "Left" if opening.swing and opening.swing.hinge == 0 else "Right"
                kind = "entryDoor" if opening.kind == "entrance" else "interiorDoor"
                doors.append({"type": kind, "roomId": self.rooms[numbers[home]]["instanceid"], "dir": f"inner{side}", "ref": refs})
        return doors

    def add_items(self) -> None:
        """Add the furniture."""
        for item in self.house.items:
            replaced = abs(abs(item.scale[0]) - 1) > 1e-9 or abs(item.scale[1] - 1) > 1e-9
            variant = "replaced" if replaced else str(self.rng.choice(list(VARIANTS), p=list(VARIANTS.values())))
            record = self._item(item, variant)
            self.furniture.append(record)
            x, y, z = item.position
            sx, sy, sz = item.scale
            pose: Json = {"pos": [_r(x), _r(z), _r(-y)], "rot": quaternion(item.yaw), "scale": [_s(sx), _s(sz), _s(sy)]}
            if replaced:
                box = dict(zip(("xLen", "yLen", "zLen"), (_r(100 * v) for v in item.model.size), strict=True))
                pose |= {"replace_jid": item.model.model_id, "replace_bbox": box}
            self.child(self.rooms[item.room], "furniture", record["uid"], pose)

    def _item(self, item: Item, variant: str) -> Json:
        """Return a furniture record. Mind the order of axes: flat sizes are width, depth, height, others width, height, depth."""
        w, d, h = (_r(v) for v in item.size)
        model = item.model
        if variant == "late":
            uid = f"2021{int(self.rng.integers(10**17, 10**18))}/model"
            return {"jid": model.model_id, "uid": uid, "aid": [], "category": model.future_name, "bbox": [w, h, d], "valid": True}
        record: Json = {"uid": self.uid("model"), "jid": model.model_id, "aid": [], "size": [w, d, h]}
        record["sourceCategoryId"] = str(uuid.uuid5(uuid.NAMESPACE_OID, model.category))
        record["title"] = cards()[model.category].corpus.title or f"{model.super_category}/{model.category.replace('_', ' ')}".lower()
        record |= self.newer(type="standard")
        if variant != "replaced":
            return record | {"bbox": [w, d, h], "valid": True}
        # A model that was replaced: the category may be as coarse as the super-category.
        record["category"] = model.super_category if self.rng.random() < 0.15 else model.future_name
        return record | {"bbox": [[w, h, d]], "valid": True}

    def add_litter(self, litter: Litter) -> None:
        """Add what real files hold besides: references to nothing, invalid records, duplicates, rooms that are none."""
        rng = self.rng
        real = [r for r in self.rooms if not r["empty"]] or self.rooms
        for _ in range(litter.dangling):
            self.child(one_of(rng, real), "furniture", self.uid("model"), self._anywhere())
        for _ in range(litter.invalid):
            w, d, h = (_r(v) for v in rng.uniform(0.1, 0.8, 3))
            entry: Json = {"jid": self.uuid(), "uid": self.uid("model"), "aid": [], "category": "Others", "bbox": [w, h, d], "valid": False}
            self.furniture.append(entry)
            self.child(one_of(rng, real), "furniture", entry["uid"], self._anywhere())
        for _ in range(litter.duplicates if self.furniture else 0):
            self.furniture.append(dict(one_of(rng, self.furniture)))
        for _ in range(litter.double_children):
            children = one_of(rng, real)["children"]
            if children:
                children.append(dict(one_of(rng, children)))
        if litter.other_room:
            self._room("OtherRoom", "OtherRoom", 0)
            for _ in range(int(rng.integers(1, 5))):
                self.child(self.rooms[-1], "furniture", self.uid("model"), self._anywhere())
        if litter.shaft_room:
            x0, y0 = (float(v) for v in self.house.plan.rooms[0].polygon.max(axis=0) + 3.0)
            quad: shell.Quad = ((x0, y0, 0.0), (x0 + 0.3, y0, 0.0), (x0 + 0.3, y0 + 0.33, 0.0), (x0, y0 + 0.33, 0.0))
            self._room("OtherRoom", self._room_id("OtherRoom"), 0.1)
            self.add_mesh(shell.Surface("Floor", len(self.rooms) - 1, (quad,)), None)

    def _anywhere(self) -> Json:
        """Return a pose for something that is not there; some are mirrored (11 of 464 on 12 real scenes)."""
        rng = self.rng
        polygon = one_of(rng, self.house.plan.rooms).polygon
        x, y = (float(v) for v in rng.uniform(polygon.min(axis=0), polygon.max(axis=0)))
        pos = [_r(x), _r(float(rng.uniform(0, 1.6))), _r(-y)]
        return {"pos": pos, "rot": quaternion(float(rng.uniform(-3, 3))), "scale": [-1 if rng.random() < 11 / 464 else 1, 1, 1]}

    def whole(self, doors: list[Json]) -> Json:
        """Return the file."""
        house, materials = self.house, list(self.materials.values())
        version = "0.1" if self.dialect == "0.4" else str(self.rng.integers(1, 400))
        top: Json = {"uid": house.uid, "design_version": version, "code_version": self.dialect, "north_vector": [0, 1, 0], "version": "2.0"}
        top |= {"furniture": self.furniture, "mesh": [record for record, _ in self.meshes], "material": materials}
        if self.dialect == "0.11":
            top |= {"jobid": "", "groups": [], "materialList": [m["jid"] for m in materials], "lights": self._lights()}
        low = np.min([r.polygon.min(axis=0) for r in house.plan.rooms], axis=0)
        high = np.max([r.polygon.max(axis=0) for r in house.plan.rooms], axis=0)
        # The real files negate y without swapping the bounds: min.z is the larger one.
        (x0, y0), (x1, y1) = low.tolist(), high.tolist()
        bounds = {"min": [_r(x0), 0, _r(-y0)], "max": [_r(x1), house.plan.rooms[0].height, _r(-y1)]}
        extension: Json = {"door": doors, "outdoor": "", "pano": [], "mini_map": "", "perspective_view": {}, "area": []}
        extension |= self.newer(snapshots=[], temperature=6500, skybox={})
        return top | {"extension": extension, "scene": {"ref": "-1", **_identity(), "room": self.rooms} | self.newer(boundingBox=bounds)}

    def _lights(self) -> list[Json]:
        lights: list[Json] = [{"nodeType": "VraySun", "uid": self.uid("light"), "roomId": "", "intensity": 0.05, "size": 10}]
        for room, record in zip(self.house.plan.rooms, self.rooms, strict=False):
            x, y = (float(v) for v in room.polygon.mean(axis=0))
            light = {"nodeType": "VRayLight", "uid": self.uid("light"), "roomId": record["instanceid"], "intensity": 3}
            place = {"src_position": [_r(x), _r(room.height - 0.1), _r(-y)], "direction": [0, -1, 0]}
            lights.append(light | {"color_temperature": 5000} | place)
        return lights


def scene_json(house: House, dialect: Dialect, rng: np.random.Generator, litter: Litter) -> Json:
    """Return the scene file of a house as JSON. `rng` draws ids and record variants, `litter` says what defects it has."""
    file = SceneFile(house, dialect, rng)
    file.add_shell()
    doors = file.add_leaves()
    file.add_items()
    file.add_litter(litter)
    return file.whole(doors)


def quaternion(yaw: float) -> list[float]:
    """Return the turn about the up axis as (x, y, z, w), 5 decimals, like the real files."""
    return [0, _r(math.sin(yaw / 2)), 0, _r(math.cos(yaw / 2))]


def _identity() -> Json:
    return {"pos": [0, 0, 0], "rot": [0, 0, 0, 1], "scale": [1, 1, 1]}


def _normal(quad: shell.Quad) -> list[float]:
    """Return the unit normal of a quad in 3D-FRONT's frame."""
    a, b, c = np.array(quad[:3])
    x, y, z = np.cross(b - a, c - a)
    length = math.hypot(x, y, z)
    return [round(x / length), round(z / length), round(-y / length)]


def _leaf_pose(opening: Opening) -> Json:
    (ax, ay), (bx, by) = opening.segment.tolist()
    yaw = 0.0 if abs(bx - ax) > abs(by - ay) else math.pi / 2
    return {"pos": [_r((ax + bx) / 2), _r(opening.sill), _r(-(ay + by) / 2)], "rot": quaternion(yaw), "scale": [1, 1, 1]}


def _r(value: float) -> float:
    """Round to 5 decimals, without a negative zero; whole numbers as the real files have them."""
    rounded = round(value, 5) + 0.0
    return int(rounded) if rounded == int(rounded) else rounded


def _s(scale: float) -> float:
    return _r(scale) if abs(scale) != 1 else int(scale)
