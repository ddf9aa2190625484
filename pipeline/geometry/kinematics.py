"""Forward kinematics of assets, and the boxes that their joints sweep.

Everything is in the object frame (origin bottom centre of the box at rest, front -Y). Positive motion opens.
"""

import math

import numpy as np

from pipeline.arrays import Floats
from pipeline.entities.asset import Asset, Joint, Link
from pipeline.geometry.memo import cached_on_asset

HANDLES = ("line_fixed_handle", "round_fixed_handle", "hinge_handle")  # part classes that a hand takes hold of
OPENERS = ("hinge_door", "slider_drawer", "hinge_lid", "slider_lid")  # part classes that open something


def joint_motion(joint: Joint, position: float) -> Floats:
    """Return the transform (4, 4) by which `joint` alone moves its child from rest, at `position` [rad, or units of `origin`]."""
    T = np.eye(4)
    if joint.type == "prismatic":
        T[:3, 3] = joint.axis * position
        return T
    T[:3, :3] = rotation(joint.axis, position)
    T[:3, 3] = joint.origin - T[:3, :3] @ joint.origin
    return T


def rotation(axis: Floats, angle: float) -> Floats:
    """Return the rotation matrix (3, 3) about a unit `axis` (3,) by `angle` [rad] (Rodrigues' formula)."""
    x, y, z = axis
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + math.sin(angle) * K + (1.0 - math.cos(angle)) * (K @ K))


def points_under(motions: Floats, points: Floats) -> Floats:
    """Return points (N, 3) under each of S maps (S, 4, 4): (S, N, 3)."""
    return np.asarray(np.einsum("kij,pj->kpi", motions[:, :3, :3], points) + motions[:, None, :3, 3])


def axis_distances(joint: Joint, points: Floats) -> Floats:
    """Return how far points (N, 3) are from the axis of a joint (N,)."""
    away = points - joint.origin
    return np.asarray(np.linalg.norm(away - np.outer(away @ joint.axis, joint.axis), axis=1))


def link_transforms(asset: Asset, positions: Floats) -> Floats:
    """Return T (L, 4, 4) that carries each link's points from rest to joint `positions` (J,) [rad or m]."""
    T = np.broadcast_to(np.eye(4), (len(asset.links), 4, 4)).copy()
    for joint, position in zip(asset.joints, positions, strict=True):
        T[joint.child] = T[joint.parent] @ joint_motion(joint, float(position))
    return T


def joint_range(joint: Joint) -> tuple[float, float]:
    """Return the limits of a joint [rad or m]; one turn from rest for a joint without limits."""
    lower = joint.lower if math.isfinite(joint.lower) else 0.0
    upper = joint.upper if math.isfinite(joint.upper) else 2 * math.pi
    return lower, upper


def moved_links(asset: Asset, joint_index: int) -> list[int]:
    """Return the links that a joint moves: its child and all that hangs on it, in the order of the joints."""
    moved = [asset.joints[joint_index].child]
    for joint in asset.joints:
        if joint.parent in moved and joint.child not in moved:
            moved.append(joint.child)
    return moved


def link_points(link: Link) -> Floats:
    """Return the vertices (V, 3) [m, object frame at rest] of a link's colliders, or of its visuals if it has none."""
    meshes = link.colliders or link.visuals
    if not meshes:
        return np.zeros((0, 3))
    return np.concatenate([np.asarray(m.vertices, np.float64) for m in meshes])


def sweep_box(asset: Asset, joint_index: int, steps: int = 9) -> Floats:
    """Return the box (2, 3) [m, object frame], lower and upper corner, of all that a joint moves over its range.

    Other joints stay at 0. `steps` positions are taken; what an arc bulges between them is added.
    """
    joint = asset.joints[joint_index]
    points = np.concatenate([link_points(asset.links[i]) for i in moved_links(asset, joint_index)])
    if not len(points):
        return np.array([joint.origin, joint.origin])
    lower, upper = joint_range(joint)
    positions = np.linspace(lower, upper, max(steps, 2))
    motions = np.stack([joint_motion(joint, q) for q in positions])
    moved = points_under(motions, points)
    corners = np.stack([moved.min((0, 1)), moved.max((0, 1))])
    if joint.type != "prismatic":
        bulge = axis_distances(joint, points).max() * (1.0 - math.cos((positions[1] - positions[0]) / 2)) * np.sqrt(1.0 - joint.axis**2)
        corners += np.stack([-bulge, bulge])
    return corners


def beyond_body(sweeps: Floats, size: Floats) -> Floats:
    """Return what swept boxes (J, 2, 3) cover beyond the body's box of `size` (3,) [m, object frame], each past the face that it goes past farthest.

    A door's edge and handle pass beside the body only when they have left its front: the box of the whole way would block its neighbours.
    """
    low, high = np.array([-size[0] / 2, -size[1] / 2, 0.0]), np.array([size[0] / 2, size[1] / 2, size[2]])
    past = np.concatenate([low - sweeps[:, 0], sweeps[:, 1] - high], 1)
    boxes = sweeps.copy()
    for box, face in zip(boxes, past.argmax(1) if len(past) else (), strict=True):
        if face < 3:
            box[1, face] = low[face]
        else:
            box[0, face - 3] = high[face - 3]
    beyond: Floats = boxes[past.max(1, initial=0.0) > 0.0]
    return beyond


def handle_point(asset: Asset, joint_index: int) -> Floats:
    """Return where a hand takes hold (3,) [m, object frame at rest].

    The middle of the handle that moves with the joint, by the box of that part or its mesh; without one, for a slider
    the middle of its face ahead, for a hinge the middle of the moving part's edge farthest from the axis.
    """
    joint = asset.joints[joint_index]
    for i in moved_links(asset, joint_index):
        boxes = [p.centre for p in asset.parts if p.link == i and p.part_class in HANDLES]
        if boxes:
            return np.array(boxes[0], np.float64)
        grips = [m.vertices for m in asset.links[i].visuals if m.part in HANDLES]
        if grips:
            return _middle(np.asarray(grips[0], np.float64))
    points = link_points(asset.links[joint.child])
    if not len(points):
        return joint.origin.copy()
    if joint.type == "prismatic":
        middle = _middle(points)
        ahead = float(((points - middle) @ joint.axis).max())
        return middle + joint.axis * ahead
    radius = axis_distances(joint, points)
    return np.asarray(points[radius > 0.98 * radius.max()].mean(0))


def opening_direction(asset: Asset, joint_index: int) -> Floats:
    """Return the unit direction (3,) in which the handle starts to move when the joint opens [object frame]."""
    joint = asset.joints[joint_index]
    if joint.type == "prismatic":
        return joint.axis.copy()
    start = np.cross(joint.axis, handle_point(asset, joint_index) - joint.origin)
    length = float(np.linalg.norm(start))
    return start / length if length > 1e-9 else np.array([0.0, -1.0, 0.0])


def facing(asset: Asset, joint_index: int) -> Floats:
    """Return the plan direction (2,) from which a part is opened [object frame]: where its handle sets off to.

    For what opens upwards or down, or slides in its own plane, it is the object's front.
    """
    joint = asset.joints[joint_index]
    if joint.type == "prismatic" and joint.part_class == "slider_lid":
        return np.array([0.0, -1.0])
    flat = opening_direction(asset, joint_index)[:2]
    length = float(np.linalg.norm(flat))
    return flat / length if length > 0.5 else np.array([0.0, -1.0])


@cached_on_asset
def grips(asset: Asset) -> tuple[tuple[Floats, Floats], ...]:
    """Return `handle_point` and `facing` of every joint."""
    return tuple((handle_point(asset, k), facing(asset, k)) for k in range(len(asset.joints)))


def _middle(points: Floats) -> Floats:
    return np.asarray((points.min(0) + points.max(0)) / 2)
