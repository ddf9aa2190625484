"""Rows of assets, asset_joints and asset_parts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pipeline.entities.asset import Asset
from pipeline.geometry.kinematics import handle_point, sweep_box
from pipeline.sources.densities import density
from pipeline.sources.reasons import Row

STEPS = 9  # positions of a joint's range whose boxes are united


@dataclass(frozen=True, slots=True)
class Scale:
    """How an asset came to its size: `factor` from the source's units to metres, from where, and how well it fits there."""

    factor: float
    origin: str = "file"
    rms: float | None = None


def asset_row(asset: Asset, *, material: str, matter: str, split: str, scale: Scale, file: str, sha256: str, heavier: float) -> Row:
    """Return the row of the assets table; `matter` is the material by which the density was chosen, `heavier` the factor on it."""
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
        "unit_scale": scale.factor,
        "scale_from": scale.origin,
        "scale_rms": None if scale.rms is None else round(scale.rms, 4),
        "articulated": asset.articulated,
        "openable": asset.openable,
        "joints": len(asset.joints),
        "triangles": int(sum(len(m.faces) for m in asset.meshes())),
        "mass": round(float(sum(link.mass for link in asset.links)), 4),
        "density": round(density(asset.super_category, matter, asset.category) * heavier, 3),
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
        "inferred": not any(p.annotated for p in asset.parts if (p.link, p.part_class) == (joint.child, joint.part_class)),
        "axis": joint.axis.tolist(),
        "origin": joint.origin.tolist(),
        "lower": joint.lower,
        "upper": joint.upper,
        "after": list(joint.after),
        "sweep_min": low.tolist(),
        "sweep_max": high.tolist(),
        "handle": np.round(handle_point(asset, index), 4).tolist(),
    }


def part_rows(asset: Asset) -> list[Row]:
    """Return one row per part box of an asset."""
    carriers = {joint.child: joint.name for joint in asset.joints}
    return [
        {
            "asset_id": asset.asset_id,
            "joint_id": carriers.get(part.link, ""),
            "part_class": part.part_class,
            "annotated": part.annotated,
            "centre": part.centre.tolist(),
            **{f"axis_{name}": axis.tolist() for name, axis in zip("xyz", part.axes, strict=True)},
            "size": part.size.tolist(),
        }
        for part in asset.parts
    ]
