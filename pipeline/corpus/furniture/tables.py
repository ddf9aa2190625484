"""Tables: dining, coffee, side and end tables."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.casework import Cell, Column, case
from pipeline.corpus.furniture.finishes import GLASS, MARBLE, Finish, Scheme
from pipeline.corpus.furniture.shape import Shape, pieces
from pipeline.corpus.furniture.solids import Solid, beam, box, circle, revolve, ring, rod, rounded, slab
from pipeline.corpus.furniture.storage import Size, case_style, front_style, pick


def top_finish(rng: np.random.Generator, scheme: Scheme, *, stone: float = 0.15, glass: float = 0.08) -> Finish:
    """Draw what a table top is made of: mostly the body's finish, sometimes marble or glass."""
    u = rng.random()
    return MARBLE if u < stone else GLASS if u < stone + glass else scheme.body


def outline(rng: np.random.Generator, w: float, d: float) -> NDArray[np.float64]:
    """Draw a table top's outline: square corners softened, or well rounded, or (where nearly square) an oval."""
    u = rng.random()
    radius = 0.012 if u < 0.5 else min(0.12, 0.2 * d) if u < 0.85 else 0.499 * min(w, d)
    return rounded((-w / 2, w / 2), (-d / 2, d / 2), radius)


def legs(rng: np.random.Generator, w: float, d: float, height: float, kind: str, inset: float) -> list[Solid]:
    """Return four legs under a rectangle (w, d): square, tapered, turned, or A-shaped pairs."""
    made: list[Solid] = []
    thick = float(rng.uniform(0.035, 0.06)) * (1.0 if height > 0.55 else 0.8)
    for sx in (-1, 1):
        for sy in (-1, 1):
            x, y = sx * (w / 2 - inset - thick / 2), sy * (d / 2 - inset - thick / 2)
            if kind == "square":
                made.append(box((x - thick / 2, x + thick / 2), (y - thick / 2, y + thick / 2), (0, height), 0.003))
            elif kind == "tapered":
                made.append(beam((x, y, 0), (x, y, height), thick, thick, 0.55))
            elif kind == "splayed":
                made.append(
                    rod((x + sx * inset * 0.7, y + sy * inset * 0.7, 0), (x - sx * 0.03, y - sy * 0.03, height), 0.014, 0.6 * thick, 10)
                )
            else:
                profile = [(0.4 * thick, 0.0), (0.55 * thick, 0.08 * height), (0.42 * thick, 0.2 * height), (0.6 * thick, 0.75 * height)]
                profile += [(0.45 * thick, 0.82 * height), (0.62 * thick, 0.86 * height), (0.62 * thick, height)]
                made += revolve(profile, 12, (x, y))
    return made


def apron(w: float, d: float, z: tuple[float, float], inset: float, thick: float = 0.02) -> list[Solid]:
    """Return the four rails under a table top."""
    x, y = w / 2 - inset, d / 2 - inset
    return [
        box((-x, x), (-y, -y + thick), z, 0.002),
        box((-x, x), (y - thick, y), z, 0.002),
        box((-x, -x + thick), (-y + thick, y - thick), z, 0.002),
        box((x - thick, x), (-y + thick, y - thick), z, 0.002),
    ]


def legged(rng: np.random.Generator, size: Size, scheme: Scheme, *, kinds: str = "square tapered splayed turned") -> Shape:
    """Build a top on an apron and four legs."""
    w, d, h = size
    t = float(rng.uniform(0.022, 0.04))
    kind = pick(rng, kinds)
    material = top_finish(rng, scheme)
    inset = 0.03 if kind != "splayed" else 0.06
    base = pieces("top", slab(outline(rng, w, d), (h - t, h), 0.004), material)
    under = scheme.body if material is MARBLE or material is GLASS else scheme.accent
    drop = 0.07 if h > 0.55 else 0.05
    base += pieces("apron", apron(w, d, (h - t - drop, h - t), inset + 0.012), under)
    return Shape(base + pieces("legs", legs(rng, w, d, h - t, kind, inset), under))


def dining_table(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Four legs, trestles, a round pedestal or slab sides."""
    w, d, h = size
    t = float(rng.uniform(0.025, 0.045))
    if form == "legs":
        return legged(rng, size, scheme)
    material = top_finish(rng, scheme, stone=0.35)
    if form == "pedestal":
        base = pieces("top", slab(circle(w / 2, 32), (h - t, h), 0.006), material)
        return Shape(base + pieces("pedestal", pedestal(rng, min(0.3 * w, 0.34), h - t), scheme.accent))
    base = pieces("top", slab(outline(rng, w, d), (h - t, h), 0.005), material)
    solids: list[Solid] = []
    x = 0.33 * w
    if form == "trestle":
        for s in (-1, 1):
            solids += [beam((s * x, sy * 0.4 * d, 0), (s * x, sy * 0.12 * d, h - t), 0.05, 0.06) for sy in (-1, 1)]
            solids.append(box((s * x - 0.025, s * x + 0.025), (-0.36 * d, 0.36 * d), (h - t - 0.04, h - t - 0.001), 0.004))
        solids.append(box((-x, x), (-0.02, 0.02), (0.35 * h, 0.35 * h + 0.07), 0.004))
    else:
        middles = (-x - 0.06, x + 0.06)
        solids += [box((m - 0.03, m + 0.03), (-0.4 * d, 0.4 * d), (0, h - t), 0.006) for m in middles]
        solids.append(box((-x - 0.03, x + 0.03), (-0.015, 0.015), (0.5 * h, h - t), 0.003))
    return Shape(base + pieces("trestle", solids, scheme.accent if form == "trestle" else scheme.body))


def pedestal(rng: np.random.Generator, radius: float, height: float) -> list[Solid]:
    """Return a round foot and column: a trumpet, a turned column, or a drum."""
    kind = rng.integers(3)
    if kind == 0:
        profile = [(radius, 0.0), (radius, 0.012), (0.35 * radius, 0.1 * height), (0.2 * radius, 0.35 * height)]
        profile += [(0.2 * radius, 0.7 * height), (0.45 * radius, height)]
    elif kind == 1:
        profile = [(radius, 0.0), (radius, 0.025), (0.28 * radius, 0.03), (0.28 * radius, height - 0.02), (0.6 * radius, height)]
    else:
        profile = [(0.75 * radius, 0.0), (0.8 * radius, 0.02), (0.8 * radius, height)]
    return revolve(profile, 24)


def coffee_table(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Legs with a lower shelf, a drum, a sled frame, or a case with drawers."""
    w, d, h = size
    if form == "legs":
        shape = legged(rng, size, scheme)
        if h > 0.3 and rng.random() < 0.6:
            lower = box((-0.42 * w, 0.42 * w), (-0.4 * d, 0.4 * d), (0.3 * h, 0.3 * h + 0.016), 0.002)
            return Shape(shape.base + pieces("shelf", lower, scheme.body))
        return shape
    if form == "drum":
        base = pieces("top", slab(circle(w / 2, 32), (h - 0.025, h), 0.005), top_finish(rng, scheme, stone=0.4))
        n = 24
        if rng.random() < 0.5:
            body = revolve([(0.40 * w, 0.0), (0.43 * w, 0.03), (0.43 * w, h - 0.025)], n)
            return Shape(base + pieces("drum", body, scheme.body))
        rods = [
            rod(
                (*(0.42 * w * np.array([math.cos(a), math.sin(a)])), 0.015),
                (*(0.42 * w * np.array([math.cos(a), math.sin(a)])), h - 0.025),
                0.006,
                n=6,
            )
            for a in np.arange(n) * 2 * math.pi / n
        ]
        return Shape(
            base + pieces("foot", slab(circle(0.44 * w, 32), (0, 0.015), 0.003), scheme.handle) + pieces("rods", rods, scheme.handle)
        )
    if form == "sled":
        t = float(rng.uniform(0.02, 0.035))
        base = pieces("top", slab(outline(rng, w, d), (h - t, h), 0.004), top_finish(rng, scheme, stone=0.3, glass=0.25))
        return Shape(base + pieces("frame", hoops(w, d, h - t, 0.02), scheme.handle))
    return cased_table(rng, size, scheme, drawer_height=min(0.16, 0.45 * h), count=1 if w < 0.95 else 2)


def hoops(w: float, d: float, height: float, thick: float) -> list[Solid]:
    """Return two closed frames of square tube under a top."""
    made = []
    for s in (-1, 1):
        x = (s * 0.42 * w - thick / 2, s * 0.42 * w + thick / 2)
        y = 0.42 * d
        made += [box(x, (-y, y), (0, thick), 0.002), box(x, (-y, y), (height - thick, height), 0.002)]
        made += [box(x, (sy * y - thick / 2, sy * y + thick / 2), (thick, height - thick), 0.002) for sy in (-1, 1)]
    return made


def cased_table(rng: np.random.Generator, size: Size, scheme: Scheme, *, drawer_height: float, count: int) -> Shape:
    """Build a top over a shallow case of drawers on tall legs."""
    style = front_style(rng, scheme, "slab slab shaker", "bar knob edge flat")
    how = case_style(rng, scheme, style, "square tapered sled", (0.1, 0.1))
    how = replace(how, feet_height=size[2] - drawer_height - how.top_thickness - how.board, inset=True, overhang=0.012)
    return case(size, [Column(1, (Cell("drawer"),)) for _ in range(count)], how)


def corner_side_table(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Legs, a pedestal, a C-shaped frame, or a drawer over a shelf."""
    w, d, h = size
    if form == "legs":
        return legged(rng, size, scheme)
    if form == "pedestal":
        base = pieces("top", slab(circle(w / 2, 28), (h - 0.022, h), 0.004), top_finish(rng, scheme, stone=0.35))
        return Shape(base + pieces("pedestal", pedestal(rng, 0.36 * w, h - 0.022), scheme.accent))
    if form == "c_shape":
        base = pieces("top", slab(outline(rng, w, d), (h - 0.022, h), 0.004), top_finish(rng, scheme, stone=0.3))
        t = 0.022
        solids = []
        for s in (-1, 1):
            x = (s * 0.4 * w - t / 2, s * 0.4 * w + t / 2)
            solids += [box(x, (-0.48 * d, 0.48 * d), (0, t), 0.002), box(x, (0.48 * d - t, 0.48 * d), (t, h - 0.022), 0.002)]
        solids.append(box((-0.4 * w + t / 2, 0.4 * w - t / 2), (0.48 * d - t, 0.48 * d), (0, t), 0.002))
        return Shape(base + pieces("frame", solids, scheme.handle))
    style = front_style(rng, scheme, "slab slab shaker")
    how = replace(case_style(rng, scheme, style, "tapered square sled hairpin", (0.45 * h, 0.6 * h)), overhang=0.0)
    return case(size, [Column(1, (Cell("drawer"),))], how)


def round_end_table(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a round top on three legs or on a cage of rods."""
    w, _, h = size
    if form == "drum":
        return coffee_table(rng, "drum", size, scheme)
    base = pieces("top", slab(circle(w / 2, 28), (h - 0.022, h), 0.004), top_finish(rng, scheme, stone=0.3))
    solids = []
    for k in range(3):
        a = k * 2 * math.pi / 3 + math.pi / 2
        u = np.array([math.cos(a), math.sin(a)])
        solids.append(rod((*(0.42 * w * u), 0), (*(0.2 * w * u), h - 0.022), 0.012, 0.02, 10))
    solids += ring((0.3 * w, 0.3 * w), (0.3 * w - 0.012, 0.3 * w - 0.012), (0.4 * h, 0.4 * h + 0.012), 16)
    return Shape(base + pieces("legs", solids, scheme.accent))
