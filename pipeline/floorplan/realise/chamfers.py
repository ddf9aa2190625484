"""Corners of the outline cut at 45 degrees, where no opening stands in the way and no room becomes too small."""

import dataclasses
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
import shapely

from pipeline.arrays import Floats
from pipeline.entities.plan import Plan, Room
from pipeline.floorplan.program.floor_program import FloorProgram

LEGS = (1.2, 1.0, 0.8, 0.6, 0.5)  # of a cut along both its walls, between inner faces [m]; the longest that fits is taken
BESIDE = 0.15  # wall that stays between a cut and an opening [m]
STAYS = 0.6  # straight wall that stays of a side [m]
MOST = 0.03  # of a room's area that a cut may take


class Corner(NamedTuple):
    """A corner of the outline: the room that owns it, which of its vertices it is, and where (x, y) [m]."""

    room: Room
    vertex: int
    at: tuple[float, float]


Cuts = dict[tuple[str, int], float]  # room and vertex -> leg [m]


def chamfer_corners(program: FloorProgram, plan: Plan, holds: Callable[[list[Room]], bool]) -> Plan:
    """Return the plan with the corners of its outline cut, as far as `holds` is true of the rooms that it then has.

    Corners above each other are cut alike, or not at all. Rooms keep them that are to have a corner, a length of outside wall, or
    a width everywhere.
    """
    kept = {r.id for r in program.rooms if r.exterior == "corner" or r.exterior_length or r.type in {"hallway", "staircase"}}
    cuts: Cuts = {}
    above: dict[tuple[float, float], list[Corner]] = {}
    for corner in _corners(plan):
        above.setdefault(corner.at, []).append(corner)
    for _, stack in sorted(above.items()):
        for leg in LEGS:
            if any(c.room.room_id in kept or not _fits(plan, c, leg, cuts) for c in stack):
                continue
            trial = cuts | {(c.room.room_id, c.vertex): leg for c in stack}
            if holds(_rooms(plan, trial)):
                cuts = trial
                break
    return dataclasses.replace(plan, rooms=tuple(_rooms(plan, cuts)))


def _corners(plan: Plan) -> Iterator[Corner]:
    """Yield the convex vertices whose two walls have the outside behind all of them, and nothing of other rooms at the corner."""
    shapes = {r.room_id: shapely.Polygon(r.polygon) for r in plan.rooms}
    for room in plan.rooms:
        others = [shapes[r.room_id] for r in plan.rooms if r is not room and (r.level == room.level or r.type == "staircase")]
        rest = shapely.union_all(others)
        ones, twos = room.polygon - np.roll(room.polygon, 1, axis=0), np.roll(room.polygon, -1, axis=0) - room.polygon
        for k, (here, one, two) in enumerate(zip(room.polygon, ones, twos, strict=True)):
            if one[0] * two[1] - one[1] * two[0] <= 0:
                continue
            near = [shapely.LineString([here, here + min(LEGS[0], np.hypot(*way)) * way / np.hypot(*way)]) for way in (-one, two)]
            if all(rest.distance(side) > plan.outer_wall + 1e-3 for side in near) if others else True:
                yield Corner(room, k, (round(float(here[0]), 2), round(float(here[1]), 2)))


def _fits(plan: Plan, corner: Corner, leg: float, cuts: Cuts) -> bool:
    """Whether enough wall stays beside the cut, no opening is near, and the room hardly shrinks."""
    room, k, ring = corner.room, corner.vertex, corner.room.polygon
    count = len(ring)
    if leg * leg / 2 > MOST * room.area:
        return False
    for end in ((k - 1) % count, (k + 1) % count):
        if float(np.hypot(*(ring[end] - ring[k]))) < leg + STAYS + cuts.get((room.room_id, end), 0.0):
            return False
    half = max(plan.inner_wall, plan.outer_wall) / 2 + 0.01
    gone = [shapely.LineString([ring[k], end]).buffer(half, cap_style="flat") for end in _ends(ring, k, leg)]
    own = [shapely.LineString(o.segment) for o in plan.openings if room.room_id in o.rooms]
    return all(wall.distance(line) >= BESIDE for wall in gone for line in own)


def _ends(ring: Floats, vertex: int, leg: float) -> tuple[Floats, Floats]:
    """Return the two corners that a cut puts in the place of one."""
    before, here, after = ring[vertex - 1], ring[vertex], ring[(vertex + 1) % len(ring)]
    back, ahead = before - here, after - here
    return here + leg * back / np.hypot(*back), here + leg * ahead / np.hypot(*ahead)


def _rooms(plan: Plan, cuts: Cuts) -> list[Room]:
    rooms = []
    for room in plan.rooms:
        corners: list[Floats] = []
        for k, here in enumerate(room.polygon):
            leg = cuts.get((room.room_id, k))
            corners += [here] if leg is None else list(_ends(room.polygon, k, leg))
        polygon: Floats = np.array(corners, dtype=np.float64).round(3)
        rooms.append(dataclasses.replace(room, polygon=polygon))
    return rooms
