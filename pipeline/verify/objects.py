"""Objects at rest: in each other, out of their rooms, floating."""

from collections.abc import Mapping

import numpy as np

from pipeline import taxonomy
from pipeline.entities.home import Home, Placement
from pipeline.entities.plan import Room
from pipeline.geometry.contact import pair_depths, wall_excesses
from pipeline.verify.bodies import Bodies
from pipeline.verify.certificate import ObjectCheck
from pipeline.verify.settings import VerifySettings
from pipeline.verify.supports import Support


def check_objects(home: Home, bodies: Bodies, supports: Mapping[int, Support], settings: VerifySettings) -> tuple[ObjectCheck, ...]:
    """Check every object against all others, the walls of its room, and gravity."""
    p = bodies.prisms
    depths = pair_depths(p.corners, p.count, p.z, bodies.flat, bodies.start, bodies.boxes, settings.touch)
    rooms = {room.room_id: room for room in home.plan.rooms}
    outside = _outside(home, bodies, rooms)
    checks = []
    for g, placement in enumerate(home.placements):
        hits = tuple(home.placements[int(h)].object_id for h in np.flatnonzero(depths[g]))
        checks.append(
            ObjectCheck(
                placement.object_id,
                placement.room_id,
                hits,
                round(float(outside[g]), 6),
                bool(outside[g] <= settings.wall),
                g in supports if placement.support else _is_supported(g, placement, home, bodies, settings),
            )
        )
    return tuple(checks)


def _outside(home: Home, bodies: Bodies, rooms: Mapping[str, Room]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return how far each object sticks out of its room's walls [m]."""
    p = bodies.prisms
    worst = np.zeros(len(home.placements))
    for g, placement in enumerate(home.placements):
        own = slice(int(bodies.start[g]), int(bodies.start[g + 1]))
        if own.stop > own.start:
            worst[g] = wall_excesses(p.corners[own], p.count[own], np.ascontiguousarray(rooms[placement.room_id].polygon, np.float64)).max()
    return worst


def _is_supported(g: int, placement: Placement, home: Home, bodies: Bodies, settings: VerifySettings) -> bool:
    """Tell whether an object stands on the floor or on another, or hangs where its category may hang."""
    floor = home.plan.elevation(placement.room_id)
    ceiling = floor + home.plan.room(placement.room_id).height
    bottom, top = float(placement.position[2]), float(placement.position[2] + placement.size[2])
    if bottom < floor - settings.wall or top > ceiling + settings.wall:
        return False
    if bottom <= floor + settings.float_gap:
        return True
    known = taxonomy.load().categories.get(placement.category)
    if known is not None and known.mount != "floor":
        return True
    low, high = placement.footprint().min(0), placement.footprint().max(0)
    p = bodies.prisms
    under = np.abs(p.z[:, 1] - bottom) <= settings.float_gap
    under[bodies.start[g] : bodies.start[g + 1]] = False
    shared = np.minimum(bodies.flat[:, 2:], high) - np.maximum(bodies.flat[:, :2], low)
    return bool(np.any(under & (shared > 0.02).all(1)))
