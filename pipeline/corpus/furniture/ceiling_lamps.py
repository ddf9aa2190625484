"""Pendant and ceiling lamps. The origin is the bottom of the box, as of all objects. Lengths in metres."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.bent import curve, tube, turns
from pipeline.corpus.furniture.finishes import GLOW, Scheme
from pipeline.corpus.furniture.lamps import turned_along
from pipeline.corpus.furniture.shades import bulb, cord, rose, shade, shade_word
from pipeline.corpus.furniture.shape import Pieces, Shape, Size, pieces
from pipeline.corpus.furniture.solids import around, box, circle, cushion, polar, revolve, ring, rod, slab

CRYSTAL = replace(GLOW, name="crystal", color=(0.82, 0.86, 0.88), roughness=0.05, opacity=0.55, density=2500)
THIN = 0.0035  # radius of a cord


def pendant_lamp(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a shade or globe on a cord, a bar over a table, a cluster, a chandelier, a lantern, a sputnik, or a cage."""
    w, d, h = size
    if form == "linear" and d > w:  # built along x, turned to the longer side
        return turned_along(pendant_lamp(rng, form, (d, w, h), scheme))
    metal = scheme.handle
    build = {"linear": _linear, "cluster": _cluster, "chandelier": _chandelier, "sputnik": _sputnik}.get(form)
    if build:
        return Shape(build(rng, size, scheme))
    kind = {"globe": "globe", "lantern": "lantern", "cage": "cage"}.get(form) or shade_word(rng, scheme, "globe lantern cage crystal paper")
    share = {
        "globe": 0.96,
        "lantern": 1.1,
        "cage": 1.15,
        "cone": 0.6,
        "dome": 0.5,
        "drum": 0.55,
        "cylinder": 1.4,
        "pleated": 0.6,
        "bell": 0.72,
        "mushroom": 0.5,
        "rattan": 0.7,
    }
    tall = min(0.66 * h, share.get(kind, 0.6) * w)
    parts = shade(rng, scheme, kind, w / 2, (0.0, tall))
    return Shape(parts + pieces("cord", cord((tall - 0.002, h - 0.024)), metal) + pieces("rose", rose(h), metal))


def _linear(rng: np.random.Generator, size: Size, scheme: Scheme) -> Pieces:
    w, d, h = size
    metal = scheme.handle
    parts = pieces("rose", box(around(0.3 * w), (-0.035, 0.035), (h - 0.024, h), 0.004), metal)
    if rng.random() < 0.35:  # one long beam of light
        deep = min(0.05, 0.4 * d)
        parts += pieces(
            "beam", box(around(w / 2), (-d / 2 if d < 0.12 else -deep, d / 2 if d < 0.12 else deep), (0.02, 0.075), 0.006), metal
        )
        parts += pieces("light", box(around(0.49 * w), around(0.8 * deep), (0.0, 0.02), 0.003), GLOW)
        return parts + pieces("cord", [rod((s * 0.28 * w, 0, 0.075), (s * 0.28 * w, 0, h - 0.024), THIN, n=6) for s in (-1, 1)], metal)
    z = min(0.24, 0.36 * h)
    parts += pieces("bar", rod((-0.49 * w, 0, z + 0.05), (0.49 * w, 0, z + 0.05), 0.011, n=10), metal)
    parts += pieces("cord", [rod((s * 0.25 * w, 0, z + 0.061), (s * 0.25 * w, 0, h - 0.024), THIN, n=6) for s in (-1, 1)], metal)
    count = int(np.clip(round(w / 0.32), 2, 6))
    paired = d > 0.5 * w
    r = min(0.23 * d if paired else 0.5 * d, 0.46 * w / count)
    kind = str(rng.choice(["globe", "cone", "dome", "cylinder"]))
    rows = [-d / 2 + r, d / 2 - r] if paired else [0.0]
    for x in np.linspace(-w / 2 + r, w / 2 - r, count).tolist():
        for y in rows:
            parts += shade(rng, scheme, kind, r, (0.0, min(1.9 * r, z)), (x, y), 14)
            parts += pieces("drop", rod((x, y, min(1.9 * r, z)), (x, 0.03 * y, z + 0.039), 0.005, n=6), metal)
    return parts


def _cluster(rng: np.random.Generator, size: Size, scheme: Scheme) -> Pieces:
    w, d, h = size
    metal = scheme.handle
    count = int(rng.integers(3, 7))
    r = 0.2 * min(w, d) if min(w, d) > 0.3 else 0.34 * min(w, d)
    parts = pieces("rose", slab(circle(0.3 * w, 24, squash=min(1.0, d / w)), (h - 0.024, h), 0.004), metal)
    kind = str(rng.choice(["globe", "globe", "cylinder", "dome"]))
    for k, a in enumerate(turns(count, 0.3)):
        x, y = (w / 2 - r) * math.cos(a), max(0.0, d / 2 - r) * math.sin(a)
        low = 0.45 * h * (k * 2 % count) / max(1, count - 1)
        high = low + min(1.9 * r, 0.4 * h)
        parts += shade(rng, scheme, kind, r, (low, high), (x, y), 14)
        parts += pieces("cord", rod((x, y, high - 0.001), (0.45 * x, 0.45 * y * min(1.0, d / w), h - 0.024), THIN, n=6), metal)
    return parts


def _chandelier(rng: np.random.Generator, size: Size, scheme: Scheme) -> Pieces:
    """Arms that swing out and up from a turned stem, each with a small shade or a candle, drops of glass below."""
    w, _, h = size
    metal = scheme.handle
    r, body = w / 2, min(0.62 * h, 0.8 * w)
    steps = [(0.012, 0.0), (0.05, 0.06), (0.02, 0.14), (0.055, 0.24), (0.02, 0.36), (0.03, 0.6), (0.012, 0.8), (0.02, 0.95), (0.006, 1.0)]
    parts = pieces("stem", revolve([(a * min(1.0, w / 0.6), b * body) for a, b in steps], 14), metal)
    count = 6 if w > 0.55 else 5
    crystal = scheme.manner.ornament > 0.75 or scheme.style == "Light Luxury"
    for a in turns(count, 0.2):
        c, s = math.cos(a), math.sin(a)
        path = [(0.035, 0.3 * body), (0.45 * r, 0.10 * body), (0.80 * r, 0.22 * body), (0.82 * r, 0.42 * body)]
        parts += pieces("arms", tube(curve([(p * c, p * s, z) for p, z in path], 2), 0.0075, 6), metal)
        at = (0.82 * r * c, 0.82 * r * s)
        z = 0.42 * body
        parts += pieces("cups", revolve([(0.012, z), (0.03, z + 0.01), (0.03, z + 0.016)], 10, at), metal)
        if crystal:
            parts += pieces("candle", rod((*at, z + 0.016), (*at, z + 0.09), 0.011, n=8), scheme.front) + bulb(z + 0.09, 0.045, at)
            parts += pieces(
                "drops", revolve([(0.002, 0.02 * body), (0.014, 0.09 * body), (0.004, 0.19 * body)], 6, (0.8 * r * c, 0.8 * r * s)), CRYSTAL
            )
        else:
            parts += shade(rng, scheme, "bell", 0.175 * r, (z + 0.03, z + 0.03 + 0.3 * r), at, 12) + pieces(
                "candle", rod((*at, z + 0.016), (*at, z + 0.03 + 0.26 * r), 0.008, n=6), metal
            )
    return parts + pieces("cord", cord((body - 0.002, h - 0.024)), metal) + pieces("rose", rose(h), metal)


def _sputnik(rng: np.random.Generator, size: Size, scheme: Scheme) -> Pieces:
    """Rods in all directions from a ball, a lit globe on each."""
    w, d, h = size
    metal = scheme.handle
    ball = min(0.66 * h, 0.9 * min(w, d))
    count, r = 12, 0.09 * min(w, d)
    middle = ball / 2
    parts = pieces(
        "hub",
        [s.moved((0, 0, middle)) for s in revolve([(0.4 * r, -0.8 * r), (0.9 * r, -0.3 * r), (0.9 * r, 0.3 * r), (0.4 * r, 0.8 * r)], 12)],
        metal,
    )
    for k in range(count):
        z = 1 - 2 * (k + 0.5) / count
        a, q = k * math.pi * (3 - math.sqrt(5)), math.sqrt(1 - z * z)
        out = np.array([q * math.cos(a) * (w / 2 - r), q * math.sin(a) * (d / 2 - r), z * (middle - r)])
        at = out + np.array([0, 0, middle])
        unit = out / np.linalg.norm(out)
        parts += pieces("rods", rod(tuple(np.array([0, 0, middle]) + 0.85 * r * unit), tuple(at - 0.9 * r * unit), 0.005, n=6), metal)
        globe = revolve([polar(r, p) for p in np.linspace(-1.4, 1.4, 7)], 12)
        parts += pieces("globes", [s.moved(at) for s in globe], GLOW)
    return parts + pieces("cord", cord((middle + 0.8 * r, h - 0.024)), metal) + pieces("rose", rose(h), metal)


def ceiling_lamp(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a disc, a square panel, a ring, a rain of crystal, a lattice frame or a row of spots; tall ones hang in tiers."""
    w, d, h = size
    metal = scheme.handle
    squash = np.array([1.0, d / w, 1.0])
    if form == "crystal" or (h > 0.3 and form != "spots"):
        return Shape(_rain(form, size, scheme))
    if form == "disc":
        rim = min(0.4 * h, 0.05)
        parts = pieces(
            "mount", revolve([(0.5 * w, h - rim), (0.5 * w, h)], 32, squash=d / w), metal if rng.random() < 0.6 else scheme.timber
        )
        profile = [(0.26 * w, 0.0), (0.38 * w, 0.08 * h), (0.45 * w, 0.35 * h), (0.48 * w, h - rim)]
        return Shape(parts + pieces("diffuser", revolve(profile, 32, squash=d / w), GLOW))
    if form == "square":
        parts = pieces("mount", box(around(w / 2), around(d / 2), (0.45 * h, h), 0.004), metal if rng.random() < 0.6 else scheme.timber)
        return Shape(parts + pieces("diffuser", cushion(around(0.47 * w), around(0.47 * d), (0, 0.45 * h), min(0.03, 0.2 * h), 2), GLOW))
    if form == "frame":
        return Shape(_lattice(size, scheme))
    if form == "spots":
        parts = pieces("bar", box(around(w / 2), (-0.03, 0.03), (h - 0.03, h), 0.003), metal)
        count = max(2, round(w / 0.28))
        for x in np.linspace(-0.42 * w, 0.42 * w, count):
            r = min(0.045, 0.3 * h, 0.2 * d)
            long = min(0.14, 0.9 * (h - 0.04))
            drum = revolve([(0.7 * r, 0.0), (r, 0.02), (r, long)], 14)
            tilt = float(rng.uniform(-0.3, 0.3))
            head = [s.moved((0, 0, -long)).turned("x", tilt).moved((float(x), 0, long)) for s in drum]
            parts += pieces("heads", head, metal) + pieces(
                "joints", rod((float(x), 0, long + 0.3 * r), (float(x), 0, h - 0.03), 0.007, n=8), metal
            )
        parts += pieces("ends", [box(around(0.08 * w), around(d / 2), (h - 0.02, h))] if d > 0.07 else [], metal)
        return Shape(parts)
    outer = [s.scaled(squash) for s in ring((0.5 * w, 0.5 * w), (0.42 * w, 0.42 * w), (0, 0.4 * h), 32)]
    parts = pieces("ring", outer, GLOW) + pieces(
        "hoop", [s.scaled(squash) for s in ring((0.5 * w, 0.5 * w), (0.42 * w, 0.42 * w), (0.4 * h, 0.6 * h), 32)], metal
    )
    bars = [box(around(0.42 * w), (-0.012, 0.012), (0.6 * h, 0.72 * h)), box((-0.012, 0.012), around(0.42 * d), (0.72 * h, 0.84 * h))]
    return Shape(parts + pieces("spokes", bars, metal) + pieces("mount", revolve([(0.08, 0.84 * h), (0.08, h)], 20), metal))


def _rain(form: str, size: Size, scheme: Scheme) -> Pieces:
    """Build rods in tiers that hang from a plate: of crystal, or lit."""
    w, d, h = size
    squash = np.array([1.0, d / w, 1.0])
    disc = revolve([(0.5 * w, h - 0.03), (0.5 * w, h - 0.008), (0.47 * w, h)], 28)
    panel = [box(around(w / 2), around(w / 2), (h - 0.03, h), 0.006)]
    edged = form in ("square", "frame")
    parts = pieces("plate", [s.scaled(squash) for s in (panel if edged else disc)], scheme.handle)
    rows = 3
    for k in range(rows):
        r = 0.47 * w * (1 - 0.3 * k)
        low = 0.62 * (h - 0.03) * (1 - k / (rows - 1)) if rows > 1 else 0.0
        count = max(10, int(22 * (1 - 0.3 * k)))
        rods = []
        for a in turns(count, 0.1 * k):
            reach = r / max(abs(math.cos(a)), abs(math.sin(a))) if edged else r
            x, y = reach * math.cos(a), reach * math.sin(a) * d / w
            rods.append(rod((x, y, low), (x, y, h - 0.03), 0.007, n=5))
        parts += pieces("drops", rods, CRYSTAL if form == "crystal" else GLOW)
    return parts


def _lattice(size: Size, scheme: Scheme) -> Pieces:
    """Build a lit box in a wooden frame with a grid before it."""
    w, d, h = size
    t = 0.03
    wood = scheme.timber
    x, y = w / 2, d / 2
    frame = [box((-x, x), around(t / 2, s * (y - t / 2)), (0, h), 0.003) for s in (-1, 1)]
    frame += [box(around(t / 2, s * (x - t / 2)), around(y - t), (0, h), 0.003) for s in (-1, 1)]
    parts = pieces("frame", frame, wood) + pieces("light", box(around(x - t), around(y - t), (0.02, h - 0.01)), GLOW)
    xs, ys = np.linspace(-x + t, x - t, 5)[1:-1], np.linspace(-y + t, y - t, 5)[1:-1]
    bars = [box(around(0.006, a), around(y - t), (0.011, 0.02)) for a in xs] + [
        box(around(x - t), around(0.006, b), (0.002, 0.011)) for b in ys
    ]
    return parts + pieces("lattice", bars, wood)
