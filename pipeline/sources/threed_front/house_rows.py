"""Rows of the training tables from what was read of a 3D-FRONT house."""

import functools
import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import pyarrow as pa
from shapely.geometry import Polygon

from pipeline import taxonomy
from pipeline.entities.plan import Opening
from pipeline.sources.reasons import Row
from pipeline.sources.rows import split_of
from pipeline.sources.threed_front.floors import Floor
from pipeline.sources.threed_front.furniture import Placed
from pipeline.sources.threed_front.house_file import HouseFile, RoomRecord
from schemas import OBJECTS, OPENINGS, ROOMS, SCENES
from schemas.table import Table

THIN = 0.05  # [m] what is flatter lies under one's feet
STANDING = 0.3  # [m] an object whose bottom is lower takes up floor; pendant lamps and wall units do not
# rooms that one enters, likeliest first
ENTRANCES = ("hallway", "aisle", "corridor", "livingdiningroom", "livingroom", "diningroom", "lounge")


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

    def covered(self) -> list[float]:
        """Return the areas [m2] of what takes up floor: neither what hangs, nor what lies on furniture, nor what one walks on."""
        bearers = self.supports or [-1] * len(self.objects)
        standing = (
            o.span[0] < STANDING and o.span[1] > THIN and (on < 0 or o.span[0] < THIN) for o, on in zip(self.objects, bearers, strict=True)
        )
        return [float(np.prod(o.pose.size[:2])) for o, stands in zip(self.objects, standing, strict=True) if stands]


@functools.cache
def _unknown(table: Table) -> Row:
    """Return a row of what no source says: how a home was asked for, made and judged."""
    plain = {c.name: "" if pa.types.is_string(c.type) else 0.0 if pa.types.is_floating(c.type) else 0 for c in table.columns}
    return plain | {c.name: None for c in table.columns if c.nullable}


def room_row(scene_id: str, uid: str, room: ReadRoom, walkable: float) -> Row:
    """Return a rooms row; `walkable` is the share of its floor that the robot reaches."""
    area = room.floor.area
    return _unknown(ROOMS) | {
        "scene_id": scene_id,
        "room_id": room.room_id,
        "type": room.type,
        "layout_type": taxonomy.load().front_rooms.get(room.type) or "",
        "height": room.height,
        "area": round(area, 4),
        "polygon": room.floor.polygon.tolist(),
        "objects": len(room.objects),
        "openable": sum(o.openable for o in room.objects),
        "walkable_paper": round(1 - sum(room.covered()) / area, 4),
        "walkable_free": walkable,
        "source_id": f"{uid}/{room.record.instance}",
    }


def opening_row(scene_id: str, opening: Opening) -> Row:
    """Return an openings row; how a leaf swings is not in the source."""
    return _unknown(OPENINGS) | {
        "scene_id": scene_id,
        "opening_id": opening.opening_id,
        "kind": opening.kind,
        "rooms": list(opening.rooms),
        "segment": opening.segment.tolist(),
        "width": round(opening.width, 4),
        "height": opening.height,
        "sill": opening.sill,
    }


def object_row(scene_id: str, uid: str, room: ReadRoom, number: int) -> Row:
    """Return the objects row of a room's object."""
    piece = room.objects[number]
    return _unknown(OBJECTS) | {
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
        "source_id": f"{uid}/{piece.filed or room.record.instance}/{piece.child.instance}#{piece.jid}",
    }


def scene_row(
    scene_id: str, house: HouseFile, rooms: Sequence[ReadRoom], rows: Sequence[Row], openings: Sequence[Opening], walls: tuple[float, float],
    licence: str,
) -> Row:  # fmt: skip
    """Return the scenes row of a house with these rooms and their `rows`; its `index` is filled in later."""
    area = sum(room.floor.area for room in rooms)
    walkable = sum(row["walkable_free"] * row["area"] for row in rows) / round(area, 4)
    return _unknown(SCENES) | {
        "scene_id": scene_id,
        "split": split_of(house.identity or house.uid),
        "storeys": 1,
        "storey_height": round(max(room.height for room in rooms) + 0.3, 4),
        "inner_wall": walls[0],
        "outer_wall": walls[1],
        "entrance": _entrance(house, rooms, openings),
        "area": round(area, 4),
        "rooms": len(rooms),
        "objects": sum(row["objects"] for row in rows),
        "openable": sum(row["openable"] for row in rows),
        "walkable_paper": round(1 - sum(part for room in rooms for part in room.covered()) / area, 4),
        "walkable_free": round(walkable, 4),
        "attempts": 1,
        "licence": licence,
    }


def _entrance(house: HouseFile, rooms: Sequence[ReadRoom], openings: Sequence[Opening]) -> str:
    """Return the room that the file's entry door names, else one with a door to outside, halls and living rooms first."""
    by_instance = {room.record.instance: room.room_id for room in rooms}
    named = (by_instance[name] for name in house.entry_rooms if name in by_instance)
    outside = {o.rooms[0] for o in openings if o.kind == "entrance"}
    usual = (room.room_id for kind in ENTRANCES for room in rooms if room.type == kind and room.room_id in outside)
    return next(itertools.chain(named, usual), "")
