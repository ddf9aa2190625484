"""Where the objects of a draft would stand if what it nearly holds were exact: at their anchors, at walls, square to them."""

import math
from collections.abc import Sequence

import numpy as np

from pipeline.arrange.bonds import Bond, at_anchor, find_bond
from pipeline.arrange.item import Item
from pipeline.arrange.learnt_relations import LearntRelations
from pipeline.arrange.settings import SeparateSettings
from pipeline.arrange.site import Site
from pipeline.arrange.walls import FAR, at_wall, in_corner, square
from pipeline.arrays import Floats

LOOSE = 0.3  # a wall may take a bound object this far from the place at its anchor [m]
ACROSS = 2.0  # and this far what stands across the room from its anchor: a TV stand goes to the wall behind it
FACING = math.radians(45)  # of walls across the room those count that face the anchor, to this turn
HUNG = (0.9, 1.4, 1.6)  # least height of what hangs on walls, and the usual ones [m above the floor]
ON_TOP = 0.4  # what is drafted this near to the top of what it is bound over stands on it [m]


def exact_poses(
    items: Sequence[Item], site: Site, learnt: LearntRelations, settings: SeparateSettings, fixed: dict[int, Floats]
) -> tuple[Floats, list[Bond | None]]:
    """Return the exact pose (N, 4) of each object and its bond; `fixed` are poses that stand already, of kitchen units.

    Larger objects come first: what is bound to them goes where they went.
    """
    poses = np.array([item.wished for item in items]).reshape(-1, 4)
    bonds: list[Bond | None] = [None] * len(items)
    for i in sorted(range(len(items)), key=lambda i: (-items[i].area, i)):
        if i in fixed:
            poses[i] = fixed[i]
            continue
        for wished in (items[i].wished, _alone(items[i], site, settings)):  # who has come to a wall may find its anchor there
            bond = find_bond(i, items, wished, poses, learnt)
            pose = None if bond is None else _pose_at_anchor(items[i], bond, items, poses, site, settings)
            bonds[i], poses[i] = (bond, wished) if pose is None else (bond, pose)
            if pose is not None:
                break
    return poses, bonds


def _pose_at_anchor(item: Item, bond: Bond, items: Sequence[Item], poses: Floats, site: Site, settings: SeparateSettings) -> Floats | None:
    """Return the pose at the anchor, the back at the wall where it belongs to one; None where no wall is where its anchor wants it."""
    x, y, yaw = at_anchor(poses[bond.anchor], bond.local)
    pose = np.array([x, y, height(item, site, float(item.wished[2])), yaw])
    if bond.over:
        anchor = items[bond.anchor].placement
        top = float(poses[bond.anchor, 2] + anchor.size[2]) + 0.001
        if item.mount == "wall" and abs(top - item.wished[2]) < ON_TOP:
            pose[2] = top
        return pose
    if item.mount != "floor" or not item.habit.must:
        return pose
    if not bond.rigid:
        return at_wall(item, pose, site.walls, ACROSS, settings.turn_cost, FACING)
    flush = at_wall(item, pose, site.walls, LOOSE, settings.turn_cost)
    if flush is None:
        return pose
    back = np.array([-math.sin(flush[3]), math.cos(flush[3])])
    depth = float((flush[:2] - pose[:2]) @ back)
    return np.array([*(pose[:2] + depth * back), pose[2], flush[3]])  # beside its anchor, even where the wall ends: then the group moves


def _alone(item: Item, site: Site, settings: SeparateSettings) -> Floats:
    """Return the pose of an object that is bound to none: at the nearest wall if it belongs to one, else square to the walls if nearly so."""
    pose, walls = item.wished.copy(), site.walls
    pose[2] = height(item, site, float(pose[2]))
    if item.habit.wants:
        reach = FAR if item.habit.must else settings.wall_reach
        flush = at_wall(item, pose, walls, 10.0 if item.mount == "wall" else reach, settings.turn_cost)
        if flush is not None:
            return in_corner(flush, item, walls)
    large = item.habit.kind in {"bed", "table", "cabinet", "sofa"} and item.area > 0.5
    pose[3] = square(float(pose[3]), walls, math.pi if large or item.habit.must else math.radians(settings.snap_angle))
    return pose


def height(item: Item, site: Site, wished: float) -> float:
    """Return z: on the floor, under the ceiling, or for what hangs on walls within reach of them."""
    tall = float(item.placement.size[2])
    if item.mount == "floor":
        return site.elevation
    if item.mount == "ceiling":
        return site.ceiling - tall
    low = site.elevation + HUNG[0]
    return float(np.clip(wished, low, max(low, site.ceiling - tall - 0.02)))
