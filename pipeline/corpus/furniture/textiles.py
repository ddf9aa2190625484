"""Rugs, curtains and loose pillows."""

import math
from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.bent import band
from pipeline.corpus.furniture.finishes import CLASSIC, CLOTH_GROUNDS, FABRICS, ORIENTAL, Finish, Pattern, Scheme, cover, pick, shade
from pipeline.corpus.furniture.intervals import around
from pipeline.corpus.furniture.shape import Pieces, Shape, Size, pieces
from pipeline.corpus.furniture.solids import Solid, box, circle, pillow, ring, rod, rounded_rectangle, slab


def rug(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a woven rug: bordered, with diamonds, striped, plain with a deep pile, or round; some with fringes."""
    w, d, h = size
    classic = scheme.style in (*CLASSIC, *ORIENTAL)
    pattern: Pattern = pick(rng, "rug_border" if classic else "rug_diamonds rug_stripes rug_border boucle")  # type: ignore[assignment]
    if form == "round":
        pattern = "rug_border" if classic else "boucle"
    if form == "shaggy":
        pattern = "boucle"
    ground = scheme.soft if max(scheme.soft.color) > 0.1 or pattern != "boucle" else scheme.second
    light = CLOTH_GROUNDS if max(ground.color) < 0.45 else shade(rng, FABRICS["taupe_cloth"], 0.3)
    weave = Finish("rug", shade(rng, ground.color, 0.08), 0.95, pattern=pattern, density=250, second=None if pattern == "boucle" else light)
    if form == "round":
        return Shape(pieces("rug", slab(circle(w / 2, 40), (0.0, h), min(0.004, 0.3 * h)), weave))
    fringe = 0.06 if form == "fringed" else 0.0
    edge = rounded_rectangle(around(w / 2), around(d / 2 - fringe), 0.012 if form != "shaggy" else 0.05, 2)
    parts = pieces("rug", slab(edge, (0.0, h), min(0.004, 0.3 * h)), weave)
    if fringe:
        count = max(12, round(w / 0.07))
        xs = np.linspace(-w / 2 + 0.01, w / 2 - 0.03, count)
        yarn = replace(weave, name="yarn", color=CLOTH_GROUNDS, pattern="plain", second=None)
        ends = [(-d / 2, -d / 2 + fringe), (d / 2 - fringe, d / 2)]
        parts += pieces("fringe", [box((float(x), float(x) + 0.018), end, (0.0, 0.5 * h)) for x in xs for end in ends], yarn)
    return Shape(parts)


def curtain(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build curtains on a rod with knobs and rings: two panels drawn aside, or one sheet over the whole width."""
    w, d, h = size
    cloth = scheme.soft if "leather" not in scheme.soft.pattern else cover(rng, "linen")
    rod_z = h - 0.03
    bar = [rod((-w / 2 + 0.03, 0, rod_z), (w / 2 - 0.03, 0, rod_z), 0.012, n=8)]
    for s in (-1, 1):
        bar.append(rod((s * (w / 2 - 0.03), 0, rod_z), (s * w / 2, 0, rod_z), 0.02, 0.012, 8))
        bar.append(box(around(0.008, s * (w / 2 - 0.06)), (0.012, d / 2), around(0.01, rod_z)))
    parts = pieces("rod", bar, scheme.handle)
    share = float(rng.uniform(0.16, 0.24)) if form == "drawn" else 0.5
    for s in (-1, 1):
        outer, inner = s * (w / 2 - 0.07), s * (w / 2 - 0.07 - share * (w - 0.14) + (0.002 if form != "drawn" else 0.0))
        parts += _panel(outer, inner, d, rod_z - 0.03, cloth)
    if form == "drawn":
        return Shape(parts)
    sheer = replace(cloth, name="sheer", color=(0.80, 0.79, 0.76), pattern="weave", second=None)
    return Shape(tuple(replace(p, finish=sheer) if p.finish is cloth else p for p in parts))


def _panel(start: float, end: float, d: float, h: float, cloth: Finish) -> Pieces:
    """Return one pleated panel between two x [m], deeper folds the more it is drawn aside."""
    wide = abs(end - start)
    folds = max(3, round(wide / 0.11))
    t = np.linspace(0, 1, 4 * folds + 1)
    path = np.column_stack([start + (end - start) * t, (0.5 * d - 0.004) * np.sin(2 * math.pi * folds * t)])
    return pieces("cloth", band(path, 0.006, (0.0, h)), cloth)


def cushion_pillow(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a throw pillow: square or oblong, or a round one."""
    w, d, h = size
    cloth = scheme.second if rng.random() < 0.5 else scheme.soft
    if form == "round":
        rims: list[Solid] = ring((0.44 * w, 0.5 * w), (0.2 * w, 0.2 * w), (0.0, 0.5 * h), 20)
        rims += ring((0.5 * w, 0.44 * w), (0.2 * w, 0.2 * w), (0.5 * h, h), 20)
        middle = slab(circle(0.2 * w, 20), (0.06 * h, 0.94 * h), 0.01)
        return Shape(pieces("pillow", rims, cloth) + pieces("button", middle, cloth))
    return Shape(pieces("pillow", pillow(around(w / 2), around(d / 2), (0.0, h), 3), cloth))
