"""Coffee, side and end tables. Lengths in metres."""

from __future__ import annotations

import math

import numpy as np

from pipeline.corpus.furniture.bent import arc, band, prism, turns
from pipeline.corpus.furniture.dining_tables import cased_table, legged_table, top, top_finish, trumpet
from pipeline.corpus.furniture.finishes import GLASS, Scheme, cane
from pipeline.corpus.furniture.legs import draw_kind, inside, leg_finish, legs, pedestal
from pipeline.corpus.furniture.shape import Shape, Size, pieces
from pipeline.corpus.furniture.solids import Solid, around, circle, polar, ring, rod, rounded_rectangle, slab


def coffee_table(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Legs with a lower shelf, a case with drawers, or a round tray."""
    w, d, h = size
    if form == "drawer":
        count = 2 if w > 0.9 else 1
        return cased_table(rng, size, scheme, drawer_height=min(0.13, 0.42 * h), count=count)
    if form == "legs":
        shape = legged_table(rng, size, scheme, without="block plank")
        if h > 0.3 and rng.random() < 0.5:
            lower = slab(rounded_rectangle(around(0.36 * w), around(0.34 * d), 0.02, 2), (0.26 * h, 0.26 * h + 0.016), 0.003)
            return Shape(shape.base + pieces("shelf", lower, cane(rng) if rng.random() < scheme.manner.cane else scheme.body))
        return shape
    rim = ring((w / 2, w / 2), (w / 2 - 0.012, w / 2 - 0.012), (h - 0.05, h), 36)
    parts = pieces("rim", rim, scheme.handle) + pieces(
        "tray", slab(circle(w / 2 - 0.0125, 36), (h - 0.05, h - 0.03), 0.002), top_finish(rng, scheme)
    )
    kind = draw_kind(rng, scheme, "plank cross sled block bun horse pipe")
    half = inside(kind, (0.36 * w, 0.36 * w), h - 0.05, 0.04)
    return Shape(parts + pieces("legs", legs(kind, half, h - 0.05, 0.04), leg_finish(scheme, kind)))


def corner_side_table(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Legs with a shelf, a pedestal or a drawer."""
    w, d, h = size
    if form == "drawer":
        return cased_table(rng, size, scheme, drawer_height=0.12, count=1)
    if form == "legs":
        shape = legged_table(rng, size, scheme, without="block plank")
        if rng.random() < 0.55:
            board = slab(rounded_rectangle(around(0.34 * w), around(0.32 * d), 0.02, 2), (0.3 * h, 0.3 * h + 0.014), 0.003)
            return Shape(shape.base + pieces("shelf", board, scheme.body))
        return shape
    material = top_finish(rng, scheme, stone=1.6)
    parts = pieces("top", top(circle(w / 2, 32), (h - 0.024, h), scheme), material)
    return Shape(parts + pieces("pedestal", pedestal(rng, scheme, 0.36 * w, h - 0.024), scheme.accent))


def round_end_table(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Three splayed legs, a drum with an open side, a tulip foot, or a tray on a tripod."""
    w, _, h = size
    t = 0.022
    material = top_finish(rng, scheme, stone=1.4)
    if form == "tulip":
        parts = pieces("top", top(circle(w / 2, 32), (h - t, h), scheme), material)
        return Shape(parts + pieces("foot", trumpet(0.34 * w, h - t), scheme.front))
    if form == "drum":
        parts = pieces("top", slab(circle(w / 2, 32), (h - t, h), 0.004), material)
        bow = arc((0.0, 0.0), 0.45 * w, -0.2 * math.pi, 1.2 * math.pi, 14)
        parts += pieces("wall", band(bow, 0.014, (0.02, h - t)), scheme.front)
        parts += pieces("boards", [slab(circle(0.44 * w, 28), (z, z + 0.016)) for z in (0.45 * h,)], scheme.body)
        return Shape(parts + pieces("foot", slab(circle(0.46 * w, 28), (0.0, 0.02), 0.003), scheme.body))
    if form == "tray":
        parts = pieces("rim", ring((w / 2, w / 2), (w / 2 - 0.008, w / 2 - 0.008), (h - 0.035, h), 32), scheme.handle)
        parts += pieces("tray", slab(circle(w / 2 - 0.0085, 32), (h - 0.035, h - 0.022)), material)
    else:
        parts = pieces("top", top(circle(w / 2, 32), (h - t, h), scheme), material)
    under = h - (0.035 if form == "tray" else t)
    solids: list[Solid] = []
    for a in turns(3, -math.pi / 2):
        u = np.array([math.cos(a), math.sin(a)])
        solids.append(rod((*(0.44 * w * u), 0), (*(0.2 * w * u), under - 0.012), 0.011, 0.018, 10))
    solids.append(slab(circle(0.27 * w, 24), (under - 0.012, under), 0.002))
    parts += pieces("legs", solids, scheme.timber if form == "tripod" else scheme.handle)
    if rng.random() < 0.4 and form == "tripod":
        parts += pieces(
            "shelf",
            prism(np.array([polar(0.26 * w, a) for a in turns(3, -math.pi / 2)]), "z", (0.38 * h, 0.38 * h + 0.014)),
            GLASS if rng.random() < 0.4 else scheme.body,
        )
    return Shape(parts)
