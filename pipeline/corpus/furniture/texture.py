"""One texture per model: a field for each finish at real-world scale, and where on it a face lies. Colours are sRGB in the image."""

from __future__ import annotations

import functools
import math
import struct
import zlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture import patterns
from pipeline.corpus.furniture.finishes import Finish
from pipeline.corpus.furniture.shape import Piece
from pipeline.rendering.palette import display
from pipeline.style import Color

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

    def uv(self, pieces: Sequence[Piece], corners: Corners) -> NDArray[np.float64]:
        """Return the texture coordinates (C, 2) of the corners of pieces.

        A face is seen along one axis; the longer extent of its piece across that axis lies along the grain (v). Pieces lie at
        different places of their finish's field, by their place in the list.
        """
        index = {finish: k for k, finish in enumerate(self.finishes)}
        of = np.array([index[piece.finish] for piece in pieces])
        whole, plain = (np.array([test(f.pattern) for f in self.finishes])[of] for test in (patterns.WHOLE.__contains__, "plain".__eq__))
        field = np.array([(f.x, f.y, f.width, f.height) for f in self.fields], float)[of]
        low, extent = corners.low, corners.high - corners.low
        scale = np.where(plain, (PLAIN - 2 * MARGIN) / np.maximum(extent.max(axis=1), 1e-9), self.scale)
        number = np.arange(len(pieces))[:, None]
        axes, starts = np.empty((len(pieces), 3, 2), np.int64), np.empty((len(pieces), 3, 2))
        for axis in range(3):
            i, j = (a for a in range(3) if a != axis)
            along = ((extent[:, j] >= extent[:, i]) | whole)[:, None]
            axes[:, axis] = np.where(along, (i, j), (j, i))
            room = field[:, 2:] - 2 * MARGIN - scale[:, None] * np.take_along_axis(extent, axes[:, axis], axis=1)
            place = np.concatenate([number * GOLDEN + 0.3 * axis, number * GOLDEN**2 + 0.7 * axis], axis=1) % 1
            starts[:, axis] = field[:, :2] + MARGIN + np.where(whole[:, None], 0.0, np.maximum(room, 0)) * place
        piece, side = corners.piece, corners.axis
        local = np.take_along_axis(corners.points - low[piece], axes[piece, side], axis=1) * scale[piece, None]
        return np.asarray((starts[piece, side] + local) / np.array([self.width, self.height]))


@dataclass(frozen=True, slots=True)
class Corners:
    """The corners of faces of pieces: `points` (C, 3) [m], `piece` (C,) and `axis` (C,) that their face is seen along.

    `low` and `high` (P, 3) are the pieces' bounds.
    """

    points: NDArray[np.float64]
    piece: NDArray[np.int64]
    axis: NDArray[np.int64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]


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
    return png(image, np.round(255 * display(np.clip(palette, 0, 1))).astype(np.uint8))


def _colors(finish: Finish, tones: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return linear colours (n, 3) of tones from 0 to 1: from the finish's colour to its second, or about its colour."""
    color = np.array(finish.color)
    if finish.second is not None:
        return np.asarray(color + tones[:, None] * (np.array(finish.second) - color))
    return np.asarray(color * (1 + patterns.CONTRAST[finish.pattern] * (2 * tones[:, None] - 1)))


@functools.cache
def srgb(color: Color) -> tuple[float, float, float]:
    """Encode one colour."""
    r, g, b = (round(float(v), 4) for v in display(np.array(color)))
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
