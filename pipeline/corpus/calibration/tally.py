"""Counts one house of the corpus as the reference was counted on real files: rooms, objects, relations, defects."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from shapely.geometry import Polygon
from shapely.ops import unary_union

from pipeline.corpus.front_statistics import Reference
from pipeline.corpus.houses.records import House, Item

Json = Mapping[str, Any]
STANDING = 0.3
"""What starts lower stands on the floor [m]."""
SOFAS = frozenset({"multi_seat_sofa", "loveseat_sofa", "l_shaped_sofa"})
DINING = frozenset({"dining_chair", "chinese_chair"})
NEAR_TABLE, ABOVE_TABLE = 1.6, 0.45
"""A chair belongs to a table within this distance, a lamp hangs above one within that [m]."""


@dataclass(frozen=True, slots=True)
class RoomTally:
    """One room as it is counted.

    `type` is 3D-FRONT's in lower case; `area` [m2]; `side` the longest of the floor's bounds [m]; `categories` those of what the
    peers count; `walkable` the share of the floor under nothing, None below three objects.
    """

    type: str
    area: float
    rectangular: bool
    side: float
    categories: tuple[str, ...]
    mirrored: bool
    walkable: float | None


@dataclass(slots=True)
class HouseTally:
    """One house; `shares` are (how many, of how many) by name, `relations` lists of lengths [m]."""

    rooms: list[RoomTally] = field(default_factory=list)
    shares: dict[str, tuple[int, int]] = field(default_factory=dict)
    relations: dict[str, list[float]] = field(default_factory=dict)


def tally(house: House, scene: Json, reference: Reference) -> HouseTally:
    """Count a house and its scene file."""
    house_tally = HouseTally(relations={name: [] for name in reference.relations})
    outside, overlapping, oblique, objects, pairs = 0, 0, 0, 0, 0
    for number, room in enumerate(house.plan.rooms):
        items = [i for i in house.items if i.room == number and reference.counted(i.model.category)]
        polygon = Polygon(room.polygon)
        shapes = [Polygon(i.corners()) for i in items]
        house_tally.rooms.append(_room(room.type, polygon, items, shapes))
        for item, shape in zip(items, shapes, strict=True):
            objects += 1
            outside += not polygon.covers(shape) and shape.intersection(polygon).area < 0.95 * shape.area
            oblique += abs(math.sin(2 * item.yaw)) > 0.035
        count, together = _overlaps(items, shapes)
        overlapping, pairs = overlapping + count, pairs + together
        relate(items, house_tally.relations)
    house_tally.shares = _defects(scene) | {
        "outside": (outside, objects),
        "overlapping": (overlapping, pairs),
        "oblique": (oblique, objects),
        "rectangular": (sum(r.rectangular for r in house_tally.rooms), len(house_tally.rooms)),
    }
    return house_tally


def _room(room_type: str, polygon: Polygon, items: Sequence[Item], shapes: Sequence[Polygon]) -> RoomTally:
    x0, y0, x1, y1 = polygon.bounds
    share = None
    if len(items) >= 3:
        standing = [s for i, s in zip(items, shapes, strict=True) if i.position[2] < STANDING]
        share = 1.0 - unary_union(standing).intersection(polygon).area / polygon.area if standing else 1.0
    mirrored = any(min(i.scale) < 0 for i in items)
    categories = tuple(i.model.category for i in items)
    rectangular = polygon.area > 0.99 * (x1 - x0) * (y1 - y0)
    return RoomTally(room_type.lower(), float(polygon.area), rectangular, max(x1 - x0, y1 - y0), categories, mirrored, share)


def _overlaps(items: Sequence[Item], shapes: Sequence[Polygon]) -> tuple[int, int]:
    """Return how many pairs of things on the floor overlap by more than 1 % of the smaller, and how many pairs there are."""
    floor = [k for k, i in enumerate(items) if i.position[2] < STANDING]
    boxes = [items[k].rect() for k in floor]
    overlaps = 0
    for n, a in enumerate(boxes):
        for m in range(n):
            b = boxes[m]
            if a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]:
                one, other = shapes[floor[n]], shapes[floor[m]]
                overlaps += one.intersection(other).area > 0.01 * min(one.area, other.area)
    return overlaps, len(floor) * (len(floor) - 1) // 2


def local(frame: Item, item: Item) -> tuple[float, float]:
    """Return an item's place in another's frame: (to the right, in front) [m]."""
    c, s = math.cos(frame.yaw), math.sin(frame.yaw)
    dx, dy = item.position[0] - frame.position[0], item.position[1] - frame.position[1]
    return c * dx + s * dy, s * dx - c * dy


def relate(items: Sequence[Item], lengths: dict[str, list[float]]) -> None:
    """Append the lengths of the relations that the pieces of one room stand in."""
    by: dict[str, list[Item]] = {}
    for item in items:
        by.setdefault(item.model.category, []).append(item)
    sofas = [i for name in sorted(SOFAS) for i in by.get(name, ())]
    for bed in by.get("double_bed", ()):
        for stand in by.get("nightstand", ()):
            if abs(math.remainder(stand.yaw - bed.yaw, 2 * math.pi)) < 0.1:
                across, ahead = local(bed, stand)
                lengths["nightstand beside double_bed, across"].append(abs(across))
                lengths["nightstand beside double_bed, ahead"].append(ahead)
        _opposite(bed, by.get("tv_stand", ()), lengths["tv_stand before double_bed, ahead"], lengths["tv_stand before double_bed, across"])
    for sofa in sofas:
        _opposite(sofa, by.get("tv_stand", ()), lengths["tv_stand before sofa, ahead"], [])
    for table in by.get("coffee_table", ()):
        places = [local(sofa, table) for sofa in sofas]
        in_front = [(ahead, abs(across)) for across, ahead in places if 0.3 < ahead < 2.5 and abs(across) < 1.0]
        if in_front:
            lengths["coffee_table before sofa, ahead"].append(min(in_front)[0])
            lengths["coffee_table before sofa, across"].append(min(in_front)[1])
    for table in by.get("dining_table", ()):
        for name, categories, most in (
            ("dining_chair from the table's centre", DINING, NEAR_TABLE),
            ("pendant_lamp from the table's centre", {"pendant_lamp"}, ABOVE_TABLE),
        ):
            distances = [math.dist(i.position[:2], table.position[:2]) for i in items if i.model.category in categories]
            lengths[name] += [d for d in distances if d < most]


def _opposite(seat: Item, stands: Sequence[Item], ahead: list[float], across: list[float]) -> None:
    for stand in stands:
        right, front = local(seat, stand)
        if math.cos(stand.yaw - seat.yaw) < -0.99 and abs(right) < 1.0 and 0.5 < front < 6.0:
            ahead.append(front)
            across.append(abs(right))


def _defects(scene: Json) -> dict[str, tuple[int, int]]:
    """Count a scene file's defects, as (how many, of how many)."""
    records = scene["furniture"]
    uids = Counter(r["uid"] for r in records)
    meshes = {m["uid"]: m for m in scene["mesh"]}
    rooms = scene["scene"]["room"]
    children = [c for room in rooms for c in room["children"] if c["instanceid"].startswith("furniture/")]
    floorless = sum(not any(meshes.get(c["ref"], {}).get("type") == "Floor" for c in room["children"]) for room in rooms)
    return {
        "dangling": (sum(c["ref"] not in uids for c in children), len(children)),
        "invalid": (sum(r.get("valid") is False for r in records), len(records)),
        "surplus": (len(records) - len(uids), len(records)),
        "floorless": (floorless, len(rooms)),
        "mirrored": (sum(bool(np.min(c["scale"]) < 0) for c in children), len(children)),
    }
