"""Joints: how far each one opens before it touches something, and where a robot can stand to open it."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pipeline.arrays import Floats
from pipeline.entities.asset import Asset
from pipeline.entities.home import Home
from pipeline.geometry.contact import first_hits, group_boxes, wall_excesses
from pipeline.geometry.door_sweeps import leaf_handles, leaf_sweep, shut_leaf
from pipeline.geometry.free_space import FreeSpace
from pipeline.geometry.kinematics import grips, joint_range, moved_links, rotation
from pipeline.geometry.polygons import contains
from pipeline.geometry.prisms import Prisms, Sweep, join_prisms
from pipeline.geometry.robot import Robot
from pipeline.geometry.stance import stand_pose
from pipeline.geometry.walls import Leaf, leaves
from pipeline.verify.bodies import Bodies
from pipeline.verify.certificate import JointCheck
from pipeline.verify.settings import VerifySettings
from pipeline.verify.supports import Support, covered, moved_by

Walks = Mapping[int, tuple[FreeSpace, int]]

WALL, DOOR = "wall", "door"  # blocker's name where a part meets a wall, or a closed door's lever


def check_joints(
    home: Home, assets: Mapping[str, Asset], bodies: Bodies, supports: Mapping[int, Support], walks: Walks, settings: VerifySettings
) -> list[JointCheck]:
    """Check every joint of every placed object, in order. What lies in a drawer comes out with it."""
    checks = []
    levels = {o.opening_id: o.level for o in home.plan.openings}
    shut = _groups([shut_leaf(leaf, levels[leaf.opening_id] * home.plan.storey_height) for leaf in leaves(home.plan)])
    for g, placement in enumerate(home.placements):
        asset = assets[placement.asset_id]
        if not asset.joints:
            continue
        turn = rotation(np.array([0.0, 0.0, 1.0]), placement.yaw)
        room = np.ascontiguousarray(home.plan.room(placement.room_id).polygon, np.float64)
        space, label = walks[home.plan.room(placement.room_id).level]
        floor = home.plan.elevation(placement.room_id)
        moved = [sweep.prisms.placed(placement.position, placement.yaw, placement.scale) for sweep in bodies.solids[g].sweeps]
        own = []
        for index, joint in enumerate(asset.joints):
            hits = _sweep_hits(bodies, g, index, asset, moved[index], turn, supports, settings)
            hits[(hits < 0) & (wall_excesses(moved[index].corners, moved[index].count, room) > settings.wall)] = -2
            hits[(hits == -1) & (_hits(moved[index], -1, shut, settings.touch) >= 0)] = -3
            clear_upper, clear, blocker = _progress(bodies.solids[g].sweeps[index], moved[index], hits, home)
            handle, way = grips(asset)[index]
            grip = placement.position + turn @ (handle * placement.scale)
            heading = turn[:2, :2] @ way
            lower, upper = joint_range(joint)
            # Where the robot stands, it stands clear of the doors that it has opened before.
            opened = join_prisms([moved[index], *(m for m, j in zip(moved, asset.joints, strict=True) if j.name in joint.after)])
            own.append(
                JointCheck(
                    placement.object_id,
                    joint.name,
                    joint.type,
                    joint.part_class,
                    turn @ joint.axis,
                    placement.position + turn @ (joint.origin * placement.scale),
                    lower,
                    upper,
                    clear_upper,
                    clear,
                    blocker,
                    _stand(grip[:2], heading, opened, floor, space, label, settings.robot),
                    joint.after,
                )
            )
        checks += _in_turn(own)
    return checks


def _in_turn(checks: list[JointCheck]) -> list[JointCheck]:
    """Return the checks of one object, in which no joint moves that waits for one that is not clear."""
    stuck = {c.joint_id: c.blocker for c in checks if not c.clear}
    blockers = {c.joint_id: next((stuck[name] for name in c.after if name in stuck), "") for c in checks}
    return [replace(c, clear=False, clear_upper=0.0, blocker=blockers[c.joint_id]) if blockers[c.joint_id] else c for c in checks]


def _sweep_hits(
    bodies: Bodies,
    owner: int,
    index: int,
    asset: Asset,
    moved: Prisms,
    turn: Floats,
    supports: Mapping[int, Support],
    settings: VerifySettings,
) -> NDArray[np.int64]:
    """Return per prism of a joint's sweep the object that it meets, -1 for none; what rides along must come through as well."""
    along = moved_by(asset, index, owner, supports)
    if not along:
        return _hits(moved, owner, bodies, settings.touch)
    boxes = bodies.boxes.copy()
    boxes[along] = (*[np.inf] * 3, *[-np.inf] * 3)
    free = replace(bodies, boxes=boxes)
    hits = _hits(moved, owner, free, settings.touch)
    still = np.flatnonzero(~np.isin(bodies.prisms.part, moved_links(asset, index)))
    still = still[(still >= bodies.start[owner]) & (still < bodies.start[owner + 1])]
    p = bodies.prisms
    frame = _groups([Prisms(p.corners[still], p.count[still], p.z[still], p.part[still])])
    reached = bodies.solids[owner].sweeps[index].reached
    # The stretches from rest upwards, then those from rest downwards, as the sweep numbers them.
    upward = np.concatenate([[0.0], reached[reached > 0]])
    downward = np.concatenate([[0.0], reached[reached < 0]])
    for ends, first in ((upward, 0), (downward, len(upward) - 1)):
        for stretch in (ends[[0, -1]], ends):  # the whole way at once; step by step only if something is in it
            things = covered(bodies, along, asset.joints[index], turn, stretch.tolist())
            met = _hits(things, owner, free, settings.touch)
            met[(met < 0) & (_hits(things, -1, frame, settings.touch) >= 0)] = along[0]
            if (met < 0).all():
                break
        for k in np.flatnonzero(met >= 0):
            hits[(hits < 0) & (moved.part == first + things.part[k])] = met[k]
    return hits


def _groups(prisms: list[Prisms]) -> Bodies:
    """Return groups of prisms that are no objects."""
    p = join_prisms(prisms)
    start = np.concatenate([[0], np.cumsum([len(group) for group in prisms], dtype=np.int64)])
    return Bodies(p, start, p.boxes(), group_boxes(p, start), ())


def check_leaves(home: Home, bodies: Bodies, walks: Walks, settings: VerifySettings) -> list[JointCheck]:
    """Check every room door, in the order of the openings."""
    levels = {o.opening_id: o.level for o in home.plan.openings}
    swings = {o.opening_id: o.swing.room_id for o in home.plan.openings if o.swing is not None}
    checks = []
    for leaf in leaves(home.plan):
        level = levels[leaf.opening_id]
        elevation = level * home.plan.storey_height
        sweep = leaf_sweep(leaf, elevation)
        hits = _hits(sweep.prisms, -1, bodies, settings.touch)
        room = next((r.polygon for r in home.plan.rooms if r.room_id == swings[leaf.opening_id]), None)
        if room is not None:
            hits[_through_wall(leaf, sweep, np.ascontiguousarray(room, np.float64), hits)] = -2
        clear_upper, clear, blocker = _progress(sweep, sweep.prisms, hits, home)
        space, label = walks[level]
        stand = None
        for handle, heading in zip(leaf_handles(leaf), (leaf.normal, -leaf.normal), strict=True):
            stand = stand or _stand(handle, heading, sweep.prisms, elevation, space, label, settings.robot)
        checks.append(
            JointCheck(
                leaf.opening_id,
                "hinge",
                "revolute",
                "door_leaf",
                np.array([0.0, 0.0, float(leaf.turn)]),
                np.array([*leaf.hinge, elevation]),
                0.0,
                leaf.angle,
                clear_upper,
                clear,
                blocker,
                stand,
            )
        )
    return checks


def _hits(moved: Prisms, owner: int, bodies: Bodies, touch: float) -> NDArray[np.int64]:
    p = bodies.prisms
    owners = np.full(len(moved), owner)
    return first_hits(
        moved.corners, moved.count, moved.z, moved.boxes(), owners, p.corners, p.count, p.z, bodies.flat, bodies.start, bodies.boxes, touch
    )


def _progress(sweep: Sweep, moved: Prisms, hits: NDArray[np.int64], home: Home) -> tuple[float, bool, str]:
    """Return the largest free position, whether the whole range is free, and what is touched first.

    `hits` (P,) is per prism the object touched, -1 none, -2 a wall, -3 a closed door.
    """
    struck = np.flatnonzero(hits != -1)
    upward = sweep.reached > 0
    end = float(sweep.reached[upward].max()) if upward.any() else 0.0
    if not len(struck):
        return end, True, ""
    order = struck[np.argsort(moved.part[struck], kind="stable")]
    first = int(order[0])
    blocker = {-2: WALL, -3: DOOR}.get(int(hits[first])) or home.placements[int(hits[first])].object_id
    step = int(moved.part[order[upward[moved.part[order]]]].min()) if upward[moved.part[order]].any() else int(upward.sum())
    reached = 0.0 if step == 0 else float(sweep.reached[min(step, int(upward.sum())) - 1])
    return reached, False, blocker


def _through_wall(leaf: Leaf, sweep: Sweep, room: Floats, hits: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return which prisms of a leaf lie past the angle at which its free end, once in the room, leaves it again."""
    angles = np.concatenate([[0.0], sweep.reached])
    ends = np.stack([leaf.outline(float(a))[1] for a in angles])
    inside = np.array([contains(float(x), float(y), room) for x, y in ends])
    if not inside.any():
        return np.zeros(len(hits), np.bool_)
    entered = int(np.argmax(inside))
    left = np.flatnonzero(~inside[entered:])
    if not len(left):
        return np.zeros(len(hits), np.bool_)
    beyond: NDArray[np.bool_] = (hits == -1) & (sweep.prisms.part >= entered + int(left[0]) - 1)
    return beyond


def _stand(
    grip: Floats, heading: Floats, swept: Prisms, floor: float, space: FreeSpace, label: int, robot: Robot
) -> tuple[float, float, float] | None:
    """Return (x, y, yaw) at which the robot, coming from the entrance, opens a part. At yaw 0 it looks along +x."""
    position = stand_pose(grip, heading, swept, floor, space, label, robot)
    if position is None:
        return None
    x, y = position
    yaw = math.atan2(float(grip[1]) - y, float(grip[0]) - x)
    return round(x, 4) + 0.0, round(y, 4) + 0.0, round(yaw, 5) + 0.0
