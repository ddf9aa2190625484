"""A small z-buffer rasteriser: orthographic, flat shaded, the same pixels on every run.

Camera frame: u to the right and v down, in pixels; depth grows towards the viewer.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy import ndimage

from pipeline.geometry.compiled import borrowing, compiled

LIGHT = np.array([-0.35, -0.45, 0.82])  # towards the light, world frame; from the front left, high up
AMBIENT = 0.45
MARGIN = 0.06  # around what an oblique view shows, as a share of the image

Buffers = tuple[NDArray[np.uint8], NDArray[np.float32], NDArray[np.int32]]  # a frame's colour, depth and item


@dataclass(frozen=True, slots=True)
class View:
    """An orthographic view: `axes` (3, 3) rows are the world directions of u, v and towards the viewer.

    `centre` (3,) [m, world] falls on the middle of the image; `scale` is pixels per metre; `width`, `height` pixels.
    """

    axes: NDArray[np.float64]
    centre: NDArray[np.float64]
    scale: float
    width: int
    height: int

    def project(self, points: NDArray[np.float64]) -> NDArray[np.float32]:
        """Map world points (..., 3) [m] to (u, v, depth): pixels, pixels, metres."""
        local = (points - self.centre) @ self.axes.T
        out = np.empty(local.shape, np.float32)
        out[..., 0] = local[..., 0] * self.scale + self.width / 2
        out[..., 1] = local[..., 1] * self.scale + self.height / 2
        out[..., 2] = local[..., 2]
        return out

    def rows(self, top: int, bottom: int) -> View:
        """Return the view of the rows from `top` to before `bottom` alone."""
        down = ((top + bottom) / 2 - self.height / 2) / self.scale
        return replace(self, centre=self.centre + down * self.axes[1], height=bottom - top)


@dataclass(frozen=True, slots=True)
class Frame:
    """What was drawn: `colour` (H, W, 3) in 8 bits, `depth` (H, W) [m] (-inf where empty), `item` (H, W) (-1 where empty)."""

    colour: NDArray[np.uint8]
    depth: NDArray[np.float32]
    item: NDArray[np.int32]

    @property
    def buffers(self) -> Buffers:
        """All three, as `fill_triangle` takes them."""
        return self.colour, self.depth, self.item


def top_down(low: NDArray[np.float64], high: NDArray[np.float64], width: int, height: int) -> View:
    """Look straight down at the plan rectangle low..high (2,), +y up in the image."""
    span = np.maximum(high - low, 1e-3)
    axes = np.array([[1.0, 0, 0], [0, -1.0, 0], [0, 0, 1.0]])
    centre = np.array([*(low + high) / 2, 0.0])
    return View(axes, centre, float(min(width / span[0], height / span[1])), width, height)


def oblique(points: NDArray[np.float64], azimuth: float, elevation: float, size: int) -> View:
    """Look at `points` (N, 3) so that they fill the image: from `azimuth` about +Z (0: from -Y), `elevation` above the floor [rad]."""
    ca, sa, ce, se = np.cos(azimuth), np.sin(azimuth), np.cos(elevation), np.sin(elevation)
    right = np.array([ca, sa, 0.0])
    back = np.array([sa * ce, -ca * ce, se])
    axes = np.array([right, np.cross(right, back), back])
    local = points @ axes.T
    low, high = local.min(axis=0), local.max(axis=0)
    scale = size * (1 - 2 * MARGIN) / max(float((high - low)[:2].max()), 1e-3)
    return View(axes, axes.T @ ((low + high) / 2), scale, size, size)


def render(
    view: View,
    triangles: NDArray[np.float64],
    colours: NDArray[np.float32],
    items: NDArray[np.int32] | None = None,
    background: tuple[float, float, float] = (1.0, 1.0, 1.0),
) -> Frame:
    """Draw `triangles` (T, 3, 3) [m, world] with `colours` (T, 3) in [0, 1], Lambert shaded from both sides; `items` (T,) label them."""
    shade = np.ones((0, 1), np.float32)
    if len(triangles):
        normals = face_normals(triangles)
        visible = np.abs(normals @ view.axes[2]) > 1e-3  # what is seen edge-on covers no pixel
        triangles, colours, normals = triangles[visible], colours[visible], normals[visible]
        items = np.flatnonzero(visible).astype(np.int32) if items is None else items[visible]
        normals *= np.where(normals @ view.axes[2] < 0, -1.0, 1.0)[:, None]  # shade the side that is seen
        lambert = np.clip(normals @ (LIGHT / np.linalg.norm(LIGHT)), 0, 1)
        shade = (AMBIENT + (1 - AMBIENT) * lambert).astype(np.float32)[:, None]
    return fill(view.project(triangles), colours * shade, items, (view.width, view.height), background)


def fill(
    projected: NDArray[np.float32],
    colours: NDArray[np.float32],
    items: NDArray[np.int32] | None,
    size: tuple[int, int],
    background: tuple[float, float, float],
) -> Frame:
    """Draw triangles (T, 3, 3) that are projected to (u, v, depth) already, in plain `colours` (T, 3); `size` is width, height."""
    width, height = size
    frame = Frame(_plain(background, width, height), np.full((height, width), -np.inf, np.float32), np.full((height, width), -1, np.int32))
    if len(projected):
        labels = np.arange(len(projected), dtype=np.int32) if items is None else items.astype(np.int32)
        _fill(np.ascontiguousarray(projected), to_bytes(colours.astype(np.float32)), labels, frame.buffers)
    return frame


def face_normals(triangles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the unit normals (T, 3) of triangles (T, 3, 3); zero for degenerate ones."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    unit: NDArray[np.float64] = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    return unit


def darken_edges(frame: Frame, radius: int, strength: float, reach: float = 0.6, ground: float | None = None) -> Frame:
    """Darken what lies below its surroundings: the unsharp mask of the depth buffer (Luft et al. 2006), a cheap ambient occlusion.

    `radius` [pixels]; `reach` [m] is the height difference that gives the full effect; empty pixels count as lying at depth
    `ground` and are darkened too, or, without it, are left alone.
    """
    drawn = np.isfinite(frame.depth)
    if not drawn.any():
        return frame
    level = float(frame.depth[drawn].min()) if ground is None else ground
    filled = np.where(drawn, frame.depth, level).astype(np.float32)
    low = filled[::2, ::2]  # blurred at half the resolution: it is smooth, and four times cheaper
    for _ in range(2):  # two box passes come close to a Gaussian
        low = ndimage.uniform_filter(low, radius + 1, mode="nearest")
    slope, most = np.float32(strength / reach), np.float32(strength)
    return replace(frame, colour=_darken_pixels(frame.colour, frame.depth, filled, low, slope, most, ground is not None))


def shrink(frame: Frame, factor: int) -> Frame:
    """Average the colours of blocks of `factor` x `factor` pixels; depth and items are those of each block's first pixel."""
    colour = np.asarray(Image.fromarray(frame.colour).reduce(factor))
    return Frame(colour, frame.depth[::factor, ::factor], frame.item[::factor, ::factor])


def to_bytes(image: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Map [0, 1] to 8 bits."""
    return np.asarray(np.clip(image * np.float32(255) + np.float32(0.5), 0, 255), np.uint8)


def _plain(colour: tuple[float, float, float], width: int, height: int) -> NDArray[np.uint8]:
    filled = np.empty((height, width, 3), np.uint8)
    filled[:] = np.tile(to_bytes(np.asarray(colour, np.float32)), (width, 1))  # whole rows: three bytes at a time take ten times as long
    return filled


@borrowing
def _fill(projected: NDArray[np.float32], colours: NDArray[np.uint8], items: NDArray[np.int32], buffers: Buffers) -> None:
    """Scan-convert triangles (T, 3, 3) of (u, v, depth) in their order."""
    for t in range(projected.shape[0]):
        fill_triangle(projected[t], colours[t], items[t], buffers)


@borrowing
def fill_triangle(corners: NDArray[np.float32], paint: NDArray[np.uint8], label: int, buffers: Buffers) -> None:
    """Scan-convert one triangle (3, 3) of (u, v, depth) in `paint` (3,); a pixel counts when its centre is inside."""
    colour, depth, item = buffers
    height, width = depth.shape
    x0, y0, z0 = float(corners[0, 0]), float(corners[0, 1]), float(corners[0, 2])
    x1, y1, z1 = float(corners[1, 0]), float(corners[1, 1]), float(corners[1, 2])
    x2, y2, z2 = float(corners[2, 0]), float(corners[2, 1]), float(corners[2, 2])
    area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
    if abs(area) < 1e-9:
        return
    top, bottom = max(int(np.ceil(min(y0, y1, y2) - 0.5)), 0), min(int(np.floor(max(y0, y1, y2) - 0.5)), height - 1)
    # Depth and the three edge functions are affine in (u, v): value = u * slope + rest(v), inside where all edges are >= 0.
    sign = 1.0 if area > 0 else -1.0
    zu = ((z1 - z0) * (y2 - y0) - (z2 - z0) * (y1 - y0)) / area
    zv = ((z2 - z0) * (x1 - x0) - (z1 - z0) * (x2 - x0)) / area
    slopes = (sign * (y1 - y2), sign * (y2 - y0), sign * (y0 - y1))
    for row in range(top, bottom + 1):
        v = row + 0.5
        rests = (
            sign * (x1 * (y2 - v) - x2 * (y1 - v)),
            sign * (x2 * (y0 - v) - x0 * (y2 - v)),
            sign * (x0 * (y1 - v) - x1 * (y0 - v)),
        )
        low, high = 0.0, float(width)
        for k in range(3):
            if slopes[k] > 0:
                low = max(low, -rests[k] / slopes[k])
            elif slopes[k] < 0:
                high = min(high, -rests[k] / slopes[k])
            elif rests[k] < 0:
                high = -1.0
        first, last = int(np.ceil(low - 0.5)), min(int(np.floor(high - 0.5)), width - 1)
        for column in range(first, last + 1):
            z = z0 + zu * (column + 0.5 - x0) + zv * (v - y0)
            if z > depth[row, column]:
                depth[row, column] = z
                item[row, column] = label
                for channel in range(3):
                    colour[row, column, channel] = paint[channel]


@compiled
def _darken_pixels(
    colour: NDArray[np.uint8],
    depth: NDArray[np.float32],
    filled: NDArray[np.float32],
    low: NDArray[np.float32],
    slope: np.float32,
    most: np.float32,
    everywhere: bool,
) -> NDArray[np.uint8]:
    """Darken each pixel (H, W) by how far it lies below `low` (H / 2, W / 2), `slope` per metre and at `most`; empty ones `everywhere` or not."""
    height, width = depth.shape
    image = np.empty((height, width, 3), np.uint8)
    zero, one, half = np.float32(0.0), np.float32(1.0), np.float32(0.5)
    for row in range(height):
        for column in range(width):
            occlusion = min(max((low[row // 2, column // 2] - filled[row, column]) * slope, zero), most)
            if not everywhere and not np.isfinite(depth[row, column]):
                occlusion = zero
            for channel in range(3):
                image[row, column, channel] = np.uint8(np.float32(colour[row, column, channel]) * (one - occlusion) + half)
    return image
