"""One small texture per model: a tile for each finish, and where on it a face lies. Colours are sRGB in the image."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.finishes import Color, Finish, Pattern
from pipeline.corpus.furniture.solids import Solid

TILE = 32  # pixels
MARGIN = 0.08  # of a tile, kept free on each side so that filtering does not mix neighbours
LEVELS = 7  # shades of one finish: few, so that the file stays small


@dataclass(frozen=True, slots=True)
class Atlas:
    """A square of `columns` x `columns` tiles, the finishes in order from the lower left, row by row."""

    finishes: tuple[Finish, ...]
    columns: int

    def uv(self, solid: Solid, finish: Finish) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Return texture coordinates for a solid: `uv` (3 V, 2), and per face which of the three projections to use (F,).

        Projection k looks along axis k; the longer extent lies along the grain (v). Coordinate row: k * V + vertex.
        """
        tile = self.finishes.index(finish)
        corner = np.array([tile % self.columns, tile // self.columns]) / self.columns
        low, high = solid.bounds()
        extent = high - low
        share = (solid.vertices - low) / max(float(extent.max()), 1e-9)
        room = (1 - 2 * MARGIN) / self.columns
        sets = []
        for axis in range(3):
            i, j = (a for a in range(3) if a != axis)
            u, v = (i, j) if extent[j] >= extent[i] else (j, i)
            sets.append(corner + MARGIN / self.columns + room * share[:, [u, v]])
        return np.concatenate(sets), np.argmax(np.abs(normals(solid)), axis=1)


def normals(solid: Solid) -> NDArray[np.float64]:
    """Return the unit normal of each face (F, 3), by Newell's sum over its edges."""
    corners = np.fromiter((v for face in solid.faces for v in face), np.int64)
    lengths = np.fromiter((len(face) for face in solid.faces), np.int64)
    starts = np.concatenate([[0], np.cumsum(lengths)[:-1]])
    following = np.arange(1, len(corners) + 1)
    following[starts + lengths - 1] = starts
    p = solid.vertices[corners] - solid.vertices[corners[starts]].repeat(lengths, axis=0)
    q = p[following]
    crossed = np.stack([p[:, i] * q[:, j] - p[:, j] * q[:, i] for i, j in ((1, 2), (2, 0), (0, 1))], axis=1)
    made = np.add.reduceat(crossed, starts, axis=0)
    return np.asarray(made / np.maximum(np.sqrt((made**2).sum(axis=1, keepdims=True)), 1e-30))


def atlas(finishes: Sequence[Finish]) -> Atlas:
    """Return the atlas of a model's finishes."""
    columns = 1
    while columns * columns < len(finishes):
        columns += 1
    return Atlas(tuple(finishes), columns)


def paint(rng: np.random.Generator, sheet: Atlas) -> bytes:
    """Return the atlas as PNG bytes."""
    size = sheet.columns * TILE
    image = np.full((size, size, 3), 128, np.uint8)
    for k, finish in enumerate(sheet.finishes):
        row, column = k // sheet.columns, k % sheet.columns
        top = size - (row + 1) * TILE  # v counts from the bottom, rows of an image from the top
        shades = np.round(_pattern(rng, finish.pattern) * (LEVELS - 1) / 2) / (LEVELS - 1) * 2
        color = np.array(finish.color) * (1 + _CONTRAST[finish.pattern] * shades[:, :, None])
        image[top : top + TILE, column * TILE : (column + 1) * TILE] = np.round(255 * to_srgb(np.clip(color, 0, 1)))
    return png(image)


_CONTRAST: dict[Pattern, float] = {"plain": 0.0, "grain": 0.13, "weave": 0.07, "speckle": 0.07}


def _pattern(rng: np.random.Generator, pattern: Pattern) -> NDArray[np.float64]:
    """Return the lightness (TILE, TILE) in [-1, 1] of a pattern: streaks along v for wood, a plain weave for cloth, specks."""
    if pattern == "plain":
        return np.zeros((TILE, TILE))
    noise = rng.uniform(-1, 1, (TILE, TILE))
    if pattern == "speckle":
        return noise
    if pattern == "weave":
        y, x = np.indices((TILE, TILE))
        return np.asarray(0.6 * np.where((x + y) % 2 == 0, 1.0, -1.0) + 0.4 * noise)
    columns = rng.uniform(-1, 1, TILE)
    drift = np.round(0.8 * np.sin(np.arange(TILE) * 2 * np.pi / TILE + rng.uniform(0, 6))).astype(int)
    streaks = np.stack([np.roll(columns, shift) for shift in drift])
    return np.asarray(np.clip(0.8 * streaks + 0.2 * noise, -1, 1))


def to_srgb(linear: NDArray[np.float64]) -> NDArray[np.float64]:
    """Encode linear values in [0, 1] as sRGB (IEC 61966-2-1)."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.power(np.maximum(linear, 1e-9), 1 / 2.4) - 0.055)


def srgb(color: Color) -> tuple[float, float, float]:
    """Encode one colour."""
    r, g, b = (round(float(v), 4) for v in to_srgb(np.array(color)))
    return (r, g, b)


def png(image: NDArray[np.uint8]) -> bytes:
    """Encode an RGB image (H, W, 3) as PNG; the bytes depend on nothing but the image and zlib."""
    height, width, _ = image.shape
    rows = b"".join(b"\x00" + row.tobytes() for row in image)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
