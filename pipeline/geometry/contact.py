"""Which prisms touch: compiled pairwise tests between groups of prisms (objects), by plan boxes, heights, then axes.

Groups are given as `start` (G + 1,): prisms start[g] .. start[g + 1] - 1 belong to group g. Two prisms touch when their
plan polygons overlap by more than `tolerance` [m] in depth and their z intervals by more than `tolerance`.
"""

import numpy as np

from pipeline.arrays import Floats, Ints
from pipeline.geometry.compiled import borrowing, compiled
from pipeline.geometry.convex import gap
from pipeline.geometry.polygons import beyond
from pipeline.geometry.prisms import Prisms


def group_boxes(prisms: Prisms, start: Ints) -> Floats:
    """Return the boxes (G, 6) of groups: x0, y0, z0, x1, y1, z1; an empty group has an inverted box."""
    boxes = np.empty((len(start) - 1, 6))
    boxes[:, :3], boxes[:, 3:] = np.inf, -np.inf
    flat = prisms.boxes()
    group = np.repeat(np.arange(len(start) - 1), np.diff(start))
    np.minimum.at(boxes[:, 0], group, flat[:, 0])
    np.minimum.at(boxes[:, 1], group, flat[:, 1])
    np.minimum.at(boxes[:, 2], group, prisms.z[:, 0])
    np.maximum.at(boxes[:, 3], group, flat[:, 2])
    np.maximum.at(boxes[:, 4], group, flat[:, 3])
    np.maximum.at(boxes[:, 5], group, prisms.z[:, 1])
    return boxes


@borrowing
def depth(corners_a: Floats, z_a: Floats, corners_b: Floats, z_b: Floats) -> float:
    """Return how deep two prisms are in each other [m]: the lesser of plan depth and shared height; <= 0 when apart."""
    shared = float(min(z_a[1], z_b[1]) - max(z_a[0], z_b[0]))
    if shared <= 0.0:
        return shared
    return min(shared, -gap(corners_a, corners_b))


@compiled
def pair_depths(corners: Floats, count: Ints, z: Floats, flat: Floats, start: Ints, group_box: Floats, tolerance: float) -> Floats:
    """Return the depths (G, G) [m] to which groups are in each other (symmetric, 0 where within `tolerance`)."""
    groups = start.shape[0] - 1
    depths = np.zeros((groups, groups))
    for g in range(groups):
        for h in range(g + 1, groups):
            if _apart(group_box[g], group_box[h], tolerance):
                continue
            worst = 0.0
            for i in range(start[g], start[g + 1]):
                for j in range(start[h], start[h + 1]):
                    if _flat_apart(flat[i], flat[j], tolerance) or min(z[i, 1], z[j, 1]) - max(z[i, 0], z[j, 0]) <= tolerance:
                        continue
                    worst = max(worst, depth(corners[i, : count[i]], z[i], corners[j, : count[j]], z[j]))
            if worst > tolerance:
                depths[g, h] = worst
                depths[h, g] = worst
    return depths


@compiled
def first_hits(
    corners: Floats,
    count: Ints,
    z: Floats,
    flat: Floats,
    owner: Ints,
    others: Floats,
    others_count: Ints,
    others_z: Floats,
    others_flat: Floats,
    start: Ints,
    group_box: Floats,
    tolerance: float,
) -> Ints:
    """Return for each prism (P,) the first group that it touches, its `owner` left out; -1 for none."""
    hits = np.full(count.shape[0], -1)
    box = np.empty(6)
    for i in range(count.shape[0]):
        box[0], box[1], box[2] = flat[i, 0], flat[i, 1], z[i, 0]
        box[3], box[4], box[5] = flat[i, 2], flat[i, 3], z[i, 1]
        for g in range(start.shape[0] - 1):
            if g == owner[i] or hits[i] >= 0 or _apart(box, group_box[g], tolerance):
                continue
            for j in range(start[g], start[g + 1]):
                if _flat_apart(flat[i], others_flat[j], tolerance):
                    continue
                if min(z[i, 1], others_z[j, 1]) - max(z[i, 0], others_z[j, 0]) <= tolerance:
                    continue
                if depth(corners[i, : count[i]], z[i], others[j, : others_count[j]], others_z[j]) > tolerance:
                    hits[i] = g
                    break
    return hits


@compiled
def wall_excesses(corners: Floats, count: Ints, polygon: Floats) -> Floats:
    """Return how far (P,) [m] each prism sticks out of a room polygon."""
    excesses, wall = np.empty(count.shape[0]), np.empty((4, 2))
    for i in range(count.shape[0]):
        excesses[i] = beyond(corners[i, : count[i]], polygon, wall)
    return excesses


@borrowing
def _apart(a: Floats, b: Floats, tolerance: float) -> bool:
    """Tell whether two boxes (6,) share at most `tolerance` along some axis."""
    shared = float(min(a[3], b[3]) - max(a[0], b[0]))
    shared = min(shared, min(a[4], b[4]) - max(a[1], b[1]))
    shared = min(shared, min(a[5], b[5]) - max(a[2], b[2]))
    return bool(shared <= tolerance)


@borrowing
def _flat_apart(a: Floats, b: Floats, tolerance: float) -> bool:
    """Tell whether two plan boxes (4,) share at most `tolerance` along some axis."""
    shared = min(min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1]))
    return bool(shared <= tolerance)
