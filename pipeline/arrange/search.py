"""The inner search: which of many poses of one object are free among what is already placed. Compiled.

Poses are rows (x, y, z, yaw). An object brings its `body`, `keep` and `access` prisms in its own frame; the room holds
the bodies and keeps of what is placed, in the world. Hard rules: a body may be in no body, no keep and no wall; a keep
may be in no body and no wall. Soft: an access place and a body may meet, at a cost.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from pipeline.geometry.compiled import compiled
from pipeline.geometry.contact import depth
from pipeline.geometry.polygons import excess

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Own = tuple[Floats, Ints, Floats]  # corners, counts, z of prisms in the object's frame
Others = tuple[Floats, Ints, Floats, Floats]  # the same in the world, and their plan boxes
Placed = tuple[Others, Others, Others]  # body, keep, access
Room = tuple[Others, Others, Others, Floats]  # bodies, keeps, accesses; the room's polygon

SOFT = 0.1  # a body may reach this far into an access place at no cost [m]
SOFT_WALL = 0.15  # and a wall this far [m]


@compiled
def place(corners: Floats, count: Ints, z: Floats, pose: Floats, out: Floats, out_z: Floats, flat: Floats) -> None:
    """Write prisms (object frame) at a pose into `out`, `out_z` and their plan boxes `flat`."""
    c, s = math.cos(pose[3]), math.sin(pose[3])
    for k in range(count.shape[0]):
        x0, y0, x1, y1 = np.inf, np.inf, -np.inf, -np.inf
        for i in range(count[k]):
            x = c * corners[k, i, 0] - s * corners[k, i, 1] + pose[0]
            y = s * corners[k, i, 0] + c * corners[k, i, 1] + pose[1]
            out[k, i, 0], out[k, i, 1] = x, y
            x0, y0, x1, y1 = min(x0, x), min(y0, y), max(x1, x), max(y1, y)
        flat[k, 0], flat[k, 1], flat[k, 2], flat[k, 3] = x0, y0, x1, y1
        out_z[k, 0], out_z[k, 1] = z[k, 0] + pose[2], z[k, 1] + pose[2]


@compiled
def touches(
    a: Floats, a_count: Ints, a_z: Floats, a_flat: Floats, b: Floats, b_count: Ints, b_z: Floats, b_flat: Floats, tolerance: float
) -> bool:
    """Tell whether any prism of one set is in any of another by more than `tolerance` [m]."""
    n, m = a_count.shape[0], b_count.shape[0]
    if n == 0 or m == 0:
        return False
    x0, y0, x1, y1 = np.inf, np.inf, -np.inf, -np.inf
    for i in range(n):
        x0, y0 = min(x0, a_flat[i, 0]), min(y0, a_flat[i, 1])
        x1, y1 = max(x1, a_flat[i, 2]), max(y1, a_flat[i, 3])
    for j in range(m):
        if min(x1, b_flat[j, 2]) - max(x0, b_flat[j, 0]) <= tolerance or min(y1, b_flat[j, 3]) - max(y0, b_flat[j, 1]) <= tolerance:
            continue
        for i in range(n):
            if min(a_flat[i, 2], b_flat[j, 2]) - max(a_flat[i, 0], b_flat[j, 0]) <= tolerance:
                continue
            if min(a_flat[i, 3], b_flat[j, 3]) - max(a_flat[i, 1], b_flat[j, 1]) <= tolerance:
                continue
            if min(a_z[i, 1], b_z[j, 1]) - max(a_z[i, 0], b_z[j, 0]) <= tolerance:
                continue
            if depth(a[i, : a_count[i]], a_z[i], b[j, : b_count[j]], b_z[j]) > tolerance:
                return True
    return False


@compiled
def blocked(own: Placed, room: Room, ceiling: float, tolerance: float) -> bool:
    """Tell whether an object, its prisms placed, breaks a hard rule; its outline is known to be within the walls."""
    (body, body_count, body_z, body_flat), (keep, keep_count, keep_z, keep_flat), _ = own
    bodies, keeps, _, polygon = room
    if body_count.shape[0] and body_z[:, 1].max() > ceiling + tolerance:
        return True
    if touches(body, body_count, body_z, body_flat, bodies[0], bodies[1], bodies[2], bodies[3], tolerance):
        return True
    if touches(body, body_count, body_z, body_flat, keeps[0], keeps[1], keeps[2], keeps[3], tolerance):
        return True
    for i in range(keep_count.shape[0]):
        if excess(keep[i, : keep_count[i]], polygon) > tolerance:
            return True
    return touches(keep, keep_count, keep_z, keep_flat, bodies[0], bodies[1], bodies[2], bodies[3], tolerance)


@compiled
def hindrance(own: Placed, room: Room) -> int:
    """Return how many soft rules are broken: own access places taken or in a wall, another's taken."""
    (body, body_count, body_z, body_flat), _, (access, access_count, access_z, access_flat) = own
    bodies, _, accesses, polygon = room
    broken = 0
    for i in range(access_count.shape[0]):
        j = i + 1
        if (
            touches(access[i:j], access_count[i:j], access_z[i:j], access_flat[i:j], bodies[0], bodies[1], bodies[2], bodies[3], SOFT)
            or excess(access[i, : access_count[i]], polygon) > SOFT_WALL
        ):
            broken += 1
    if touches(body, body_count, body_z, body_flat, accesses[0], accesses[1], accesses[2], accesses[3], SOFT):
        broken += 1
    return broken


@compiled
def free_poses(
    poses: Floats,
    costs: Floats,
    first: int,
    wanted: int,
    outline: Floats,
    own: tuple[Own, Own, Own],
    room: Room,
    ceiling: float,
    tolerance: float,
    access_cost: float,
) -> tuple[Floats, int]:
    """Return the cost of poses from `first` on, inf where not free, until `wanted` are found; and where it stopped.

    `own` are the object's body, keep and access; `room` the bodies, keeps and access places that stand, and the room's
    polygon. Poses are given in ascending order of `costs`, to which the soft rules add.
    """
    found = np.full(poses.shape[0], np.inf)
    body, keep, access = own
    body_at = (np.empty_like(body[0]), body[1], np.empty_like(body[2]), np.empty((body[1].shape[0], 4)))
    keep_at = (np.empty_like(keep[0]), keep[1], np.empty_like(keep[2]), np.empty((keep[1].shape[0], 4)))
    access_at = (np.empty_like(access[0]), access[1], np.empty_like(access[2]), np.empty((access[1].shape[0], 4)))
    shell = np.empty_like(outline)
    have = 0
    for k in range(first, poses.shape[0]):
        if have >= wanted:
            return found, k
        pose = poses[k]
        c, s = math.cos(pose[3]), math.sin(pose[3])
        for i in range(outline.shape[0]):
            shell[i, 0] = c * outline[i, 0] - s * outline[i, 1] + pose[0]
            shell[i, 1] = s * outline[i, 0] + c * outline[i, 1] + pose[1]
        if excess(shell, room[3]) > tolerance:
            continue
        place(body[0], body[1], body[2], pose, body_at[0], body_at[2], body_at[3])
        place(keep[0], keep[1], keep[2], pose, keep_at[0], keep_at[2], keep_at[3])
        place(access[0], access[1], access[2], pose, access_at[0], access_at[2], access_at[3])
        placed = (body_at, keep_at, access_at)
        if blocked(placed, room, ceiling, tolerance):
            continue
        found[k] = costs[k] + access_cost * hindrance(placed, room)
        have += 1
    return found, poses.shape[0]
