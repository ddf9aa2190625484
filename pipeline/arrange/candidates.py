"""Poses that an object may take, each with its cost in metres of displacement: near by, along walls, beside partners."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from pipeline.arrange.item import Item, turned, wrapped
from pipeline.arrange.settings import SeparateSettings
from pipeline.arrange.site import Hole, Site

Floats = NDArray[np.float64]

OFF_WALL = {"must": 1.0, "want": 0.35, "free": 0.0}  # cost of standing free for what belongs to a wall [m]
ALONE = 0.5  # cost of standing away from a partner that is near [m]
BESIDE = 0.5  # a metre towards a place beside a partner costs this much [m]
PARTNER_REACH = 1.8  # partners farther than this are none [m]
RINGS = (0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0)  # radii of the poses tried near by [m]
WAYS = 16
GRID = 0.25  # of poses tried all over the room [m]
STRIDE = 0.1  # of poses tried along walls [m]
WALL_GAP = 0.001  # [m]
OVERHANG = 0.05  # an object may stand this far before an opening at no cost [m]
BEFORE_WINDOW = 0.2  # cost of hiding a window behind something high [m]


def candidates(item: Item, site: Site, placed: Sequence[Item], settings: SeparateSettings) -> tuple[Floats, Floats]:
    """Return poses (C, 4) x, y, z, yaw, rounded as poses are, and their costs (C,), the cheapest first."""
    beside, beside_cost = _partnered(item, placed)
    # Who already stands as one does beside a partner has nothing to gain by moving.
    alone = min(ALONE, 0.9 * float(beside_cost.min())) if len(beside) else 0.0
    groups = [(beside, beside_cost)]
    walls, walls_cost = _along_walls(item, site, placed)
    groups.append((walls, walls_cost + alone))
    hanging = item.mount == "wall"
    if not hanging:
        off_wall = OFF_WALL[item.trait.wall]
        if item.trait.wall == "want" and not _near_wall(item, site, settings.wall_reach):
            off_wall = 0.0
        near, near_cost = _near_by(item, _yaw(item, site, settings))
        groups.append((near, near_cost + off_wall + alone))
        if item.trait.wall != "must":
            everywhere, cost = _everywhere(item, site)
            groups.append((everywhere, cost + off_wall + alone))
    poses = np.concatenate([g[0] for g in groups])
    costs = np.concatenate([g[1] for g in groups]) + settings.turn_cost * turned(poses[:, 3], float(item.wished[3]))
    poses, costs = _with_heights(item, site, poses, costs)
    order = np.argsort(np.round(costs, 9), kind="stable")
    poses = poses[order]
    poses[:, :3] = np.round(poses[:, :3], 4) + 0.0
    return np.ascontiguousarray(poses), np.ascontiguousarray(costs[order])


def wall_yaws(polygon: Floats) -> Floats:
    """Return per edge (n,) the yaw [rad] of an object that has its back to it."""
    along = np.roll(polygon, -1, axis=0) - polygon
    yaw: Floats = np.arctan2(-along[:, 1], -along[:, 0])
    return yaw


def _yaw(item: Item, site: Site, settings: SeparateSettings) -> float:
    """Return the yaw to keep: the wished one, or the walls' direction next to it when it is near.

    What others are placed by (beds, cabinets, sofas, tables) always goes with the walls; chairs may stand askew.
    """
    wished = float(item.wished[3])
    squares = (wall_yaws(site.polygon)[:, None] + np.arange(4) * math.pi / 2).ravel()
    distance = turned(squares, wished)
    best = int(np.argmin(np.round(distance, 6)))
    if distance[best] <= math.radians(settings.snap_angle) or item.trait.wall == "must" or item.trait.order <= 1:
        return wrapped(float(squares[best]))
    return wrapped(wished)


def _near_by(item: Item, yaw: float) -> tuple[Floats, Floats]:
    angles = np.arange(WAYS) * (2 * math.pi / WAYS) + yaw
    ring = np.stack([np.cos(angles), np.sin(angles)], 1)
    offsets = np.concatenate([np.zeros((1, 2)), *(r * ring for r in RINGS)])
    return _made(item.wished[:2] + offsets, np.full(len(offsets), yaw)), np.linalg.norm(offsets, axis=1)


def _everywhere(item: Item, site: Site) -> tuple[Floats, Floats]:
    """Return a grid over the room in the four directions of its longest wall."""
    along = np.roll(site.polygon, -1, axis=0) - site.polygon
    base = wall_yaws(site.polygon)[int(np.argmax(np.round(np.linalg.norm(along, axis=1), 6)))]
    low, high = site.polygon.min(0), site.polygon.max(0)
    xs, ys = (np.arange(low[k] + GRID / 2, high[k], GRID) for k in (0, 1))
    points = np.stack(np.meshgrid(xs, ys, indexing="ij"), -1).reshape(-1, 2)
    points = points[shapely.contains_xy(shapely.Polygon(site.polygon), points[:, 0], points[:, 1])]
    yaws = np.array([wrapped(float(base) + k * math.pi / 2) for k in range(4)])
    spread = np.repeat(points, 4, axis=0)
    return _made(spread, np.tile(yaws, len(points))), np.linalg.norm(spread - item.wished[:2], axis=1)


def _along_walls(item: Item, site: Site, placed: Sequence[Item]) -> tuple[Floats, Floats]:
    """Return poses with the back to each wall: at a stride, at the wished place, at corners, flush with neighbours."""
    if item.trait.wall == "free":
        return np.zeros((0, 4)), np.zeros(0)
    found, costs = [], []
    w, d = item.half
    ends = np.roll(site.polygon, -1, axis=0)
    for a, b, yaw, holes in zip(site.polygon, ends, wall_yaws(site.polygon), site.holes, strict=True):
        length = float(np.linalg.norm(b - a))
        if length < 2 * w + 2 * WALL_GAP:
            continue
        t = (b - a) / length
        n = np.array([-t[1], t[0]])
        wished = float((item.wished[:2] - a) @ t)
        stops = [np.arange(w + WALL_GAP, length - w, STRIDE), [w + WALL_GAP, length - w - WALL_GAP, wished, wished - 0.05, wished + 0.05]]
        for other in placed:
            corners = other.placement.footprint()
            if ((corners - a) @ n).min() < 2 * d:
                s = (corners - a) @ t
                stops.append([s.min() - w - WALL_GAP, s.max() + w + WALL_GAP])
        stops.extend([hole.start - w - WALL_GAP, hole.end + w + WALL_GAP] for hole in holes)
        s = np.concatenate([np.asarray(x, float) for x in stops])
        s = np.unique(np.round(s[(s >= w) & (s <= length - w)], 4))
        points = a + s[:, None] * t + (d + WALL_GAP) * n
        found.append(_made(points, np.full(len(s), wrapped(float(yaw)))))
        costs.append(np.linalg.norm(points - item.wished[:2], axis=1) + _hole_cost(item, s, holes))
    if not found:
        return np.zeros((0, 4)), np.zeros(0)
    poses, cost = np.concatenate(found), np.concatenate(costs)
    return poses[np.isfinite(cost)], cost[np.isfinite(cost)]


def _hole_cost(item: Item, s: Floats, holes: Sequence[Hole]) -> Floats:
    """Return what standing before openings costs at places `s` (S,) along an edge: there is no wall to lean on.

    What hangs needs a wall; what is low may stand under a window.
    """
    cost = np.zeros(len(s))
    w = float(item.half[0])
    for hole in holes:
        shared = np.minimum(s + w, hole.end) - np.maximum(s - w, hole.start)
        before = shared > OVERHANG
        if hole.window and item.mount == "floor":
            high = float(item.placement.size[2]) > hole.sill + 0.4
            cost += np.where(before, BEFORE_WINDOW if high else 0.0, 0.0)
        elif item.mount == "wall":
            cost[before] = np.inf
        else:
            cost += np.where(before, OFF_WALL[item.trait.wall], 0.0)
    return cost


def _partnered(item: Item, placed: Sequence[Item]) -> tuple[Floats, Floats]:
    """Return poses beside the partners of an object that are near where it is wished."""
    spots: list[tuple[Floats, float]] = []
    for other in placed:
        if other.placement.category not in item.trait.partners:
            continue
        if np.linalg.norm(other.placement.position[:2] - item.wished[:2]) > PARTNER_REACH + float(np.max(other.half)):
            continue
        c, s = math.cos(other.placement.yaw), math.sin(other.placement.yaw)
        T = np.array([[c, s], [-s, c]])
        for local, turn in _spots(item, other):
            spots.append((local @ T + other.placement.position[:2], wrapped(other.placement.yaw + turn)))
    if not spots:
        return np.zeros((0, 4)), np.zeros(0)
    points, yaws = np.array([p for p, _ in spots]), np.array([y for _, y in spots])
    return _made(points, yaws), BESIDE * np.linalg.norm(points - item.wished[:2], axis=1)


def _spots(item: Item, other: Item) -> list[tuple[Floats, float]]:
    """Return places beside a partner in its frame (front -y), each with the turn against it [rad]."""
    w, d = item.half
    pw, pd = other.half
    if item.trait.relation == "flank":
        return [(np.array([side * (pw + w + g), pd - d]), 0.0) for g in (0.01, 0.04, 0.08, 0.15, 0.25) for side in (-1, 1)]
    if item.trait.relation == "front" and item.placement.category == "coffee_table":
        return [(np.array([x, -(pd + d + g)]), 0.0) for g in (0.35, 0.45, 0.3, 0.6) for x in (0.0, -0.15, 0.15, -0.3, 0.3)]
    tucks = tuple(d * k for k in (0.8, 0.5, 0.2, 0.0, -0.2, -0.5))  # how far its front goes under the partner's edge [m]
    shifts = tuple(k * 0.1 for k in range(-12, 13))
    sides = (0,) if item.trait.relation == "front" else (0, 1, 2, 3)
    spots = []
    for side in sides:  # front, right, back, left of the partner
        reach, span = (pd, pw) if side % 2 == 0 else (pw, pd)
        for tuck in tucks:
            for shift in (x for x in shifts if abs(x) <= max(span - w, 0.0) + 1e-9):
                out = reach + d - tuck
                local = {0: (shift, -out), 1: (out, shift), 2: (shift, out), 3: (-out, shift)}[side]
                spots.append((np.array(local), math.pi + side * math.pi / 2))
    return spots


def _near_wall(item: Item, site: Site, reach: float) -> bool:
    back = item.wished[:2] + np.array([-math.sin(item.wished[3]), math.cos(item.wished[3])]) * item.half[1]
    return bool(shapely.distance(shapely.LinearRing(site.polygon), shapely.Point(back)) <= reach)


def _with_heights(item: Item, site: Site, poses: Floats, costs: Floats) -> tuple[Floats, Floats]:
    """Set z: on the floor, under the ceiling, or for what hangs on walls at heights around the wished one."""
    height = float(item.placement.size[2])
    if item.mount == "floor":
        poses[:, 2] = site.elevation
        return poses, costs
    if item.mount == "ceiling":
        poses[:, 2] = site.ceiling - height
        return poses, costs
    low, high = site.elevation + 0.9, max(site.elevation + 0.9, site.ceiling - height - 0.02)
    wished = float(np.clip(item.wished[2], low, high))
    levels = sorted({round(float(np.clip(z, low, high)), 4) for z in (wished, site.elevation + 1.4, site.elevation + 1.6)})
    repeated = np.repeat(poses, len(levels), axis=0)
    repeated[:, 2] = np.tile(levels, len(poses))
    return repeated, np.repeat(costs, len(levels)) + np.abs(repeated[:, 2] - wished)


def _made(points: Floats, yaws: Floats) -> Floats:
    return np.column_stack([points, np.zeros(len(points)), yaws])
