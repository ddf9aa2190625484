"""Triangles of posed assets: links moved by their joints, then placed in the world."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.asset import Asset, Joint
from pipeline.rendering.boxes import triangles

FREE_TURN = math.pi / 2  # how far a joint without limits turns when it is shown open [rad]


def motion(joint: Joint, value: float) -> NDArray[np.float64]:
    """Return the transform (4, 4) of the child in the object frame when the joint alone stands at `value` [rad or m]."""
    T = np.eye(4)
    if joint.type == "prismatic":
        T[:3, 3] = joint.axis * value
        return T
    x, y, z = joint.axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    T[:3, :3] = np.eye(3) + math.sin(value) * K + (1 - math.cos(value)) * K @ K  # Rodrigues
    T[:3, 3] = joint.origin - T[:3, :3] @ joint.origin
    return T


def link_transforms(asset: Asset, values: Mapping[str, float]) -> list[NDArray[np.float64]]:
    """Return T_object_link (4, 4) of every link, against its pose at rest, with joints at `values` by name (0 elsewhere)."""
    found = [np.eye(4) for _ in asset.links]
    for joint in asset.joints:
        found[joint.child] = found[joint.parent] @ motion(joint, values.get(joint.name, 0.0))
    return found


def opened(asset: Asset, fraction: float) -> dict[str, float]:
    """Return joint values with doors, drawers and lids at `fraction` of their range; knobs and buttons stay."""
    openers = {"hinge_door", "slider_drawer", "hinge_lid", "slider_lid"}
    return {j.name: fraction * (j.upper if math.isfinite(j.upper) else FREE_TURN) for j in asset.joints if j.part_class in openers}


def placement_transform(
    position: NDArray[np.float64], yaw: float, scale: NDArray[np.float64] | None = None
) -> NDArray[np.float64]:
    """Return T_world_object (4, 4): scale, then yaw about +Z, then translation."""
    c, s = math.cos(yaw), math.sin(yaw)
    T = np.eye(4)
    T[:3, :3] = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) * (np.ones(3) if scale is None else scale)
    T[:3, 3] = position
    return T


def asset_triangles(asset: Asset, values: Mapping[str, float] | None = None) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Return all visual triangles (T, 3, 3) [m, object frame] and the material of each (T,)."""
    transforms = link_transforms(asset, values or {})
    faces: list[NDArray[np.float64]] = []
    materials: list[NDArray[np.int32]] = []
    for link, T in zip(asset.links, transforms, strict=True):
        for mesh in link.visuals:
            moved = triangles(mesh)
            if values:
                moved = moved @ T[:3, :3].T + T[:3, 3]
            faces.append(moved)
            materials.append(np.full(len(moved), mesh.material, np.int32))
    if not faces:
        return np.zeros((0, 3, 3)), np.zeros(0, np.int32)
    return np.concatenate(faces), np.concatenate(materials)


def colours(asset: Asset, *, display: bool = True) -> NDArray[np.float32]:
    """Return the base colour (M, 3) of each material, sRGB encoded for `display`."""
    linear = np.array([m.base_color for m in asset.materials] or [(0.8, 0.8, 0.8)], np.float32)
    if not display:
        return linear
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-6) ** (1 / 2.4) - 0.055).astype(np.float32)
