"""All objects of a room as arrays: their prisms at rest and placed. What the compiled search works on."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.shapes import Shape
from pipeline.arrays import Floats, Ints
from pipeline.geometry.compiled import borrowing, compiled
from pipeline.geometry.contact import apart, depth
from pipeline.geometry.polygons import beyond
from pipeline.geometry.prisms import Prisms, join_prisms

SOFT = 0.1  # a body may reach this far into an access place at no cost [m]
SOFT_WALL = 0.15  # and a wall this far [m]
NEARER = 0.05  # things that are nearer to each other than such things are by no more may stay [m]
FREE, WALL, DOOR = -1, -2, -3  # what blocks an object, beside another's index


class World(NamedTuple):
    """N objects and the doors of their room, of P prisms. `start` (N, 4): bodies from start[i, 0], keeps from start[i, 1], access places from start[i, 2] to start[i, 3].

    `doors` (3,): what doors sweep from doors[0], what they take closed from doors[1] to doors[2]; it stays where it is.
    `corners` (P, V, 2), `corner_count` (P,), `z` (P, 2) and `shell` (N, S, 2), `shell_count` (N,) (the body's hull in plan) are in the object's frame;
    `at`, `at_z`, `flat` (P, 4), `box` and, without keeps and access places, `body` (N, 4) are where it was placed last [m].
    `distances` (N, N) is how far each keeps from each [m], 0 where it does not matter.
    The room: `polygon` (n, 2), `ceiling` (1,) [m].
    `outline` (S, 2) and `wall` (4, 2) are scratch.
    """

    start: Ints
    doors: Ints
    corners: Floats
    corner_count: Ints
    z: Floats
    shell: Floats
    shell_count: Ints
    at: Floats
    at_z: Floats
    flat: Floats
    box: Floats
    body: Floats
    distances: Floats
    polygon: Floats
    ceiling: Floats
    outline: Floats
    wall: Floats


def make_world(shapes: Sequence[Shape], swung: Prisms, shut: Prisms, polygon: Floats, ceiling: float, distances: Floats) -> World:
    """Gather the shapes of a room's objects, nothing placed yet; `distances` (N, N) [m] are those that they keep."""
    groups = [part for s in shapes for part in (s.body, s.keep, s.access)]
    sizes = np.array([len(g) for g in groups], np.int64).reshape(-1, 3)
    ends = np.cumsum(sizes.ravel()).reshape(-1, 3)
    start = np.column_stack([ends[:, 0] - sizes[:, 0], ends]) if len(shapes) else np.zeros((0, 4), np.int64)
    every, last = join_prisms([*groups, swung, shut]), int(sizes.sum())
    most = max((len(s.outline) for s in shapes), default=1)
    shell = np.zeros((len(shapes), most, 2))
    for i, s in enumerate(shapes):
        shell[i, : len(s.outline)] = s.outline
    corners, z = np.ascontiguousarray(every.corners), np.ascontiguousarray(every.z)
    return World(
        start,
        np.array([last, last + len(swung), len(every)], np.int64),
        corners,
        every.count,
        z,
        shell,
        np.array([len(s.outline) for s in shapes], np.int64),
        corners.copy(),
        z.copy(),
        every.boxes(),
        np.zeros((len(shapes), 4)),
        np.tile([np.inf, np.inf, -np.inf, -np.inf], (len(shapes), 1)),
        distances,
        polygon,
        np.array([ceiling]),
        np.zeros((most, 2)),
        np.zeros((4, 2)),
    )


@borrowing
def put(world: World, i: int, pose: Floats) -> None:
    """Place object `i` at (x, y, z, yaw)."""
    c, s = math.cos(pose[3]), math.sin(pose[3])
    left, low, right, high = np.inf, np.inf, -np.inf, -np.inf
    for k in range(world.start[i, 0], world.start[i, 3]):
        x0, y0, x1, y1 = np.inf, np.inf, -np.inf, -np.inf
        for v in range(world.corner_count[k]):
            x = c * world.corners[k, v, 0] - s * world.corners[k, v, 1] + pose[0]
            y = s * world.corners[k, v, 0] + c * world.corners[k, v, 1] + pose[1]
            world.at[k, v, 0], world.at[k, v, 1] = x, y
            x0, y0, x1, y1 = min(x0, x), min(y0, y), max(x1, x), max(y1, y)
        world.flat[k, 0], world.flat[k, 1], world.flat[k, 2], world.flat[k, 3] = x0, y0, x1, y1
        world.at_z[k, 0], world.at_z[k, 1] = world.z[k, 0] + pose[2], world.z[k, 1] + pose[2]
        left, low, right, high = min(left, x0), min(low, y0), max(right, x1), max(high, y1)
        if k + 1 == world.start[i, 1]:
            world.body[i, 0], world.body[i, 1], world.body[i, 2], world.body[i, 3] = left, low, right, high
    world.box[i, 0], world.box[i, 1], world.box[i, 2], world.box[i, 3] = left, low, right, high


@borrowing
def leaves_room(world: World, i: int, pose: Floats, tolerance: float) -> bool:
    """Tell whether the outline of object `i` would be beyond the walls at a pose."""
    c, s = math.cos(pose[3]), math.sin(pose[3])
    n = world.shell_count[i]
    for v in range(n):
        world.outline[v, 0] = c * world.shell[i, v, 0] - s * world.shell[i, v, 1] + pose[0]
        world.outline[v, 1] = s * world.shell[i, v, 0] + c * world.shell[i, v, 1] + pose[1]
    return bool(beyond(world.outline[:n], world.polygon, world.wall) > tolerance)


@borrowing
def meet(world: World, a0: int, a1: int, b0: int, b1: int, tolerance: float) -> bool:
    """Tell whether any of the placed prisms a0 .. a1 - 1 is in one of b0 .. b1 - 1 by more than `tolerance` [m]."""
    flat, at_z = world.flat, world.at_z
    for i in range(a0, a1):
        for j in range(b0, b1):
            if apart(flat[i], flat[j], tolerance) or apart(at_z[i], at_z[j], tolerance):
                continue
            if depth(world.at[i, : world.corner_count[i]], at_z[i], world.at[j, : world.corner_count[j]], at_z[j]) > tolerance:
                return True
    return False


@borrowing
def collide(world: World, i: int, j: int, tolerance: float) -> bool:
    """Tell whether two placed objects break a hard rule: a body in the other's body or where its parts move."""
    a, b, box, flat = world.start[i], world.start[j], world.box, world.flat
    if apart(box[i], box[j], tolerance):
        return False
    for k in range(a[0], a[2]):  # bodies and keeps lie one behind the other
        if not apart(flat[k], box[j], tolerance) and meet(world, k, k + 1, b[0], b[2] if k < a[1] else b[1], tolerance):
            return True
    return False


@borrowing
def blocker(world: World, i: int, others: NDArray[np.bool_], tolerance: float) -> int:
    """Return what is in the way of placed object `i`, whose outline is within the walls: WALL, DOOR, the first of `others`, or FREE."""
    a = world.start[i]
    for k in range(a[0], a[1]):
        if world.at_z[k, 1] > world.ceiling[0] + tolerance:
            return WALL
    for k in range(a[1], a[2]):
        if beyond(world.at[k, : world.corner_count[k]], world.polygon, world.wall) > tolerance:
            return WALL
    doors = world.doors
    if meet(world, a[0], a[1], doors[0], doors[2], tolerance) or meet(world, a[1], a[2], doors[1], doors[2], tolerance):
        return DOOR
    for j in range(others.shape[0]):
        if others[j] and j != i and collide(world, i, j, tolerance):
            return j
    return FREE


@borrowing
def hindrance(world: World, i: int, others: NDArray[np.bool_]) -> int:
    """Return how many soft rules placed object `i` breaks: own access places taken or in a wall, another's taken."""
    a = world.start[i]
    broken = 0
    for k in range(a[2], a[3]):
        taken = beyond(world.at[k, : world.corner_count[k]], world.polygon, world.wall) > SOFT_WALL
        for j in range(others.shape[0]):
            if taken:
                break
            taken = others[j] and j != i and meet(world, k, k + 1, world.start[j, 0], world.start[j, 1], SOFT)
        broken += taken
    for j in range(others.shape[0]):
        if others[j] and j != i and meet(world, a[0], a[1], world.start[j, 2], world.start[j, 3], SOFT):
            broken += 1
            break
    return broken


@borrowing
def shortfall(world: World, i: int, j: int) -> float:
    """Return by how much two placed objects are nearer to each other than such things are [m]."""
    wanted = world.distances[i, j]
    if wanted == 0.0:
        return 0.0
    x = max(0.0, world.body[i, 0] - world.body[j, 2], world.body[j, 0] - world.body[i, 2])
    y = max(0.0, world.body[i, 1] - world.body[j, 3], world.body[j, 1] - world.body[i, 3])
    return float(max(0.0, wanted - math.sqrt(x * x + y * y)))


@compiled
def conflicts(world: World, poses: Floats, tolerance: float) -> tuple[NDArray[np.bool_], NDArray[np.bool_], Ints]:
    """Place all N objects; return which pairs (N, N) break a hard rule, which are too near to each other, and of each (N,) whether WALL or DOOR is in its way, else FREE."""
    n = poses.shape[0]
    pairs, near, nobody = np.zeros((n, n), np.bool_), np.zeros((n, n), np.bool_), np.zeros(n, np.bool_)
    alone = np.full(n, FREE)
    for i in range(n):
        put(world, i, poses[i])
        alone[i] = WALL if leaves_room(world, i, poses[i], tolerance) else blocker(world, i, nobody, tolerance)
    for i in range(n):
        for j in range(i):
            pairs[i, j] = pairs[j, i] = collide(world, i, j, tolerance)
            near[i, j] = near[j, i] = shortfall(world, i, j) > NEARER
    return pairs, near, alone


@borrowing
def compose_pose(pose: Floats, offset: Floats, out: Floats) -> None:
    """Write the pose of a member at `offset` (x, y, z, yaw) in the frame of one at `pose`, rounded as poses are."""
    c, s = math.cos(pose[3]), math.sin(pose[3])
    out[0] = round((pose[0] + c * offset[0] - s * offset[1]) * 1e4) / 1e4
    out[1] = round((pose[1] + s * offset[0] + c * offset[1]) * 1e4) / 1e4
    out[2] = round((pose[2] + offset[2]) * 1e4) / 1e4
    out[3] = (pose[3] + offset[3] + math.pi) % (2 * math.pi) - math.pi


@compiled
def free_poses(
    world: World, members: Ints, offsets: Floats, poses: Floats, costs: Floats, first: int, wanted: int, others: NDArray[np.bool_],
    tolerance: float, soft: tuple[float, float],
) -> tuple[Floats, int]:  # fmt: skip
    """Return the cost (C,) of poses of a group from `first` on, inf where not free, until `wanted` are found; and where it stopped.

    `members` (K,) move as one, at `offsets` (K, 4) from the group's pose; `others` (N,) are the objects that stand. Poses are
    given in ascending order of `costs`, to which the soft rules add: `soft` are the cost of each access place taken and of a metre too near [m].
    """
    found, own = np.full(poses.shape[0], np.inf), np.empty((members.shape[0], 4))
    have = 0
    last = FREE  # what was in the way of the pose before is likely to be in the way of this one
    for k in range(first, poses.shape[0]):
        if have >= wanted:
            return found, k
        free = True
        for m in range(members.shape[0]):
            compose_pose(poses[k], offsets[m], own[m])
            if leaves_room(world, members[m], own[m], tolerance):
                free = False
                break
        if not free:
            continue
        for m in range(members.shape[0]):
            put(world, members[m], own[m])
            if last < 0 or not collide(world, members[m], last, tolerance):
                last = blocker(world, members[m], others, tolerance)
            if last != FREE:
                free = False
                break
        if not free:
            continue
        broken, missing = 0, 0.0
        for m in range(members.shape[0]):
            broken += hindrance(world, members[m], others)
            for j in range(others.shape[0]):
                if others[j] and j != members[m]:
                    missing = max(missing, shortfall(world, members[m], j))
        found[k] = costs[k] + soft[0] * broken + soft[1] * missing
        have += 1
    return found, len(poses)
