"""Rows of the training tables from what was read of a 3D-FRONT house."""

from dataclasses import dataclass, field

import numpy as np
from shapely.geometry import Polygon

from pipeline.entities.plan import Opening
from pipeline.sources.identity import split_of
from pipeline.sources.reasons import Row
from pipeline.sources.threed_front.floors import Floor
from pipeline.sources.threed_front.furniture import Placed
from pipeline.sources.threed_front.house_file import HouseFile, RoomRecord
from pipeline.taxonomy import Taxonomy

THIN = 0.05  # [m] what is flatter lies under one's feet
STANDING = 0.3  # [m] an object whose bottom is lower takes up floor; pendant lamps and wall units do not


@dataclass(slots=True)
class ReadRoom:
    """A room with a usable floor, and the objects that were kept."""

    record: RoomRecord
    room_id: str
    type: str
    floor: Floor
    polygon: Polygon
    height: float
    objects: list[Placed]
    supports: list[int] = field(default_factory=list)

    def object_id(self, number: int) -> str:
        """Return the id of the room's object of that number; empty for -1."""
        return f"{self.objects[number].category}_{self.room_id}_{number}" if number >= 0 else ""

    def covering(self) -> list[Placed]:
        """Return what takes up floor: neither what hangs, nor what lies on furniture, nor what one walks on."""
        bearers = self.supports or [-1] * len(self.objects)
        return [
            o
            for o, on in zip(self.objects, bearers, strict=True)
            if o.span[0] < STANDING and o.span[1] > THIN and (on < 0 or o.span[0] < THIN)
        ]


def room_row(scene_id: str, uid: str, room: ReadRoom, taxonomy: Taxonomy) -> Row:
    """Return a rooms row; `walkable_free` is filled in once the openings are known."""
    area = room.floor.area
    covered = sum(float(np.prod(o.pose.size[:2])) for o in room.covering())
    return {
        "scene_id": scene_id,
        "room_id": room.room_id,
        "type": room.type,
        "layout_type": taxonomy.front_rooms.get(room.type) or "",
        "role": "",
        "level": 0,
        "height": room.height,
        "area": round(area, 4),
        "polygon": room.floor.polygon.tolist(),
        "objects": len(room.objects),
        "asked_objects": None,
        "openable": sum(o.openable for o in room.objects),
        "openable_sampled": None,
        "walkable_paper": round(1 - covered / area, 4),
        "walkable_free": 0.0,
        "walkable_target": None,
        "source_id": f"{uid}/{room.record.instance}",
    }


def opening_row(scene_id: str, opening: Opening) -> Row:
    """Return an openings row; how a leaf swings is not in the source."""
    return {
        "scene_id": scene_id,
        "opening_id": opening.opening_id,
        "kind": opening.kind,
        "rooms": list(opening.rooms),
        "segment": opening.segment.tolist(),
        "width": round(opening.width, 4),
        "height": opening.height,
        "sill": opening.sill,
        "swing_room": "",
        "swing_hinge": None,
        "swing_angle": None,
        "level": 0,
    }


def object_row(scene_id: str, room: ReadRoom, number: int, source: str) -> Row:
    """Return the objects row of a room's object; `source` is its room and child in the file."""
    piece = room.objects[number]
    return {
        "scene_id": scene_id,
        "object_id": room.object_id(number),
        "room_id": room.room_id,
        "category": piece.category,
        "asset_id": piece.asset_id,
        "position": piece.pose.position.tolist(),
        "yaw": piece.pose.yaw,
        "size": piece.pose.size.tolist(),
        "scale": piece.scale.tolist(),
        "openable": piece.openable,
        "support": room.object_id(room.supports[number]) if room.supports else "",
        "latent": [0.0] * 32,
        "retrieval_distance": 0.0,
        "source_id": f"{source}#{piece.jid}",
    }


def scene_row(
    scene_id: str, house: HouseFile, rooms: list[ReadRoom], openings: list[Opening], walls: tuple[float, float], licence: str
) -> Row:
    """Return the scenes row of a house; `index` and `walkable_free` are filled in later."""
    area = sum(room.floor.area for room in rooms)
    objects = [o for room in rooms for o in room.objects]
    covered = sum(float(np.prod(o.pose.size[:2])) for room in rooms for o in room.covering())
    return {
        "scene_id": scene_id,
        "index": 0,
        "seed": 0,
        "split": split_of(house.identity or house.uid),
        "prompt": "",
        "program": "",
        "storeys": 1,
        "storey_height": round(max(room.height for room in rooms) + 0.3, 4),
        "inner_wall": walls[0],
        "outer_wall": walls[1],
        "entrance": _entrance(house, rooms, openings),
        "area": round(area, 4),
        "rooms": len(rooms),
        "objects": len(objects),
        "openable": sum(o.openable for o in objects),
        "joints": 0,
        "joints_clear": 0,
        "collisions": 0,
        "reach": 0.0,
        "walkable_paper": round(1 - covered / area, 4),
        "walkable_free": 0.0,
        "attempts": 1,
        "licence": licence,
        "usd": "",
        "usd_sha256": "",
    }


def _entrance(house: HouseFile, rooms: list[ReadRoom], openings: list[Opening]) -> str:
    """Return the room that the file's entry door names, else one with a door to outside, halls and living rooms first."""
    by_instance = {room.record.instance: room.room_id for room in rooms}
    for name in house.entry_rooms:
        if name in by_instance:
            return by_instance[name]
    outside = {o.rooms[0] for o in openings if o.kind == "entrance"}
    wanted = ("hallway", "aisle", "corridor", "livingdiningroom", "livingroom", "diningroom", "lounge")
    for kind in wanted:
        for room in rooms:
            if room.type == kind and room.room_id in outside:
                return room.room_id
    return ""
