"""One colour per triangle: the material's, or where it has a texture the mean of the texels under the triangle."""

import functools
import math
from io import BytesIO
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from pipeline.entities.asset import Asset, Material, Mesh
from pipeline.geometry.compiled import compiled

LARGEST = 256  # larger textures are averaged down first, so that fine patterns give their mean colour [pixels]
GREY = (0.8, 0.8, 0.8)
LINEAR = np.array(
    [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in np.arange(256) / 255], np.float32
)  # of encoded 8 bits
ROWS = 4  # of spots in a triangle
SPOTS = (
    np.array([(i + 1 / 3, j + 1 / 3, ROWS - i - j - 2 / 3) for i in range(ROWS) for j in range(ROWS - i)], np.float32) / ROWS
)  # barycentric


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
