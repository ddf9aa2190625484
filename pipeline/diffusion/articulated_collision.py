"""phi_articoll: how deep bodies, and what the joints of articulated objects sweep, reach into each other; its gradient, and the descents down it.

Paper eq. articoll sums IoU(b'_i, b_j) over ordered pairs, b' the extended state. Here b' is the body and, per joint, the box that it really
sweeps; in place of the IoU stands half the square of the depth, whose descent is the depth itself, DEEP at most, along the shortest way
out. Doorways are obstacles too, and so is what lies outside the room.

Compiled, with the gradient written out: of a room's few pairs a tensor library spends all its time on calls.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pipeline.arrays import Bools, Floats, Ints
from pipeline.diffusion.batch import RoomBatch
from pipeline.diffusion.context import KINDS
from pipeline.geometry.compiled import compiled

CLEARANCE = 0.45  # [m] kept free at a doorway whose leaf does not turn into the room
LEAF_HEIGHT = 2.0  # [m] a door leaf and a person need that much
DEEP = 0.04  # [m] from which depth on a push grows no further: squares would share an overlap out along a row that is too full
RAMP = 0.05  # [m] that two things must share in height to count wholly
LEAST = 0.02  # [m] that a side of a box has
BODY, SWEEP = 0.5, 0.25  # weight of what lies outside the room: a side of a box has two corners or more beyond a wall
# Corners and side middles of a box, in halves of its sides.
EIGHT = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (0, 1), (-1, 0), (1, 0)], float)
SHORT = 1e-3  # length of (cos, sin) of a yaw that is not known at all
TIE = 1e-6  # [m]
CX, CY, HALF_W, HALF_D, COS, SIN, LOW, HIGH = range(8)  # columns of a prism: an upright rotated box
TURN, COST, DEPTH = 4, 5, 6  # columns of a push, behind the slopes by centre and halves: slope by the angle, phi, the deepest overlap [m]


@dataclass(frozen=True, slots=True)
class Obstacles:
    """What stands still in B rooms: `doorways` (B, D, 8) as prisms and which of them `exist` (B, D); `walls` (B, M, 2, 2) [m], ends of those that `bound` (B, M) it."""

    doorways: Floats
    exist: Bools
    walls: Floats
    bound: Bools

    @classmethod
    def of(cls, rooms: RoomBatch) -> Obstacles:
        """Return walls, and what must stay free before doors: the square around the leaf's quarter disc, or a strip."""
        ends, normal, hinge = (v.double().cpu().numpy() for v in (rooms.ends, rooms.normal, rooms.hinge))
        width = np.hypot(*np.moveaxis(ends[:, :, 1] - ends[:, :, 0], -1, 0))
        depth = np.where(hinge >= 0, width, CLEARANCE)
        centre = ends.mean(2) + normal * depth[..., None] / 2
        floor, leaf = np.zeros_like(width), np.full_like(width, LEAF_HEIGHT)
        doorways = np.stack([*np.moveaxis(centre, -1, 0), width / 2, depth / 2, normal[..., 1], -normal[..., 0], floor, leaf], -1)
        kinds = [KINDS.index(name) for name in ("door", "open", "portal", "entrance")]
        mask = rooms.mask.cpu().numpy()
        return cls(doorways, np.isin(rooms.kind.cpu().numpy(), kinds) & mask, ends, rooms.walls.cpu().numpy())

    def rows(self, index: Ints) -> Obstacles:
        """Take some rooms."""
        return Obstacles(self.doorways[index], self.exist[index], self.walls[index], self.bound[index])


@dataclass(frozen=True, slots=True)
class Furniture:
    """What fills the N slots of B rooms.

    Which are `occupied` (B, N); what joints sweep, `sweeps` (B, N, K, 2, 3) [m, object frame], NaN where nothing; pairs whose bodies may share a place,
    `tucked` (B, N, N), as chairs do under tables.
    """

    occupied: Bools
    sweeps: Floats
    tucked: Bools

    @classmethod
    def of(cls, occupied: Bools, sweeps: Floats | None = None, tucked: Bools | None = None) -> Furniture:
        """Return furniture that opens nothing, and of which nothing is tucked, where that is not said."""
        batch, slots = occupied.shape
        nothing = np.zeros((batch, slots, 0, 2, 3))
        return cls(occupied, nothing if sweeps is None else sweeps, np.zeros((batch, slots, slots), np.bool_) if tucked is None else tucked)


def articulated_collision(boxes: Floats, furniture: Furniture, obstacles: Obstacles) -> tuple[Floats, Floats, Floats]:
    """Return phi_articoll (B,) [m2], its gradient (B, N, 8), and the deepest overlap (B,) [m] of each room.

    `boxes` (B, N, 8) [m, room frame]: position, size, cos and sin of yaw. Heights have no gradient.
    """
    f, o = furniture, obstacles
    return _collide(np.ascontiguousarray(boxes, np.float64), f.occupied, f.sweeps, f.tucked, o.doorways, o.exist, o.walls, o.bound)


def descend(boxes: Floats, furniture: Furniture, obstacles: Obstacles, steps: int, scale: float, turn: float, clip: float) -> Floats:
    """Return the boxes (B, N, 8) after so many steps down phi_articoll: a step is `scale` times the gradient and `clip` [m] at most, yaws turn by `turn` of it."""
    moved = np.array(boxes, np.float64, order="C")
    for _ in range(steps):
        gradient = articulated_collision(moved, furniture, obstacles)[1]
        push = -scale * gradient[..., :2]
        length = np.hypot(push[..., 0], push[..., 1])
        moved[..., :2] += push * np.minimum(clip / np.maximum(length, 1e-9), 1.0)[..., None]
        moved[..., 6:] += np.clip(-turn * scale * gradient[..., 6:], -clip, clip)
    return moved


@compiled
def _collide(
    boxes: Floats, occupied: Bools, sweeps: Floats, tucked: Bools, doorways: Floats, exist: Bools, walls: Floats, bound: Bools
) -> tuple[Floats, Floats, Floats]:
    """Return phi (B,), its gradient (B, N, 8) and the deepest overlaps (B,), room after room, so that none knows of the others."""
    phi, gradient, deepest = np.zeros(boxes.shape[0]), np.zeros(boxes.shape), np.zeros(boxes.shape[0])
    most = sweeps.shape[1] * (1 + sweeps.shape[2]) + doorways.shape[1]
    prisms, owner = np.zeros((most, 8)), np.zeros(most, np.int64)
    for room in range(boxes.shape[0]):
        bodies, doors, last = _list_prisms(boxes[room], occupied[room], sweeps[room], doorways[room], exist[room], prisms, owner)
        push = np.zeros((last, 7))
        for i in range(bodies):
            for j in range(i + 1, doors):
                if j >= bodies or not tucked[room, owner[i], owner[j]]:
                    _press(i, j, prisms, push)
        for i in range(doors, last):
            for j in range(doors):
                if owner[j] != owner[i]:
                    _press(i, j, prisms, push)
        for i in range(last):
            if i < bodies or i >= doors:
                _leave(prisms[i], BODY if i < bodies else SWEEP, walls[room], bound[room], push[i])
                phi[room] += push[i, COST]
                deepest[room] = max(deepest[room], push[i, DEPTH])
        _hand_back(bodies, doors, boxes[room], prisms, push, owner, gradient[room])
    return phi, gradient, deepest


@compiled
def _list_prisms(
    boxes: Floats, occupied: Bools, sweeps: Floats, doorways: Floats, exist: Bools, prisms: Floats, owner: Ints
) -> tuple[int, int, int]:
    """Fill a room's list of prisms with bodies, doorways and sweeps, and the slots that own them; return where each kind ends."""
    n = 0
    for slot in range(boxes.shape[0]):
        if occupied[slot]:
            box = boxes[slot]
            length = max(np.hypot(box[6], box[7]), SHORT)
            prisms[n, CX], prisms[n, CY] = box[0], box[1]
            prisms[n, HALF_W], prisms[n, HALF_D] = max(box[3], LEAST) / 2, max(box[4], LEAST) / 2
            prisms[n, COS], prisms[n, SIN] = box[6] / length, box[7] / length
            prisms[n, LOW], prisms[n, HIGH] = box[2], box[2] + max(box[5], LEAST)
            owner[n] = slot
            n += 1
    bodies = n
    for door in range(doorways.shape[0]):
        if exist[door]:
            prisms[n], owner[n] = doorways[door], -1
            n += 1
    doors = n
    for body in range(bodies):
        for k in range(sweeps.shape[1]):
            low, high = sweeps[owner[body], k, 0], sweeps[owner[body], k, 1]
            if np.isfinite(low).all() and np.isfinite(high).all():
                across, along = (low[0] + high[0]) / 2, (low[1] + high[1]) / 2
                c, s = prisms[body, COS], prisms[body, SIN]
                prisms[n, CX], prisms[n, CY] = prisms[body, CX] + c * across - s * along, prisms[body, CY] + s * across + c * along
                prisms[n, HALF_W], prisms[n, HALF_D] = (high[0] - low[0]) / 2, (high[1] - low[1]) / 2
                prisms[n, COS], prisms[n, SIN] = c, s
                prisms[n, LOW], prisms[n, HIGH] = prisms[body, LOW] + low[2], prisms[body, LOW] + high[2]
                owner[n] = owner[body]
                n += 1
    return bodies, doors, n


@compiled
def _press(i: int, j: int, prisms: Floats, push: Floats) -> None:
    """Add what it costs that prisms i and j overlap.

    The depth is the least push along one of the four side directions that parts the footprints (separating axes), counted where the heights overlap. A
    depth, unlike IoU, does not fade when one box swallows the other; both have the same zeros. Directions that are equally near share the push.
    """
    a, b = prisms[i], prisms[j]
    rise = min(1.0, (min(a[HIGH], b[HIGH]) - max(a[LOW], b[LOW])) / RAMP)
    x, y = b[CX] - a[CX], b[CY] - a[CY]
    if rise <= 0.0 or x * x + y * y >= (np.hypot(a[HALF_W], a[HALF_D]) + np.hypot(b[HALF_W], b[HALF_D])) ** 2:
        return
    cos, sin = a[COS] * b[COS] + a[SIN] * b[SIN], a[SIN] * b[COS] - a[COS] * b[SIN]  # of a's yaw less b's
    same, cross = abs(cos), abs(sin)
    turn_same, turn_cross = -np.sign(cos) * sin, np.sign(sin) * cos  # their slopes by that angle
    along = np.empty(
        (4, 6)
    )  # by a's sides and b's: direction, distance of the centres, depth, and how much of it comes from the other's width and depth
    for k in range(4):
        own, other = (a, b) if k < 2 else (b, a)
        wide, deep = (same, cross) if k % 2 == 0 else (cross, same)
        along[k, 0], along[k, 1] = (own[COS], own[SIN]) if k % 2 == 0 else (-own[SIN], own[COS])
        along[k, 2] = x * along[k, 0] + y * along[k, 1]
        along[k, 3] = own[HALF_W + k % 2] + other[HALF_W] * wide + other[HALF_D] * deep - abs(along[k, 2])
        along[k, 4], along[k, 5] = wide, deep
    least = along[:, 3].min()
    if least <= 0.0:
        return
    depth = least * rise
    push[i, COST] += depth**2 / 2 if depth < DEEP else DEEP * (depth - DEEP / 2)
    push[i, DEPTH] = max(push[i, DEPTH], depth)
    ties = (along[:, 3] < least + TIE).sum()
    slope = min(depth, DEEP) * rise / ties
    for k in range(4):
        if along[k, 3] >= least + TIE:
            continue
        mine, its = (i, j) if k < 2 else (j, i)
        other = prisms[its]
        way = slope * np.sign(along[k, 2])
        push[i, CX] += way * along[k, 0]
        push[i, CY] += way * along[k, 1]
        push[j, CX] -= way * along[k, 0]
        push[j, CY] -= way * along[k, 1]
        push[mine, HALF_W + k % 2] += slope
        push[its, HALF_W] += slope * along[k, 4]
        push[its, HALF_D] += slope * along[k, 5]
        wide, deep = (turn_same, turn_cross) if k % 2 == 0 else (turn_cross, turn_same)
        turn = slope * (other[HALF_W] * wide + other[HALF_D] * deep)
        push[i, TURN] += turn
        push[j, TURN] -= turn
        push[mine, TURN] -= way * (y * along[k, 0] - x * along[k, 1])  # the direction turns with its owner


@compiled
def _leave(prism: Floats, weight: float, walls: Floats, bound: Bools, push: Floats) -> None:
    """Add half the squared distances by which corners and side middles of a prism lie outside the room, times `weight`."""
    c, s = prism[COS], prism[SIN]
    for k in range(EIGHT.shape[0]):
        u, v = EIGHT[k, 0] * prism[HALF_W], EIGHT[k, 1] * prism[HALF_D]
        x, y = prism[CX] + c * u - s * v, prism[CY] + s * u + c * v
        inside, nearest, away_x, away_y = False, np.inf, 0.0, 0.0
        for wall in range(walls.shape[0]):
            if bound[wall]:
                ax, ay = walls[wall, 0, 0], walls[wall, 0, 1]
                ex, ey = walls[wall, 1, 0] - ax, walls[wall, 1, 1] - ay
                if (ay > y) != (ay + ey > y) and x < ax + ex * (y - ay) / ey:
                    inside = not inside
                place = min(max(((x - ax) * ex + (y - ay) * ey) / max(ex * ex + ey * ey, 1e-6), 0.0), 1.0)
                dx, dy = x - ax - place * ex, y - ay - place * ey
                if dx * dx + dy * dy < nearest:
                    nearest, away_x, away_y = dx * dx + dy * dy, dx, dy
        if not inside and nearest < np.inf:
            push[COST] += weight * nearest / 2
            push[DEPTH] = max(push[DEPTH], np.sqrt(nearest))
            push[CX] += weight * away_x
            push[CY] += weight * away_y
            push[HALF_W] += weight * EIGHT[k, 0] * (away_x * c + away_y * s)
            push[HALF_D] += weight * EIGHT[k, 1] * (away_y * c - away_x * s)
            push[TURN] += weight * (away_y * (x - prism[CX]) - away_x * (y - prism[CY]))


@compiled
def _hand_back(bodies: int, doors: int, boxes: Floats, prisms: Floats, push: Floats, owner: Ints, gradient: Floats) -> None:
    """Gather the pushes of prisms into the gradient (N, 8) by the boxes that own them: sweeps move and turn with their bodies and keep their size."""
    for i in range(push.shape[0]):
        if bodies <= i < doors:
            continue
        box, own, turn = boxes[owner[i]], gradient[owner[i]], push[i, TURN]
        own[0] += push[i, CX]
        own[1] += push[i, CY]
        if i < bodies:
            own[3] += push[i, HALF_W] / 2 if box[3] > LEAST else 0.0
            own[4] += push[i, HALF_D] / 2 if box[4] > LEAST else 0.0
        else:
            turn += push[i, CY] * (prisms[i, CX] - box[0]) - push[i, CX] * (prisms[i, CY] - box[1])
        length = max(np.hypot(box[6], box[7]), SHORT)
        own[6] -= turn * box[7] / length**2
        own[7] += turn * box[6] / length**2
