"""Coffee, side and end tables. Lengths in metres."""

import math

import numpy as np

from pipeline.corpus.furniture.bent import arc, band, prism, turns
from pipeline.corpus.furniture.dining_tables import cased_table, legged_table, top, top_finish, trumpet
from pipeline.corpus.furniture.finishes import GLASS, Scheme, cane
from pipeline.corpus.furniture.intervals import around, polar
from pipeline.corpus.furniture.legs import draw_kind, inside, leg_finish, legs, pedestal
from pipeline.corpus.furniture.shape import Shape, Size, pieces
from pipeline.corpus.furniture.solids import board, circle, ring, rod, slab


def coffee_table(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Legs with a lower shelf, a case with drawers, or a round tray."""
    w, d, h = size
    if form == "drawer":
        return cased_table(rng, size, scheme, drawer_height=min(0.13, 0.42 * h), count=2 if w > 0.9 else 1)
    if form == "legs":
        shape = legged_table(rng, size, scheme, without="block plank")
        if h <= 0.3 or rng.random() >= 0.5:
            return shape
        lower = board(around(0.36 * w), around(0.34 * d), (0.26 * h, 0.26 * h + 0.016), 0.02, 2, 0.003)
        return Shape(shape.base + pieces("shelf", lower, cane(rng) if rng.random() < scheme.manner.cane else scheme.body))
    under = h - 0.05
    parts = pieces("rim", ring((w / 2, w / 2), (w / 2 - 0.012, w / 2 - 0.012), (under, h), 36), scheme.handle)
    parts += pieces("tray", slab(circle(w / 2 - 0.0125, 36), (under, h - 0.03), 0.002), top_finish(rng, scheme))
    kind = draw_kind(rng, scheme, "plank cross sled block bun horse pipe")
    half = inside(kind, (0.36 * w, 0.36 * w), under, 0.04)
    return Shape(parts + pieces("legs", legs(kind, half, under, 0.04), leg_finish(scheme, kind)))


def corner_side_table(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Legs with a shelf, a pedestal or a drawer."""
    w, d, h = size
    if form == "drawer":
        return cased_table(rng, size, scheme, drawer_height=0.12, count=1)
    if form == "legs":
        shape = legged_table(rng, size, scheme, without="block plank")
        if rng.random() >= 0.55:
            return shape
        lower = board(around(0.34 * w), around(0.32 * d), (0.3 * h, 0.3 * h + 0.014), 0.02, 2, 0.003)
        return Shape(shape.base + pieces("shelf", lower, scheme.body))
    parts = pieces("top", top(circle(w / 2, 32), (h - 0.024, h), scheme), top_finish(rng, scheme, stone=1.6))
    return Shape(parts + pieces("pedestal", pedestal(rng, scheme, 0.36 * w, h - 0.024), scheme.accent))


def round_end_table(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Three splayed legs, a drum with an open side, a tulip foot, or a tray on a tripod."""
    w, _, h = size
    material = top_finish(rng, scheme, stone=1.4)
    under = h - (0.035 if form == "tray" else 0.022)
    if form == "drum":
        bow = arc((0.0, 0.0), 0.45 * w, -0.2 * math.pi, 1.2 * math.pi, 14)
        parts = pieces("top", slab(circle(w / 2, 32), (under, h), 0.004), material)
        parts += pieces("wall", band(bow, 0.014, (0.02, under)), scheme.front)
        parts += pieces("boards", slab(circle(0.44 * w, 28), (0.45 * h, 0.45 * h + 0.016)), scheme.body)
        return Shape(parts + pieces("foot", slab(circle(0.46 * w, 28), (0.0, 0.02), 0.003), scheme.body))
    if form == "tray":
        parts = pieces("rim", ring((w / 2, w / 2), (w / 2 - 0.008, w / 2 - 0.008), (under, h), 32), scheme.handle)
        parts += pieces("tray", slab(circle(w / 2 - 0.0085, 32), (under, h - 0.022)), material)
    else:
        parts = pieces("top", top(circle(w / 2, 32), (under, h), scheme), material)
    if form == "tulip":
        return Shape(parts + pieces("foot", trumpet(0.34 * w, under), scheme.front))
    angles = turns(3, -math.pi / 2)
    solids = [rod(polar(0.44 * w, a, 0), polar(0.2 * w, a, under - 0.012), 0.011, 0.018, 10) for a in angles]
    solids.append(slab(circle(0.27 * w, 24), (under - 0.012, under), 0.002))
    parts += pieces("legs", solids, scheme.timber if form == "tripod" else scheme.handle)
    if rng.random() < 0.4 and form == "tripod":
        shelf = prism(np.array([polar(0.26 * w, a) for a in angles]), "z", (0.38 * h, 0.38 * h + 0.014))
        parts += pieces("shelf", shelf, GLASS if rng.random() < 0.4 else scheme.body)
    return Shape(parts)
