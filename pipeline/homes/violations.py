"""What must leave a home so that it can ship."""

from dataclasses import dataclass

import numpy as np

from pipeline import taxonomy
from pipeline.entities.home import Home, Placement
from pipeline.verify import Certificate


@dataclass(frozen=True, slots=True)
class Violation:
    """Why an object must go: its room, a reason code, and words."""

    room_id: str
    reason: str
    detail: str


def violations(home: Home, certificate: Certificate, closed: frozenset[str] = frozenset()) -> dict[str, Violation]:
    """Return what must go, by object_id.

    Of two objects in each other the smaller goes, and small things before furniture; of a blocked joint what blocks it, or its owner where a wall does or the owner
    is a small thing that lies on something else; of a room that cannot be entered the floor-standing object nearest to one of its doors,
    unless the plan itself has `closed` it.
    """
    placed = {p.object_id: p for p in home.placements}
    violating: dict[str, Violation] = {}
    small = taxonomy.load().small
    for check in certificate.objects:
        if not check.inside:
            violating[check.object_id] = Violation(check.room_id, "outside_room", f"{check.outside:.3f} m beyond the walls")
        elif not check.supported:
            violating[check.object_id] = Violation(check.room_id, "unsupported", "floats, or sticks through the ceiling")
        for other in check.hits:
            smaller = min(
                (placed[check.object_id], placed[other]), key=lambda p: (p.category not in small, float(p.size.prod()), p.object_id)
            )
            violating[smaller.object_id] = Violation(smaller.room_id, "collision", f"{check.object_id} and {other} are in each other")
    for joint in certificate.joints:
        if joint.clear:
            continue
        owner = placed.get(joint.object_id)
        blamed = owner if owner is not None and owner.support else placed.get(joint.blocker) or owner
        if blamed is not None:
            detail = f"{joint.object_id}/{joint.joint_id} stops at {joint.blocker}"
            violating.setdefault(blamed.object_id, Violation(blamed.room_id, "blocks_joint", detail))
    for room in certificate.rooms:
        nearest = None if room.connected or room.room_id in closed else _nearest_to_door(home, room.room_id)
        if nearest is not None:
            violating.setdefault(nearest.object_id, Violation(room.room_id, "blocks_way", f"no way into {room.room_id}"))
    return violating


def _nearest_to_door(home: Home, room_id: str) -> Placement | None:
    doors = [o.segment.mean(0) for o in home.plan.openings if room_id in o.rooms and o.kind != "window"]
    floor, small = home.plan.elevation(room_id), taxonomy.load().small
    standing = [p for p in home.in_room(room_id) if p.position[2] < floor + 0.1 and p.category not in small]
    if not doors or not standing:
        return None
    # Footprint corners and centre stand in for the outline: the order matters here, not the distance.
    points = {p.object_id: np.vstack([p.footprint(), p.position[None, :2]]) for p in standing}
    apart = {name: min(float(np.linalg.norm(own - door, axis=1).min()) for door in doors) for name, own in points.items()}
    return min(standing, key=lambda p: (apart[p.object_id], p.object_id))
