"""Triangles of posed assets: links moved by their joints, then placed in the world."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.asset import Asset
from pipeline.geometry.kinematics import OPENERS, link_transforms
from pipeline.rendering.boxes import triangles

FREE_TURN = math.pi / 2  # how far a joint without limits turns when it is shown open [rad]


def open_joint_values(asset: Asset, fraction: float) -> dict[str, float]:
    """Return joint values with doors, drawers and lids at `fraction` of their range; knobs and buttons stay."""
    return {j.name: fraction * (j.upper if math.isfinite(j.upper) else FREE_TURN) for j in asset.joints if j.part_class in OPENERS}


def placement_transform(position: NDArray[np.float64], yaw: float, scale: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
    """Return T_world_object (4, 4): scale, then yaw about +Z, then translation."""
    c, s = math.cos(yaw), math.sin(yaw)
    T = np.eye(4)
    T[:3, :3] = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) * (np.ones(3) if scale is None else scale)
    T[:3, 3] = position
    return T


def asset_triangles(asset: Asset, values: Mapping[str, float] | None = None) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Return all visual triangles (T, 3, 3) [m, object frame] and the material of each (T,)."""
    transforms = link_transforms(asset, np.array([(values or {}).get(joint.name, 0.0) for joint in asset.joints]))
    faces, materials = [np.zeros((0, 3, 3))], [np.zeros(0, np.int32)]
    for link, T in zip(asset.links, transforms, strict=True):
        for mesh in link.visuals:
            moved = triangles(mesh)
            if values:
                moved = moved @ T[:3, :3].T + T[:3, 3]
            faces.append(moved)
            materials.append(np.full(len(moved), mesh.material, np.int32))
    return np.concatenate(faces), np.concatenate(materials)
