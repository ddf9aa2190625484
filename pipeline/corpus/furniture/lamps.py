"""Lamps: pendant, ceiling, floor and wall lamps. The origin is the bottom of the box, as of all objects."""

# ruff: noqa: ARG001 - all builders share one signature, whatever of it they need

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.finishes import GLOW, Finish, Scheme
from pipeline.corpus.furniture.shape import Piece, Shape, pieces
from pipeline.corpus.furniture.solids import Solid, box, circle, cushion, revolve, ring, rod, slab
from pipeline.corpus.furniture.storage import Size, pick


def shade(
    scheme: Scheme, kind: str, radius: float, z: tuple[float, float], centre: tuple[float, float] = (0.0, 0.0), n: int = 20
) -> tuple[Piece, ...]:
    """Return a lamp shade: a hollow drum, cone or dome, or a solid globe of glass; bulb inside."""
    low, high = z
    bulb = (
        pieces("bulb", revolve([(0.012, high - 0.1), (0.03, high - 0.085), (0.03, high - 0.06), (0.015, high - 0.03)], 10, centre), GLOW)
        if high - low > 0.14
        else ()
    )
    cloth = Finish("shade_cloth", (0.80, 0.75, 0.65), 0.9, density=150)
    if kind == "drum":
        return bulb + pieces("shade", ring((radius, 0.88 * radius), (radius - 0.005, 0.88 * radius - 0.005), z, n, centre), cloth)
    if kind == "cone":
        return bulb + pieces("shade", ring((radius, 0.3 * radius), (radius - 0.006, 0.3 * radius - 0.006), z, n, centre), scheme.front)
    if kind == "dome":
        made: list[Solid] = []
        steps = np.linspace(0.0, 1.25, 5)
        rims = [(radius * math.cos(a), low + (high - low) * math.sin(a) / math.sin(1.25)) for a in steps]
        for (r0, z0), (r1, z1) in itertools.pairwise(rims):
            made += ring((r0, r1), (r0 - 0.006, r1 - 0.006), (z0, z1), n, centre)
        return bulb + pieces("shade", made, scheme.handle)
    profile = [(radius * math.cos(a), (low + high) / 2 + (high - low) / 2 * math.sin(a)) for a in np.linspace(-1.5, 1.5, 9)]
    return pieces("globe", revolve(profile, n, centre), GLOW)


def hanging(z: tuple[float, float], centre: tuple[float, float] = (0.0, 0.0)) -> list[Solid]:
    """Return a cord."""
    return [rod((*centre, z[0]), (*centre, z[1]), 0.004, n=6)]


def pendant_lamp(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a shade or globe on a cord, a bar over a table, or a cluster of small ones."""
    w, d, h = size
    if form == "linear" and d > w:  # built along x, turned to the longer side
        along = pendant_lamp(rng, form, (d, w, h), scheme)
        return Shape(tuple(replace(p, solid=p.solid.turned("z", math.pi / 2)) for p in along.base))
    rose = revolve([(0.05, h - 0.025), (0.05, h)], 16)
    metal = scheme.handle
    if form in ("shade", "globe"):
        kind = "globe" if form == "globe" else pick(rng, "drum cone dome")
        tall = min(0.62 * h, (0.95 if form == "globe" else float(rng.uniform(0.5, 0.75))) * w)
        base = shade(scheme, kind, w / 2, (0.0, tall)) + pieces(
            "cord", hanging((tall - 0.03 if kind != "globe" else tall - 0.004, h - 0.025)), metal
        )
        if kind in ("drum", "cone"):
            top = 0.86 * w / 2 if kind == "drum" else 0.28 * w / 2
            base += pieces(
                "spider",
                [
                    rod((-top, 0, tall - 0.02), (top, 0, tall - 0.02), 0.004, n=6),
                    rod((0, -top, tall - 0.02), (0, top, tall - 0.02), 0.004, n=6),
                ],
                metal,
            )
        return Shape(base + pieces("rose", rose, metal))
    base = pieces("rose", [box((-0.3 * w, 0.3 * w), (-0.04, 0.04), (h - 0.025, h), 0.004)], metal)
    if form == "linear":
        z = min(0.18, 0.3 * h)
        base += pieces("bar", box((-0.48 * w, 0.48 * w), (-0.012, 0.012), (z, z + 0.025), 0.003), metal)
        base += pieces("cord", [rod((s * 0.25 * w, 0, z + 0.025), (s * 0.25 * w, 0, h - 0.025), 0.003, n=6) for s in (-1, 1)], metal)
        count = int(np.clip(round(w / 0.3), 2, 6))
        r = min(0.5 * d, 0.45 * w / count)
        for k, x in enumerate(np.linspace(-w / 2 + r, w / 2 - r, count)):
            kind = "globe" if k % 2 == 0 or count < 3 else "drum"
            base += shade(scheme, kind, r, (0.0, min(2 * r, z)), (float(x), 0.0), 12)
        return Shape(base)
    count = int(rng.integers(3, 6))
    r = 0.2 * min(w, d) if min(w, d) > 0.3 else 0.35 * min(w, d)
    for k in range(count):
        a = 2 * math.pi * k / count
        x, y = (w / 2 - r) * math.cos(a), max(0.0, d / 2 - r) * math.sin(a)
        low = 0.45 * h * k / max(1, count - 1)
        base += shade(scheme, "globe", r, (low, low + min(2 * r, 0.4 * h)), (x, y), 12)
        base += pieces("cord", [rod((x, y, low + min(2 * r, 0.4 * h) - 0.004), (0.5 * x, 0.2 * y, h - 0.025), 0.003, n=6)], metal)
    return Shape(base + pieces("rose_disc", slab(circle(0.6 * w / 2, 20, squash=min(1.0, d / w)), (h - 0.024, h - 0.002)), metal))


def ceiling_lamp(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a disc, a square panel or a ring close to the ceiling; tall ones hang in tiers."""
    w, d, h = size
    metal = scheme.handle
    if h > 0.45:
        tiers = [(1.0, 0.0, 0.32), (0.62, 0.38, 0.6)]
        base: tuple[Piece, ...] = ()
        for share, low, high in tiers:
            r = share * w / 2
            base += pieces(
                "tier", [s.scaled(np.array([1, d / w, 1])) for s in ring((0.9 * r, r), (0.82 * r, 0.94 * r), (low * h, high * h), 24)], GLOW
            )
            base += pieces("spokes", [box((-0.85 * r, 0.85 * r), (-0.008, 0.008), ((low + 0.1) * h, (low + 0.1) * h + 0.012))], metal)
        base += pieces("stem", revolve([(0.012, 0.05 * h), (0.012, 0.94 * h), (0.08, h)], 16), metal)
        return Shape(base)
    if form == "disc":
        rim = min(0.4 * h, 0.05)
        base = pieces("mount", [s.scaled(np.array([1, d / w, 1])) for s in revolve([(0.5 * w, h - rim), (0.5 * w, h)], 28)], metal)
        profile = [(0.30 * w, 0.0), (0.42 * w, 0.15 * h), (0.47 * w, 0.45 * h), (0.48 * w, h - rim)]
        return Shape(base + pieces("diffuser", [s.scaled(np.array([1, d / w, 1])) for s in revolve(profile, 28)], GLOW))
    if form == "square":
        base = pieces("mount", box((-w / 2, w / 2), (-d / 2, d / 2), (0.5 * h, h), 0.004), metal)
        return Shape(
            base + pieces("diffuser", cushion((-0.46 * w, 0.46 * w), (-0.46 * d, 0.46 * d), (0, 0.5 * h), min(0.03, 0.2 * h)), GLOW)
        )
    outer = [s.scaled(np.array([1, d / w, 1])) for s in ring((0.5 * w, 0.5 * w), (0.42 * w, 0.42 * w), (0, 0.55 * h), 28)]
    base = pieces("ring", outer, GLOW)
    base += pieces(
        "spokes",
        [
            box((-0.43 * w, 0.43 * w), (-0.012, 0.012), (0.55 * h, 0.7 * h)),
            box((-0.012, 0.012), (-0.43 * d, 0.43 * d), (0.7 * h, 0.85 * h)),
        ],
        metal,
    )
    return Shape(base + pieces("mount", revolve([(0.07, 0.85 * h), (0.07, h)], 20), metal))


def floor_lamp(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a shade on a pole, on three legs, or on an arc."""
    w, d, h = size
    metal = scheme.handle
    r = w / 2
    if form == "arc":
        r = min(0.3 * w, 0.45 * d, 0.2)
        x = -w / 2 + r
        foot = revolve([(min(0.42 * d, 0.3 * w), 0.0), (min(0.42 * d, 0.3 * w), 0.035)], 24, (x + 0.02, 0.0))
        points = [(x + 0.02, 0.035), (x + 0.02, 0.8 * h), (x + 0.15 * w, 0.96 * h), (x + 0.4 * w, h - 0.012), (w / 2 - r, h - 0.04)]
        arm = [rod((a[0], 0, a[1]), (b[0], 0, b[1]), 0.011, n=8) for a, b in itertools.pairwise(points)]
        top = h - 0.2
        base = pieces("foot", foot, metal) + pieces("pole", arm, metal)
        base += pieces("cord", [rod((w / 2 - r, 0, top - 0.02), (w / 2 - r, 0, h - 0.035), 0.006, n=6)], metal)
        return Shape(base + shade(scheme, "dome", r, (top - 0.9 * r, top), (w / 2 - r, 0.0)))
    tall = min(0.28 * h, 0.9 * w)
    kind = pick(rng, "drum drum cone") if form == "shade" else "drum"
    base = shade(scheme, kind, r, (h - tall, h))
    spoke = 0.86 * r if kind == "drum" else 0.28 * r
    base += pieces("spider", [rod((-spoke, 0, h - 0.02), (spoke, 0, h - 0.02), 0.004, n=6)], metal)
    if form == "tripod":
        legs = []
        for k in range(3):
            a = math.pi / 2 + k * 2 * math.pi / 3
            legs.append(
                rod(
                    (0.95 * r * math.cos(a), 0.95 * r * math.sin(a), 0),
                    (0.03 * math.cos(a), 0.03 * math.sin(a), h - tall - 0.02),
                    0.011,
                    0.014,
                    8,
                )
            )
        hub = revolve([(0.05, h - tall - 0.03), (0.05, h - tall), (0.008, h - tall + 0.005), (0.008, h - 0.018)], 14)
        return Shape(base + pieces("legs", legs, scheme.accent) + pieces("hub", hub, metal))
    pole = revolve([(0.62 * r, 0.0), (0.62 * r, 0.02), (0.012, 0.035), (0.010, h - 0.018)], 20)
    return Shape(base + pieces("pole", pole, metal))


def wall_lamp(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a small shade on an arm, or a lit bar; the back is at the wall."""
    w, d, h = size
    if form == "bar":
        plate = box((-0.5 * w, 0.5 * w), (d / 2 - 0.018, d / 2), (0.36 * h, 0.64 * h), 0.004)
        r = min(0.16 * w, 0.3 * d)
        tube = [rod((0, -d / 2 + r, 0), (0, -d / 2 + r, h), 0.85 * r, n=14)]
        caps = [rod((0, -d / 2 + r, z), (0, -d / 2 + r, z + 0.03 * h), r, n=14) for z in (0.0, 0.97 * h)]
        arm = box((-0.012, 0.012), (-d / 2 + r, d / 2 - 0.018), (0.48 * h, 0.52 * h), 0.002)
        metal = pieces("plate", plate, scheme.handle) + pieces("caps", [*caps, arm], scheme.handle)
        return Shape(metal + pieces("tube", tube, GLOW))
    base = pieces("plate", box((-0.18 * w, 0.18 * w), (d / 2 - 0.018, d / 2), (0.3 * h, 0.85 * h), 0.004), scheme.handle)
    r = min(w / 2, 0.42 * d)
    y = -d / 2 + r
    arm = rod((0, d / 2 - 0.018, 0.6 * h), (0, y, 0.52 * h), 0.008, n=8)
    base += pieces("arm", arm, scheme.handle) + pieces(
        "spider", rod((-0.85 * r, y, 0.52 * h), (0.85 * r, y, 0.52 * h), 0.005, n=6), scheme.handle
    )
    return Shape(base + shade(scheme, pick(rng, "drum globe") if h > 0.25 else "drum", r, (0.0 if h < 0.3 else 0.2 * h, h), (0.0, y), 16))


def table_lamp(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a shade or a globe on a turned foot, or a desk lamp with a jointed arm."""
    w, d, h = size
    metal = scheme.handle
    if form == "desk":
        foot = revolve([(0.4 * d, 0.0), (0.4 * d, 0.015), (0.1 * d, 0.022)], 20, (-w / 2 + 0.4 * d, 0.0))
        x0 = -w / 2 + 0.4 * d
        elbow, tip = (x0 - 0.1 * d, 0.0, 0.62 * h), (w / 2 - 0.3 * d, 0.0, h - 0.03)
        arm = [
            rod((x0, 0, 0.022), elbow, 0.007, n=8),
            rod(elbow, tip, 0.007, n=8),
            revolve([(0.012, -0.012), (0.012, 0.012)], 10)[0].moved(elbow),
        ]
        r = 0.3 * d
        head = shade(scheme, "cone", r, (h - 0.03 - 0.3 * h, h - 0.03), (w / 2 - r, 0.0), 16)
        return Shape(pieces("foot", foot, metal) + pieces("arm", arm, metal) + head)
    r = w / 2
    tall = 0.42 * h
    stem = h - tall
    if form == "globe":
        base = pieces("foot", revolve([(0.6 * r, 0.0), (0.6 * r, 0.02), (0.02, 0.03), (0.02, stem)], 20), metal)
        return Shape(base + shade(scheme, "globe", r, (stem, h)))
    body = [
        (0.45 * r, 0.0),
        (0.5 * r, 0.03 * h),
        (0.62 * r, 0.2 * h),
        (0.5 * r, 0.4 * h),
        (0.16 * r, 0.52 * h),
        (0.016, stem),
        (0.008, h - 0.02),
    ]
    base = pieces("foot", revolve(body, 20), scheme.timber if rng.random() < 0.4 else scheme.front)
    base += pieces("spider", rod((-0.85 * r, 0, h - 0.02), (0.85 * r, 0, h - 0.02), 0.003, n=6), metal)
    return Shape(base + shade(scheme, "drum", r, (stem, h)))
