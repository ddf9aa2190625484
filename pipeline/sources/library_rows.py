"""Rows of assets and asset_joints."""

from __future__ import annotations

import numpy as np

from pipeline.entities.asset import Asset
from pipeline.geometry.kinematics import handle_point, sweep_box
from pipeline.sources.reasons import Row

STEPS = 9  # positions of a joint's range whose boxes are united


def asset_row(asset: Asset, *, material: str, split: str, unit_scale: float, file: str, sha256: str) -> Row:
    """Return the row of the assets table; `unit_scale` is the factor from the source's units to metres."""
    return {
        "asset_id": asset.asset_id,
        "source": asset.source,
        "source_id": asset.source_id,
        "category": asset.category,
        "super_category": asset.super_category,
        "style": asset.style,
        "material": material,
        "split": split,
        "size": asset.size.tolist(),
        "unit_scale": unit_scale,
        "articulated": asset.articulated,
        "openable": asset.openable,
        "joints": len(asset.joints),
        "triangles": int(sum(len(m.faces) for m in asset.meshes())),
        "mass": round(float(sum(link.mass for link in asset.links)), 4),
        "licence": asset.licence,
        "file": file,
        "sha256": sha256,
    }


def joint_rows(asset: Asset) -> list[Row]:
    """Return one row per joint of an asset."""
    return [_joint_row(asset, k) for k in range(len(asset.joints))]


def _joint_row(asset: Asset, index: int) -> Row:
    joint = asset.joints[index]
    low, high = np.round(np.asarray(sweep_box(asset, index, STEPS), dtype=np.float64), 4)
    return {
        "asset_id": asset.asset_id,
        "joint_id": joint.name,
        "type": joint.type,
        "part_class": joint.part_class,
        "axis": joint.axis.tolist(),
        "origin": joint.origin.tolist(),
        "lower": joint.lower,
        "upper": joint.upper,
        "sweep_min": low.tolist(),
        "sweep_max": high.tolist(),
        "handle": np.round(handle_point(asset, index), 4).tolist(),
    }
