"""Cloth of baths and windows: towels hung and folded, throws, bath mats, blinds; and the holder of a paper roll."""

import math
from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.finishes import FABRICS, PAPER, Finish, Scheme, one_of, pick, shade
from pipeline.corpus.furniture.intervals import Interval, around, inset, split
from pipeline.corpus.furniture.shape import Pieces, Shape, Size, pieces
from pipeline.corpus.furniture.solids import board, box, circle, cushion, rod, slab, standing

TERRY = ("snow_cloth", "cream_cloth", "grey_cloth", "linen", "blue_cloth", "mint_cloth", "taupe_cloth", "rust_cloth", "charcoal")


def terry(rng: np.random.Generator, scheme: Scheme) -> Finish:
    """Draw the cloth of a towel: one in three in the colour of the style's covers."""
    name = one_of(rng, TERRY)
    color = scheme.soft.color if rng.random() < 0.33 else FABRICS[name]
    return Finish("terry", shade(rng, color, 0.08), 0.95, pattern="boucle", density=150)


def towel(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a towel over a rail, two of them side by side, or one through a ring; the back is at the wall (+y)."""
    w, d, h = size
    cloth, metal = terry(rng, scheme), scheme.handle
    if form == "ring":
        plate = box((-0.025, 0.025), (d / 2 - 0.012, d / 2), (h - 0.06, h - 0.01), 0.003)
        arm = rod((0.0, d / 2 - 0.012, h - 0.035), (0.0, 0.0, h - 0.035), 0.008)
        hoop = [box(around(0.24 * w), (-0.006, 0.006), (z, z + 0.012), 0.003) for z in (h - 0.16, h - 0.042)]
        sides = [box(around(0.005, s * 0.24 * w), (-0.006, 0.006), (h - 0.148, h - 0.042), 0.002) for s in (-1, 1)]
        parts = pieces("ring", [plate, arm, *hoop, *sides], metal)
        return Shape(parts + _towel_over_bar(around(0.22 * w), d, h - 0.152, h - 0.16, cloth, rng))
    z = h - 0.03
    bar = [rod((-w / 2, 0, z), (w / 2, 0, z), 0.009, n=8)]
    for s in (-1, 1):
        x = s * (w / 2 - 0.02)
        bar += [rod((x, d / 2, z), (x, 0.0, z), 0.009, n=8), rod((x, d / 2, z), (x, d / 2 - 0.01, z), 0.024, n=12)]
    parts = pieces("rail", bar, metal)
    if form == "single":
        return Shape(parts + _towel_over_bar(around(0.4 * w), d, z, z, cloth, rng))
    other = terry(rng, scheme)
    left = _towel_over_bar((-0.46 * w, -0.02 * w), d, z, z, cloth, rng)
    return Shape(parts + left + _towel_over_bar((0.02 * w, 0.46 * w), d, z, 0.8 * z, other, rng))


def _towel_over_bar(x: Interval, d: float, top: float, drop: float, cloth: Finish, rng: np.random.Generator) -> Pieces:
    """Return a towel over a bar at height `top`: the front fall `drop` long, the back one a little shorter, a border near the hem."""
    t, half = 0.012, 0.016
    front, back = top - drop, top - drop * float(rng.uniform(0.75, 0.9))
    falls = [
        cushion(x, (-half - t, -half), (front, top + 0.006), 0.005),
        cushion(x, (half, half + t), (back, top + 0.006), 0.005),
        cushion(x, around(half + t), (top + 0.004, top + 0.018), 0.006),
    ]
    hem = replace(cloth, name="hem", color=tuple(0.75 * c for c in cloth.color), pattern="weave")  # type: ignore[arg-type]
    band = box(inset(x, 0.001), (-half - t - 0.0015, -half - t + 0.001), (front + 0.05, front + 0.085))
    return pieces("towel", falls, cloth) + pieces("hem", band, hem)


def folded_towels(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a pile of folded towels, or three rolled ones."""
    w, d, h = size
    parts: Pieces = ()
    if form == "rolled":
        r = min(w / 4, h / 3.6)
        spots = [(-r, r), (r, r), (0.0, r + 1.7 * r)]
        for x, z in spots:
            roll = slab(circle(r, 16), around(d / 2), 0.25 * r).turned("x", math.pi / 2).moved((x, 0, z))
            parts += pieces("towel", roll, terry(rng, scheme))
        return Shape(parts)
    count = max(2, round(h / 0.05))
    for k in range(count):
        cloth = terry(rng, scheme)
        dx, dy = (float(v) for v in rng.uniform(-0.012, 0.012, 2))
        span = (k * h / count, (k + 1) * h / count - 0.001)
        parts += pieces(
            "towel", cushion((-w / 2 + 0.012 + dx, w / 2 - 0.012 + dx), (-d / 2 + 0.012 + dy, d / 2 - 0.012 + dy), span, 0.02, 3), cloth
        )
    return Shape(parts)


def throw(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a folded blanket with fringes at one side."""
    w, d, h = size
    pattern = pick(rng, "knit check stripe boucle")
    cloth = Finish("throw", shade(rng, scheme.second.color, 0.1), 0.95, pattern=pattern, density=120)  # type: ignore[arg-type]
    layers = [cushion(around(w / 2), (-d / 2 + 0.04, d / 2), z, 0.4 * h / 3, 2) for z in split((0.0, h), 3)]
    yarn = replace(cloth, name="yarn", pattern="plain")
    xs = np.linspace(-w / 2 + 0.02, w / 2 - 0.032, 12).tolist()
    ends = [box((x, x + 0.012), (-d / 2, -d / 2 + 0.045), (0.35 * h, 0.42 * h)) for x in xs]
    return Shape(pieces("throw", layers, cloth) + pieces("yarn", ends, yarn))


def bath_mat(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a bath mat: of terry with a border, or of wooden slats."""
    w, d, h = size
    if form == "slats":
        count = max(5, round(w / 0.09))
        step = w / count
        slats = [box((-w / 2 + k * step, -w / 2 + (k + 0.8) * step), around(d / 2), (0.3 * h, h), 0.002) for k in range(count)]
        slats += [box(around(w / 2), around(0.015, s * 0.35 * d), (0.0, 0.3 * h)) for s in (-1, 1)]
        return Shape(pieces("mat", slats, scheme.timber))
    cloth = terry(rng, scheme)
    pile = replace(cloth, name="pile", color=tuple(0.85 * c for c in cloth.color))  # type: ignore[arg-type]
    mat = board(around(w / 2), around(d / 2), (0.0, 0.75 * h), 0.03, 2)
    return Shape(
        pieces("mat", mat, cloth) + pieces("pile", board(around(w / 2 - 0.05), around(d / 2 - 0.05), (0.75 * h, h), 0.02, 2), pile)
    )


def blind(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a blind: a roller with its cloth, a pleated Roman one, or slats; the back is at the wall (+y)."""
    w, d, h = size
    color = FABRICS[pick(rng, "cream_cloth linen grey_cloth snow_cloth taupe_cloth")]
    cloth = Finish("blind", shade(rng, color, 0.06), 0.9, pattern="weave", density=300)
    top = h - 0.05
    rail = box(around(w / 2), around(d / 2), (top, h), 0.004)
    if form == "roller":
        sheet = box(around(w / 2 - 0.01), (-0.0015, 0.0015), (0.02, top))
        hem = rod((-w / 2 + 0.01, 0, 0.012), (w / 2 - 0.01, 0, 0.012), 0.012, n=8)
        return Shape(pieces("rail", rail, scheme.handle) + pieces("cloth", [sheet, hem], cloth))
    x = around(w / 2 - 0.005)
    if form == "roman":
        folds = max(3, round(h / 0.22))
        laps = [cushion(x, around(0.42 * d), (low, high - 0.004), 0.3 * d, 2) for low, high in split((0.0, top), folds)]
        return Shape(pieces("rail", rail, cloth) + pieces("cloth", laps, cloth))
    timber = scheme.timber if rng.random() < 0.6 else Finish("slat", (0.78, 0.77, 0.74), 0.4, density=500)
    slat = box(x, around(0.4 * d), (-0.0015, 0.0015)).turned("x", 0.6)
    levels = split((0.0, top), max(8, round(top / 0.05)))
    slats = [slat.moved((0, 0, (low + high) / 2)) for low, high in levels]
    cords = [box(around(0.003, s * 0.35 * w), (-0.003, 0.003), (0.0, top)) for s in (-1, 1)]
    return Shape(pieces("rail", rail, timber) + pieces("slats", slats, timber) + pieces("cords", cords, cloth))


def paper_holder(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a roll of paper on an arm, or on one under a lid; the back is at the wall (+y)."""
    w, d, h = size
    r = 0.42 * h
    arm = [
        box((-w / 2, -w / 2 + 0.014), (d / 2 - 0.012, d / 2), (0.3 * h, 0.9 * h), 0.002),
        box((-w / 2, -w / 2 + 0.014), (d / 2 - r - 0.03, d / 2 - 0.012), (0.54 * h, 0.62 * h), 0.002),
        box((-w / 2 + 0.014, w / 2), (d / 2 - r - 0.03, d / 2 - r - 0.018), (0.54 * h, 0.62 * h), 0.002),
    ]
    if form == "lid":
        arm.append(box((-w / 2 + 0.01, w / 2), around(d / 2), (h - 0.004, h)))
    roll = standing([slab(circle(r, 20), around(0.38 * w), 0.002)], (0, 0, 0))[0].turned("z", math.pi / 2)
    sheet = box(around(0.36 * w), (d / 2 - 2 * r - 0.024, d / 2 - 2 * r - 0.022), (0.0, 0.45 * h))
    placed = roll.moved((0.005, d / 2 - r - 0.024, 0.5 * h))
    return Shape(pieces("arm", arm, scheme.handle) + pieces("roll", [placed, sheet], PAPER))
