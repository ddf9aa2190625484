"""Upright convex prisms: what assets occupy at rest, and what their joints sweep.

Objects only yaw, so a convex collider is covered by the convex hull of its plan projection over its z interval: exactly
for upright boxes and cylinders, conservatively otherwise. Sweeps join neighbouring positions of a moving piece by
their hull, with the points where the tangents of arcs meet: all that moves is in them. Positions are taken so close that an arc bulges less than
`BULGE` beyond its chord.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pipeline.arrays import Floats, Ints
from pipeline.entities.asset import Asset, Joint, Link
from pipeline.geometry.compiled import compiled
from pipeline.geometry.convex import hull
from pipeline.geometry.kinematics import axis_distances, joint_motion, joint_range, moved_links, points_under
from pipeline.geometry.memo import cached_on_asset

CORNERS = 12  # vertices kept per prism; rounder ones are covered by a polygon of that many sides
STEPS = 12  # least number of positions per joint
MOST_STEPS = 48
BULGE = 0.002  # [m]
MARGIN = 0.002  # [m] about what furniture moves: prisms may be in each other by a touch, but a door that grazes a cabinet sticks there in an engine.
# Kitchen units stand no farther apart: with more, none would open beside another that stands out.


@dataclass(frozen=True, slots=True)
class Prisms:
    """P upright prisms: `corners` (P, CORNERS, 2) [m] of which `count` (P,) are used, `z` (P, 2) [m], `part` (P,)."""

    corners: Floats
    count: Ints
    z: Floats
    part: Ints

    def __len__(self) -> int:
        return len(self.count)

    def polygon(self, i: int) -> Floats:
        """Return the plan polygon (n, 2) of prism i."""
        return self.corners[i, : self.count[i]]

    def placed(self, position: Floats, yaw: float, scale: Floats) -> Prisms:
        """Return the prisms in the world: scaled, turned by `yaw` [rad], moved to `position` (3,) [m]."""
        corners, z = _place_corners(self.corners, self.z, np.asarray(position, np.float64), yaw, np.asarray(scale, np.float64))
        return Prisms(corners, self.count, z, self.part)

    def boxes(self) -> Floats:
        """Return the plan boxes (P, 4): x0, y0, x1, y1 (padding repeats the last vertex, so all may be used)."""
        return _boxes(self.corners)


@compiled
def _place_corners(corners: Floats, z: Floats, position: Floats, yaw: float, scale: Floats) -> tuple[Floats, Floats]:
    """Scale, turn and move corners (P, V, 2) and heights (P, 2)."""
    c, s = math.cos(yaw), math.sin(yaw)
    moved, raised = np.empty(corners.shape), np.empty(z.shape)
    for i in range(corners.shape[0]):
        for k in range(corners.shape[1]):
            x, y = corners[i, k, 0] * scale[0], corners[i, k, 1] * scale[1]
            moved[i, k, 0] = c * x - s * y + position[0]
            moved[i, k, 1] = s * x + c * y + position[1]
        raised[i, 0], raised[i, 1] = z[i, 0] * scale[2] + position[2], z[i, 1] * scale[2] + position[2]
    return moved, raised


@compiled
def _boxes(corners: Floats) -> Floats:
    """Return the boxes (P, 4) of corners (P, V, 2)."""
    boxes = np.empty((corners.shape[0], 4))
    for i in range(corners.shape[0]):
        for axis in range(2):
            low = high = corners[i, 0, axis]
            for k in range(1, corners.shape[1]):
                low, high = min(low, corners[i, k, axis]), max(high, corners[i, k, axis])
            boxes[i, axis], boxes[i, axis + 2] = low, high
    return boxes


@dataclass(frozen=True, slots=True)
class Sweep:
    """What one joint moves. Prism k covers the way to `reached[part[k]]` from the position before; 0 is at rest.

    `reached` (S,) ascends from the first step above 0 to the upper limit, then, for joints that also turn back,
    descends from the first step below 0 to the lower limit.
    """

    prisms: Prisms
    reached: Floats


@dataclass(frozen=True, slots=True)
class Solid:
    """An asset's prisms in the object frame: at rest (`part` is the link), and per joint (`part` is the step)."""

    rest: Prisms
    sweeps: tuple[Sweep, ...]


def join_prisms(groups: list[Prisms]) -> Prisms:
    """Join groups of prisms into one."""
    if not groups:
        return Prisms(np.zeros((0, CORNERS, 2)), np.zeros(0, np.int64), np.zeros((0, 2)), np.zeros(0, np.int64))
    return Prisms(*map(np.concatenate, zip(*((g.corners, g.count, g.z, g.part) for g in groups), strict=True)))


def prism(points: Floats, part: int = 0) -> Prisms | None:
    """Return the one prism that covers points (N, 3), or None when their projection is degenerate."""
    cover = covering_prisms(np.asarray(points, np.float64)[None], part)
    return cover if len(cover) else None


def covering_prisms(points: Floats, first: int = 0, margin: float = 0.0) -> Prisms:
    """Return the prisms that cover sets of points (S, N, 3), parts `first` and following; none where a projection is degenerate.

    They reach `margin` [m] farther in plan, along both axes; not in height, for what moves lies between boards and on desks.
    """
    corners, count, z = _cover(np.ascontiguousarray(points), margin)
    there = np.flatnonzero(count)
    return Prisms(corners[there], count[there], z[there], first + there)


@compiled
def _cover(points: Floats, margin: float) -> tuple[Floats, Ints, Floats]:
    """Return corners (S, CORNERS, 2), their number, 0 where degenerate, and z (S, 2) of prisms over points (S, N, 3)."""
    sets = points.shape[0]
    corners, count, z = np.zeros((sets, CORNERS, 2)), np.zeros(sets, np.int64), np.zeros((sets, 2))
    for s in range(sets):
        outline = hull(np.rint(points[s, :, :2] * 1e7) / 1e7)
        if len(outline) < 3:
            continue
        if margin > 0.0:
            outline = hull(_spread(outline, margin))
        outline = _fewer(outline, CORNERS)
        count[s] = len(outline)
        for k in range(CORNERS):
            corners[s, k] = outline[min(k, len(outline) - 1)]
        z[s, 0], z[s, 1] = points[s, :, 2].min(), points[s, :, 2].max()
    return corners, count, z


@compiled
def _spread(outline: Floats, margin: float) -> Floats:
    """Return the corners (4 n, 2) of squares, 2 `margin` wide, about the corners of an outline (n, 2)."""
    spread = np.empty((4 * len(outline), 2))
    for k in range(len(spread)):
        spread[k, 0] = outline[k // 4, 0] + (margin if k % 2 else -margin)
        spread[k, 1] = outline[k // 4, 1] + (margin if k % 4 > 1 else -margin)
    return spread


@cached_on_asset
def solid(asset: Asset) -> Solid:
    """Return the prisms of an asset at rest and in motion."""
    pieces = [p for i, link in enumerate(asset.links) for points in _pieces(link) if (p := prism(points, i)) is not None]
    return Solid(join_prisms(pieces), tuple(sweep_of(asset, j, MARGIN) for j in range(len(asset.joints))))


def _pieces(link: Link) -> list[Floats]:
    return [np.asarray(mesh.vertices, np.float64) for mesh in (link.colliders or link.visuals)]


def sweep_of(asset: Asset, index: int, margin: float = 0.0) -> Sweep:
    """Return what joint `index` moves over its range, the others at 0, and `margin` [m] about it."""
    joint = asset.joints[index]
    pieces = [points for i in moved_links(asset, index) for points in _pieces(asset.links[i])]
    lower, upper = joint_range(joint)
    groups: list[Prisms] = []
    reached: list[float] = []
    for limit in (upper, lower):
        if abs(limit) < 1e-9:
            continue
        positions = np.linspace(0.0, limit, _steps(joint, limit, pieces) + 1)
        motions = np.stack([joint_motion(joint, float(q)) for q in positions])
        tangents = None if joint.type == "prismatic" else _tangents(joint, positions)
        for points in pieces:
            moved = points_under(motions, points)
            between = [] if tangents is None else [points_under(tangents, points)]
            groups.append(covering_prisms(np.concatenate([moved[:-1], moved[1:], *between], axis=1), len(reached), margin))
        reached += positions[1:].tolist()
    return Sweep(join_prisms(groups), np.array(reached))


def _tangents(joint: Joint, positions: Floats) -> Floats:
    """Return the maps (S, 4, 4) that take points of a hinged part to where the tangents of their arcs meet, between each position and the next."""
    half = (positions[1] - positions[0]) / 2
    away = np.eye(4)
    away[:3, :3] += (1.0 / math.cos(half) - 1.0) * (np.eye(3) - np.outer(joint.axis, joint.axis))
    away[:3, 3] = joint.origin - away[:3, :3] @ joint.origin
    return np.stack([joint_motion(joint, float(q)) @ away for q in positions[:-1] + half])


def _steps(joint: Joint, limit: float, pieces: list[Floats]) -> int:
    if joint.type == "prismatic" or not pieces:
        return STEPS
    radius = float(axis_distances(joint, np.concatenate(pieces)).max())
    step = 2 * math.acos(max(0.0, 1.0 - BULGE / max(radius, BULGE)))
    return min(MOST_STEPS, max(STEPS, math.ceil(abs(limit) / max(step, 1e-6))))


@compiled
def _fewer(outline: Floats, most: int) -> Floats:
    """Cover a convex polygon by one of at most `most` vertices: edges are dropped, the cheapest in area first."""
    while len(outline) > most:
        n = len(outline)
        best, edge, x, y = np.inf, 0, np.nan, np.nan
        for k in range(n):
            before, a, b, after = outline[(k - 1) % n], outline[k], outline[(k + 1) % n], outline[(k + 2) % n]
            ux, uy, vx, vy = a[0] - before[0], a[1] - before[1], b[0] - after[0], b[1] - after[1]
            det = ux * -vy - uy * -vx
            if abs(det) < 1e-12:
                continue
            t = ((after[0] - before[0]) * -vy - (after[1] - before[1]) * -vx) / det
            apex_x, apex_y = before[0] + t * ux, before[1] + t * uy
            cost = abs((b[0] - a[0]) * (apex_y - a[1]) - (b[1] - a[1]) * (apex_x - a[0]))
            if t >= 1.0 - 1e-9 and cost < best:
                best, edge, x, y = cost, k, apex_x, apex_y
        corners = np.empty((n - 1, 2))
        dropped = (edge + 1) % n
        for k in range(n):
            if k != dropped:
                corners[k - (k > dropped)] = outline[k]
        place = edge if dropped > edge else edge - 1
        corners[place, 0], corners[place, 1] = x, y
        outline = corners
    return outline
