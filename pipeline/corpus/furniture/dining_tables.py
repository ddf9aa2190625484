"""Dining tables and bars, and the parts that all tables share: tops, aprons, feet. Lengths in metres."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.bent import turns
from pipeline.corpus.furniture.casework import Cell, Column, case
from pipeline.corpus.furniture.finishes import Finish, Scheme
from pipeline.corpus.furniture.intervals import Interval, Spot, around, polar, split
from pipeline.corpus.furniture.legs import WIDE, draw_kind, inside, leg_finish, legs
from pipeline.corpus.furniture.shape import Pieces, Shape, Size, pieces
from pipeline.corpus.furniture.solids import Solid, beam, box, circle, revolve, rod, rounded_rectangle, slab
from pipeline.corpus.furniture.storage import case_style, front_style


def top_finish(rng: np.random.Generator, scheme: Scheme, *, stone: float = 1.0) -> Finish:
    """Draw what a table top is made of: the style's stone or glass at its chance times `stone`, else wood or lacquer."""
    return scheme.stone if rng.random() < stone * scheme.manner.stone else scheme.body


def outline(rng: np.random.Generator, scheme: Scheme, w: float, d: float) -> NDArray[np.float64]:
    """Draw a table top's outline: nearly square corners, well rounded ones, an oval, or a boat."""
    u = rng.random()
    if u < 0.12 and w > 1.2:
        t = np.linspace(-1, 1, 11)
        side = np.column_stack([w / 2 * t, (0.1 * t**2 - 0.5) * d])
        return np.concatenate([side, -side])
    radius = 0.012 + scheme.manner.edge if u < 0.55 else min(0.14, 0.2 * d) if u < 0.88 else 0.499 * min(w, d)
    return rounded_rectangle(around(w / 2), around(d / 2), radius, 4 if radius < 0.2 else 8)


def top(edge: NDArray[np.float64], z: Interval, scheme: Scheme) -> list[Solid]:
    """Return a table top: a plain board with eased edges, or where there is ornament one with a moulded rim below it."""
    ease = min(scheme.manner.edge, 0.4 * (z[1] - z[0]))
    if scheme.manner.ornament < 0.4:
        return [slab(edge, z, ease)]
    cut = z[1] - 0.45 * (z[1] - z[0])
    return [slab(edge * 0.965, (z[0], cut), 0.003), slab(edge, (cut, z[1]), min(ease, 0.4 * (z[1] - cut)))]


def legged_table(rng: np.random.Generator, size: Size, scheme: Scheme, *, without: str = "") -> Shape:
    """Build a top on legs of the style's form, joined by rails between them."""
    w, d, h = size
    t = float(rng.uniform(0.022, 0.036)) * min(scheme.manner.slim, 1.15)
    kind = draw_kind(rng, scheme, without + (" bun" if h > 0.3 else ""))
    material = top_finish(rng, scheme)
    parts = pieces("top", top(outline(rng, scheme, w, d), (h - t, h), scheme), material)
    finish = leg_finish(scheme, kind)
    thick = (0.062 if h > 0.6 else 0.046) * scheme.manner.slim
    room = 0.16 * min(w, d) if d > 0.9 * w else 0.05
    framed = kind in ("hairpin", "sled", "cross", "plank", "blade", "pipe")
    half = inside(kind, (w / 2 - room * 0.6 - (0.06 * w if kind in WIDE else 0), d / 2 - room * 0.6), h - t, thick)
    parts += pieces("legs", legs(kind, half, h - t, thick), finish)
    if kind in WIDE:  # a beam under the top keeps side frames apart
        parts += pieces("beam", box(around(half[0] - 0.032), (-0.02, 0.02), (h - t - 0.045, h - t - 0.001), 0.002), finish)
    if not framed:
        drop = (0.075 if h > 0.6 else 0.045) + 0.02 * scheme.manner.ornament
        gap = 0.5 * thick + (0.004 if kind not in ("turned", "fluted") else 0.0)
        parts += pieces("apron", rails(half, (h - t - drop, h - t), gap), finish)
    return Shape(parts)


def rails(half: Spot, z: Interval, gap: float) -> list[Solid]:
    """Return four rails between the tops of legs at (+-half), each `gap` short of a leg's middle."""
    x, y = half
    along = [box(around(x - gap), around(0.01, s * y), z, 0.002) for s in (-1, 1)]
    return along + [box(around(0.01, s * x), around(y - gap), z, 0.002) for s in (-1, 1)]


def dining_table(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Four legs, slab sides, a crossed base, a tulip foot, a drum, or a bar."""
    w, d, h = size
    t = float(rng.uniform(0.026, 0.042))
    if form == "legs":
        return legged_table(rng, size, scheme, without="block")
    material = top_finish(rng, scheme, stone=1.8)
    under = h - t
    if form in ("tulip", "drum"):
        parts = pieces("top", top(circle(w / 2, 36), (under, h), scheme), material)
        if form == "drum":
            return Shape(parts + fluted_drum(0.3 * w, under, scheme))
        return Shape(parts + pieces("pedestal", trumpet(0.32 * w, under), scheme.front))
    parts = pieces("top", top(outline(rng, scheme, w, d), (under, h), scheme), material)
    if form == "bar":
        return Shape(parts + _bar(size, t, scheme))
    if form == "cross":
        solids = [
            beam((s * (0.30 * w + dx), y, 0), (s * (0.14 * w * 0.4 + dx), y_top, under - 0.02), 0.06, 0.05)
            for dx, y, y_top in ((0.035, -0.32 * d, 0.3 * d), (0.105, 0.3 * d, -0.32 * d))
            for s in (-1, 1)
        ]
        solids.append(box(around(0.33 * w), around(0.36 * d), (under - 0.02, under), 0.003))
        return Shape(parts + pieces("cross", solids, scheme.handle if scheme.manner.tube > 0.3 else scheme.timber))
    x, half = 0.32 * w, 0.025
    solids = [box(around(half, s * x), around(0.4 * d), (0, under), 0.006) for s in (-1, 1)]
    solids.append(box(around(x - half), (-0.016, 0.016), (0.55 * h, under), 0.003))
    return Shape(parts + pieces("slabs", solids, scheme.body))


def trumpet(radius: float, height: float) -> list[Solid]:
    """Return a foot like an upturned trumpet: a thin disc that rises in one sweep into a slender stem."""
    disc = ((1.0, 0.0), (1.0, 0.008), (0.8, 0.02), (0.55, 0.045), (0.34, 0.1), (0.2, 0.22))
    stem = ((0.15, 0.42), (0.15, 0.66), (0.2, 0.82), (0.36, 0.95), (0.5, 1.0))
    return revolve([(a * radius, b * height) for a, b in (*disc, *stem)], 24)


def fluted_drum(radius: float, height: float, scheme: Scheme) -> Pieces:
    """Return a round base clad in upright half-round staves."""
    r = math.pi * radius / 30
    staves = [rod(polar(radius + 0.85 * r, a, 0.0), polar(radius + 0.85 * r, a, height), 0.95 * r, n=6) for a in turns(30)]
    return pieces("drum", revolve([(radius, 0.0), (radius, height)], 24), scheme.body) + pieces("staves", staves, scheme.body)


def _bar(size: Size, t: float, scheme: Scheme) -> Pieces:
    """Return a counter's front of upright boards on a plinth, a shelf behind it and a foot rail before it."""
    w, d, h = size
    y, half = -0.22 * d, 0.45 * w
    boards = [box(x, (y, y + 0.02), (0.06, h - t), 0.003) for x in split(around(0.46 * w), max(5, round(w / 0.14)), 0.001)]
    sides = [box(around(0.012, s * half), (y + 0.02, 0.42 * d), (0.0, h - t), 0.002) for s in (-1, 1)]
    shelves = [box(around(half - 0.012), (y + 0.02, 0.4 * d), (z, z + 0.02)) for z in (0.1, 0.48 * h)]
    parts = pieces("front", boards, scheme.front) + pieces("sides", sides, scheme.body) + pieces("shelf", shelves, scheme.body)
    parts += pieces("plinth", box((-half, half), (y + 0.004, y + 0.02), (0.0, 0.06)), scheme.handle)
    rail = [rod((-half, y - 0.1, 0.17), (half, y - 0.1, 0.17), 0.014, n=10)]
    rail += [rod((s * 0.36 * w, y, 0.17), (s * 0.36 * w, y - 0.087, 0.17), 0.009, n=8) for s in (-1, 0, 1)]
    return parts + pieces("rail", rail, scheme.handle)


def cased_table(rng: np.random.Generator, size: Size, scheme: Scheme, *, drawer_height: float, count: int) -> Shape:
    """Build a shallow case with a row of drawers on legs."""
    w, d, h = size
    style = front_style(rng, scheme, "slab slab shaker")
    how = replace(case_style(rng, scheme, style, "tapered square sled", (0.1, 0.2)), feet_height=max(0.05, h - drawer_height - 0.04))
    return case((w, d, h), [Column(1, (Cell("drawer"),)) for _ in range(count)], how)
