"""Which prisms touch: compiled pairwise tests between groups of prisms (objects), by plan boxes, heights, then axes.

Groups are given as `start` (G + 1,): prisms start[g] .. start[g + 1] - 1 belong to group g. Two prisms touch when their
plan polygons overlap by more than `tolerance` [m] in depth and their z intervals by more than `tolerance`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pipeline.arrays import Floats, Ints
from pipeline.geometry.compiled import borrowing, compiled
from pipeline.geometry.convex import gap
from pipeline.geometry.polygons import beyond
from pipeline.geometry.prisms import Prisms, join_prisms


def group_boxes(prisms: Prisms, start: Ints) -> Floats:
    """Return the boxes (G, 6) of groups: x0, y0, z0, x1, y1, z1; an empty group has an inverted box."""
    boxes = np.empty((len(start) - 1, 6))
    boxes[:, :3], boxes[:, 3:] = np.inf, -np.inf
    flat = prisms.boxes()
    group = np.repeat(np.arange(len(start) - 1), np.diff(start))
    np.minimum.at(boxes[:, :3], group, np.column_stack([flat[:, :2], prisms.z[:, 0]]))
    np.maximum.at(boxes[:, 3:], group, np.column_stack([flat[:, 2:], prisms.z[:, 1]]))
    return boxes


@dataclass(frozen=True, slots=True)
class Groups:
    """Prisms in the world; those of group g are `start[g]` .. `start[g + 1]`; `flat` (P, 4) and `boxes` (G, 6) bound them."""

    prisms: Prisms
    start: Ints
    flat: Floats
    boxes: Floats

    @classmethod
    def of(cls, groups: Sequence[Prisms]) -> Groups:
        """Join groups."""
        start = np.concatenate([[0], np.cumsum([len(g) for g in groups], dtype=np.int64)]).astype(np.int64)
        prisms = join_prisms(list(groups))
        return cls(prisms, start, prisms.boxes(), group_boxes(prisms, start))

    def plus(self, groups: Sequence[Prisms]) -> Groups:
        """Return the groups and some more."""
        more = Groups.of(groups)
        start = np.concatenate([self.start, self.start[-1] + more.start[1:]])
        flat, boxes = np.concatenate([self.flat, more.flat]), np.concatenate([self.boxes, more.boxes])
        return Groups(join_prisms([self.prisms, more.prisms]), start, flat, boxes)

    def hit(self, moved: Prisms, touch: float, without: Sequence[int] = ()) -> bool:
        """Tell whether prisms touch any group, some left out."""
        boxes = self.boxes
        if len(without):
            boxes = boxes.copy()
            boxes[list(without)] = (*[np.inf] * 3, *[-np.inf] * 3)
        if not len(self.prisms) or not len(moved):
            return False
        p, alone = self.prisms, np.full(len(moved), -1)
        hits = first_hits(
            moved.corners, moved.count, moved.z, moved.boxes(), alone, p.corners, p.count, p.z, self.flat, self.start, boxes, touch
        )
        return bool((hits >= 0).any())


@borrowing
def apart(a: Floats, b: Floats, tolerance: float) -> bool:
    """Tell whether two boxes (2 K,), K lower bounds before K upper ones, share at most `tolerance` along some of their K axes."""
    axes, shared = a.shape[0] // 2, np.inf
    for k in range(axes):
        shared = min(shared, min(a[k + axes], b[k + axes]) - max(a[k], b[k]))
    return bool(shared <= tolerance)


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
            if apart(group_box[g], group_box[h], tolerance):
                continue
            worst = 0.0
            for i in range(start[g], start[g + 1]):
                for j in range(start[h], start[h + 1]):
                    if apart(flat[i], flat[j], tolerance) or apart(z[i], z[j], tolerance):
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
            if g == owner[i] or hits[i] >= 0 or apart(box, group_box[g], tolerance):
                continue
            for j in range(start[g], start[g + 1]):
                if apart(flat[i], others_flat[j], tolerance) or apart(z[i], others_z[j], tolerance):
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
