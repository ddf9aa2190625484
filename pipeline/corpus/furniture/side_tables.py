"""Coffee, side and end tables. Lengths in metres."""

from __future__ import annotations

import math

import numpy as np

from pipeline.corpus.furniture.bent import arc, band, curve, prism, tube, turns
from pipeline.corpus.furniture.dining_tables import apron, cased_table, fluted_drum, legged_table, rails, top, top_finish, trumpet
from pipeline.corpus.furniture.finishes import GLASS, Scheme, cane
from pipeline.corpus.furniture.legs import draw_kind, inside, leg_finish, legs, pedestal
from pipeline.corpus.furniture.shape import Piece, Shape, pieces
from pipeline.corpus.furniture.solids import Solid, box, circle, revolve, ring, rod, rounded_rectangle, slab
from pipeline.corpus.furniture.storage import Size


def coffee_table(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:  # noqa: PLR0911 - one return per form
    """Legs with a lower shelf, a drum, a sled frame, a case with drawers, two planks, a round tray, a block, or a Ming table."""
    w, d, h = size
    if form == "drawer":
        count = 2 if w > 0.9 else 1
        return cased_table(rng, size, scheme, drawer_height=min(0.13, 0.42 * h), count=count)
    if form == "ming":
        return _ming(size, scheme)
    if form in ("legs", "oval"):
        shape = legged_table(rng, size, scheme, without="block plank")
        if h > 0.3 and form == "legs" and rng.random() < 0.5:
            lower = slab(rounded_rectangle((-0.36 * w, 0.36 * w), (-0.34 * d, 0.34 * d), 0.02, 2), (0.26 * h, 0.26 * h + 0.016), 0.003)
            return Shape(shape.base + pieces("shelf", lower, cane(rng) if rng.random() < scheme.manner.cane else scheme.body))
        return shape
    if form == "drum":
        return Shape(_drum(rng, size, scheme))
    if form == "tray":
        rim = ring((w / 2, w / 2), (w / 2 - 0.012, w / 2 - 0.012), (h - 0.05, h), 36)
        parts = pieces("rim", rim, scheme.handle) + pieces(
            "tray", slab(circle(w / 2 - 0.0125, 36), (h - 0.05, h - 0.03), 0.002), top_finish(rng, scheme)
        )
        kind = draw_kind(rng, scheme, "plank cross sled block bun horse pipe")
        half = inside(kind, (0.36 * w, 0.36 * w), h - 0.05, 0.04)
        return Shape(parts + pieces("legs", legs(kind, half, h - 0.05, 0.04), leg_finish(scheme, kind)))
    if form == "block":
        t = min(0.05, 0.14 * h)
        material = top_finish(rng, scheme, stone=1.6)
        edge = rounded_rectangle((-w / 2, w / 2), (-d / 2, d / 2), float(rng.choice([0.02, 0.1, 0.2])) * min(1.0, d), 5)
        parts = pieces("top", slab(edge, (h - t, h), scheme.manner.edge), material)
        low = slab(edge * 0.86, (0.0, 0.03), 0.003)
        return Shape(parts + pieces("body", slab(edge * 0.93, (0.03, h - t), 0.003), scheme.front) + pieces("plinth", low, scheme.handle))
    if form == "planks":
        return Shape(_planks(size, scheme))
    t = 0.02
    bars = hoops(w, d, h - t, 0.026)
    material = top_finish(rng, scheme, stone=1.4)
    return Shape(
        pieces("top", slab(rounded_rectangle((-w / 2, w / 2), (-d / 2, d / 2), 0.01, 3), (h - t, h), 0.003), material)
        + pieces("frame", bars, scheme.handle)
    )


def _drum(rng: np.random.Generator, size: Size, scheme: Scheme) -> tuple[Piece, ...]:
    """Build a round top on a fluted drum, or on hoops with rods between them."""
    w, _, h = size
    parts = pieces("top", slab(circle(w / 2, 36), (h - 0.026, h), 0.005), top_finish(rng, scheme, stone=1.6))
    if rng.random() < 0.45:
        return parts + fluted_drum(0.40 * w, h - 0.026, scheme)
    hoop = [ring((0.44 * w, 0.44 * w), (0.44 * w - 0.012, 0.44 * w - 0.012), z, 28) for z in ((0.0, 0.014), (h - 0.04, h - 0.026))]
    rods = [
        rod(
            (0.435 * w * math.cos(a), 0.435 * w * math.sin(a), 0.014),
            (0.435 * w * math.cos(a), 0.435 * w * math.sin(a), h - 0.04),
            0.005,
            n=6,
        )
        for a in turns(22)
    ]
    return parts + pieces("hoops", hoop[0] + hoop[1], scheme.handle) + pieces("rods", rods, scheme.handle)


def _planks(size: Size, scheme: Scheme) -> tuple[Piece, ...]:
    """Build two planks on posts, one lower than the other."""
    w, d, h = size
    t, wide = 0.05, 0.5 * w
    spans = ((-w / 2, -w / 2 + wide + 0.12 * w), (w / 2 - wide - 0.06 * w, w / 2))
    parts = pieces(
        "top",
        [
            slab(rounded_rectangle(spans[0], (-d / 2, 0.25 * d), 0.02, 3), (h - t, h), 0.005),
            slab(rounded_rectangle(spans[1], (-0.3 * d, d / 2), 0.02, 3), (0.68 * h - t, 0.68 * h), 0.005),
        ],
        scheme.body,
    )
    legs_ = [
        box((spans[0][0] + 0.03, spans[0][0] + 0.07), (-0.42 * d, 0.18 * d), (0, h - t), 0.004),
        box((spans[0][1] - 0.05, spans[0][1] - 0.01), (-0.42 * d, -0.302 * d), (0, h - t), 0.004),
    ]
    legs_.append(box((spans[1][1] - 0.07, spans[1][1] - 0.03), (-0.22 * d, 0.42 * d), (0, 0.68 * h - t), 0.004))
    legs_.append(box((spans[1][0] + 0.02, spans[1][0] + 0.06), (0.3 * d, 0.42 * d), (0, 0.68 * h - t), 0.004))
    return parts + pieces("legs", legs_, scheme.accent)


def _ming(size: Size, scheme: Scheme) -> Shape:
    """Build a floating panel in a frame over a waist, humped rails, and legs with hoof feet."""
    w, d, h = size
    t, wood = 0.03, scheme.timber
    rim = 0.05
    x, y = w / 2, d / 2
    frame = [box((-x, x), (s * (y - rim / 2) - rim / 2, s * (y - rim / 2) + rim / 2), (h - t, h), 0.004) for s in (-1, 1)]
    frame += [box((s * (x - rim / 2) - rim / 2, s * (x - rim / 2) + rim / 2), (-y + rim, y - rim), (h - t, h), 0.004) for s in (-1, 1)]
    parts = pieces("frame", frame, wood) + pieces(
        "panel",
        box((-x + rim, x - rim), (-y + rim, y - rim), (h - t + 0.004, h - 0.004)),
        scheme.stone if scheme.manner.stone > 0.15 else scheme.body,
    )
    parts += pieces("waist", apron(w, d, (h - t - 0.025, h - t), 0.03, 0.014), wood)
    under = h - t - 0.025
    half = (x - 0.045, y - 0.045)
    parts += pieces("legs", legs("horse", half, under, 0.055), wood)
    parts += pieces("apron", rails(half, (under - 0.045, under), 0.026), wood)
    for s in (-1, 1):
        path = curve(
            [
                (-half[0] + 0.03, s * half[1], under - 0.13),
                (-0.5 * half[0], s * half[1], under - 0.085),
                (0.5 * half[0], s * half[1], under - 0.085),
                (half[0] - 0.03, s * half[1], under - 0.13),
            ],
            2,
        )
        parts += pieces("humped_rail", tube(path, 0.011, 8), wood)
    return Shape(parts)


def hoops(w: float, d: float, height: float, thick: float) -> list[Solid]:
    """Return two rectangular loops of square tube that stand under the ends of a top."""
    solids = []
    for s in (-1, 1):
        x = s * 0.38 * w
        span_x = (x - thick / 2, x + thick / 2)
        solids += [box(span_x, (sy * (0.44 * d) - thick / 2, sy * 0.44 * d + thick / 2), (thick, height - thick), 0.002) for sy in (-1, 1)]
        solids += [box(span_x, (-0.44 * d - thick / 2, 0.44 * d + thick / 2), z, 0.002) for z in ((0, thick), (height - thick, height))]
    return solids


def corner_side_table(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:  # noqa: PLR0911 - one return per form
    """Legs with a shelf, a pedestal, a C that reaches over a seat, a drawer, a drum, an hourglass, or a Ming stand."""
    w, d, h = size
    if form == "drawer":
        return cased_table(rng, size, scheme, drawer_height=0.12, count=1)
    if form == "ming":
        return _ming(size, scheme)
    if form == "legs":
        shape = legged_table(rng, size, scheme, without="block plank")
        if rng.random() < 0.55:
            board = slab(rounded_rectangle((-0.34 * w, 0.34 * w), (-0.32 * d, 0.32 * d), 0.02, 2), (0.3 * h, 0.3 * h + 0.014), 0.003)
            return Shape(shape.base + pieces("shelf", board, scheme.body))
        return shape
    material = top_finish(rng, scheme, stone=1.6)
    if form == "c_shape":
        t = 0.018
        parts = pieces("top", slab(rounded_rectangle((-w / 2, w / 2), (-d / 2, d / 2), 0.02, 3), (h - t, h), 0.003), material)
        r = 0.011
        frame = []
        for s in (-1, 1):
            path = [
                (s * 0.4 * w, -0.42 * d, r),
                (s * 0.4 * w, 0.44 * d - 0.04, r),
                (s * 0.4 * w, 0.44 * d, 0.04 + r),
                (s * 0.4 * w, 0.44 * d, h - t),
            ]
            frame += tube(path, r, 8)
        frame += [rod((-0.4 * w + r, -0.42 * d + r, r), (0.4 * w - r, -0.42 * d + r, r), r, n=8)]
        return Shape(parts + pieces("frame", frame, scheme.handle))
    parts = pieces("top", top(circle(w / 2, 32), (h - 0.024, h), scheme), material)
    if form == "drum":
        return Shape(parts + fluted_drum(0.42 * w, h - 0.024, scheme))
    if form == "hourglass":
        body = [(0.46, 0.0), (0.46, 0.03), (0.36, 0.2), (0.24, 0.5), (0.36, 0.8), (0.46, 1.0)]
        return Shape(parts + pieces("body", revolve([(a * w, b * (h - 0.024)) for a, b in body], 24), scheme.front))
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
            prism(
                np.array([(0.26 * w * math.cos(a), 0.26 * w * math.sin(a)) for a in turns(3, -math.pi / 2)]),
                "z",
                (0.38 * h, 0.38 * h + 0.014),
            ),
            GLASS if rng.random() < 0.4 else scheme.body,
        )
    return Shape(parts)
