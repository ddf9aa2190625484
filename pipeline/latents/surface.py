"""Surface samples: points spread evenly over an asset's visual meshes, centred and scaled by the largest side."""

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.asset import Asset
from pipeline.errors import ContentError


def triangles(asset: Asset) -> NDArray[np.float64]:
    """Return all visual triangles (F, 3, 3) at rest, moved and scaled into the cube [-0.5, 0.5]^3.

    The box's centre goes to the origin and its largest side to 1, so that the latent does not know the size.
    """
    corners = np.concatenate([np.asarray(m.vertices, float)[m.faces] for m in asset.meshes()] or [np.zeros((0, 3, 3))])
    if not len(corners):
        raise ContentError(f"asset {asset.asset_id} has no surface", "run `dvc repro preprocess` again, or remove the model")
    flat = corners.reshape(-1, 3)
    low, high = flat.min(0), flat.max(0)
    placed: NDArray[np.float64] = (corners - (low + high) / 2) / max(float((high - low).max()), 1e-6)
    return placed


def surface_points(rng: np.random.Generator, corners: NDArray[np.float64], count: int) -> NDArray[np.float32]:
    """Draw `count` points (count, 3) from triangles (F, 3, 3), by area.

    Systematic over the cumulated area (one random offset per point in its own stratum): a sample of 2,048 points then
    describes its shape with far less noise than as many independent draws.
    """
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    total = np.cumsum(area)
    if total[-1] <= 0:
        return np.asarray(corners.reshape(-1, 3)[rng.integers(0, 3 * len(corners), count)], np.float32)
    at = (np.arange(count) + rng.random(count)) / count * total[-1]
    face = np.minimum(np.searchsorted(total, at, side="right"), len(corners) - 1)
    u, v = rng.random((2, count, 1))
    fold = u + v > 1
    u, v = np.where(fold, 1 - u, u), np.where(fold, 1 - v, v)
    a, b, c = corners[face, 0], corners[face, 1], corners[face, 2]
    points: NDArray[np.float32] = (a + u * (b - a) + v * (c - a)).astype(np.float32)
    return points
