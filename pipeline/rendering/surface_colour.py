"""Colours of surfaces: one per triangle, the material's or where it has a texture the mean of the texels under it; and an asset's finish, that of most of its surface."""

import functools
import math
from io import BytesIO
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from pipeline.entities.asset import Asset, Material, Mesh
from pipeline.geometry.compiled import compiled
from pipeline.rendering.pose import asset_triangles

LARGEST = 256  # larger textures are averaged down first, so that fine patterns give their mean colour [pixels]
GREY = (0.8, 0.8, 0.8)
# of encoded 8 bits
LINEAR = np.array([v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in np.arange(256) / 255], np.float32)
ROWS = 4  # of spots in a triangle
# barycentric
SPOTS = np.array([(i + 1 / 3, j + 1 / 3, ROWS - i - j - 2 / 3) for i in range(ROWS) for j in range(ROWS - i)], np.float32) / ROWS
CELL = 14.0  # side of the cells of CIELAB in which colours count as one
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])  # linear sRGB, IEC 61966-2-1
WHITE = TO_XYZ.sum(axis=1)  # D65
UNKNOWN = np.full(3, np.nan)


class Pyramid(NamedTuple):
    """A texture and its means over ever larger squares (Williams 1983): `texels` (N, 3), encoded, of all levels, and where each begins, its height and width (L, 3)."""

    texels: NDArray[np.uint8]
    levels: NDArray[np.int64]


def face_colours(asset: Asset, chosen: NDArray[np.bool_] | None = None) -> NDArray[np.float32]:
    """Return linear RGB (T, 3) of the visual triangles, in the order of `asset_triangles`: of all, or of those `chosen` by a mask."""
    parts, start = [], 0
    for mesh in asset.meshes():
        mine = slice(None) if chosen is None else chosen[start : start + len(mesh.faces)]
        parts.append(_mesh_colours(asset, mesh, mesh.faces[mine]))
        start += len(mesh.faces)
    return np.concatenate(parts) if parts else np.zeros((0, 3), np.float32)


def _mesh_colours(asset: Asset, mesh: Mesh, faces: NDArray[np.int32]) -> NDArray[np.float32]:
    material = asset.materials[mesh.material] if asset.materials else Material("none", GREY)
    plain = np.tile(np.array(material.base_color, np.float32), (len(faces), 1))
    if material.texture is None or mesh.uv is None or material.texture not in asset.textures or not len(faces):
        return plain
    pyramid = _pyramid(asset.textures[material.texture])
    return plain if pyramid is None else _mean_colours(*pyramid, np.asarray(mesh.uv, np.float32), faces)


@compiled
def _mean_colours(
    texels: NDArray[np.uint8], levels: NDArray[np.int64], uv: NDArray[np.float32], faces: NDArray[np.int32]
) -> NDArray[np.float32]:
    """Return the mean linear colour (F, 3) of a pyramid's texels under the spots of each face, by its corners' coordinates in `uv` (V, 2).

    They are those of the level whose texels are as large as the spots are apart: large triangles would else see a pattern by chance.
    """
    colours = np.zeros((len(faces), 3), np.float32)
    one = np.float32(1.0)
    for f in range(len(faces)):
        a, b, c = uv[faces[f, 0]], uv[faces[f, 1]], uv[faces[f, 2]]
        across = max(abs(a[0] - b[0]), abs(b[0] - c[0]), abs(c[0] - a[0])) * levels[0, 2]
        along = max(abs(a[1] - b[1]), abs(b[1] - c[1]), abs(c[1] - a[1])) * levels[0, 1]
        level = min(int(math.log2(max(across / ROWS, along / ROWS, 1.0))), len(levels) - 1)
        start, height, width = levels[level]
        for s in range(SPOTS.shape[0]):
            u = (SPOTS[s, 0] * a[0] + SPOTS[s, 1] * b[0] + SPOTS[s, 2] * c[0]) % one
            v = (SPOTS[s, 0] * a[1] + SPOTS[s, 1] * b[1] + SPOTS[s, 2] * c[1]) % one
            row, column = min(int((one - v) * np.float32(height)), height - 1), min(int(u * np.float32(width)), width - 1)
            for k in range(3):
                colours[f, k] += LINEAR[texels[start + row * width + column, k]]
        for k in range(3):
            colours[f, k] /= np.float32(SPOTS.shape[0])
    return colours


@functools.lru_cache(maxsize=16)
def _pyramid(blob: bytes) -> Pyramid | None:
    """Decode a texture; None where it is no picture."""
    try:
        image = Image.open(BytesIO(blob)).convert("RGB")
    except (UnidentifiedImageError, OSError):
        return None
    if max(image.size) > LARGEST:
        image.thumbnail((LARGEST, LARGEST), Image.Resampling.BOX)
    images = [image]
    while max(images[-1].size) > 1:
        images.append(images[-1].reduce(2))
    pixels = [np.asarray(level).reshape(-1, 3) for level in images]
    starts = np.cumsum([0, *(len(level) for level in pixels)])[:-1]
    return Pyramid(np.concatenate(pixels), np.array([(at, level.height, level.width) for at, level in zip(starts, images, strict=True)]))


def finish_of(asset: Asset) -> NDArray[np.float64]:
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


def lab(linear: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return CIELAB (T, 3) of linear RGB (T, 3), for D65 (CIE 15:2004)."""
    t = np.clip(linear, 0.0, 1.0) @ TO_XYZ.T / WHITE
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.stack([116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])], axis=1)
