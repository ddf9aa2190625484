"""Poses that a group may take, each with its cost in metres: near by, along walls, at its anchor, all over the room."""

import math
from collections.abc import Sequence

import numpy as np
import shapely

from pipeline.arrange.bonds import mode_poses
from pipeline.arrange.item import Item, other_wall, wrap_yaw, yaw_difference
from pipeline.arrange.learnt_relations import LearntRelations
from pipeline.arrange.settings import SeparateSettings
from pipeline.arrange.site import Site
from pipeline.arrange.snapping import ACROSS, FACING, height
from pipeline.arrange.walls import Edge, at_wall, hides_window, opening_cost
from pipeline.arrays import Floats

OFF_WALL = 1.0  # cost of standing free for what always belongs to a wall [m]; less for what seldom does
OFF_ITS_WALL = 3.0  # and for what belongs to one: a wardrobe goes to a wall 3 m away before it stands free
BESIDE = 0.2  # a metre towards another place at the anchor costs this much [m]
ASIDE = 2.0  # and a metre along the anchor's side, away from such a place [m]
ALONE = 0.8  # cost of standing away from the anchor [m]
RINGS = (0.02, 0.05, 0.08, 0.12, 0.16, 0.2, 0.25, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0)  # radii of the poses tried near by [m]
WAYS = 16
SQUARE = 0.1  # what is turned to within this stands straight across [rad]
GRID = 0.25  # of poses tried all over the room [m]
STRIDE = 0.1  # of poses tried along walls [m]
SEAM = 0.002  # between neighbours [m]
ALONG = np.array([0.0, *(s * k for k in (0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8) for s in (1, -1))])
OUT = np.array([0.0, -0.06, -0.12, 0.03, 0.06, 0.1, 0.15, 0.2, 0.3])
DRAWN_OUT = np.array([0.4, 0.5, 0.6])  # a chair before drawers stands clear of them [m]


def near_by(item: Item, target: Floats, neighbours: Floats, site: Site, settings: SeparateSettings) -> tuple[Floats, Floats]:
    """Return poses (C, 4) of an object about its target (4,) and along the walls, and their costs (C,), the cheapest first.

    `neighbours` (M, 4, 2) are the outlines of what stands, with which it may be flush.
    """
    walls = site.walls
    candidates, costs = [target[None]], [_opening_cost(item, target[None], walls)]
    if item.mount != "wall":
        backed = item.habit.wants and _at_wall(item, target, walls)
        off = (OFF_ITS_WALL if item.habit.must else OFF_WALL) * item.habit.backed if backed else 0.0
        angles = np.arange(WAYS) * (2 * math.pi / WAYS) + target[3]
        ring = np.stack([np.cos(angles), np.sin(angles)], 1)
        shifts = np.concatenate([r * ring for r in RINGS])
        candidates.append(_stack_poses(target[:2] + shifts, np.full(len(shifts), target[3]), target[2]))
        costs.append(np.linalg.norm(shifts, axis=1) + off + _opening_cost(item, candidates[-1], walls))
    if item.habit.wants:
        poses, cost = _along_walls(item, target, walls, neighbours)
        candidates.append(poses)
        costs.append(cost + settings.turn_cost * yaw_difference(poses[:, 3], float(target[3])))
    return _rank_poses(item, np.concatenate(candidates), np.concatenate(costs), site)


def round_walls(item: Item, target: Floats, walls: Sequence[Edge], site: Site, settings: SeparateSettings) -> tuple[Floats, Floats]:
    """Return poses (C, 4) along all the walls, and their costs (C,), the cheapest first: for what takes along who stands across from it."""
    poses, cost = _along_walls(item, target, walls, np.zeros((0, 4, 2)))
    return _rank_poses(item, poses, cost + settings.turn_cost * yaw_difference(poses[:, 3], float(target[3])), site)


def steps_to_walls(item: Item, across: Item, offset: Floats, walls: Sequence[Edge]) -> list[tuple[float, Edge]]:
    """Return how much farther from an item one that looks at it from `offset` (4,) in its frame has its back at a wall [m], and the item's wall then, the least step first.

    Nothing for one that would not rather be at a wall.
    """
    if not across.habit.wants or abs(math.remainder(float(offset[3]) - math.pi, math.tau)) > SQUARE:
        return []
    taken = item.habit.gap[1] + float(item.half[1]) - float(offset[1]) + float(across.half[1]) + across.habit.gap[1]
    facing = [
        (edge, float(other.off(edge.start))) for edge in walls for other in walls if yaw_difference(edge.yaw, other.yaw) > math.pi - SQUARE
    ]
    return sorted(((depth - taken, edge) for edge, depth in facing if depth > 0.0), key=lambda step: (round(abs(step[0]), 6), step[1].yaw))


def everywhere(item: Item, target: Floats, site: Site, settings: SeparateSettings) -> tuple[Floats, Floats]:
    """Return a grid over the room in the four directions of its longest wall, and poses along the walls, as `near_by` does; none for what belongs to a wall."""
    if item.mount == "wall" or item.habit.must:
        return np.zeros((0, 4)), np.zeros(0)
    base = max(site.walls, key=lambda edge: round(edge.length, 6)).yaw
    low, high = site.polygon.min(0), site.polygon.max(0)
    xs, ys = (np.arange(low[k] + GRID / 2, high[k], GRID) for k in (0, 1))
    points = np.stack(np.meshgrid(xs, ys, indexing="ij"), -1).reshape(-1, 2)
    points = points[shapely.contains_xy(shapely.Polygon(site.polygon), points[:, 0], points[:, 1])]
    yaws = np.array([wrap_yaw(float(base) + k * math.pi / 2) for k in range(4)])
    spread, turns = np.repeat(points, 4, axis=0), np.tile(yaws, len(points))
    free, backed = _stack_poses(spread, turns, target[2]), _along_walls(item, target, site.walls, np.zeros((0, 4, 2)))
    cost = np.concatenate([np.linalg.norm(spread - target[:2], axis=1) + OFF_WALL * item.habit.backed, backed[1]])
    poses = np.concatenate([free, backed[0]])
    return _rank_poses(item, poses, cost + settings.turn_cost * yaw_difference(poses[:, 3], float(target[3])), site)


def at_anchor_poses(
    item: Item, target: Floats, anchor: Item, at: Floats, site: Site, learnt: LearntRelations, settings: SeparateSettings
) -> tuple[Floats, Floats]:
    """Return poses of a member in every mode at its anchor, which stands at `at` (4,), and a little along and out of them.

    What belongs to a wall, and stands across the room from its anchor, is at the wall behind the mode.
    """
    modes = mode_poses(anchor, at, item, target, learnt)
    if item.habit.must:
        across = [
            at_wall(item, np.insert(m, 2, target[2]), site.walls, ACROSS, settings.turn_cost, FACING) if other_wall(m[2] - at[3]) else m
            for m in modes
        ]
        modes = np.array([m[[0, 1, -1]] for m in across if m is not None]).reshape(-1, 3)
    if not len(modes):
        return np.zeros((0, 4)), np.zeros(0)
    c, s = math.cos(at[3]), math.sin(at[3])
    apart = modes[:, :2] - at[:2]
    local = np.column_stack([c * apart[:, 0] + s * apart[:, 1], c * apart[:, 1] - s * apart[:, 0]])
    beyond = np.abs(local) - anchor.half  # the side on which it stands is the one that it is farther out of
    out = np.where((beyond[:, 0] > beyond[:, 1])[:, None], np.sign(local) * [1, 0], np.sign(local) * [0, 1])
    along = np.stack([-out[:, 1], out[:, 0]], 1)
    outwards = np.concatenate([OUT, DRAWN_OUT]) if anchor.shape.opens else OUT
    steps = out[:, None, None] * outwards[None, None, :, None] + along[:, None, None] * ALONG[None, :, None, None]
    spots = (local[:, None, None] + steps).reshape(-1, 2)
    points = at[:2] + np.column_stack([c * spots[:, 0] - s * spots[:, 1], s * spots[:, 0] + c * spots[:, 1]])
    aside = np.tile(ASIDE * np.abs(ALONG[:, None]) + np.abs(outwards[None]), (len(modes), 1, 1)).ravel()
    yaws = np.repeat(modes[:, 2], len(ALONG) * len(outwards))
    away = np.repeat(np.linalg.norm(modes[:, :2] - target[:2], axis=1), len(ALONG) * len(outwards))
    cost = BESIDE * away + aside + 0.5 * settings.turn_cost * yaw_difference(yaws, float(target[3]))
    return cheapest_first(_stack_poses(points, yaws, target[2]), cost)


def _along_walls(item: Item, target: Floats, walls: Sequence[Edge], neighbours: Floats) -> tuple[Floats, Floats]:
    """Return poses with the back to each wall: at a stride, at the target, at corners, flush with neighbours."""
    poses, costs = [np.zeros((0, 4))], [np.zeros(0)]
    w, d = item.half
    gap = item.habit.gap[1]
    for edge in walls:
        if edge.length < 2 * w + 2 * SEAM:
            continue
        wished = float(edge.along_of(target[:2]))
        stops = [
            np.arange(w + SEAM, edge.length - w, STRIDE),
            np.array([w + SEAM, edge.length - w - SEAM, wished, wished - 0.05, wished + 0.05]),
        ]
        if len(neighbours):
            near = edge.off(neighbours)
            s = edge.along_of(neighbours)[near.min(1) < 2 * d]
            stops += [s.min(1) - w - SEAM, s.max(1) + w + SEAM]
        stops += [np.array([opening.start - w - SEAM, opening.end + w + SEAM]) for opening in edge.openings]
        places = np.concatenate(stops)
        places = np.unique(np.round(places[(places >= w) & (places <= edge.length - w)], 4))
        points = edge.start + places[:, None] * edge.along + (d + gap) * edge.inward
        cost = np.linalg.norm(points - target[:2], axis=1) + opening_cost(item, places, edge.openings)
        poses.append(_stack_poses(points, np.full(len(places), edge.yaw), target[2])[np.isfinite(cost)])
        costs.append(cost[np.isfinite(cost)])
    return np.concatenate(poses), np.concatenate(costs)


def _at_wall(item: Item, pose: Floats, walls: Sequence[Edge]) -> bool:
    """Whether an object has its back at a wall."""
    back = pose[:2] + np.array([-math.sin(pose[3]), math.cos(pose[3])]) * item.half[1]
    return any(yaw_difference(edge.yaw, float(pose[3])) < 0.1 and abs(float(edge.off(back))) <= 2 * item.habit.gap[2] for edge in walls)


def hides(item: Item, pose: Floats, site: Site) -> bool:
    """Whether an object at a pose (4,) hides a window, or leans on a wall that is not there."""
    return bool(_opening_cost(item, pose[None], site.walls)[0] > 0.0)


def _opening_cost(item: Item, poses: Floats, walls: Sequence[Edge]) -> Floats:
    """Return what standing before openings costs at poses with the target's yaw: windows are not hidden, and what belongs to a wall needs one."""
    cost = np.zeros(len(poses))
    for edge in walls:
        openings = [
            opening
            for opening in edge.openings
            if (hides_window(item, opening) and item.habit.kind != "bed") or (item.habit.must and not opening.window)
        ]
        if openings and yaw_difference(edge.yaw, float(poses[0, 3])) < 0.1:
            near = edge.off(poses[:, :2]) < item.half[1] + 0.3
            cost[near] += opening_cost(item, edge.along_of(poses[near, :2]), openings)
    return cost


def _rank_poses(item: Item, poses: Floats, costs: Floats, site: Site) -> tuple[Floats, Floats]:
    """Return poses rounded, the cheapest first; what hangs on walls is tried at other heights as well."""
    if item.mount == "wall":
        wished = height(item, site, float(item.wished[2]))
        levels = sorted({round(height(item, site, z), 4) for z in (wished, site.elevation + 1.4, site.elevation + 1.6)})
        poses, costs = np.repeat(poses, len(levels), axis=0), np.repeat(costs, len(levels))
        poses[:, 2] = np.tile(levels, len(poses) // len(levels))
        costs = costs + np.abs(poses[:, 2] - wished)
    poses, costs = cheapest_first(poses, costs)
    poses[:, :3] = np.round(poses[:, :3], 4) + 0.0
    return poses, costs


def cheapest_first(poses: Floats, costs: Floats) -> tuple[Floats, Floats]:
    """Return poses (C, 4) and costs (C,) in the order of the costs."""
    order = np.argsort(np.round(costs, 9), kind="stable")
    return np.ascontiguousarray(poses[order]), costs[order]


def _stack_poses(points: Floats, yaws: Floats, z: float) -> Floats:
    return np.column_stack([points, np.full(len(points), z), yaws])
