"""A denoiser for path-traced images: edge-avoiding à-trous wavelets (Dammertz et al. 2010), guided by albedo, normal and depth."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

KERNEL = np.array([1, 4, 6, 4, 1], np.float32) / 16


@dataclass(frozen=True, slots=True)
class Guides:
    """What the first hit of each pixel says without noise: `albedo` (H, W, 3), `normal` (H, W, 3), `depth` (H, W) [m], 0 at the sky."""

    albedo: NDArray[np.float32]
    normal: NDArray[np.float32]
    depth: NDArray[np.float32]


def denoise(image: NDArray[np.float32], guides: Guides, rounds: int = 4) -> NDArray[np.float32]:
    """Smooth linear `image` (H, W, 3) within surfaces. Colours are divided out first, so that their detail survives."""
    albedo = np.maximum(guides.albedo, 0.02)
    light = suppress_fireflies(np.asarray(image / albedo, np.float32))
    spread = 0.6
    for level in range(rounds):
        light = _pass(light, guides, 1 << level, spread)
        spread *= 0.6
    return np.where((guides.depth > 0)[..., None], light * albedo, image)


def suppress_fireflies(image: NDArray[np.float32]) -> NDArray[np.float32]:
    """Lower single pixels that outshine their surroundings (fireflies) to twice the local median."""
    luminance = image.mean(axis=2)
    middle = ndimage.median_filter(luminance, 5, mode="nearest")
    factor = np.minimum(1.0, 2.0 * (middle + 1e-3) / np.maximum(luminance, 1e-6))
    return np.asarray(image * factor[..., None], np.float32)


def _pass(light: NDArray[np.float32], guides: Guides, step: int, spread: float) -> NDArray[np.float32]:
    """Average over 5 x 5 taps, `step` pixels apart, weighted by how alike the surfaces and their light are."""
    height, width, _ = light.shape
    reach = 2 * step
    pad = ((reach, reach), (reach, reach))
    wide = np.pad(light, (*pad, (0, 0)), mode="edge")
    normal = np.pad(guides.normal, (*pad, (0, 0)), mode="edge")
    depth = np.pad(guides.depth, pad, mode="edge")
    tone = np.log1p(light.mean(axis=2))
    tones = np.log1p(wide.mean(axis=2))
    slope = 0.02 + 0.6 * step * np.maximum(*(np.abs(g) for g in np.gradient(ndimage.median_filter(guides.depth, 3))))
    total = np.zeros_like(light)
    weights = np.zeros((height, width), np.float32)
    for i in range(5):
        for j in range(5):
            window = (slice(i * step, i * step + height), slice(j * step, j * step + width))
            alike = np.clip(np.einsum("ijk,ijk->ij", normal[window], guides.normal), 0, 1)
            alike = alike * alike  # to the 32nd power in five squarings
            for _ in range(4):
                alike = alike * alike
            exponent = np.abs(depth[window] - guides.depth) / (2 * slope) + np.abs(tones[window] - tone) / spread
            weight = KERNEL[i] * KERNEL[j] * alike * np.exp(-exponent)
            total += wide[window] * weight[..., None]
            weights += weight
    return np.where(weights[..., None] > 1e-6, total / np.maximum(weights, 1e-6)[..., None], light)
