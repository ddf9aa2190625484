"""What a floor plan says in lines: door leaves and their arcs, how far drawers and doors of furniture reach, the entrance."""

import math
from collections.abc import Callable

import numpy as np
import shapely
from numpy.typing import NDArray
from PIL import ImageDraw

from pipeline.entities.asset import Asset, Joint
from pipeline.entities.home import Placement
from pipeline.geometry.kinematics import OPENERS, joint_motion
from pipeline.geometry.memo import cached_on_asset
from pipeline.geometry.tiling import polygons
from pipeline.geometry.walls import Cut, Leaf, Shell
from pipeline.rendering.pose import placement_transform

Project = Callable[[NDArray[np.float64]], list[tuple[float, float]]]

LEAF = (120, 78, 44)
ARC = (120, 100, 84)
OPENS = (226, 106, 22)
GLASS = (245, 250, 253)
ENTRANCE = (30, 120, 200)


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


def swing_arc(leaf: Leaf) -> NDArray[np.float64]:
    """Return the path (17, 2) [m] of the leaf's outer edge, from closed to open."""
    angles = np.linspace(0, leaf.angle, 17)
    return leaf.hinge + leaf.width * (np.cos(angles)[:, None] * leaf.along + np.sin(angles)[:, None] * leaf.normal)


def draw_reach(draw: ImageDraw.ImageDraw, placement: Placement, asset: Asset, project: Project, line: int) -> None:
    """Outline where each door, drawer and lid of a placed object moves, as far as that lies before its box."""
    T = placement_transform(placement.position, placement.yaw, placement.scale)
    for ring in reaches(asset):
        draw.line(project(ring @ T[:2, :2].T + T[:2, 3]), fill=OPENS, width=line)


@cached_on_asset
def reaches(asset: Asset) -> tuple[NDArray[np.float64], ...]:
    """Return the outlines (n, 2) [m, object frame] of what doors, drawers and lids cover before the asset's box."""
    w, d = asset.size[0] / 2, asset.size[1] / 2
    body = shapely.box(-w, -d, w, d)
    beyond = (part for joint in asset.joints if joint.part_class in OPENERS for part in polygons(reach(asset, joint).difference(body)))
    return tuple(np.asarray(part.exterior.coords) for part in beyond)


def reach(asset: Asset, joint: Joint, steps: int = 9) -> shapely.Geometry:
    """Return what the joint's child covers in plan on its way [m, object frame]: the hull of the box around it in `steps` poses."""
    meshes = asset.links[joint.child].visuals or asset.links[joint.child].colliders
    points = np.concatenate([m.vertices for m in meshes]).astype(np.float64)
    (x0, y0, z0), (x1, y1, z1) = points.min(axis=0), points.max(axis=0)
    corners = np.array([[x, y, z] for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)])
    upper = joint.upper if math.isfinite(joint.upper) else math.pi / 2
    poses = np.stack([joint_motion(joint, value) for value in np.linspace(0, upper, 2 if joint.type == "prismatic" else steps)])
    covered = np.einsum("tij,pj->tpi", poses[:, :2, :3], corners) + poses[:, None, :2, 3]
    return shapely.convex_hull(shapely.multipoints(covered.reshape(-1, 2)))


def _arrow(draw: ImageDraw.ImageDraw, cut: Cut, shell: Shell, project: Project) -> None:
    """Draw a triangle before the entrance, pointing in."""
    inward = next((leaf.normal for leaf in shell.leaves if leaf.opening_id == cut.opening.opening_id), None)
    if inward is None:
        return
    middle = cut.opening.segment.mean(axis=0) - 0.32 * inward
    across = np.array([-inward[1], inward[0]])
    corners = [middle + 0.16 * inward, middle - 0.12 * inward + 0.16 * across, middle - 0.12 * inward - 0.16 * across]
    draw.polygon(project(np.array(corners)), fill=ENTRANCE)
