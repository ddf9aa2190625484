"""The finish of an asset as a person sees it: the colour of most of its surface."""

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.asset import Asset
from pipeline.rendering.pose import asset_triangles
from pipeline.rendering.texture import face_colours

Floats = NDArray[np.float64]

CELL = 14.0  # side of the cells of CIELAB in which colours count as one
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])  # linear sRGB, IEC 61966-2-1
WHITE = TO_XYZ.sum(axis=1)  # D65
UNKNOWN = np.full(3, np.nan)


def finish_of(asset: Asset) -> Floats:
    """Return the CIELAB colour (3,) of the cell of colours with the largest area; NaN for an asset without surface."""
    corners, _ = asset_triangles(asset)
    if not len(corners):
        return UNKNOWN
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    colours = lab(face_colours(asset).astype(np.float64))
    _, cell = np.unique(np.floor(colours / CELL) @ (1e6, 1e3, 1.0), return_inverse=True)
    most = cell == int(np.bincount(cell, area).argmax())
    weight = area[most] if area[most].sum() > 0 else np.ones(int(most.sum()))
    return np.asarray(np.average(colours[most], axis=0, weights=weight))


def lab(linear: Floats) -> Floats:
    """Return CIELAB (T, 3) of linear RGB (T, 3), for D65 (CIE 15:2004)."""
    t = np.clip(linear, 0.0, 1.0) @ TO_XYZ.T / WHITE
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.stack([116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])], axis=1)
