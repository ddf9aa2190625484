"""Beds for one and two, and children's beds: with rails, bunks, cars. The head is at the back (+y)."""

import math

import numpy as np

from pipeline.corpus.furniture.bent import prism, tube
from pipeline.corpus.furniture.finishes import Finishes, cane
from pipeline.corpus.furniture.intervals import Interval, around, edges, inset, split
from pipeline.corpus.furniture.legs import leg_finish, legs
from pipeline.corpus.furniture.shape import Piece, Pieces, pieces
from pipeline.corpus.furniture.solids import Solid, box, cushion, pillow, rod
from pipeline.corpus.furniture.textiles import channels, duvet, throw_pillow, tufted_panel

SOFT = frozenset({"upholstered", "tufted", "wing"})


def bed(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a bed of one of the forms, made up with a mattress, a duvet and pillows."""
    x, y = around(w / 2), around(d / 2)
    soft = form in SOFT
    lift = float(rng.uniform(0.1, 0.16))
    rail_top = min(lift + float(rng.uniform(0.15, 0.2)), 0.4 * h)
    top = min(rail_top + 0.17, 0.55 * h + 0.05)
    head = {"upholstered": 0.1, "tufted": 0.12, "wing": 0.1, "metal": 0.05}.get(form, 0.06)
    foot = 0.05 if form == "metal" else 0.0
    parts = _head(rng, form, x, (y[1] - head, y[1]), lift, h, finishes)
    side, margin = (0.07, 0.0) if soft else (0.032, 0.008)
    rail, z = (y[0] + foot, y[1] - head), (lift, rail_top)
    inner_x, inner_y = inset(x, side), (rail[0] + (0.0 if foot else side), rail[1])
    places = [(span, rail) for span in edges(inset(x, margin), side - margin)]
    if not foot:
        places.append((inner_x, (rail[0], rail[0] + side)))
    frame = [cushion(*place, z, 0.02, 2) if soft else box(*place, z, 0.004) for place in places]
    low = rail_top - 0.03
    frame.append(box(inner_x, inner_y, (low - 0.03, low)))
    parts += pieces("frame", frame, finishes.soft if soft else finishes.handle if form == "metal" else finishes.body)
    if foot:
        parts += pieces("footboard", _hoop(x, y[0] + foot / 2, min(0.72 * h, 0.7), finishes), finishes.handle)
    else:
        kind = "bun" if finishes.style.ornament > 0.5 and lift < 0.16 else "square" if form in ("panel", "slatted") else "tapered"
        feet = [s.translate((0, -0.04, 0)) for s in legs(kind, (w / 2 - 0.07, d / 2 - 0.12), lift, 0.055)]
        parts += pieces("feet", feet, leg_finish(finishes, kind))
    return parts + bedding(rng, inner_x, inner_y, low, top, finishes, h - top)


def bedding(rng: np.random.Generator, x: Interval, y: Interval, low: float, top: float, finishes: Finishes, room: float = 1.0) -> Pieces:
    """Return a mattress from `low` to `top`, a duvet turned down over it, pillows at the head, often cushions and a throw.

    There are cushions only where there is `room` above for them.
    """
    mx, my = inset(x, 0.014), (y[0] + 0.014, y[1] - 0.006)
    parts = pieces("mattress", cushion(mx, my, (low, top), 0.045, 3), "mattress")
    wide, long = mx[1] - mx[0], my[1] - my[0]
    head = min(0.62, 0.34 * long)
    cover = "bedding" if rng.random() < 0.45 else finishes.second
    fold = my[1] - head
    thick = 0.045
    drop = min(0.8 * (top - low), 0.16)
    parts += duvet(mx, (my[0], fold - 0.2), top, thick, drop, cover)
    turned = cushion((mx[0] - 0.02, mx[1] + 0.02), (fold - 0.198, fold + 0.03), (top, top + 1.5 * thick), 0.03, 3)
    parts += pieces("duvet_fold", turned, "bedding" if cover != "bedding" else finishes.soft if rng.random() < 0.5 else "bedding")
    count = 2 if wide > 1.25 else 1
    share = wide / count
    deep = min(0.44, head - 0.1)
    half = min(0.36, 0.47 * share)
    pads = []
    for k in range(count):
        middle = mx[0] + share * (k + 0.5)
        pad = pillow(around(half, middle), (my[1] - deep - 0.02, my[1] - 0.02), (top, top + 0.15), 3)
        pads.append(pad.rotate("x", 0.22, (0, my[1] - deep, top)).translate((0, 0.0, 0.012)))
        if room > 0.3 and rng.random() < 0.5 * finishes.style.tufts + 0.35:
            at, yaw = (middle, my[1] - deep - 0.13, top + 1.5 * thick + 0.002), float(rng.uniform(-0.15, 0.15))
            parts += pieces("cushion", throw_pillow(at, min(0.4, 1.5 * half, deep), 0.5, yaw), finishes.soft)
    parts += pieces("pillows", pads, "bedding")
    if rng.random() < 0.55:
        foot = my[0] + 0.14 * long
        band = duvet((mx[0] - 0.027, mx[1] + 0.027), (foot, foot + 0.45), top + 1.25 * thick, 0.014, drop * 0.95, finishes.soft)
        parts += tuple(Piece("throw", p.solid, p.finish) for p in band)
    return parts


def _head(rng: np.random.Generator, form: str, x: Interval, y: Interval, lift: float, h: float, finishes: Finishes) -> Pieces:
    """Return a headboard over `x`, `y` up to `h`."""
    w = x[1] - x[0]
    if form == "upholstered":
        pad_y, z = (y[0], y[0] + 0.05), (lift + 0.12, h)
        parts = pieces("headboard", box(x, (y[0] + 0.052, y[1]), (lift, h - 0.012), 0.006), finishes.soft)
        if rng.random() < 0.5:
            return parts + pieces("pads", channels(x, pad_y, z, max(6, round(w / 0.14))), finishes.soft)
        pads = [cushion(span, pad_y, z, 0.024, 3) for span in split(x, max(2, round(w / 0.45)), 0.001)]
        return parts + pieces("pads", pads, finishes.soft)
    if form == "tufted":
        return pieces("headboard", tufted_panel(x, y, (lift, h), max(4, round(w / 0.26)), max(2, round((h - lift) / 0.26))), finishes.soft)
    if form == "wing":
        wings = [cushion(span, (y[0] - 0.16, y[1]), (lift + 0.3, h - 0.02), 0.026, 2) for span in edges(x, 0.058)]
        board = cushion(inset(x, 0.06), y, (lift, h), 0.04, 3)
        return pieces("headboard", board, finishes.soft) + pieces("wings", wings, finishes.soft)
    if form == "metal":
        return pieces("headboard", _hoop(x, (y[0] + y[1]) / 2, h, finishes), finishes.handle)
    return _wooden_head(rng, form, x, y, lift, h, finishes)


def _wooden_head(rng: np.random.Generator, form: str, x: Interval, y: Interval, lift: float, h: float, finishes: Finishes) -> Pieces:
    """Return a headboard between two posts: of slats, or of a framed panel, which may be of cane."""
    wood, post = finishes.timber if form == "slatted" else finishes.body, 0.05
    parts = pieces("posts", [box((a, a + post), y, (0, h), 0.006) for a in (x[0], x[1] - post)], wood)
    inner = inset(x, post)
    if form == "slatted":
        boards = [box(inner, inset(y, 0.01), z, 0.004) for z in ((lift + 0.14, lift + 0.21), (h - 0.09, h - 0.005))]
        xs = np.linspace(*inset(inner, 0.05), max(5, round((x[1] - x[0]) / 0.11)))
        boards += [box(around(0.014, a), inset(y, 0.018), (lift + 0.21, h - 0.09), 0.002) for a in xs]
        return parts + pieces("headboard", boards, wood)
    weave = rng.random() < finishes.style.cane
    field = inset(inner, 0.07)
    deep = (y[0] + 0.012, y[1] - 0.008)
    boards = [box(span, deep, (lift, h - 0.02), 0.003) for span in ((inner[0], field[0]), (field[1], inner[1]))]
    boards += [box(field, deep, z, 0.003) for z in ((lift, lift + 0.3), (h - 0.1, h - 0.02))]
    panel = box(field, (deep[0] + 0.012, deep[1] - 0.006), (lift + 0.3, h - 0.1))
    parts += pieces("headboard", boards, wood) + pieces("panel", panel, cane(rng) if weave else finishes.front)
    if form == "panel":
        parts += pieces("cap", box(inner, y, (h - 0.02, h), 0.005), wood)
    return parts


def _hoop(x: Interval, y: float, h: float, finishes: Finishes) -> list[Solid]:
    """Return a bent tube with bars in it, and knobs where there is ornament."""
    r, w = 0.017, x[1] - x[0]
    rise = 0.12 * w if finishes.style.ornament > 0.2 else 0.0
    low, span, z = h - rise, w - 2 * r, 0.42 * h
    shoulder = low - 0.08 * (rise == 0)
    bow = [(x[0] + r, 0.0), (x[0] + r, shoulder)]
    bow += [(x[0] + r + span * t, low - r + rise * math.sin(math.pi * t)) for t in np.linspace(0.06, 0.94, 8)]
    bow += [(x[1] - r, shoulder), (x[1] - r, 0.0)]
    solids = tube([(px, y, pz) for px, pz in bow], r, 8)
    solids.append(rod((x[0] + 2 * r, y, z), (x[1] - 2 * r, y, z), 0.7 * r, n=8))
    count = max(5, round(w / 0.14))
    for t in ((np.arange(count) + 0.5) / count).tolist():
        top = low - 2 * r + rise * math.sin(math.pi * t) - 0.012 * (rise > 0)
        at = x[0] + r + span * t
        if top > z + 0.06:
            solids.append(rod((at, y, z + 0.7 * r), (at, y, top), 0.4 * r, n=6))
    return solids


def platform_bed(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a low deck of boards that stands out around the mattress, with a plain back that leans."""
    deck = min(0.26, 0.32 * h)
    x, y = w / 2, d / 2
    boards = [box(span, (-y, y - 0.08), (deck - 0.035, deck), 0.003) for span in split((-x, x), max(3, round(w / 0.28)), 0.0008)]
    plinth = box(around(x - 0.16), around(y - 0.18), (0, deck - 0.035), 0.003)
    parts = pieces("deck", boards, finishes.body) + pieces("plinth", plinth, leg_finish(finishes, "square"))
    wide = min(0.7 * w, 1.2) if rng.random() < 0.3 else w
    parts += pieces("headboard", box(around(wide / 2), (y - 0.045, y - 0.01), (0.06, h), 0.006), finishes.timber)
    if rng.random() < 0.5:
        half = (w - 0.06) / 4
        pads = [cushion(around(half - 0.01, s * half), (y - 0.11, y - 0.047), (deck + 0.12, h - 0.02), 0.028, 3) for s in (-1, 1)]
        parts += pieces("back_pads", pads, finishes.soft)
    edge, room = min(0.12, 0.06 * w), h - deck
    return parts + bedding(rng, around(x - edge), (-y + edge, y - 0.12), deck, deck + min(0.2, 0.4 * room), finishes, 0.6 * room)


def rail_bed(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a child's bed with rails of bars around it."""
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
    parts = pieces("posts", posts, finishes.front) + pieces("knobs", knobs, finishes.timber)
    parts += pieces("boards", boards, finishes.front) + pieces("bars", bars, finishes.timber)
    return parts + bedding(rng, inner_x, inner_y, lift + 0.08, low + 0.06, finishes)


def bunk_bed(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Two berths over each other and a ladder at the front."""
    t, thick = 0.06, 0.026
    x, y = around(w / 2), (-d / 2 + 0.07, d / 2)
    posts = [box((px, px + t), (py, py + t), (0, h), 0.008) for px in (x[0], x[1] - t) for py in (y[0], y[1] - t)]
    parts = pieces("posts", posts, finishes.front)
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
        parts += pieces("berth", boards, finishes.front)
        parts += tuple(p for p in bedding(rng, inner_x, inner_y, z + 0.04, z + 0.19, finishes) if p.name not in ("throw", "cushion"))
    lx = (x[1] - 0.56, x[1] - 0.14)
    ladder = [box(around(0.02, px), (-d / 2, -d / 2 + 0.06), (0, min(h, upper + 0.45)), 0.006) for px in lx]
    rungs = np.arange(0.25, upper, 0.27)
    ladder += [box(inset(lx, 0.02), (-d / 2 + 0.008, -d / 2 + 0.05), (z, z + 0.03), 0.004) for z in rungs]
    return parts + pieces("ladder", ladder, finishes.timber)


def car_bed(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a bed between two boards cut like a car, with wheels; the bonnet is at the front."""
    x = w / 2
    body = min(0.55, 0.6 * h)
    parts: Pieces = ()
    r = min(0.2, 0.24 * h)
    low = np.array([(-d / 2, 0.09), (d / 2, 0.09), (d / 2, body), (-0.32 * d, 0.86 * body), (-d / 2, 0.62 * body)])
    rise = np.array([(0.12 * d, body * 0.955), (d / 2, body), (d / 2, h), (0.36 * d, h)])
    for s in (-1, 1):
        parts += pieces("sides", [prism(cut, "x", around(0.018, s * (x - 0.04))) for cut in (low, rise)], finishes.front)
        for cy in (-0.3 * d, 0.3 * d):
            parts += pieces("wheels", rod((s * (x - 0.022), cy, r), (s * x, cy, r), r, n=20), "plastic")
            parts += pieces("hubs", rod((s * x - s * 0.001, cy, r), (s * x + s * 0.006, cy, r), 0.5 * r, n=14), finishes.handle)
    inner, (front, rear) = around(x - 0.06), edges(around(d / 2), 0.03)
    ends = [box(inner, front, (0.09, 0.6 * body), 0.01), box(inner, rear, (0.09, h), 0.01), box(inner, around(d / 2 - 0.03), (0.14, 0.16))]
    lamps = [rod((px, -d / 2 - 0.012, 0.42 * body), (px, -d / 2, 0.42 * body), 0.07, n=14) for px in (-0.3 * w, 0.3 * w)]
    parts += pieces("ends", ends, finishes.front) + pieces("lamps", lamps, finishes.second)
    return parts + bedding(rng, inner, around(d / 2 - 0.035), 0.16, 0.16 + 0.55 * (body - 0.16), finishes)
