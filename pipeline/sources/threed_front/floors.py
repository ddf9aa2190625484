"""Room outlines from floor triangles (3D-FRONT format: floors come in pieces, with slivers and zero-area triangles)."""

import warnings
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import Polygon

from pipeline.arrays import Bools, Floats

SNAP = 1e-4  # [m] joins triangles whose shared corners differ by rounding
SIMPLIFY = 0.01  # [m] flattens what is no corner of a room
SLIVER = 0.05  # [m2] smaller pieces and holes are not worth a word


@dataclass(frozen=True, slots=True)
class Floor:
    """`polygon` (n, 2) [m] in our plan coordinates, counter-clockwise; `lost` [m2] of other pieces and filled holes."""

    polygon: Floats
    area: float
    lost: float
    pieces: int


def outline(triangles: Floats) -> Floor | None:
    """Return the outline of floor triangles (T, 3, 3) in the file's frame, or None where they have no area.

    Union of all triangles whatever their winding, closed by SNAP, the largest piece, holes filled (they are columns),
    simplified. File (x, y, z) becomes plan (x, -z).
    """
    flat = np.stack([triangles[..., 0], -triangles[..., 2]], axis=-1)
    a, b, c = flat[:, 0], flat[:, 1], flat[:, 2]
    area = 0.5 * np.abs((b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0]))
    flat = flat[area > 1e-8]
    if not len(flat):
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        whole = shapely.union_all(shapely.polygons(np.round(flat, 5)))
        whole = whole.buffer(SNAP, join_style="mitre").buffer(-SNAP, join_style="mitre")
    parts = sorted((p for p in shapely.get_parts(whole) if isinstance(p, Polygon)), key=lambda p: -p.area)
    if not parts:
        return None
    holes = sum(Polygon(ring).area for ring in parts[0].interiors)
    polygon = clean(Polygon(parts[0].exterior))
    if polygon is None:
        return None
    pieces = [p for p in parts if p.area > SLIVER]
    return Floor(polygon, float(Polygon(polygon).area), float(sum(p.area for p in parts[1:]) + holes), len(pieces))


def clean(shape: Polygon) -> Floats | None:
    """Return the corners of a polygon counter-clockwise, without collinear ones, from the lowest (x, y) on."""
    simple = shape.simplify(SIMPLIFY)
    if not isinstance(simple, Polygon) or simple.is_empty or not simple.is_valid or simple.area < 1e-3:
        return None
    ring = np.round(np.asarray(shapely.geometry.polygon.orient(simple, 1.0).exterior.coords)[:-1], 4)
    kept = ring[~_straight(ring)]
    if len(kept) < 3:
        return None
    return np.roll(kept, -int(np.lexsort((kept[:, 1], kept[:, 0]))[0]), axis=0)


def _straight(ring: Floats) -> Bools:
    """Return which corners (n,) lie within SIMPLIFY / 2 of the line between their neighbours."""
    before, after = np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0)
    span = after - before
    length = np.maximum(np.hypot(span[:, 0], span[:, 1]), 1e-9)
    offset = np.abs(span[:, 0] * (ring[:, 1] - before[:, 1]) - span[:, 1] * (ring[:, 0] - before[:, 0])) / length
    return np.asarray(offset < SIMPLIFY / 2)
