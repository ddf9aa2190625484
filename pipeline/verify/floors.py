"""Floors: what of each room a robot can walk on, and how it hangs together with the entrance."""

import numpy as np

from pipeline import taxonomy
from pipeline.entities.home import Home, Placement
from pipeline.entities.plan import Plan, Room
from pipeline.geometry.free_space import FreeSpace, bare_floor, free_space
from pipeline.geometry.prisms import Prisms
from pipeline.verify.bodies import Bodies
from pipeline.verify.certificate import RoomCheck
from pipeline.verify.settings import VerifySettings

NEAR_ENTRANCE = 1.0  # the robot must find a place this near to the entrance door [m]


def level_free_space(home: Home, level: int, bodies: Bodies, settings: VerifySettings) -> tuple[FreeSpace, int]:
    """Return the furnished floor of one storey, and the label of the part that one enters.

    Small things take no floor: what lies on furniture is above it, rugs are driven over, curtains give way.
    """
    plan, robot = home.plan, settings.robot
    rooms = [r for r in plan.rooms if r.level == level]
    openings = [o for o in plan.openings if o.level == level]
    floor = bare_floor(rooms, openings, max(plan.inner_wall, plan.outer_wall) / 2 + settings.cell, settings.cell)
    base = level * plan.storey_height
    space = free_space(floor, _furniture(home, bodies), robot.radius, robot.band(base))
    return space, _entry_label(plan, level, rooms, space)


def _furniture(home: Home, bodies: Bodies) -> Prisms:
    """Return the prisms of all but small things."""
    small, p = taxonomy.load().small, bodies.prisms
    own = np.repeat([placement.category not in small for placement in home.placements], np.diff(bodies.start)).astype(bool)
    return Prisms(p.corners[own], p.count[own], p.z[own], p.part[own])


def _entry_label(plan: Plan, level: int, rooms: list[Room], space: FreeSpace) -> int:
    """Return the label of the part one comes into: at the entrance door, else in the entrance room, else by the stairs."""
    doors = [o for o in plan.openings if o.level == level and o.kind == "entrance"]
    if doors:
        return space.label_near(doors[0].segment.mean(0), NEAR_ENTRANCE)
    where = np.zeros(space.labels.shape, np.bool_)
    for number, room in enumerate(rooms):
        if room.room_id == plan.entrance or room.type == "staircase":
            where |= space.floor.room == number
    return space.largest_label(where if where.any() else space.floor.room >= 0)


def check_rooms(home: Home, spaces: dict[int, tuple[FreeSpace, int]]) -> dict[str, RoomCheck]:
    """Return the figures of every room."""
    checks: dict[str, RoomCheck] = {}
    small = taxonomy.load().small
    for level, (space, label) in spaces.items():
        rooms = [r for r in home.plan.rooms if r.level == level]
        shares = space.shares(space.swept_floor(label), len(rooms))
        inside = space.floor.room[space.centres(label)]
        entered = np.bincount(inside[inside >= 0], minlength=len(rooms))
        for number, room in enumerate(rooms):
            own = tuple(p for p in home.in_room(room.room_id) if p.category not in small)
            checks[room.room_id] = RoomCheck(
                room.room_id,
                room.area,
                occupied_ratio(room, tuple(p for p in own if _floor_standing(p, home.plan))),
                occupied_ratio(room, own),
                float(shares[number]),
                bool(entered[number] > 0),
            )
    return checks


def occupied_ratio(room: Room, placements: tuple[Placement, ...]) -> float:
    """Return the paper's R_walkable, (A_room - sum A_i) / A_room: footprints are summed, not united; no robot."""
    taken = sum(float(p.size[0] * p.size[1]) for p in placements)
    return (room.area - taken) / room.area


def _floor_standing(placement: Placement, plan: Plan) -> bool:
    known = taxonomy.load().categories.get(placement.category)
    if known is not None and known.mount == "ceiling":
        return False
    return bool(placement.position[2] - plan.elevation(placement.room_id) < 0.1)
