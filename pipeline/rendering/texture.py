"""One colour per triangle: the material's, or where it has a texture the mean of some texels under the triangle."""

from __future__ import annotations

import functools
from io import BytesIO

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
SPOTS = np.array([(i + 1 / 3, j + 1 / 3, 4 - i - j - 2 / 3) for i in range(4) for j in range(4 - i)], np.float32) / 4  # barycentric


def face_colours(asset: Asset, chosen: NDArray[np.bool_] | None = None) -> NDArray[np.float32]:
    """Return linear RGB (T, 3) of the visual triangles, in the order of `asset_triangles`: of all, or of those `chosen` by a mask."""
    parts, start = [], 0
    for mesh in asset.meshes():
        mine = slice(None) if chosen is None else chosen[start : start + len(mesh.faces)]
        parts.append(_mesh_colours(asset, mesh, mesh.faces[mine]))
        start += len(mesh.faces)
    return np.concatenate(parts) if parts else np.zeros((0, 3), np.float32)


def display(linear: NDArray[np.float32]) -> NDArray[np.float32]:
    """Encode linear RGB for display (IEC 61966-2-1)."""
    curve = 1.055 * np.maximum(linear, 1e-6) ** np.float32(1 / 2.4) - 0.055
    return np.where(linear <= 0.0031308, 12.92 * linear, curve).astype(np.float32)


def _mesh_colours(asset: Asset, mesh: Mesh, faces: NDArray[np.int32]) -> NDArray[np.float32]:
    material = asset.materials[mesh.material] if asset.materials else Material("none", GREY)
    plain = np.tile(np.array(material.base_color, np.float32), (len(faces), 1))
    if material.texture is None or mesh.uv is None or material.texture not in asset.textures or not len(faces):
        return plain
    texels = _texels(asset.textures[material.texture])
    return plain if texels is None else _mean_colours(texels, np.asarray(mesh.uv, np.float32), faces)


@compiled
def _mean_colours(texels: NDArray[np.uint8], uv: NDArray[np.float32], faces: NDArray[np.int32]) -> NDArray[np.float32]:
    """Return the mean linear colour (F, 3) of the encoded texels (H, W, 3) under the spots of each face, by its corners' coordinates in `uv` (V, 2)."""
    height, width = texels.shape[:2]
    colours = np.zeros((len(faces), 3), np.float32)
    one = np.float32(1.0)
    for f in range(len(faces)):
        a, b, c = uv[faces[f, 0]], uv[faces[f, 1]], uv[faces[f, 2]]
        for s in range(SPOTS.shape[0]):
            u = (SPOTS[s, 0] * a[0] + SPOTS[s, 1] * b[0] + SPOTS[s, 2] * c[0]) % one
            v = (SPOTS[s, 0] * a[1] + SPOTS[s, 1] * b[1] + SPOTS[s, 2] * c[1]) % one
            row, column = min(int((one - v) * np.float32(height)), height - 1), min(int(u * np.float32(width)), width - 1)
            for k in range(3):
                colours[f, k] += LINEAR[texels[row, column, k]]
        for k in range(3):
            colours[f, k] /= np.float32(SPOTS.shape[0])
    return colours


@functools.lru_cache(maxsize=16)
def _texels(blob: bytes) -> NDArray[np.uint8] | None:
    """Decode a texture (H, W, 3), encoded as it is; None where it is no picture."""
    try:
        image = Image.open(BytesIO(blob)).convert("RGB")
    except (UnidentifiedImageError, OSError):
        return None
    if max(image.size) > LARGEST:
        image.thumbnail((LARGEST, LARGEST), Image.Resampling.BOX)
    return np.asarray(image)
