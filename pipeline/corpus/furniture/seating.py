"""Chairs and stools."""

# ruff: noqa: ARG001 - all builders share one signature, whatever of it they need

from __future__ import annotations

import itertools
import math

import numpy as np

from pipeline.corpus.furniture.finishes import PLASTIC, Scheme
from pipeline.corpus.furniture.shape import Piece, Shape, pieces
from pipeline.corpus.furniture.solids import Solid, beam, box, circle, cushion, revolve, rod, rounded, slab
from pipeline.corpus.furniture.storage import Size, pick

Spot = tuple[float, float]


def chair_legs(rng: np.random.Generator, half: Spot, height: float, kind: str) -> list[Solid]:
    """Return four legs at (+-half) under a seat at `height` [m]."""
    made: list[Solid] = []
    for sx in (-1, 1):
        for sy in (-1, 1):
            x, y = sx * half[0], sy * half[1]
            if kind == "square":
                made.append(beam((x, y, 0), (x, y, height), 0.036, 0.036, 0.7))
            elif kind == "metal":
                made.append(rod((x, y, 0), (x - sx * 0.02, y - sy * 0.02, height), 0.009, n=8))
            else:
                made.append(rod((x, y, 0), (x - sx * 0.05, y - sy * 0.05, height), 0.011, 0.02, 10))
    if kind == "square" and rng.random() < 0.6:
        z = 0.35 * height
        made += [box((sx * half[0] - 0.01, sx * half[0] + 0.01), (-half[1] + 0.016, half[1] - 0.016), (z, z + 0.025)) for sx in (-1, 1)]
    return made


def dining_chair(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a chair of wood, with a shell, upholstered, or with spindles."""
    w, d, h = size
    seat = min(0.47, 0.56 * h)
    kind = pick(rng, "square round metal") if form != "wood" else "square"
    frame = scheme.handle if kind == "metal" else scheme.accent
    x, y = 0.5 * w, 0.5 * d
    lean = 0.10 * d
    base = pieces("legs", chair_legs(rng, (x - 0.022, y - 0.06 if form != "shell" else y - 0.05), seat - 0.04, kind), frame)
    back_y = y - lean - 0.01
    if form == "shell":
        shell = scheme.soft if rng.random() < 0.5 else scheme.front
        base += pieces("seat", cushion((-x, x), (-y, y - 0.08), (seat - 0.05, seat), 0.024), shell)
        back = [
            cushion((-0.96 * x, 0.96 * x), (back_y - 0.03, back_y + 0.02), (seat - 0.03, h), 0.02).turned(
                "x", -lean / (h - seat), (0, back_y, seat)
            ),
        ]
        wings = [
            cushion(
                (s * x - 0.03 if s > 0 else -x, x if s > 0 else -x + 0.03),
                (-0.2 * y, back_y),
                (seat - 0.03, seat + 0.4 * (h - seat)),
                0.014,
            )
            for s in (-1, 1)
        ]
        return Shape(base + pieces("back", back, shell) + (pieces("arms", wings, shell) if rng.random() < 0.5 else ()))
    rail = box((-x + 0.01, x - 0.01), (-y + 0.02, back_y + 0.01), (seat - 0.075, seat - 0.04), 0.003)
    base += pieces("seat_frame", rail, frame if kind != "metal" else scheme.body)
    if form == "wood":
        base += pieces("seat", slab(rounded((-x, x), (-y, back_y + 0.02), 0.05, 3), (seat - 0.04, seat), 0.006), scheme.body)
    else:
        base += pieces("seat", cushion((-x, x), (-y, back_y + 0.02), (seat - 0.045, seat + 0.02), 0.03), scheme.soft)
    posts = [beam((s * (x - 0.025), back_y, seat - 0.045), (s * (x - 0.035), back_y + lean, h), 0.03, 0.028) for s in (-1, 1)]

    def at(t: float) -> float:
        return back_y + lean * t

    def bar(t0: float, t1: float, thick: float = 0.018) -> Solid:
        z0, z1 = seat + t0 * (h - seat), seat + t1 * (h - seat)
        return beam((0, at(t0), z0), (0, at(t1), z1), 2 * x - 0.075, thick)

    if form == "upholstered":
        z0 = seat + 0.12 * (h - seat)
        pad = cushion((-0.96 * x, 0.96 * x), (back_y - 0.03, back_y + 0.03), (z0, h), 0.024).turned(
            "x", -lean / (h - seat), (0, back_y, z0)
        )
        return Shape(base + pieces("back", pad, scheme.soft) + pieces("posts", [s.scaled(np.array([0.9, 1, 0.96])) for s in posts], frame))
    bars = [bar(0.82, 1.0)]
    if form == "spindle":
        xs = np.linspace(-x + 0.08, x - 0.08, max(4, round(w / 0.09)))
        bars += [rod((sx, back_y, seat - 0.002), (sx, at(0.85), seat + 0.85 * (h - seat)), 0.008, n=6) for sx in xs]
    else:
        bars += [bar(0.5, 0.64), bar(0.2, 0.33)] if rng.random() < 0.6 else [bar(0.3, 0.75)]
    return Shape(base + pieces("posts", posts, frame) + pieces("back", bars, frame))


def lounge_chair(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build an easy chair in a wooden frame, an office chair on castors, or a wing chair."""
    if form == "office":
        return _office_chair(size, scheme)
    w, d, h = size
    seat = min(0.42, 0.48 * h)
    x, y = w / 2, d / 2
    if form == "wing":
        legs = [
            rod((s * (x - 0.07), t * (y - 0.08), 0), (s * (x - 0.09), t * (y - 0.1), 0.16), 0.013, 0.022, 10)
            for s in (-1, 1)
            for t in (-1, 1)
        ]
        base = pieces("legs", legs, scheme.accent)
        base += pieces("body", cushion((-x + 0.02, x - 0.02), (-y + 0.02, y - 0.02), (0.16, seat - 0.09), 0.03), scheme.soft)
        base += pieces("seat", cushion((-x + 0.1, x - 0.1), (-y, y - 0.14), (seat - 0.09, seat + 0.02), 0.04), scheme.soft)
        base += pieces("back", cushion((-x + 0.06, x - 0.06), (y - 0.15, y), (seat - 0.08, h), 0.05), scheme.soft)
        arms = [
            cushion((s * x - 0.1 if s > 0 else -x, x if s > 0 else -x + 0.1), (-y + 0.04, y - 0.05), (0.2, seat + 0.17), 0.035)
            for s in (-1, 1)
        ]
        wings = [
            cushion(
                (s * x - 0.07 if s > 0 else -x + 0.01, x - 0.01 if s > 0 else -x + 0.07), (y - 0.3, y - 0.04), (seat + 0.1, h - 0.03), 0.03
            )
            for s in (-1, 1)
        ]
        return Shape(base + pieces("arms", arms + wings, scheme.soft))
    frame: list[Solid] = []
    arm = seat + 0.17
    for s in (-1, 1):
        px = s * (x - 0.02)
        frame += [
            beam((px, -y + 0.04, 0), (px, -y + 0.06, arm - 0.025), 0.032, 0.04),
            beam((px, y - 0.03, 0), (px, y - 0.12, arm - 0.025), 0.032, 0.04),
        ]
        frame += [box((px - 0.028 if s > 0 else -x, x if s > 0 else px + 0.028), (-y + 0.01, y - 0.06), (arm - 0.025, arm), 0.006)]
        frame += [box((px - 0.012, px + 0.012), (-y + 0.06, y - 0.06), (seat - 0.17, seat - 0.12), 0.003)]
    frame += [box((-x + 0.03, x - 0.03), (sy - 0.012, sy + 0.012), (seat - 0.17, seat - 0.12), 0.003) for sy in (-y + 0.09, y - 0.15)]
    tilt = -0.22
    pads = [
        cushion((-x + 0.045, x - 0.045), (-y + 0.02, y - 0.16), (seat - 0.12, seat), 0.04),
        cushion((-x + 0.045, x - 0.045), (y - 0.26, y - 0.14), (seat - 0.02, h / math.cos(tilt) - 0.01), 0.045).turned(
            "x", tilt, (0, y - 0.2, seat)
        ),
    ]
    return Shape(pieces("frame", frame, scheme.accent) + pieces("pads", pads, scheme.soft))


def _office_chair(size: Size, scheme: Scheme) -> Shape:
    """Five castors, a gas spring, a padded seat, a back and two arms."""
    w, d, h = size
    seat = min(0.5, 0.52 * h)
    r = 0.46 * min(w, d)
    base: list[Solid] = []
    wheels: list[Solid] = []
    for k in range(5):
        a = math.pi / 2 + k * 2 * math.pi / 5
        c, s = math.cos(a), math.sin(a)
        base.append(rod((0.03 * c, 0.03 * s, 0.10), (r * c, r * s, 0.068), 0.022, 0.014, 8))
        wheels.append(rod((r * c - 0.018 * s, r * s + 0.018 * c, 0.027), (r * c + 0.018 * s, r * s - 0.018 * c, 0.027), 0.027, n=10))
    base += revolve([(0.034, 0.06), (0.034, 0.13), (0.02, 0.14), (0.02, seat - 0.09)], 12)
    x, y = 0.46 * w, 0.44 * d
    made = pieces("castors", wheels, PLASTIC) + pieces("star", base, scheme.handle)
    made += pieces("seat", cushion((-x + 0.03, x - 0.03), (-y, y - 0.1), (seat - 0.09, seat), 0.035), scheme.soft)
    back = cushion((-x + 0.05, x - 0.05), (y - 0.1, y - 0.03), (seat + 0.1, h), 0.03)
    made += pieces("back", back, scheme.soft)
    made += pieces("bracket", box((-0.03, 0.03), (y - 0.06, y - 0.02), (seat - 0.08, seat + 0.3), 0.005), PLASTIC)
    arms: list[Solid] = []
    for s in (-1, 1):
        px = s * (w / 2 - 0.03)
        arms += [box((px - 0.03, px + 0.03), (-0.25 * d, 0.22 * d), (seat + 0.19, seat + 0.22), 0.006)]
        arms += [box((px - 0.012, px + 0.012), (-0.05 * d, 0.05 * d), (seat - 0.08, seat + 0.19), 0.002)]
        arms += [box((min(px, s * 0.2 * w), max(px, s * 0.2 * w)), (-0.05 * d, 0.05 * d), (seat - 0.105, seat - 0.08), 0.002)]
    return Shape(made + pieces("arms", arms, PLASTIC))


def dressing_chair(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a round upholstered stool, with a low back where it is tall."""
    w, d, h = size
    seat = h if h < 0.56 else min(0.48, 0.6 * h)
    half = 0.36 * w
    base = pieces("legs", chair_legs(rng, (half, half * d / w), seat - 0.09, pick(rng, "round metal")), scheme.accent)
    pad = [
        s.scaled(np.array([1.0, d / w, 1.0]))
        for s in revolve([(0.47 * w, seat - 0.09), (0.5 * w, seat - 0.07), (0.5 * w, seat - 0.03), (0.45 * w, seat)], 24)
    ]
    base += pieces("seat", pad, scheme.soft)
    if h > seat + 0.1:
        back = cushion((-0.46 * w, 0.46 * w), (0.5 * d - 0.07, 0.5 * d), (seat - 0.03, h), 0.034)
        base += pieces("back", back, scheme.soft)
    return Shape(base)


def chinese_chair(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build the official's chair: round posts, stretchers near the floor, a splat, arms and a yoke."""
    w, d, h = size
    seat = min(0.5, 0.55 * h)
    x, y = 0.5 * w - 0.03, 0.5 * d - 0.03
    wood = scheme.body
    posts: list[Solid] = []
    arm = seat + 0.45 * (h - seat)
    for s in (-1, 1):
        posts += [rod((s * x, -y, 0), (s * x, -y, arm), 0.017, 0.015, 10), rod((s * x, y, 0), (s * x, y, h - 0.05), 0.017, 0.015, 10)]
        posts += [rod((s * x, -y - 0.03, arm), (s * x, y, arm + 0.02), 0.015, n=8), rod((s * x, -y, 0.1), (s * x, y, 0.1), 0.012, n=8)]
    posts += [rod((-x, sy, z), (x, sy, z), 0.012, n=8) for sy, z in ((-y, 0.07), (y, 0.12))]
    posts.append(rod((-x - 0.03, y, h - 0.04), (x + 0.03, y, h - 0.04), 0.02, n=10))
    base = pieces("posts", posts, wood)
    base += pieces("seat", box((-x - 0.03, x + 0.03), (-y - 0.03, y + 0.03), (seat - 0.04, seat), 0.006), wood)
    base += pieces("apron", [box((-x, x), (sy * y - 0.006, sy * y + 0.006), (seat - 0.1, seat - 0.04), 0.002) for sy in (-1, 1)], wood)
    base += pieces("splat", box((-0.09, 0.09), (y - 0.008, y + 0.008), (seat, h - 0.055), 0.003), wood)
    pad = cushion((-0.8 * x, 0.8 * x), (-0.8 * y, 0.8 * y), (seat + 0.0005, seat + 0.03), 0.013)
    return Shape(base + (pieces("pad", pad, scheme.soft) if rng.random() < 0.5 else ()))


def barstool(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a high seat on legs with a foot ring, or on a column."""
    w, d, h = size
    seat = h if h < 0.85 else 0.72 * h
    made: tuple[Piece, ...]
    if form == "pedestal":
        column = revolve([(0.46 * w, 0.0), (0.46 * w, 0.012), (0.03, 0.035), (0.025, seat - 0.07)], 20)
        rest = [s.moved((0, 0, 0)) for s in _foot_ring(0.3 * w, 0.32 * seat)]
        made = pieces("column", column, scheme.handle) + pieces("foot_rest", rest, scheme.handle)
    else:
        kind = pick(rng, "square round metal")
        half = (0.45 * w, 0.45 * d)
        made = pieces("legs", chair_legs(rng, half, seat - 0.06, kind), scheme.accent)
        z = 0.3 * seat
        made += pieces(
            "foot_rest",
            [rod((-half[0], sy * half[1] * 0.97, z), (half[0], sy * half[1] * 0.97, z), 0.01, n=8) for sy in (-1, 1)],
            scheme.handle,
        )
    made += pieces("seat", cushion((-0.5 * w, 0.5 * w), (-0.5 * d, 0.42 * d), (seat - 0.07, seat), 0.028), scheme.soft)
    if h > seat + 0.1:
        back = cushion((-0.45 * w, 0.45 * w), (0.5 * d - 0.05, 0.5 * d), (seat + 0.05, h), 0.022)
        struts = [
            box((s * 0.3 * w - 0.012, s * 0.3 * w + 0.012), (0.38 * d, 0.5 * d - 0.03), (seat - 0.06, seat + 0.12), 0.002) for s in (-1, 1)
        ]
        made += pieces("back", back, scheme.soft) + pieces("struts", struts, scheme.handle)
    return Shape(made)


def _foot_ring(radius: float, z: float) -> list[Solid]:
    points = circle(radius, 12)
    return [rod((*points[i], z), (*points[(i + 1) % 12], z), 0.009, n=6) for i in range(12)] + [rod((0, 0, z), (0, -radius, z), 0.009, n=6)]


def stool(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a bed-end bench, an ottoman or a stool on legs."""
    w, d, h = size
    if form == "ottoman":
        foot = pieces(
            "feet",
            [rod((s * 0.38 * w, t * 0.36 * d, 0), (s * 0.38 * w, t * 0.36 * d, 0.05), 0.02, 0.02, 10) for s in (-1, 1) for t in (-1, 1)],
            scheme.accent,
        )
        body = pieces("body", cushion((-0.5 * w, 0.5 * w), (-0.5 * d, 0.5 * d), (0.05, 0.68 * h), 0.02), scheme.soft)
        return Shape(foot + body + pieces("seat", cushion((-0.5 * w, 0.5 * w), (-0.5 * d, 0.5 * d), (0.68 * h, h), 0.045), scheme.soft))
    half = (0.5 * w - 0.05, 0.5 * d - 0.05)
    legs = chair_legs(rng, half, h - 0.11, pick(rng, "square round metal"))
    thick = 0.11 if form == "bench" else 0.08
    base = pieces("legs", legs, scheme.accent)
    base += pieces("frame", box((-0.47 * w, 0.47 * w), (-0.45 * d, 0.45 * d), (h - thick - 0.03, h - thick), 0.003), scheme.body)
    count = max(1, round(w / 0.6)) if form == "bench" else 1
    xs = np.linspace(-0.5 * w, 0.5 * w, count + 1)
    pads = [cushion((a + 0.001, b - 0.001), (-0.5 * d, 0.5 * d), (h - thick, h), 0.035) for a, b in itertools.pairwise(xs)]
    return Shape(base + pieces("seat", pads, scheme.soft))
