"""What models give: asset files, and rows of assets, asset_joints and asset_parts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from pipeline.entities.asset import Asset
from pipeline.entities.files import save_asset
from pipeline.geometry.kinematics import handle_point, sweep_box
from pipeline.sources.densities import density
from pipeline.sources.identity import split_of
from pipeline.sources.masses import clamp_mass
from pipeline.sources.reasons import Row, SourceError, reject

STEPS = 9  # positions of a joint's range whose boxes are united


@dataclass(slots=True)
class LibraryRows:
    """Rows of models; `models` is what houses need to know of each, by its id in the source."""

    assets: list[Row] = field(default_factory=list)
    joints: list[Row] = field(default_factory=list)
    parts: list[Row] = field(default_factory=list)
    rejects: list[Row] = field(default_factory=list)
    models: dict[str, Any] = field(default_factory=dict)

    def add(self, other: LibraryRows) -> None:
        """Append what another gave."""
        self.assets += other.assets
        self.joints += other.joints
        self.parts += other.parts
        self.rejects += other.rejects
        self.models.update(other.models)

    def keep(self, folder: Path, asset: Asset, scale: Scale, material: str = "", matter: str = "") -> None:
        """Write an asset into `folder`, and its rows; `matter` is the material by which its density was chosen.

        A mass by volume is held to what such things weigh; a URDF to scale may state its own.
        """
        asset, heavier = (asset, 1.0) if asset.source == "urdf" else clamp_mass(asset)
        file = f"{asset.asset_id}.safetensors"
        digest = save_asset(folder / file, asset)
        split = split_of(asset.source_id)
        self.assets.append(
            asset_row(asset, material=material, matter=matter, split=split, scale=scale, file=file, sha256=digest, heavier=heavier)
        )
        self.joints += joint_rows(asset)
        self.parts += part_rows(asset)

    def guard(self, where: str, work: Callable[[], None]) -> LibraryRows:
        """Do the work on one model; what goes wrong in it becomes a reject of it."""
        try:
            work()
        except SourceError as error:
            self.rejects.append(reject("model", where, error.code, f"{error.where}: {error.detail}"))
        except MemoryError:
            raise  # the budget's business
        except Exception as error:  # noqa: BLE001 - one bad file of thousands must not end the run; the table tells
            self.rejects.append(reject("model", where, "internal", f"{type(error).__name__}: {error}"))
        return self


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
