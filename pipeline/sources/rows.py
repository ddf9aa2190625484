"""What sources give: rows of the training tables by house, asset files and rows of the library by model."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from pipeline.card import cards
from pipeline.entities.asset import Asset
from pipeline.entities.files import save_asset
from pipeline.geometry.kinematics import handle_point, sweep_box
from pipeline.seeds import key
from pipeline.sources.densities import density
from pipeline.sources.reasons import Row, reject

STEPS = 9  # positions of a joint's range whose boxes are united


def split_of(uid: str) -> str:
    """Return train (8 of 10), val or test for a house or model, from its id alone."""
    draw = key(0, "split", uid) % 10
    return "val" if draw == 8 else "test" if draw == 9 else "train"


def slug(prefix: str, name: str) -> str:
    """Return an id that matches [a-z][a-z0-9_]*."""
    return f"{prefix}_{re.sub(r'[^a-z0-9]+', '_', name.lower()).strip('_')}"


@dataclass(slots=True)
class HouseRows:
    """What a house gives; all lists are empty but `rejects` when it is left out. `name` is that of its file.

    `content` is a digest of its rooms and furniture, wherever its file lies and whatever it is called; "" where nobody needs it.
    """

    name: str = ""
    scenes: list[Row] = field(default_factory=list)
    rooms: list[Row] = field(default_factory=list)
    openings: list[Row] = field(default_factory=list)
    objects: list[Row] = field(default_factory=list)
    rejects: list[Row] = field(default_factory=list)
    content: str = ""

    @classmethod
    def refused(cls, where: str, reason: str, detail: str) -> HouseRows:
        """Return what stands for a house that is left out."""
        return cls(rejects=[reject("house", where, reason, detail)])


def number_scenes(parts: Iterable[HouseRows]) -> Iterator[HouseRows]:
    """Yield the rows of all houses, their scenes numbered in order; one that was there before under another name only gives a reject."""
    count = 0
    known: dict[str, str] = {}
    for part in parts:
        first = known.setdefault(part.content, part.name) if part.content else part.name
        if first != part.name:
            of_house = [row for row in part.rejects if row["what"] == "house"]
            yield HouseRows(part.name, rejects=[*of_house, reject("house", part.name, "duplicate_house", f"the same as {first}")])
            continue
        for scene in part.scenes:
            scene["index"] = count
            count += 1
        yield part


@dataclass(frozen=True, slots=True)
class Scale:
    """How an asset came to its size: `factor` from the source's units to metres, from where, and how well it fits there."""

    factor: float
    origin: str = "file"
    rms: float | None = None


@dataclass(slots=True)
class LibraryRows:
    """Rows of models; `models` is what houses need to know of each, by its id in the source."""

    assets: list[Row] = field(default_factory=list)
    joints: list[Row] = field(default_factory=list)
    parts: list[Row] = field(default_factory=list)
    rejects: list[Row] = field(default_factory=list)
    models: dict[str, Any] = field(default_factory=dict)

    @classmethod
    def refused(cls, where: str, reason: str, detail: str) -> LibraryRows:
        """Return what stands for a model that is left out."""
        return cls(rejects=[reject("model", where, reason, detail)])

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
        self.assets.append(
            {
                "asset_id": asset.asset_id,
                "source": asset.source,
                "source_id": asset.source_id,
                "category": asset.category,
                "super_category": asset.super_category,
                "style": asset.style,
                "material": material,
                "split": split_of(asset.source_id),
                "size": asset.size.tolist(),
                "unit_scale": scale.factor,
                "scale_from": scale.origin,
                "scale_rms": None if scale.rms is None else round(scale.rms, 4),
                "articulated": asset.articulated,
                "openable": asset.openable,
                "joints": len(asset.joints),
                "triangles": int(sum(len(m.faces) for m in asset.meshes())),
                "mass": round(mass(asset), 4),
                "density": round(density(asset.super_category, matter, asset.category) * heavier, 3),
                "licence": asset.licence,
                "file": file,
                "sha256": save_asset(folder / file, asset),
            }
        )
        self.joints += [_joint_row(asset, k) for k in range(len(asset.joints))]
        carriers = {joint.child: joint.name for joint in asset.joints}
        self.parts += [
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


def mass(asset: Asset) -> float:
    """Return what all links weigh together [kg]."""
    return float(sum(link.mass for link in asset.links))


def mass_factor(category: str, kilograms: float) -> float:
    """Return by what an estimate is to be multiplied to lie in its category's range: 1 within it, or where none is known."""
    low, high = cards()[category].mass if category in cards() else (kilograms, kilograms)
    return min(max(kilograms, low), high) / kilograms


def clamp_mass(asset: Asset) -> tuple[Asset, float]:
    """Return the asset with its mass in the range of its category, and the factor on all masses and inertias.

    An estimate by volume is no better than the mesh: a shell weighs too little, one whose hollows are filled too much. The ranges
    on the cards are wide: an empty cabinet, a plant with its pot.
    """
    by = mass_factor(asset.category, mass(asset))
    if by == 1.0:
        return asset, by
    return replace(asset, links=tuple(replace(k, mass=round(k.mass * by, 5), inertia=k.inertia * by) for k in asset.links)), by
