"""One texture per model: procedural patterns at real-world scale, a field for each finish, and where on it a face lies. Colours are sRGB in the image."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline import seeds
from pipeline.corpus.furniture.finishes import Finish, Pattern
from pipeline.corpus.furniture.shape import Piece
from pipeline.corpus.furniture.solids import Topology
from pipeline.rendering import png
from pipeline.rendering.palette import display

Tones = NDArray[np.float64]
SIDE = 512  # pixels of a pattern's master, which repeats
_ROWS, _COLUMNS = np.fft.fftfreq(SIDE), np.fft.rfftfreq(SIDE)  # [per pixel]
_Y, _X = np.arange(SIDE)[:, None], np.arange(SIDE)[None, :]
_WARP = np.where((_X // 2 + _Y // 2) % 2 == 0, 1.0, -1.0)  # of a plain weave: which thread lies on top
_LOOPS = np.sin(2 * math.pi * _X / 8) + 0.5 * np.sin(2 * math.pi * (_Y / 4 + np.abs(_X % 8 - 4) / 4))  # of a knit
_HOLES = ((_X + _Y) % 8 >= 2) & ((_X - _Y) % 8 >= 2) & (_X % 8 >= 2) & (_Y % 8 >= 2)  # between strands of cane
SCALE = 256.0  # [pixels per metre] of the masters: they span two metres
# How far from its colour a finish goes, as a share of it, where it has no second colour.
CONTRAST: Mapping[str, float] = {
    "plain": 0.0, "grain": 0.20, "weave": 0.09, "speckle": 0.08, "leather": 0.10, "boucle": 0.16, "velvet": 0.10, "brushed": 0.10, "concrete": 0.14,
    "marble": 0.2, "terrazzo": 0.3, "stripe": 0.2, "check": 0.2, "floral": 0.2, "cane": 0.3, "knit": 0.15, "leaf": 0.2,
}  # fmt: skip
FINEST = 256.0  # [pixels per metre]
LARGEST = 320  # pixels a side; a model too large for that at FINEST gets fewer per metre
MARGIN = 2  # pixels around each field, so that filtering does not mix neighbours
PLAIN = 6  # pixels a side of the field of a finish without a pattern
SHADES = 8  # of one finish
LEVEL = 4  # of zlib
GOLDEN = 0.6180339887498949


def tones(rng: np.random.Generator, pattern: Pattern, shape: tuple[int, int], scale: float) -> Tones:
    """Return a pattern's tones of `shape` (rows, columns) at `scale` [pixels per metre], from a place of its own."""
    if pattern in WHOLE:
        y, x = np.meshgrid(np.linspace(1, 0, shape[0]), np.linspace(0, 1, shape[1]), indexing="ij")
        tone = _DRAWN[pattern](rng, x, y, shape[1] / shape[0])
        return np.asarray(np.clip(tone + 0.04 * rng.uniform(-1, 1, shape), 0, 1))
    start = rng.integers(SIDE, size=2)
    rows, columns = ((start[k] + np.arange(shape[k]) * (SCALE / scale)).astype(np.int64) % SIDE for k in (0, 1))
    return np.asarray(_master(pattern)[rows[:, None], columns[None, :]])


def _spread(values: Tones) -> Tones:
    """Stretch to [0, 1] between the 2nd and the 98th percentile."""
    low, high = np.percentile(values, (2, 98))
    return np.asarray(np.clip((values - low) / max(high - low, 1e-9), 0, 1))


def _noise(rng: np.random.Generator, rows: float, columns: float) -> Tones:
    """Return smooth noise whose features are `rows` x `columns` pixels; it repeats: a Gaussian filter, by its spectrum."""
    along, across = (np.exp(-2 * (math.pi * sigma * frequency) ** 2) for sigma, frequency in ((rows, _ROWS), (columns, _COLUMNS)))
    spectrum = np.fft.rfft2(rng.standard_normal((SIDE, SIDE))) * along[:, None] * across
    return np.fft.irfft2(spectrum, (SIDE, SIDE))


@functools.cache
def _master(pattern: Pattern) -> Tones:
    """Return the repeating master (SIDE, SIDE) of a pattern, tones in [0, 1]."""
    rng = seeds.generator(0, "corpus.furniture.pattern", pattern)
    return np.asarray(np.clip(_MASTERS.get(pattern, _speckle)(rng), 0, 1))


def _speckle(rng: np.random.Generator) -> Tones:
    return rng.uniform(0, 1, (SIDE, SIDE))


def _grain(rng: np.random.Generator) -> Tones:
    bend = _noise(rng, 60, 40)
    rings = np.sin(2 * math.pi * (_X / SIDE * 22 + 3.5 * bend / np.abs(bend).max()))
    return _spread(0.35 * rings + 1.1 * _spread(_noise(rng, 14, 0.6)) + 0.6 * _spread(_noise(rng, 90, 5)))


def _concrete(rng: np.random.Generator) -> Tones:
    cloud = _spread(_noise(rng, 28, 28)) + 0.5 * _spread(_noise(rng, 5, 5))
    return np.where(_speckle(rng) < 0.004, 0.0, _spread(cloud + 0.15 * _speckle(rng)))


def _marble(rng: np.random.Generator) -> Tones:
    flow, ripple, mist = _noise(rng, 34, 34), _noise(rng, 6, 6), _spread(_noise(rng, 40, 40))
    vein = np.abs(flow / flow.std() + 0.35 * ripple / ripple.std())
    return np.asarray(0.85 * np.exp(-((vein / 0.09) ** 2)) + 0.25 * mist**2 + 0.35 * np.exp(-((vein / 0.5) ** 2)) * mist)


def _terrazzo(rng: np.random.Generator) -> Tones:
    chips = _noise(rng, 2.4, 2.4)
    return np.where(chips > 1.1 * chips.std(), 0.55 + 0.45 * _spread(_noise(rng, 6, 6)), 0.06 * _speckle(rng))


_MASTERS: Mapping[str, Callable[[np.random.Generator], Tones]] = {
    "grain": _grain,
    "weave": lambda rng: _spread(0.5 * _WARP + 0.8 * (_spread(_noise(rng, 0.5, 7)) + _spread(_noise(rng, 7, 0.5)))),
    "knit": lambda rng: _spread(_LOOPS + 0.3 * _speckle(rng)),
    "boucle": lambda rng: _spread(_noise(rng, 1.6, 1.6)),
    "velvet": lambda rng: _spread(_spread(_noise(rng, 22, 22)) + 0.2 * _spread(_noise(rng, 2, 2))),
    "leather": lambda rng: _spread(np.abs(_noise(rng, 2.2, 2.2)) ** 0.5),
    "brushed": lambda rng: _spread(_noise(rng, 60, 0.5)),
    "concrete": _concrete,
    "marble": _marble,
    "terrazzo": _terrazzo,
    "stripe": lambda rng: np.where(_X % 32 < 11, 0.95, 0.05) + 0.05 * _speckle(rng),
    "check": lambda rng: np.asarray(0.45 * (_X % 32 < 14) + 0.45 * (_Y % 32 < 14) + 0.1 * _speckle(rng)),
    "floral": lambda rng: _petals(rng) + 0.04 * _speckle(rng),
    "cane": lambda rng: np.where(_HOLES, 0.85, 0.0) + 0.1 * _speckle(rng),
    "leaf": lambda rng: _spread(_noise(rng, 8, 8)),
}


def _petals(rng: np.random.Generator) -> Tones:
    """Return flowers of five petals scattered over the master."""
    image = np.zeros((SIDE, SIDE))
    y, x = np.indices((33, 33)) - 16
    for cy, cx in rng.integers(SIDE, size=(90, 2)):
        turn, size = rng.uniform(0, 6.28), rng.uniform(0.6, 1.0)
        r, a = np.hypot(x, y) / (15 * size), np.arctan2(y, x) + turn
        flower = np.where(r < 0.25, 0.35, np.where(r < 0.62 + 0.35 * np.cos(5 * a), 0.95, 0.0))
        at = np.ix_((cy + np.arange(33)) % SIDE, (cx + np.arange(33)) % SIDE)
        image[at] = np.maximum(image[at], flower)
    return image


def _rug_border(rng: np.random.Generator, x: Tones, y: Tones, aspect: float) -> Tones:
    edge = np.minimum(np.minimum(x, 1 - x) * aspect, np.minimum(y, 1 - y)) / min(aspect, 1.0)
    wide = rng.uniform(0.05, 0.1)
    lines = np.where((edge > wide) & (edge < wide + 0.025), 1.0, np.where((edge > wide + 0.05) & (edge < wide + 0.06), 0.7, 0.0))
    r = np.hypot((x - 0.5) * aspect, y - 0.5) / min(aspect, 1.0)
    rosette = np.where(r < 0.3 + 0.05 * np.cos(12 * np.arctan2(y - 0.5, (x - 0.5) * aspect)), 0.5 + 0.5 * np.cos(40 * r), 0.0)
    return np.asarray(0.06 + lines + rosette * (edge > wide + 0.07))


def _rug_diamonds(rng: np.random.Generator, x: Tones, y: Tones, aspect: float) -> Tones:
    cells = rng.integers(3, 6)
    u = np.abs((x * aspect * cells) % 1 - 0.5) + np.abs((y * cells) % 1 - 0.5)
    return np.where(np.abs(u - 0.5) < 0.06, 1.0, np.where(u < 0.16, 0.8, 0.05))


def _art_hills(rng: np.random.Generator, x: Tones, y: Tones, aspect: float) -> Tones:
    image: Tones = 0.9 - 0.25 * (1 - y)
    for k in range(4):
        phase, pitch = rng.uniform(0, 6.28, 2)
        ridge = 0.62 - 0.15 * k + 0.09 * np.sin(3.2 * x * aspect + phase) + 0.03 * np.sin(9 * x * aspect + pitch)
        image = np.where(y < ridge, 0.62 - 0.19 * k, image)
    sun = np.hypot((x - rng.uniform(0.25, 0.75)) * aspect, y - 0.8) < 0.09
    return np.where(sun & (image > 0.64), 1.0, image)


def _art_circles(rng: np.random.Generator, x: Tones, y: Tones, aspect: float) -> Tones:
    image = np.full(x.shape, 0.06)
    for _ in range(6):
        cx, cy, r = rng.uniform(0.15, 0.85), rng.uniform(0.15, 0.85), rng.uniform(0.08, 0.3)
        image = np.where(np.hypot((x - cx) * aspect, y - cy) < r, rng.uniform(0.25, 1.0), image)
    return image


def _art_lines(rng: np.random.Generator, x: Tones, y: Tones, aspect: float) -> Tones:
    image = np.full(x.shape, 0.05)
    for _ in range(14):
        a, b, c = rng.uniform(0, 1), rng.uniform(-0.3, 0.3), rng.uniform(1, 8)
        image = np.where(np.abs(y - a - b * x - 0.05 * np.sin(c * x * aspect)) < rng.uniform(0.003, 0.012), rng.uniform(0.5, 1), image)
    return image


def _art_blocks(rng: np.random.Generator, x: Tones, y: Tones, aspect: float) -> Tones:
    image = np.full(x.shape, 0.1)
    for _ in range(9):
        x0, y0, w, h = rng.uniform(-0.1, 0.9), rng.uniform(-0.1, 0.9), rng.uniform(0.1, 0.5), rng.uniform(0.1, 0.5)
        image = np.where((x > x0) & (x < x0 + w) & (y > y0) & (y < y0 + h), rng.uniform(0, 1), image)
    return image


def _dial(rng: np.random.Generator, x: Tones, y: Tones, aspect: float) -> Tones:
    r, a = np.hypot(x - 0.5, y - 0.5) * 2, np.arctan2(x - 0.5, y - 0.5)
    marks = (r > 0.74) & (r < 0.88) & (np.abs((a * 6 / math.pi + 0.5) % 1 - 0.5) < 0.1)
    wide = 0.045 / np.maximum(r, 0.1)
    hands = ((r < 0.5) & (np.abs(a - 1.05) < wide)) | ((r < 0.72) & (np.abs(a + 1.05) < 0.6 * wide))
    return np.where(marks | hands, 1.0, 0.0)


_DRAWN: Mapping[str, Callable[[np.random.Generator, Tones, Tones, float], Tones]] = {
    "rug_border": _rug_border,
    "rug_diamonds": _rug_diamonds,
    "rug_stripes": lambda rng, _, y, __: np.asarray(rng.uniform(0, 1, 10)[np.searchsorted(np.sort(rng.random(9)), y)]),
    "art_hills": _art_hills,
    "art_circles": _art_circles,
    "art_lines": _art_lines,
    "art_blocks": _art_blocks,
    "dial": _dial,
}
# Patterns that are drawn once over their whole piece: never turned, never shifted.
WHOLE = frozenset(_DRAWN)


@dataclass(frozen=True, slots=True)
class Atlas:
    """Fields of all finishes of a model, side by side at the bottom of an image of `width` x `height` pixels.

    `fields` are (left edge, width, height) [pixels] by finish; `scale` [pixels per metre].
    """

    fields: Mapping[Finish, tuple[int, int, int]]
    width: int
    height: int
    scale: float

    def uv(self, pieces: Sequence[Piece], points: NDArray[np.float64], faces: Topology, side: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the texture coordinates (C, 2) of the corners of pieces' faces, whose vertices are `points` (V, 3) [m].

        A face is seen along one axis, `side` (C,); the longer extent of its piece across that axis lies along the grain (v). Pieces lie
        at different places of their finish's field, by their place in the list.
        """
        whole, plain = (np.array([test(p.finish.pattern) for p in pieces]) for test in (WHOLE.__contains__, "plain".__eq__))
        field = np.array([self.fields[piece.finish] for piece in pieces], float)
        counts = [len(piece.solid.vertices) for piece in pieces]
        firsts = np.cumsum([0, *counts[:-1]])
        low = np.minimum.reduceat(points, firsts)
        extent = np.maximum.reduceat(points, firsts) - low
        scale = np.where(plain, (PLAIN - 2 * MARGIN) / np.maximum(extent.max(axis=1), 1e-9), self.scale)
        number = np.arange(len(pieces))[:, None]
        axes, starts = np.empty((len(pieces), 3, 2), np.int64), np.empty((len(pieces), 3, 2))
        for axis in range(3):
            i, j = (a for a in range(3) if a != axis)
            along = ((extent[:, j] >= extent[:, i]) | whole)[:, None]
            axes[:, axis] = np.where(along, (i, j), (j, i))
            room = field[:, 1:] - 2 * MARGIN - scale[:, None] * np.take_along_axis(extent, axes[:, axis], axis=1)
            place = np.concatenate([number * GOLDEN + 0.3 * axis, number * GOLDEN**2 + 0.7 * axis], axis=1) % 1
            starts[:, axis] = field[:, :1] * (1, 0) + MARGIN + np.where(whole[:, None], 0.0, np.maximum(room, 0)) * place
        piece = np.repeat(np.arange(len(pieces)), counts)[faces.corners]
        local = np.take_along_axis(points[faces.corners] - low[piece], axes[piece, side], axis=1) * scale[piece, None]
        return np.asarray((starts[piece, side] + local) / np.array([self.width, self.height]))


def atlas(pieces: Iterable[Piece]) -> Atlas:
    """Return the atlas of a model: each finish gets a field as large as its largest piece, side by side, at one scale."""
    reach: dict[Finish, NDArray[np.float64]] = {}
    for piece in pieces:
        low, high = piece.solid.bounds()
        extent = high - low
        whole = piece.finish.pattern in WHOLE
        across = np.array([extent[0], extent[1:].max()]) if whole else np.sort(extent)[1:]
        reach[piece.finish] = np.maximum(reach.get(piece.finish, np.zeros(2)), across)
    patterned = [size for finish, size in reach.items() if finish.pattern != "plain"]
    scale = FINEST
    if patterned:
        room = LARGEST - len(reach) * (PLAIN + 2 * MARGIN)
        scale = min(scale, room / sum(float(s[0]) for s in patterned), room / max(float(s[1]) for s in patterned))
    fields, x = {}, 0
    for finish, size in reach.items():
        w, h = (PLAIN, PLAIN) if finish.pattern == "plain" else (math.ceil(float(e) * scale) + 2 * MARGIN for e in size)
        fields[finish] = (x, w, h)
        x += w
    return Atlas(fields, x, max(h for _, _, h in fields.values()), scale)


def paint(rng: np.random.Generator, sheet: Atlas) -> bytes:
    """Return the atlas as the bytes of a PNG with a palette."""
    image = np.zeros((sheet.height, sheet.width), np.uint8)
    shades = min(SHADES, 256 // len(sheet.fields))
    palette = np.zeros((shades * len(sheet.fields), 3))
    levels = np.linspace(0, 1, shades)
    for k, (finish, (x, width, height)) in enumerate(sheet.fields.items()):
        palette[k * shades : (k + 1) * shades] = _colors(finish, levels)
        spot = image[sheet.height - height :, x : x + width]
        if finish.pattern == "plain":
            spot[:] = k * shades + shades // 2
        else:
            tone = tones(rng, finish.pattern, spot.shape, sheet.scale)
            spot[:] = k * shades + np.minimum(tone * shades, shades - 1).astype(np.uint8)
    colors = np.round(255 * display(np.clip(palette, 0, 1))).astype(np.uint8)
    return png.encode(np.pad(image, ((0, 0), (1, 0))), sheet.width, LEVEL, colors.tobytes())


def _colors(finish: Finish, tones: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return linear colours (n, 3) of tones from 0 to 1: from the finish's colour to its second, or about its colour."""
    color = np.array(finish.color)
    if finish.second is not None:
        return np.asarray(color + tones[:, None] * (np.array(finish.second) - color))
    return np.asarray(color * (1 + CONTRAST[finish.pattern] * (2 * tones[:, None] - 1)))
