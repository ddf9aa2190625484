"""A retrieved asset is rarely as large as what was asked for: the side that stood at a wall stays where it was, all of it in the room, and out of what stands flush with it."""

import numpy as np

from pipeline.arrays import Floats
from pipeline.geometry.compiled import compiled
from pipeline.relations.walls import STRAIGHT

REACH = 0.12  # a side so near to a wall stands at it [m]
BEYOND = 0.1  # past its ends a wall goes on for what is beside it [m]
OVERLAP = 0.05  # a wall that is beside no more than this of a side does not bear on it [m]
CLEAR = 0.002  # of what is put before a wall [m]
SHALLOW = 0.15  # what reaches deeper into another is meant to, or a matter for the arranger [m]
SQUARE = 0.05  # boxes turned to each other by less than this, or by so much more than quarters, are square [rad]
ROUNDS = 8  # over all pairs: who is moved may meet the next


def keep_at_walls(position: Floats, yaw: float, asked: Floats, size: Floats, polygon: Floats) -> Floats:
    """Return the position (3,) [m] at which a box of `size` keeps the asked box's sides that lie at walls.

    `position` is the asked bottom centre, `asked` and `size` (3,) are full extents [m], `polygon` (n, 2) the room in the
    same frame. Along each horizontal axis of the object, the side that is within REACH of a wall parallel to it stays;
    with a wall at both sides or none the centre stays. A gap left by the model below REACH is thus kept as it is.
    """
    return _keep(np.asarray(position, float), _axes(yaw), np.asarray(asked, float), np.asarray(size, float), np.asarray(polygon, float))


def put_before_walls(position: Floats, yaw: float, size: Floats, polygon: Floats) -> Floats:
    """Return the position (3,) [m] of a box moved out of walls that it sticks into by less than REACH, where the room is wide enough for it."""
    return _pull_out(np.asarray(position, float), _axes(yaw), np.asarray(size, float), np.asarray(polygon, float))


def _axes(yaw: float) -> Floats:
    """Return the unit vectors (2, 2) along the width and the depth of a box."""
    return np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])


@compiled
def gap_to_wall(point: Floats, outward: Floats, polygon: Floats, past: float) -> float:
    """Return how far [m] before the point the nearest wall is that faces `outward` squarely and ends no more than `past` beside it; infinite where none is.

    `polygon` (n, 2) goes counter-clockwise; the gap is negative where the point is beyond the wall.
    """
    nearest = np.inf
    for k in range(len(polygon)):
        start, end = polygon[k], polygon[(k + 1) % len(polygon)]
        length = max(np.hypot(end[0] - start[0], end[1] - start[1]), 1e-9)
        x, y = (end[0] - start[0]) / length, (end[1] - start[1]) / length
        place = (point[0] - start[0]) * x + (point[1] - start[1]) * y
        offset = (start[0] - point[0]) * y - (start[1] - point[1]) * x
        if y * outward[0] - x * outward[1] > 0.98 and -past < place < length + past and abs(offset) < abs(nearest):
            nearest = offset
    return nearest


@compiled
def _keep(position: Floats, axes: Floats, asked: Floats, size: Floats, polygon: Floats) -> Floats:
    moved = position.copy()
    for extent in range(2):
        axis = axes[extent]
        ahead = abs(gap_to_wall(position[:2] + axis * asked[extent] / 2, axis, polygon, BEYOND)) < REACH
        behind = abs(gap_to_wall(position[:2] - axis * asked[extent] / 2, -axis, polygon, BEYOND)) < REACH
        moved[:2] += axis * (asked[extent] - size[extent]) / 2 * (int(ahead) - int(behind))
    return moved


@compiled
def _pull_out(position: Floats, axes: Floats, size: Floats, polygon: Floats) -> Floats:
    moved = position.copy()
    for extent in range(2):
        axis, past = axes[extent], size[1 - extent] / 2 - OVERLAP
        ahead = gap_to_wall(moved[:2] + axis * size[extent] / 2, axis, polygon, past)
        behind = gap_to_wall(moved[:2] - axis * size[extent] / 2, -axis, polygon, past)
        if -REACH < min(ahead, behind) < 0.0 <= ahead + behind:
            moved[:2] += axis * (ahead - CLEAR if ahead < behind else CLEAR - behind)
    return moved


def straightened(yaws: Floats, polygon: Floats) -> Floats:
    """Return yaws (n,), those along or across a wall of `polygon` (k, 2) that differ from its direction by less than STRAIGHT."""
    along = np.roll(polygon, -1, axis=0) - polygon
    off = np.asarray(yaws)[:, None] - np.arctan2(along[:, 1], along[:, 0])
    off = np.mod(off + np.pi / 4, np.pi / 2) - np.pi / 4
    least = off[np.arange(len(off)), np.abs(off).argmin(1)]
    return np.asarray(yaws - np.where(np.abs(least) < STRAIGHT, least, 0.0))


def part(centres: Floats, yaws: Floats, sizes: Floats, polygon: Floats) -> Floats:
    """Return the centres (n, 3) [m] of boxes, those that reach into each other by less than SHALLOW moved apart, each by half or as far as its wall allows.

    `centres` are of the boxes' undersides, `yaws` (n,), `sizes` (n, 3) [m], `polygon` (k, 2) the room in the same frame. Only boxes that
    are square to each other and at one height move, and along the side by which they meet.
    """
    return _part(
        np.array(centres, float), np.asarray(yaws, float), np.ascontiguousarray(sizes, float), np.ascontiguousarray(polygon, float)
    )


@compiled
def _part(centres: Floats, yaws: Floats, sizes: Floats, polygon: Floats) -> Floats:
    half = sizes[:, :2] / 2
    for _ in range(ROUNDS):
        moved = False
        for i in range(len(yaws)):
            u = np.array([np.cos(yaws[i]), np.sin(yaws[i])])
            v = np.array([-u[1], u[0]])
            for j in range(i):
                quarters = (yaws[j] - yaws[i]) / (np.pi / 2)
                if abs(quarters - np.rint(quarters)) * np.pi / 2 > SQUARE:
                    continue
                if centres[i, 2] >= centres[j, 2] + sizes[j, 2] or centres[j, 2] >= centres[i, 2] + sizes[i, 2]:
                    continue
                turned = int(abs(np.rint(quarters))) % 2  # which extent of j lies along the width of i
                between = centres[j, :2] - centres[i, :2]
                x, y = np.dot(between, u), np.dot(between, v)
                along_u, along_v = half[i, 0] + half[j, turned] - abs(x), half[i, 1] + half[j, 1 - turned] - abs(y)
                if not (1e-4 - CLEAR < min(along_u, along_v) < SHALLOW and max(along_u, along_v) > min(along_u, along_v) + 0.02):
                    continue
                axis = 0 if along_u < along_v else 1
                push = u * np.sign(x) if axis == 0 else v * np.sign(y)
                wanted = min(along_u, along_v) + CLEAR
                room_i = _room(centres[i, :2], -push, half[i, axis], half[i, 1 - axis], polygon)
                room_j = _room(centres[j, :2], push, half[j, abs(axis - turned)], half[j, 1 - abs(axis - turned)], polygon)
                share_j = min(max(wanted / 2, wanted - room_i), room_j)
                share_i = min(wanted - share_j, room_i)
                if share_i + share_j > 1e-4:
                    centres[i, :2] -= push * share_i
                    centres[j, :2] += push * share_j
                    moved = True
        if not moved:
            break
    return centres


@compiled
def _room(centre: Floats, outward: Floats, reach: float, across: float, polygon: Floats) -> float:
    """Return how far [m] a box can be moved `outward` until it stands before a wall."""
    return max(0.0, gap_to_wall(centre + outward * reach, outward, polygon, across - OVERLAP) - CLEAR)
