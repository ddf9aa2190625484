"""What an asset takes of a room: its body, the space its parts move through, the place in front of them."""

from dataclasses import dataclass

import numpy as np

from pipeline.arrays import Floats
from pipeline.entities.asset import Asset, Joint
from pipeline.geometry.convex import hull
from pipeline.geometry.kinematics import OPENERS, grips
from pipeline.geometry.memo import cached_on_asset
from pipeline.geometry.prisms import Prisms, Sweep, join_prisms, prism, solid

BEDSIDE = 0.6  # at the sides of a bed, the length at its head that is left to nightstands [m]
STRIDE = 3  # steps of a hinge that are covered by one prism


@dataclass(frozen=True, slots=True)
class Grip:
    """A handle in plan: where (2,) [m] and which way (2,) it sets off, object frame; and what the part sweeps."""

    point: Floats
    heading: Floats
    swept: Prisms


@dataclass(frozen=True, slots=True)
class Shape:
    """All in the object frame, scaled: `body` at rest, `keep` what joints sweep, `access` where one comes to it.

    `grips` are the handles of doors, drawers and lids; `access` is then the place before them. `outline` (n, 2) is the convex hull of the body in plan.
    """

    body: Prisms
    keep: Prisms
    access: Prisms
    grips: tuple[Grip, ...]
    outline: Floats

    @property
    def opens(self) -> bool:
        """Whether it has doors, drawers or lids."""
        return bool(self.grips)


def shape(asset: Asset, scale: Floats, access_depth: float, access: str = "") -> Shape:
    """Return the shape of an asset at a scale; it is kept while the process lives, where nothing is scaled."""
    if np.any(scale != 1.0):
        return make_shape(asset, scale, access_depth, access)
    own = _shape_cache(asset)
    key = (access_depth, access)
    if key not in own:
        own[key] = make_shape(asset, scale, access_depth, access)
    return own[key]


@cached_on_asset
def _shape_cache(_: Asset) -> dict[tuple[float, str], Shape]:
    return {}


def make_shape(asset: Asset, scale: Floats, access_depth: float, access: str) -> Shape:
    """Compute the shape of an asset at a scale.

    `access_depth` [m] is the place kept free beyond opened parts; what does not open gets half of it where people come
    to it: before its front ("front") or at both its sides ("sides").
    """
    asset_solid = solid(asset)
    origin = np.zeros(3)
    body = asset_solid.rest.placed(origin, 0.0, scale)
    keep = join_prisms([p for sweep, j in zip(asset_solid.sweeps, asset.joints, strict=True) for p in _coarse(sweep, j)]).placed(
        origin, 0.0, scale
    )
    handles = tuple(
        Grip(point[:2] * scale[:2], heading, sweep.prisms.placed(origin, 0.0, scale))
        for (point, heading), sweep, j in zip(grips(asset), asset_solid.sweeps, asset.joints, strict=True)
        if j.part_class in OPENERS
    )
    places = _access(join_prisms([g.swept for g in handles]), asset, scale, access_depth)
    if not len(places) and access:
        places = _approach(asset.size * scale, access_depth / 2, sides=access == "sides")
    points = body.corners.reshape(-1, 2) if len(body) else np.zeros((1, 2))
    return Shape(body, keep, places, handles, hull(np.ascontiguousarray(points)))


def _coarse(sweep: Sweep, joint: Joint) -> list[Prisms]:
    """Cover a sweep by few prisms: for sliders one, for hinges one per `STRIDE` steps."""
    covers = []
    steps = len(sweep.reached)
    stride = max(steps, 1) if joint.type == "prismatic" else STRIDE
    for first in range(0, steps, stride):
        own = np.flatnonzero((sweep.prisms.part >= first) & (sweep.prisms.part < first + stride))
        if not len(own):
            continue
        flat = sweep.prisms.corners[own].reshape(-1, 2)
        low, high = sweep.prisms.z[own, 0].min(), sweep.prisms.z[own, 1].max()
        points = np.concatenate([np.column_stack([flat, np.full(len(flat), z)]) for z in (low, high)])
        cover = prism(points)
        if cover is not None:
            covers.append(cover)
    return covers


def _access(swept: Prisms, asset: Asset, scale: Floats, depth: float) -> Prisms:
    """Return the box before the front, as wide as the asset, from its face to `depth` beyond what opens."""
    if not len(swept):
        return join_prisms([])
    w, d = float(asset.size[0] * scale[0]) / 2, float(asset.size[1] * scale[1]) / 2
    return _box((-w, min(float(swept.corners[..., 1].min()), -d) - depth), (w, -d))


def _approach(size: Floats, depth: float, *, sides: bool) -> Prisms:
    """Return boxes of `depth` before the front, or at both sides."""
    w, d = float(size[0]) / 2, float(size[1]) / 2
    if not sides:
        return _box((-w, -d - depth), (w, -d))
    back = max(d - BEDSIDE, -d + 0.1)
    return join_prisms([_box((-w - depth, -d), (-w, back)), _box((w, -d), (w + depth, back))])


def _box(low: tuple[float, float], high: tuple[float, float]) -> Prisms:
    """Return one prism over a rectangle, as high as a person needs it."""
    block = prism(np.array([[x, y, z] for z in (0.02, 1.4) for x in (low[0], high[0]) for y in (low[1], high[1])]))
    return join_prisms([]) if block is None else block
