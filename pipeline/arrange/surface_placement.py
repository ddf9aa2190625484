"""Lays small things on and in the furniture of a room: wholly on a level surface, in nobody's way, however doors and drawers move."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from pipeline.arrange.item import wrap_yaw
from pipeline.arrange.settings import ThingsSettings
from pipeline.arrange.surfaces import HIGHEST, Surfaces, surfaces
from pipeline.arrays import Floats
from pipeline.entities.asset import Asset
from pipeline.entities.home import Placement
from pipeline.geometry.contact import Groups, wall_excesses
from pipeline.geometry.convex import hull
from pipeline.geometry.kinematics import moved_links, rotation
from pipeline.geometry.memo import cached_on_asset
from pipeline.geometry.prisms import Prisms, join_prisms, prism, solid

UNIT = np.ones(3)
BACKED = 0.3  # share of a surface's depth, from its back, that is for what lies there
HEADROOM = 0.01  # above what a drawer carries [m]: a bottle that fits to the millimetre wedges under the worktop as the drawer jolts
STEADY = 0.7  # of what rides in a drawer: the way from below its centre of mass to the edge of its foot, as a share of that one's height. By dry friction it then slides before it tips
FOOT = 0.002  # [m] above its lowest point: what is lower is its foot
WOBBLE = 0.1  # spread of the yaw of what has a front [rad]


class SurfacePlacement:
    """A room whose furniture stands. Things are added one by one; nothing is taken away."""

    def __init__(
        self, polygon: Floats, furniture: Sequence[Placement], assets: Mapping[str, Asset], settings: ThingsSettings, touch: float
    ) -> None:
        self.polygon = np.ascontiguousarray(polygon, np.float64)
        self.furniture, self.assets, self.settings, self.touch = furniture, assets, settings, touch
        self.solids = [solid(assets[p.asset_id]) for p in furniture]
        self.rest = Groups.of([s.rest.placed(p.position, p.yaw, p.scale) for s, p in zip(self.solids, furniture, strict=True)])
        joints = [(g, k) for g, s in enumerate(self.solids) for k in range(len(s.sweeps))]
        self.joints = {key: n for n, key in enumerate(joints)}
        self.sweeps = Groups.of(
            [self.solids[g].sweeps[k].prisms.placed(furniture[g].position, furniture[g].yaw, furniture[g].scale) for g, k in joints]
        )
        self.laid = Groups.of([])
        self.laid_sweeps = Groups.of([])
        self._taken: dict[int, list[Floats]] = {}

    def fix(self, placements: Sequence[Placement]) -> None:
        """Take in things that hang or stand already, and bear nothing."""
        prisms = [solid(self.assets[p.asset_id]).rest.placed(p.position, p.yaw, p.scale) for p in placements]
        self.laid = self.laid.plus(prisms)

    def lay(
        self, rng: np.random.Generator, asset: Asset, support: int, *, facing: bool, centred: bool = False, backed: bool = False
    ) -> tuple[Floats, float] | None:
        """Find a place for an asset on furniture `support` (index); return position (3,) [m] and yaw [rad], None if there is none.

        `facing`: it looks where its support looks; `centred`: the middles of surfaces, the highest first, are tried before others;
        `backed`: it lies towards their backs. Open surfaces are preferred to what lies behind doors and in drawers.
        """
        placement = self.furniture[support]
        support_surfaces = surfaces(self.assets[placement.asset_id])
        turn = float(rng.normal(0, WOBBLE) if facing else rng.uniform(-math.pi, math.pi))
        tops = self._candidates(rng, support_surfaces, placement, asset.size, turn, backed=backed)
        for top, x, y in (self._middles(support_surfaces, placement, asset.size, turn) + tops) if centred else tops:
            z = float(support_surfaces.tops[top, 4] * placement.scale[2])
            if self._meets_box(support, asset.size, (x, y, z), turn):
                continue
            yaw = wrap_yaw(placement.yaw + turn)
            c, s = math.cos(placement.yaw), math.sin(placement.yaw)
            position = np.round(placement.position + np.array([c * x - s * y, s * x + c * y, z]), 4) + 0.0
            if self._free(asset, position, yaw, support, int(support_surfaces.link[top])):
                self._add(asset, position, yaw)
                self._taken.setdefault(support, []).append(_box(asset.size, (x, y, z), turn, self.settings.margin))
                return position, yaw
        return None

    def _candidates(
        self, rng: np.random.Generator, support_surfaces: Surfaces, support: Placement, size: Floats, turn: float, *, backed: bool
    ) -> list[tuple[int, float, float]]:
        """Draw (surface, x, y) at which the thing lies wholly on a surface, object frame of the support."""
        if not len(support_surfaces):
            return []
        half, margin = _half_extents(size, turn), self.settings.margin
        first = support_surfaces.tops[:, :2] * support.scale[:2] + half + margin
        last = support_surfaces.tops[:, 2:4] * support.scale[:2] - half - margin
        open_weight = _within_reach(support_surfaces, support)
        weight = np.where(support_surfaces.hidden, self.settings.hidden, open_weight) * (last >= first).all(1)
        if weight.sum() <= 0:
            return []
        which = rng.choice(len(weight), self.settings.tries, p=weight / weight.sum())
        spots = rng.uniform(first[which], last[which])
        if backed:
            spots[:, 1] = last[which, 1] - BACKED * (last[which, 1] - spots[:, 1])
        return [(int(k), float(x), float(y)) for k, (x, y) in zip(which, spots, strict=True)]

    @staticmethod
    def _middles(support_surfaces: Surfaces, support: Placement, size: Floats, turn: float) -> list[tuple[int, float, float]]:
        """Return (surface, x, y) of the middles of the open surfaces that are wide enough, the highest first."""
        extent = (support_surfaces.tops[:, 2:4] - support_surfaces.tops[:, :2]) * support.scale[:2]
        middle = (support_surfaces.tops[:, 2:4] + support_surfaces.tops[:, :2]) * support.scale[:2] / 2
        fits = np.flatnonzero(
            (extent >= 2 * _half_extents(size, turn)).all(1) & ~support_surfaces.hidden & _within_reach(support_surfaces, support)
        )
        return [
            (int(k), float(middle[k, 0]), float(middle[k, 1])) for k in fits[np.argsort(-support_surfaces.tops[fits, 4], kind="stable")]
        ]

    def _meets_box(self, support: int, size: Floats, at: tuple[float, float, float], turn: float) -> bool:
        """Tell whether a thing's box meets that of another thing on the same furniture."""
        box = _box(size, at, turn, 0.0)
        return any(bool(np.all(box[0] < other[1]) and np.all(box[1] > other[0])) for other in self._taken.get(support, ()))

    def _free(self, asset: Asset, position: Floats, yaw: float, support: int, link: int) -> bool:
        """Tell whether a thing stands free there, no joint sweeps through it, and its own joints move."""
        asset_solid = solid(asset)
        rest = asset_solid.rest.placed(position, yaw, UNIT)
        if not len(rest) or self.rest.hit(rest, self.touch) or self.laid.hit(rest, self.touch) or self._outside(rest):
            return False
        bearer = self.assets[self.furniture[support].asset_id]
        carrying = [k for k in range(len(bearer.joints)) if link in moved_links(bearer, k)]
        if self.sweeps.hit(rest, self.touch, [self.joints[support, k] for k in carrying]) or self.laid_sweeps.hit(rest, self.touch):
            return False
        for sweep in asset_solid.sweeps:
            moved = sweep.prisms.placed(position, yaw, UNIT)
            if self.rest.hit(moved, self.touch) or self.laid.hit(moved, self.touch) or self._outside(moved):
                return False
        return not carrying or (steady(asset) >= STEADY and all(self._rides(rest, support, bearer, k) for k in carrying))

    def _rides(self, rest: Prisms, support: int, bearer: Asset, joint: int) -> bool:
        """Tell whether a thing comes out with the drawer that it lies in, with some room above it."""
        placement, moving = self.furniture[support], bearer.joints[joint]
        way = rotation(np.array([0.0, 0.0, 1.0]), placement.yaw) @ moving.axis * moving.upper
        heights = rest.z + np.array([0.0, HEADROOM])
        ends = [[np.column_stack([rest.polygon(i), np.full(rest.count[i], z)]) for z in heights[i]] for i in range(len(rest))]
        out = join_prisms([p for own in ends if (p := prism(np.concatenate([*own, *(e + way for e in own)]))) is not None])
        body = self.solids[support].rest.placed(placement.position, placement.yaw, placement.scale)
        still = ~np.isin(body.part, moved_links(bearer, joint))
        frame = Prisms(body.corners[still], body.count[still], body.z[still], body.part[still])
        clear = not self.rest.hit(out, self.touch, [support]) and not self.laid.hit(out, self.touch)
        return clear and not Groups.of([frame]).hit(out, self.touch) and not self._outside(out)

    def _outside(self, moved: Prisms) -> bool:
        return bool((wall_excesses(moved.corners, moved.count, self.polygon) > self.touch).any())

    def _add(self, asset: Asset, position: Floats, yaw: float) -> None:
        asset_solid = solid(asset)
        self.laid = self.laid.plus([asset_solid.rest.placed(position, yaw, UNIT)])
        if asset_solid.sweeps:
            self.laid_sweeps = self.laid_sweeps.plus([s.prisms.placed(position, yaw, UNIT) for s in asset_solid.sweeps])


def _within_reach(support_surfaces: Surfaces, support: Placement) -> NDArray[np.bool_]:
    """Tell which surfaces (m,) are low enough above the floor: the top of a wall cabinet is not, though it is of a height with a sideboard's."""
    return np.asarray(support.position[2] + support_surfaces.tops[:, 4] * support.scale[2] < HIGHEST)


@cached_on_asset
def steady(asset: Asset) -> float:
    """Return how far a thing's centre of mass is within the edge of its foot, as a share of its height: it tips where it is held back by more of its weight."""
    points = np.concatenate([piece.vertices for link in asset.links for piece in link.colliders]).astype(np.float64)
    low = float(points[:, 2].min())
    foot = hull(np.ascontiguousarray(np.round(points[points[:, 2] < low + FOOT, :2], 6)))
    mass = np.array([link.mass for link in asset.links])
    x, y, z = mass @ np.array([link.com for link in asset.links]) / mass.sum()
    along = np.roll(foot, -1, 0) - foot
    within = along[:, 0] * (y - foot[:, 1]) - along[:, 1] * (x - foot[:, 0])
    return float((within / np.linalg.norm(along, axis=1)).min() / max(z - low, FOOT))


def _half_extents(size: Floats, turn: float) -> Floats:
    """Return half the extents (2,) of the box around a footprint turned by `turn` about its middle."""
    c, s = abs(math.cos(turn)), abs(math.sin(turn))
    return np.array([c * size[0] + s * size[1], s * size[0] + c * size[1]]) / 2


def _box(size: Floats, at: tuple[float, float, float], turn: float, margin: float) -> Floats:
    half, middle = _half_extents(size, turn), np.array(at[:2])
    return np.array([[*(middle - half - margin), at[2] - margin], [*(middle + half + margin), at[2] + size[2] + margin]])
