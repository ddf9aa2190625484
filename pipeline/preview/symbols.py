"""What a floor plan says in lines: door leaves and their arcs, how far drawers and doors of furniture reach, the entrance."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from PIL import ImageDraw

from pipeline.entities.asset import Asset, Joint
from pipeline.entities.home import Placement
from pipeline.geometry.kinematics import joint_motion
from pipeline.geometry.walls import Cut, Leaf, Shell
from pipeline.rendering.pose import placement_transform

Project = Callable[[NDArray[np.float64]], list[tuple[float, float]]]

LEAF = (120, 78, 44)
ARC = (120, 100, 84)
OPENS = (226, 106, 22)
GLASS = (245, 250, 253)
ENTRANCE = (30, 120, 200)
OPENERS = frozenset({"hinge_door", "slider_drawer", "hinge_lid", "slider_lid"})


def draw_openings(draw: ImageDraw.ImageDraw, shell: Shell, project: Project, line: int) -> None:
    """Draw windows, door leaves standing open with their arcs, and an arrow at the entrance; `line` is a hair line [pixels]."""
    for cut in shell.cuts:
        if cut.opening.kind == "window":
            a, b, c, d = cut.quad
            draw.line(project(np.array([(a + d) / 2, (b + c) / 2])), fill=GLASS, width=2 * line)
        if cut.opening.kind == "entrance":
            _arrow(draw, cut, shell, project)
    for leaf in shell.leaves:
        draw.line(project(swing_arc(leaf)), fill=ARC, width=line)
        draw.polygon(project(leaf.outline(leaf.angle)), fill=LEAF)


def swing_arc(leaf: Leaf, steps: int = 16) -> NDArray[np.float64]:
    """Return the path (steps + 1, 2) [m] of the leaf's outer edge, from closed to open."""
    angles = np.linspace(0, leaf.angle, steps + 1)
    return leaf.hinge + leaf.width * (np.cos(angles)[:, None] * leaf.along + np.sin(angles)[:, None] * leaf.normal)


def draw_reach(draw: ImageDraw.ImageDraw, placement: Placement, asset: Asset, project: Project, line: int) -> None:
    """Outline where each door, drawer and lid of a placed object moves."""
    T = placement_transform(placement.position, placement.yaw, placement.scale)
    for joint in asset.joints:
        if joint.part_class in OPENERS:
            path = reach(asset, joint)
            world = path @ T[:2, :2].T + T[:2, 3]
            draw.line(project(np.concatenate([world, world[:1]])), fill=OPENS, width=line)


def reach(asset: Asset, joint: Joint, steps: int = 10) -> NDArray[np.float64]:
    """Return the outline (n, 2) [m, object frame] of what the joint's child covers in plan on its way: the hull of its poses."""
    from scipy.spatial import ConvexHull, QhullError

    meshes = asset.links[joint.child].visuals or asset.links[joint.child].colliders
    points = np.concatenate([m.vertices for m in meshes]).astype(np.float64)
    low, high = points.min(axis=0), points.max(axis=0)
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    upper = joint.upper if math.isfinite(joint.upper) else math.pi / 2
    poses = [joint_motion(joint, value) for value in np.linspace(0, upper, 2 if joint.type == "prismatic" else steps)]
    covered = np.concatenate([corners @ T[:3, :3].T + T[:3, 3] for T in poses])[:, :2]
    try:
        return covered[ConvexHull(covered).vertices]
    except QhullError:
        return covered[:2]


def _arrow(draw: ImageDraw.ImageDraw, cut: Cut, shell: Shell, project: Project) -> None:
    """Draw a triangle before the entrance, pointing in."""
    inward = next((leaf.normal for leaf in shell.leaves if leaf.opening_id == cut.opening.opening_id), None)
    if inward is None:
        return
    middle = cut.opening.segment.mean(axis=0) - 0.32 * inward
    across = np.array([-inward[1], inward[0]])
    draw.polygon(project(np.array([middle + 0.16 * inward, middle - 0.12 * inward + 0.16 * across, middle - 0.12 * inward - 0.16 * across])), fill=ENTRANCE)
