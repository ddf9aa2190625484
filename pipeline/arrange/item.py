"""One object while it is being arranged: its placement, what it takes of the room, what is expected of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.shapes import Shape, shape
from pipeline.arrange.traits import Trait, mount, trait
from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Item:
    """An object: `wished` (x, y, z, yaw) is where the layout model wants it, whatever becomes of `placement`."""

    placement: Placement
    shape: Shape
    trait: Trait
    mount: str
    wished: Floats

    @property
    def half(self) -> Floats:
        """Half extents (2,) in plan [m]."""
        return self.placement.size[:2] / 2

    @property
    def pose(self) -> Floats:
        """Where it stands (x, y, z, yaw)."""
        return np.array([*self.placement.position, self.placement.yaw])

    def at(self, pose: Floats) -> Item:
        """Return the item at another pose."""
        return replace(self, placement=replace(self.placement, position=pose[:3].copy(), yaw=float(pose[3])))


def make_item(placement: Placement, assets: Mapping[str, Asset], access_depth: float) -> Item:
    """Prepare a placement."""
    asset = assets[placement.asset_id]
    wished = np.array([*placement.position, placement.yaw])
    kind = trait(placement.category)
    return Item(placement, shape(asset, placement.scale, access_depth, kind.access), kind, mount(placement.category), wished)


def wrapped(yaw: float) -> float:
    """Return a yaw in (-pi, pi], rounded as poses are (1e-5 rad)."""
    found = round(math.remainder(yaw, 2 * math.pi), 5)
    return 3.14159 if found <= -3.14159 else found


def turned(a: Floats | float, b: float) -> Floats:
    """Return the absolute difference of yaws [rad], at most pi."""
    difference = np.abs(np.asarray(a, float) - b) % (2 * math.pi)
    smaller: Floats = np.minimum(difference, 2 * math.pi - difference)
    return smaller
