"""Children's beds: with rails, bunks and cars. The wall is at the back (+y)."""

import numpy as np

from pipeline.corpus.furniture.beds import bedding
from pipeline.corpus.furniture.bent import prism
from pipeline.corpus.furniture.finishes import PLASTIC, Scheme
from pipeline.corpus.furniture.intervals import around, edges, inset
from pipeline.corpus.furniture.shape import Pieces, Shape, Size, pieces
from pipeline.corpus.furniture.solids import box, rod


def kids_bed(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a bed of one of the forms. Where it is wide the sleeper lies along x."""
    return Shape({"rails": _rail_bed, "bunk": _bunk, "car": _car}[form](rng, size, scheme))


def _rail_bed(rng: np.random.Generator, size: Size, scheme: Scheme) -> Pieces:
    w, d, h = size
    lift, t = 0.12, 0.045
    x, y = around(w / 2), around(d / 2)
    low, guard = min(0.36, 0.42 * h), 0.66 * h
    inner_x, inner_y = inset(x, t), inset(y, t)
    spots = [(px, py, 0.8 * h if py < 0 else h) for px in inset(x, t / 2) for py in inset(y, t / 2)]
    posts = [rod((px, py, 0), (px, py, z - 0.03), 0.5 * t, n=12) for px, py, z in spots]
    knobs = [rod((px, py, z - 0.03), (px, py, z), 0.48 * t, 0.3 * t, 12) for px, py, z in spots]
    boards = [box(inner_x, span, (lift, low), 0.004) for span in ((y[1] - 0.03, y[1] - 0.008), (y[0] + 0.008, y[0] + 0.03))]
    sides = [(px, px + 0.022) for px in (x[0] + 0.01, x[1] - 0.032)]
    boards += [box(span, inner_y, (lift, low), 0.004) for span in sides]
    boards += [box(inner_x, (y[1] - 0.03, y[1] - 0.012), (h - 0.1, h - 0.04), 0.004)]
    boards += [box(span, inner_y, (guard, guard + 0.06), 0.004) for span in sides]
    boards.append(box(inset(x, 0.032), inset(y, 0.03), (lift + 0.06, lift + 0.08)))
    ys = np.linspace(*inset(inner_y, 0.06), max(4, round((d - 2 * t) / 0.12)))
    bars = [rod((px, b, low), (px, b, guard), 0.008, n=6) for px in inset(x, 0.021) for b in ys]
    xs = np.linspace(*inset(x, 0.14), max(5, round(w / 0.15)))
    bars += [rod((a, y[1] - 0.02, low), (a, y[1] - 0.02, h - 0.1), 0.008, n=6) for a in xs]
    parts = pieces("posts", posts, scheme.front) + pieces("knobs", knobs, scheme.timber)
    parts += pieces("boards", boards, scheme.front) + pieces("bars", bars, scheme.timber)
    return parts + bedding(rng, inner_x, inner_y, lift + 0.08, low + 0.06, scheme)


def _bunk(rng: np.random.Generator, size: Size, scheme: Scheme) -> Pieces:
    """Two berths over each other and a ladder at the front."""
    w, d, h = size
    t, thick = 0.06, 0.026
    x, y = around(w / 2), (-d / 2 + 0.07, d / 2)
    posts = [box((px, px + t), (py, py + t), (0, h), 0.008) for px in (x[0], x[1] - t) for py in (y[0], y[1] - t)]
    parts = pieces("posts", posts, scheme.front)
    upper = 0.24 + 0.48 * h
    inner_x, inner_y = inset(x, t), inset(y, 0.034)
    front, rear = edges(inset(y, 0.008), thick)
    sides = edges(inset(x, 0.008), thick)
    for z in (0.2, upper):
        guard = min(z + 0.3, h - 0.06) if z == upper else z + 0.3
        rail = (guard, guard + 0.06)
        boards = [box(inner_x, span, (z, z + 0.15), 0.004) for span in (front, rear)]
        boards += [box(span, inset(y, t), (z, z + 0.15), 0.004) for span in sides]
        boards.append(box(inner_x, inner_y, (z + 0.02, z + 0.04)))
        boards += [box(span, inset(y, t), rail, 0.004) for span in sides]
        if z == upper:
            boards += [box(inner_x, rear, rail, 0.004), box((x[0] + t, x[1] - 0.64), front, rail, 0.004)]
        parts += pieces("berth", boards, scheme.front)
        parts += tuple(p for p in bedding(rng, inner_x, inner_y, z + 0.04, z + 0.19, scheme) if p.name not in ("throw", "cushion"))
    lx = (x[1] - 0.56, x[1] - 0.14)
    ladder = [box(around(0.02, px), (-d / 2, -d / 2 + 0.06), (0, min(h, upper + 0.45)), 0.006) for px in lx]
    rungs = np.arange(0.25, upper, 0.27)
    ladder += [box(inset(lx, 0.02), (-d / 2 + 0.008, -d / 2 + 0.05), (z, z + 0.03), 0.004) for z in rungs]
    return parts + pieces("ladder", ladder, scheme.timber)


def _car(rng: np.random.Generator, size: Size, scheme: Scheme) -> Pieces:
    """Build a bed between two boards cut like a car, with wheels; the bonnet is at the front."""
    w, d, h = size
    x = w / 2
    body = min(0.55, 0.6 * h)
    parts: Pieces = ()
    r = min(0.2, 0.24 * h)
    low = np.array([(-d / 2, 0.09), (d / 2, 0.09), (d / 2, body), (-0.32 * d, 0.86 * body), (-d / 2, 0.62 * body)])
    rise = np.array([(0.12 * d, body * 0.955), (d / 2, body), (d / 2, h), (0.36 * d, h)])
    for s in (-1, 1):
        parts += pieces("sides", [prism(cut, "x", around(0.018, s * (x - 0.04))) for cut in (low, rise)], scheme.front)
        for cy in (-0.3 * d, 0.3 * d):
            parts += pieces("wheels", rod((s * (x - 0.022), cy, r), (s * x, cy, r), r, n=20), PLASTIC)
            parts += pieces("hubs", rod((s * x - s * 0.001, cy, r), (s * x + s * 0.006, cy, r), 0.5 * r, n=14), scheme.handle)
    inner, (front, rear) = around(x - 0.06), edges(around(d / 2), 0.03)
    ends = [box(inner, front, (0.09, 0.6 * body), 0.01), box(inner, rear, (0.09, h), 0.01), box(inner, around(d / 2 - 0.03), (0.14, 0.16))]
    lamps = [rod((px, -d / 2 - 0.012, 0.42 * body), (px, -d / 2, 0.42 * body), 0.07, n=14) for px in (-0.3 * w, 0.3 * w)]
    parts += pieces("ends", ends, scheme.front) + pieces("lamps", lamps, scheme.second)
    return parts + bedding(rng, inner, around(d / 2 - 0.035), 0.16, 0.16 + 0.55 * (body - 0.16), scheme)
