"""One texture per model: a field for each finish at real-world scale, and where on it a face lies. Colours are sRGB in the image."""

from __future__ import annotations

import functools
import math
import struct
import zlib
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture import patterns
from pipeline.corpus.furniture.finishes import Color, Finish
from pipeline.corpus.furniture.shape import Piece
from pipeline.corpus.furniture.solids import Solid, topology

FINEST = 256.0  # [pixels per metre]
LARGEST = 320  # pixels a side; a model too large for that at FINEST gets fewer per metre
MARGIN = 2  # pixels around each field, so that filtering does not mix neighbours
PLAIN = 6  # pixels a side of the field of a finish without a pattern
SHADES = 8  # of one finish
GOLDEN = 0.6180339887498949


@dataclass(frozen=True, slots=True)
class Field:
    """Where on the image a finish lies: lower left corner and size [pixels], from the lower left of the image."""

    x: int
    y: int
    width: int
    height: int


@dataclass(frozen=True, slots=True)
class Atlas:
    """Fields of all finishes of a model on an image of `width` x `height` pixels; `scale` [pixels per metre]."""

    finishes: tuple[Finish, ...]
    fields: tuple[Field, ...]
    width: int
    height: int
    scale: float

    def uv(self, solid: Solid, finish: Finish, number: int = 0) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Return texture coordinates for a solid: `uv` (3 V, 2), and per face which of the three projections to use (F,).

        Projection k looks along axis k; the longer extent lies along the grain (v). Coordinate row: k * V + vertex. Pieces of
        one finish lie at different places of its field, by their `number`.
        """
        field = self.fields[self.finishes.index(finish)]
        low, high = solid.bounds()
        extent = high - low
        local = (solid.vertices - low) * self.scale
        if finish.pattern == "plain":
            local = local * (min(field.width, field.height) - 2 * MARGIN) / max(float(extent.max()) * self.scale, 1e-9)
            extent = extent * 0
        sets = []
        for axis in range(3):
            i, j = (a for a in range(3) if a != axis)
            u, v = (i, j) if extent[j] >= extent[i] or finish.pattern in patterns.WHOLE else (j, i)
            spare = np.array([field.width, field.height]) - 2 * MARGIN - self.scale * extent[[u, v]]
            if finish.pattern in patterns.WHOLE:
                spare = spare * 0
            start = np.maximum(spare, 0) * np.array([(number * GOLDEN + 0.3 * axis) % 1, (number * GOLDEN**2 + 0.7 * axis) % 1])
            sets.append((np.array([field.x, field.y]) + MARGIN + start + local[:, [u, v]]) / np.array([self.width, self.height]))
        return np.concatenate(sets), np.argmax(np.abs(normals(solid)), axis=1)


def normals(solid: Solid) -> NDArray[np.float64]:
    """Return the unit normal of each face (F, 3), by Newell's sum over its edges."""
    shared = topology(solid.faces)
    p = solid.vertices[shared.corners] - solid.vertices[shared.corners[shared.starts]].repeat(shared.lengths, axis=0)
    q = p[shared.following]
    crossed = np.stack([p[:, i] * q[:, j] - p[:, j] * q[:, i] for i, j in ((1, 2), (2, 0), (0, 1))], axis=1)
    made = np.add.reduceat(crossed, shared.starts, axis=0)
    return np.asarray(made / np.maximum(np.sqrt((made**2).sum(axis=1, keepdims=True)), 1e-30))


def atlas(pieces: Iterable[Piece]) -> Atlas:
    """Return the atlas of a model: each finish gets a field as large as its largest piece, side by side, at one scale."""
    reach: dict[Finish, NDArray[np.float64]] = {}
    for piece in pieces:
        low, high = piece.solid.bounds()
        extent = high - low
        whole = piece.finish.pattern in patterns.WHOLE
        across = np.array([extent[0], extent[1:].max()]) if whole else np.sort(extent)[1:]
        reach[piece.finish] = np.maximum(reach.get(piece.finish, np.zeros(2)), across)
    patterned = [size for finish, size in reach.items() if finish.pattern != "plain"]
    scale = FINEST
    if patterned:
        room = LARGEST - len(reach) * (PLAIN + 2 * MARGIN)
        scale = min(scale, room / sum(float(s[0]) for s in patterned), room / max(float(s[1]) for s in patterned))
    fields, x = [], 0
    for finish, size in reach.items():
        w, h = (PLAIN, PLAIN) if finish.pattern == "plain" else (math.ceil(float(e) * scale) + 2 * MARGIN for e in size)
        fields.append(Field(x, 0, w, h))
        x += w
    return Atlas(tuple(reach), tuple(fields), x, max(f.height for f in fields), scale)


def paint(rng: np.random.Generator, sheet: Atlas) -> bytes:
    """Return the atlas as the bytes of a PNG with a palette."""
    image = np.zeros((sheet.height, sheet.width), np.uint8)
    shades = min(SHADES, 256 // len(sheet.finishes))
    palette = np.zeros((shades * len(sheet.finishes), 3))
    tones = np.linspace(0, 1, shades)
    for k, (finish, field) in enumerate(zip(sheet.finishes, sheet.fields, strict=True)):
        palette[k * shades : (k + 1) * shades] = _colors(finish, tones)
        spot = image[sheet.height - field.y - field.height : sheet.height - field.y, field.x : field.x + field.width]
        if finish.pattern == "plain":
            spot[:] = k * shades + shades // 2
        else:
            tone = patterns.tones(rng, finish.pattern, spot.shape, sheet.scale)
            spot[:] = k * shades + np.minimum(tone * shades, shades - 1).astype(np.uint8)
    return png(image, np.round(255 * to_srgb(np.clip(palette, 0, 1))).astype(np.uint8))


def _colors(finish: Finish, tones: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return linear colours (n, 3) of tones from 0 to 1: from the finish's colour to its second, or about its colour."""
    color = np.array(finish.color)
    if finish.second is not None:
        return np.asarray(color + tones[:, None] * (np.array(finish.second) - color))
    return np.asarray(color * (1 + patterns.CONTRAST[finish.pattern] * (2 * tones[:, None] - 1)))


def to_srgb(linear: NDArray[np.float64]) -> NDArray[np.float64]:
    """Encode linear values in [0, 1] as sRGB (IEC 61966-2-1)."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.power(np.maximum(linear, 1e-9), 1 / 2.4) - 0.055)


@functools.cache
def srgb(color: Color) -> tuple[float, float, float]:
    """Encode one colour."""
    r, g, b = (round(float(v), 4) for v in to_srgb(np.array(color)))
    return (r, g, b)


def png(image: NDArray[np.uint8], palette: NDArray[np.uint8]) -> bytes:
    """Encode an image of palette numbers (H, W) as PNG; the bytes depend on nothing but the image and zlib."""
    height, width = image.shape
    rows = np.zeros((height, width + 1), np.uint8)
    rows[:, 1:] = image

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)
    parts = chunk(b"IHDR", header) + chunk(b"PLTE", palette.tobytes()) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 4))
    return b"\x89PNG\r\n\x1a\n" + parts + chunk(b"IEND", b"")
