"""Where things can stand on and in furniture: the level tops of its convex pieces, boards inside and drawers' floors included."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline import taxonomy
from pipeline.arrays import Floats
from pipeline.entities.asset import Asset, Link
from pipeline.geometry.convex import hull, rectangle_in
from pipeline.geometry.memo import cached_on_asset
from pipeline.geometry.prisms import Prisms, solid

FLAT = 1e-3  # vertices within this height of a piece's highest lie on its top [m]
LEAST = 0.07  # narrowest top that anything stands on [m]
LOWEST, HIGHEST = 0.03, 1.75  # tops within these heights above the furniture's foot are used [m]
SOFT = 0.03  # the same for what is upholstered, whose cushions swell a little [m]
UPHOLSTERED = frozenset({"sofa", "bed", "chair", "stool"})  # super-categories
SEEN = 0.004  # a top is there to see if the visual meshes come this near to it [m]
GRID = 5  # points per side at which that is looked at
ABOVE = 0.35  # a top with so much air above it is open [m]
DRAWER = "slider_drawer"


@dataclass(frozen=True, slots=True)
class Surfaces:
    """Level rectangles of an asset at rest, object frame [m]: `tops` (m, 5) x0, y0, x1, y1, z; `link` (m,) that bears each.

    `hidden` (m,): in a drawer, or behind a door that stands shut.
    """

    tops: Floats
    link: NDArray[np.int64]
    hidden: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.tops)


@cached_on_asset
def surfaces(asset: Asset) -> Surfaces:
    """Return the surfaces of an asset: of its base, and of drawers that slide out of it. They are kept while the process lives."""
    drawers = {j.child for j in asset.joints if j.part_class == DRAWER and j.parent == 0 and abs(float(j.axis[2])) < 0.1}
    rest = solid(asset).rest
    flat = rest.boxes()
    known = taxonomy.load().categories.get(asset.category)
    swell = SOFT if known is not None and known.super in UPHOLSTERED else FLAT
    tolerance = max(swell, SEEN)
    tops, links, hidden = [], [], []
    for number in (0, *sorted(drawers)):
        link = asset.links[number]
        level: Floats | None = None
        for piece in link.colliders or link.visuals:
            vertices = np.asarray(piece.vertices, np.float64)
            low, high = vertices.min(0), vertices.max(0)
            if not LOWEST < high[2] < HIGHEST or (high - low)[:2].min() < LEAST:
                continue
            top = level_top(vertices, swell)
            if top is None:
                continue
            level = _level(link, tolerance) if level is None else level
            access = _access(rest, flat, top, float(asset.size[1]), inside=number != 0) if _covers_top(level, top, tolerance) else ""
            if access:
                tops.append(top)
                links.append(number)
                hidden.append(access == "hidden")
    return Surfaces(np.array(tops).reshape(-1, 5), np.array(links, np.int64), np.array(hidden, np.bool_))


def level_top(vertices: Floats, flat: float = FLAT) -> tuple[float, float, float, float, float] | None:
    """Return the largest of some rectangles, square to the axes, on the level top of a convex piece (V, 3), level to `flat` [m]; None if it is narrow."""
    z = float(vertices[:, 2].max()) if len(vertices) else 0.0
    upper = vertices[vertices[:, 2] > z - flat, :2]
    outline = hull(np.ascontiguousarray(np.round(upper, 6))) if len(upper) > 2 else upper
    if len(outline) < 3:
        return None
    inside = rectangle_in(outline, LEAST)
    return (*inside, z) if inside else None


def _level(link: Link, tolerance: float) -> Floats:
    """Return the level triangles (T, 3, 3), to 2 `tolerance` [m], of a link's visuals, counter-clockwise seen from above: files wind them either way."""
    corners = np.concatenate([np.asarray(m.vertices, np.float64)[m.faces] for m in link.visuals] or [np.zeros((0, 3, 3))])
    if len(corners):
        corners = corners[np.ptp(corners[:, :, 2], axis=1) < 2 * tolerance]
    turn = _cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.concatenate([corners[turn > 1e-12], corners[turn < -1e-12][:, ::-1]])


def _covers_top(level: Floats, top: Sequence[float], tolerance: float) -> bool:
    """Tell whether a surface within `tolerance` [m] of it is there to see all over a top: a hull may span what is open."""
    near = level[(np.abs(level[:, :, 2] - top[4]) < tolerance).all(1)]
    if not len(near):
        return False
    x, y = (np.linspace(top[k], top[k + 2], GRID + 2)[1:-1] for k in (0, 1))
    points = np.stack(np.meshgrid(x, y), -1).reshape(-1, 1, 2)
    a, b, c = (near[None, :, k, :2] for k in range(3))
    inside = (_cross(b - a, points - a) >= -1e-9) & (_cross(c - b, points - b) >= -1e-9) & (_cross(a - c, points - c) >= -1e-9)
    return bool(inside.any(1).all())


def _cross(u: Floats, v: Floats) -> Floats:
    product: Floats = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return product


def _access(rest: Prisms, flat: Floats, top: Sequence[float], depth: float, *, inside: bool) -> str:
    """Return how one gets at a top: "open" from above or from the front, "hidden" where only a mover is in the way, else ""."""
    x0, y0, x1, y1, z = top
    cx, cy = (x0 + x1) / 2, (y0 + y1) / 2
    dx, dy = 0.3 * (x1 - x0), 0.3 * (y1 - y0)
    if inside:
        return "hidden"
    if not _in_box(rest, flat, (cx - dx, cy - dy, z + 0.005), (cx + dx, cy + dy, z + ABOVE)).any():
        return "open"
    before = _in_box(rest, flat, (cx - dx, -depth / 2 - 0.05, z + 0.01), (cx + dx, cy, z + 0.06))
    if not before.any():
        return "open"
    return "" if (rest.part[before] == 0).any() else "hidden"


def _in_box(prisms: Prisms, flat: Floats, low: Sequence[float], high: Sequence[float]) -> NDArray[np.bool_]:
    apart = (flat[:, 0] >= high[0]) | (flat[:, 2] <= low[0]) | (flat[:, 1] >= high[1]) | (flat[:, 3] <= low[1])
    return ~apart & (prisms.z[:, 0] < high[2]) & (prisms.z[:, 1] > low[2])
