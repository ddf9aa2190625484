"""Bar stools, dressing stools, benches, ottomans and poufs. The front is -y. Lengths in metres."""

import math

import numpy as np

from pipeline.corpus.furniture.bent import arc, tube, turns, wall
from pipeline.corpus.furniture.finishes import Finish, Scheme
from pipeline.corpus.furniture.intervals import around, polar, split
from pipeline.corpus.furniture.legs import METAL, draw_kind, inside, leg_finish, legs
from pipeline.corpus.furniture.shape import Shape, Size, pieces
from pipeline.corpus.furniture.solids import board, box, circle, cushion, revolve, rod, slab, standing
from pipeline.corpus.furniture.upholstery import piping, seat_cushion, tufted_panel, upright_pad


def dressing_chair(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a round upholstered stool, one with a low curved back, or a drum with a skirt."""
    w, d, h = size
    seat = h if h < 0.56 else min(0.48, 0.6 * h)
    low, squash = seat - 0.11, d / w
    if form == "drum":
        parts = pieces("body", revolve([(0.44 * w, 0.0), (0.46 * w, 0.03), (0.46 * w, low)], 28, squash=squash), scheme.second)
    else:
        kind = draw_kind(rng, scheme, "plank cross sled horse block bun pipe")
        half = 0.31 * w
        parts = pieces("legs", legs(kind, (half, half * d / w), low - 0.012, 0.034), leg_finish(scheme, kind))
        parts += pieces("ring", slab(circle(0.45 * w, 24, squash=squash), (low - 0.012, low), 0.003), leg_finish(scheme, kind))
    backed = h > seat + 0.1
    profile = [(0.46 * w, low), (0.495 * w, low + 0.015), (0.5 * w, low + 0.04), (0.5 * w, seat - 0.05)]
    profile += [(0.47 * w, seat - 0.018), (0.36 * w, seat - 0.003), (0.2 * w, seat)]
    if backed:
        profile = [(0.85 * r, z) for r, z in profile]
    parts += pieces("seat", revolve(profile, 28, squash=squash), scheme.soft)
    if backed:
        bow = arc((0.0, 0.0), 0.467 * w, 0.06 * math.pi, 0.94 * math.pi, 10, squash)
        rise = 0.55 + 0.45 * np.sin(np.linspace(0.1, math.pi - 0.1, 11))
        parts += pieces("back", wall(bow, 0.06, low, seat + (h - seat) * rise / rise.max(), 0.025), scheme.soft)
    return Shape(parts)


def barstool(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a high seat on four legs or on a column; a foot rest goes around it."""
    w, d, h = size
    seat = h if h < 0.85 else 0.72 * h
    x, y = w / 2, d / 2
    metal, top = scheme.handle, seat - 0.075
    if form == "pedestal":
        r, z = min(w, d), 0.32 * seat
        column = [(0.46 * r, 0.0), (0.46 * r, 0.012), (0.05, 0.035), (0.028, 0.05), (0.026, top - 0.012), (0.11, top - 0.01), (0.11, top)]
        hoop = arc((0.0, 0.0), 0.3 * r, 0, 2 * math.pi, 14)[:-1]
        rest = tube(np.column_stack([hoop, np.full(14, z)]), 0.009, 6, closed=True)
        rest += [rod(polar(0.028, a, z), polar(0.3 * r - 0.009, a, z), 0.007, n=6) for a in turns(3, math.pi / 2)]
        parts = pieces("column", revolve(column, 24), metal) + pieces("foot_rest", rest, metal)
    else:
        kind = draw_kind(rng, scheme, "plank cross sled block bun hairpin blade cabriole")
        finish = leg_finish(scheme, kind)
        half = inside(kind, (x, y), top - 0.02, 0.036)
        frame = board(around(0.46 * w), around(0.44 * d), (top - 0.02, top), 0.03, 2, 0.003)
        parts = pieces("legs", legs(kind, half, top - 0.02, 0.036), finish) + pieces("frame", frame, finish)
        z, out = 0.3 * seat, min(0.12 * top, 0.06) * 0.7 if kind == "splayed" else 0.0
        a, b = half[0] + out, half[1] + out
        rest = [rod((-a + 0.012, t * b, z), (a - 0.012, t * b, z), 0.009, n=8) for t in (-1, 1)]
        rest += [rod((s * a, -b + 0.012, z + 0.04), (s * a, b - 0.012, z + 0.04), 0.009, n=8) for s in (-1, 1)]
        parts += pieces("foot_rest", rest, metal if kind in METAL else finish)
    parts += seat_cushion((-x, x), (-y, 0.84 * y), (top, seat), 0.03, scheme.soft, piping(rng, scheme))
    if h > seat + 0.1:
        parts += pieces("back", upright_pad(rng, scheme, around(0.45 * w), (y - 0.055, y), (seat + 0.05, h)), scheme.soft)
        struts = [box(around(0.012, s * 0.3 * w), (0.85 * y, 0.85 * y + 0.012), (top, seat + 0.05), 0.002) for s in (-1, 1)]
        parts += pieces("struts", struts, metal)
    return Shape(parts)


def stool(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a bed-end bench, an ottoman, a stool on legs, a round pouf, or a ceramic drum."""
    w, d, h = size
    x, y = w / 2, d / 2
    if form == "drum":
        profile = [(0.62, 0.0), (0.7, 0.06), (0.92, 0.26), (1.0, 0.5), (0.92, 0.74), (0.7, 0.94), (0.62, 1.0)]
        glazed = Finish("glaze", scheme.soft.color, 0.2, density=900)
        return Shape(pieces("drum", revolve([(a * x, b * h) for a, b in profile], 24, squash=d / w), glazed))
    if form == "pouf":
        profile = [(0.6, 0.0), (0.86, 0.06), (0.97, 0.22), (1.0, 0.5), (0.97, 0.78), (0.86, 0.94), (0.5, 1.0)]
        wool = Finish("knit", scheme.soft.color, 0.95, pattern="knit", density=80)
        return Shape(pieces("pouf", revolve([(a * x, b * h) for a, b in profile], 28, squash=d / w), wool))
    cord = piping(rng, scheme)
    if form == "ottoman":
        low = 0.66 * h
        feet = legs("bun" if scheme.manner.ornament > 0.5 else "tapered", (x - 0.05, y - 0.05), 0.06, 0.05)
        body = cushion(around(x - 0.004), around(y - 0.004), (0.06, low), 0.02, 2)
        parts = pieces("feet", feet, scheme.timber) + pieces("body", body, scheme.soft)
        if rng.random() < scheme.manner.tufts and w > 0.4:
            pad = tufted_panel((-x, x), (-0.34 * h, 0.0), (-y, y), max(2, round(w / 0.22)), max(2, round(d / 0.22)))
            laid = standing(pad, (0, 0, 0))
            drop = low - min(float(s.vertices[:, 2].min()) for s in laid)
            return Shape(parts + pieces("seat", [s.moved((0, 0, drop)) for s in laid], scheme.soft))
        return Shape(parts + seat_cushion((-x, x), (-y, y), (low, h), 0.05, scheme.soft, cord))
    kind = draw_kind(rng, scheme, "bun blade")
    half = inside(kind, (x, y), h - 0.1, 0.04)
    thick = min(0.12, 0.3 * h) if form == "bench" else 0.07
    finish, top = leg_finish(scheme, kind), h - thick
    parts = pieces("legs", legs(kind, half, top - 0.035, 0.04), finish)
    parts += pieces("frame", board(around(x - 0.008), around(y - 0.008), (top - 0.035, top), 0.02, 2, 0.004), finish)
    if form == "legs" and rng.random() < 0.35:
        return Shape(parts + pieces("seat", board((-x, x), (-y, y), (top, h), 0.03, 3, scheme.manner.edge), scheme.body))
    for span in split((-x, x), max(1, round(w / 0.55)) if form == "bench" else 1, 0.001):
        parts += seat_cushion(span, (-y, y), (top, h), 0.04, scheme.soft, cord)
    return Shape(parts)
