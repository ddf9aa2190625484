"""Pendant and ceiling lamps. The origin is the bottom of the box, as of all objects. Lengths in metres."""

import math

import numpy as np

from pipeline.corpus.furniture.bent import curve, lathe, tube, turns
from pipeline.corpus.furniture.finishes import Finishes, pick
from pipeline.corpus.furniture.intervals import around, polar
from pipeline.corpus.furniture.lamps import bulb, shade, shade_word, turn_along_y
from pipeline.corpus.furniture.shape import Pieces, pieces
from pipeline.corpus.furniture.solids import box, circle, cushion, revolve, ring, rod, slab

THIN = 0.0035  # radius of a cord


SHARES = {  # height of a shade in its widths
    "globe": 0.96, "lantern": 1.1, "cage": 1.15, "cone": 0.6, "dome": 0.5, "drum": 0.55, "cylinder": 1.4, "bell": 0.72, "mushroom": 0.5, "rattan": 0.7,
}  # fmt: skip


def pendant_lamp(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a shade, a globe, a lantern or a cage on a cord."""
    kind = form if form in ("globe", "lantern", "cage") else shade_word(rng, finishes, "globe lantern cage crystal paper")
    tall = min(0.66 * h, SHARES.get(kind, 0.6) * w)
    return shade(rng, finishes, kind, w / 2, (0.0, tall)) + _suspension(tall - 0.002, h, finishes)


def _suspension(z: float, h: float, finishes: Finishes) -> Pieces:
    """Return a cord from `z` up to a canopy at the ceiling."""
    cord, rose = rod((0, 0, z), (0, 0, h - 0.024), THIN, n=6), revolve([(0.055, h - 0.024), (0.055, h - 0.006), (0.9 * 0.055, h)], 20)
    return pieces("cord", cord, finishes.handle) + pieces("rose", rose, finishes.handle)


def linear_lamp(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a row of shades under a bar over a table, or one long beam of light; along the longer side."""
    if d > w:
        return turn_along_y(linear_lamp(rng, form, d, w, h, finishes))
    metal = finishes.handle
    parts = pieces("rose", box(around(0.3 * w), (-0.035, 0.035), (h - 0.024, h), 0.004), metal)
    if rng.random() < 0.35:  # one long beam of light
        deep = min(0.05, 0.4 * d)
        parts += pieces("beam", box(around(w / 2), around(d / 2 if d < 0.12 else deep), (0.02, 0.075), 0.006), metal)
        parts += pieces("light", box(around(0.49 * w), around(0.8 * deep), (0.0, 0.02), 0.003), "glow")
        return parts + pieces("cord", [rod((s * 0.28 * w, 0, 0.075), (s * 0.28 * w, 0, h - 0.024), THIN, n=6) for s in (-1, 1)], metal)
    z = min(0.24, 0.36 * h)
    parts += pieces("bar", rod((-0.49 * w, 0, z + 0.05), (0.49 * w, 0, z + 0.05), 0.011, n=10), metal)
    parts += pieces("cord", [rod((s * 0.25 * w, 0, z + 0.061), (s * 0.25 * w, 0, h - 0.024), THIN, n=6) for s in (-1, 1)], metal)
    count = int(np.clip(round(w / 0.32), 2, 6))
    paired = d > 0.5 * w
    r = min(0.23 * d if paired else 0.5 * d, 0.46 * w / count)
    kind = pick(rng, "globe cone dome cylinder")
    low = min(1.9 * r, z)
    for x in np.linspace(-w / 2 + r, w / 2 - r, count).tolist():
        for y in around(d / 2 - r) if paired else [0.0]:
            parts += shade(rng, finishes, kind, r, (0.0, low), (x, y), 14)
            parts += pieces("drop", rod((x, y, low), (x, 0.03 * y, z + 0.039), 0.005, n=6), metal)
    return parts


def cluster_lamp(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build shades that hang at several heights from one rose."""
    count = int(rng.integers(3, 7))
    r = 0.2 * min(w, d) if min(w, d) > 0.3 else 0.34 * min(w, d)
    squash = min(1.0, d / w)
    parts = pieces("rose", slab(circle(0.3 * w, 24, squash=squash), (h - 0.024, h), 0.004), finishes.handle)
    kind = pick(rng, "globe globe cylinder dome")
    for k, a in enumerate(turns(count, 0.3)):
        x, y = (w / 2 - r) * math.cos(a), max(0.0, d / 2 - r) * math.sin(a)
        low = 0.45 * h * (k * 2 % count) / max(1, count - 1)
        high = low + min(1.9 * r, 0.4 * h)
        parts += shade(rng, finishes, kind, r, (low, high), (x, y), 14)
        parts += pieces("cord", rod((x, y, high - 0.001), (0.45 * x, 0.45 * y * squash, h - 0.024), THIN, n=6), finishes.handle)
    return parts


def chandelier(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Arms that swing out and up from a turned stem, each with a small shade or a candle, drops of glass below."""
    metal = finishes.handle
    r, body = w / 2, min(0.62 * h, 0.8 * w)
    parts = pieces("stem", lathe("chandelier_stem", min(1.0, w / 0.6), body, 14), metal)
    crystal = finishes.style.ornament > 0.75 or finishes.style_name == "Light Luxury"
    z = 0.42 * body
    for a in turns(6 if w > 0.55 else 5, 0.2):
        path = [(0.035, 0.3 * body), (0.45 * r, 0.10 * body), (0.80 * r, 0.22 * body), (0.82 * r, z)]
        parts += pieces("arms", tube(curve([polar(p, a, q) for p, q in path], 2), 0.0075, 6), metal)
        x, y = polar(0.82 * r, a)
        parts += pieces("cups", revolve([(0.012, z), (0.03, z + 0.01), (0.03, z + 0.016)], 10, (x, y)), metal)
        if crystal:
            parts += pieces("candle", rod((x, y, z + 0.016), (x, y, z + 0.09), 0.011, n=8), finishes.front) + bulb(z + 0.09, 0.045, (x, y))
            drop = [(0.002, 0.02 * body), (0.014, 0.09 * body), (0.004, 0.19 * body)]
            parts += pieces("drops", revolve(drop, 6, (0.8 * r * math.cos(a), 0.8 * r * math.sin(a))), "crystal")
        else:
            parts += shade(rng, finishes, "bell", 0.175 * r, (z + 0.03, z + 0.03 + 0.3 * r), (x, y), 12)
            parts += pieces("candle", rod((x, y, z + 0.016), (x, y, z + 0.03 + 0.26 * r), 0.008, n=6), metal)
    return parts + _suspension(body - 0.002, h, finishes)


def sputnik_lamp(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Rods in all directions from a ball, a lit globe on each."""
    count, r = 12, 0.09 * min(w, d)
    middle = np.array([0, 0, min(0.66 * h, 0.9 * min(w, d)) / 2])
    z = float(middle[2])
    hub = revolve([(0.4 * r, -0.8 * r), (0.9 * r, -0.3 * r), (0.9 * r, 0.3 * r), (0.4 * r, 0.8 * r)], 12)
    globe = revolve([(r * math.cos(p), r * math.sin(p)) for p in np.linspace(-1.4, 1.4, 7)], 12)
    parts = pieces("hub", [s.translate(middle) for s in hub], finishes.handle)
    for k in range(count):
        up = 1 - 2 * (k + 0.5) / count
        x, y = polar(math.sqrt(1 - up * up), k * math.pi * (3 - math.sqrt(5)))
        out = np.array([x * (w / 2 - r), y * (d / 2 - r), up * (z - r)])
        unit = out / np.linalg.norm(out)
        parts += pieces("rods", rod(middle + 0.85 * r * unit, middle + out - 0.9 * r * unit, 0.005, n=6), finishes.handle)
        parts += pieces("globes", [s.translate(middle + out) for s in globe], "glow")
    return parts + _suspension(z + 0.8 * r, h, finishes)


def ceiling_lamp(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a disc, a square panel, a ring, a rain of crystal, or a lattice frame; tall ones hang in tiers."""
    metal, squash = finishes.handle, d / w
    if form == "crystal" or h > 0.3:
        return _rain(form, w, d, h, finishes)
    if form == "frame":
        return _lattice(w, d, h, finishes)
    if form == "ring":
        parts = pieces("ring", ring((0.5 * w, 0.5 * w), (0.42 * w, 0.42 * w), (0, 0.4 * h), 32, squash=squash), "glow")
        parts += pieces("hoop", ring((0.5 * w, 0.5 * w), (0.42 * w, 0.42 * w), (0.4 * h, 0.6 * h), 32, squash=squash), metal)
        bars = [box(around(0.42 * w), (-0.012, 0.012), (0.6 * h, 0.72 * h)), box((-0.012, 0.012), around(0.42 * d), (0.72 * h, 0.84 * h))]
        return parts + pieces("spokes", bars, metal) + pieces("mount", revolve([(0.08, 0.84 * h), (0.08, h)], 20), metal)
    finish = metal if rng.random() < 0.6 else finishes.timber
    if form == "disc":
        top = h - min(0.4 * h, 0.05)
        mount = revolve([(0.5 * w, top), (0.5 * w, h)], 32, squash=squash)
        diffuser = revolve([(0.26 * w, 0.0), (0.38 * w, 0.08 * h), (0.45 * w, 0.35 * h), (0.48 * w, top)], 32, squash=squash)
    else:
        mount = [box(around(w / 2), around(d / 2), (0.45 * h, h), 0.004)]
        diffuser = [cushion(around(0.47 * w), around(0.47 * d), (0, 0.45 * h), min(0.03, 0.2 * h), 2)]
    return pieces("mount", mount, finish) + pieces("diffuser", diffuser, "glow")


def spots(rng: np.random.Generator, form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a bar with a row of spots that look down, each a little another way."""
    metal = finishes.handle
    parts = pieces("bar", box(around(w / 2), (-0.03, 0.03), (h - 0.03, h), 0.003), metal)
    r, long = min(0.045, 0.3 * h, 0.2 * d), min(0.14, 0.9 * (h - 0.04))
    for x in np.linspace(-0.42 * w, 0.42 * w, max(2, round(w / 0.28))).tolist():
        tilt = float(rng.uniform(-0.3, 0.3))
        drum = revolve([(0.7 * r, 0.0), (r, 0.02), (r, long)], 14)
        parts += pieces("heads", [s.translate((0, 0, -long)).rotate("x", tilt).translate((x, 0, long)) for s in drum], metal)
        parts += pieces("joints", rod((x, 0, long + 0.3 * r), (x, 0, h - 0.03), 0.007, n=8), metal)
    return parts + pieces("ends", [box(around(0.08 * w), around(d / 2), (h - 0.02, h))] if d > 0.07 else [], metal)


def _rain(form: str, w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build rods in three tiers that hang from a plate: of crystal, or lit."""
    edged = form in ("square", "frame")
    plate = revolve([(0.5 * w, h - 0.03), (0.5 * w, h - 0.008), (0.47 * w, h)], 28)
    if edged:
        plate = [box(around(w / 2), around(w / 2), (h - 0.03, h), 0.006)]
    parts = pieces("plate", [s.scale(np.array([1.0, d / w, 1.0])) for s in plate], finishes.handle)
    for k in range(3):
        r = 0.47 * w * (1 - 0.3 * k)
        low = 0.62 * (h - 0.03) * (1 - k / 2)
        rods = []
        for a in turns(max(10, int(22 * (1 - 0.3 * k))), 0.1 * k):
            x, y = polar(r / max(abs(math.cos(a)), abs(math.sin(a))) if edged else r, a)
            rods.append(rod((x, y * d / w, low), (x, y * d / w, h - 0.03), 0.007, n=5))
        parts += pieces("drops", rods, "crystal" if form == "crystal" else "glow")
    return parts


def _lattice(w: float, d: float, h: float, finishes: Finishes) -> Pieces:
    """Build a lit box in a wooden frame with a grid before it."""
    t = 0.03
    x, y = w / 2, d / 2
    inner_x, inner_y = around(x - t), around(y - t)
    frame = [box((-x, x), around(t / 2, s * (y - t / 2)), (0, h), 0.003) for s in (-1, 1)]
    frame += [box(around(t / 2, s * (x - t / 2)), inner_y, (0, h), 0.003) for s in (-1, 1)]
    bars = [box(around(0.006, a), inner_y, (0.011, 0.02)) for a in np.linspace(*inner_x, 5)[1:-1]]
    bars += [box(inner_x, around(0.006, b), (0.002, 0.011)) for b in np.linspace(*inner_y, 5)[1:-1]]
    light = box(inner_x, inner_y, (0.02, h - 0.01))
    return pieces("frame", frame, finishes.timber) + pieces("light", light, "glow") + pieces("lattice", bars, finishes.timber)
