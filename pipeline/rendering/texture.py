"""One colour per triangle: the material's, or where it has a texture the mean of some texels under the triangle."""

from __future__ import annotations

import functools
from io import BytesIO

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from pipeline.entities.asset import Asset, Material, Mesh

LARGEST = 256  # larger textures are averaged down first, so that fine patterns give their mean colour [pixels]
GREY = (0.8, 0.8, 0.8)
SPOTS = np.array([(i + 1 / 3, j + 1 / 3, 4 - i - j - 2 / 3) for i in range(4) for j in range(4 - i)], np.float32) / 4  # barycentric


def face_colours(asset: Asset) -> NDArray[np.float32]:
    """Return linear RGB (T, 3) of all visual triangles, in the order of `asset_triangles`."""
    parts = [_mesh_colours(asset, mesh) for mesh in asset.meshes()]
    return np.concatenate(parts) if parts else np.zeros((0, 3), np.float32)


def display(linear: NDArray[np.float32]) -> NDArray[np.float32]:
    """Encode linear RGB for display (IEC 61966-2-1)."""
    curve = 1.055 * np.maximum(linear, 1e-6) ** np.float32(1 / 2.4) - 0.055
    return np.where(linear <= 0.0031308, 12.92 * linear, curve).astype(np.float32)


def _mesh_colours(asset: Asset, mesh: Mesh) -> NDArray[np.float32]:
    material = asset.materials[mesh.material] if asset.materials else Material("none", GREY)
    plain = np.tile(np.array(material.base_color, np.float32), (len(mesh.faces), 1))
    if material.texture is None or mesh.uv is None or material.texture not in asset.textures:
        return plain
    texels = _texels(asset.textures[material.texture])
    if texels is None:
        return plain
    height, width, _ = texels.shape
    u, v = np.moveaxis(np.einsum("sk,tkc->tsc", SPOTS, mesh.uv[mesh.faces]) % 1.0, 2, 0)
    rows, columns = ((1 - v) * height).astype(int), (u * width).astype(int)
    seen: NDArray[np.float32] = texels[np.clip(rows, 0, height - 1), np.clip(columns, 0, width - 1)].mean(axis=1)
    return seen


@functools.lru_cache(maxsize=128)
def _texels(blob: bytes) -> NDArray[np.float32] | None:
    """Decode a texture to linear RGB (H, W, 3); None where it is no picture."""
    try:
        image = Image.open(BytesIO(blob)).convert("RGB")
    except (UnidentifiedImageError, OSError):
        return None
    if max(image.size) > LARGEST:
        image.thumbnail((LARGEST, LARGEST), Image.Resampling.BOX)
    encoded = np.asarray(image, np.float32) / 255
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    return np.asarray(linear, np.float32)
