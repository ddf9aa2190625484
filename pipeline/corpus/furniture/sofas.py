"""Sofas, armchairs, chaises and bean bags."""

# ruff: noqa: ARG001 - all builders share one signature, whatever of it they need

from __future__ import annotations

import itertools

import numpy as np

from pipeline.corpus.furniture.finishes import Scheme
from pipeline.corpus.furniture.shape import Piece, Shape, pieces
from pipeline.corpus.furniture.solids import Solid, box, cushion, revolve, rod
from pipeline.corpus.furniture.storage import Size, pick


def sofa(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a frame on feet, arms, seat and back cushions, one per seat, and throw pillows."""
    w, d, h = size
    seats = max(1, round((w - 0.4) / 0.72))
    seat = float(rng.uniform(0.40, 0.45)) * min(1.0, h / 0.78)
    arm = {"track": 0.13, "legs": 0.09, "roll": 0.19, "tub": 0.12}[form] * min(1.0, w / 0.8)
    lift = {"track": 0.05, "legs": 0.15, "roll": 0.09, "tub": 0.12}[form]
    deep = min(0.2, 0.22 * d)
    base = _feet((-w / 2, w / 2), (-d / 2, d / 2), lift, form, scheme)
    base += pieces("frame", cushion((-w / 2 + 0.01, w / 2 - 0.01), (-d / 2 + 0.02, d / 2 - 0.005), (lift, seat - 0.13), 0.02), scheme.soft)
    base += _arms(form, w, d, lift, seat, arm, h, scheme)
    base += pieces(
        "back", cushion((-w / 2 + 0.5 * arm, w / 2 - 0.5 * arm), (d / 2 - 0.6 * deep, d / 2), (lift + 0.01, h - 0.05), 0.045), scheme.soft
    )
    base += _cushions((-w / 2 + arm, w / 2 - arm), (-d / 2, d / 2 - 0.6 * deep), seat, h, seats, deep, scheme)
    if w > 1.2:
        base += _pillows(rng, w / 2 - arm, d / 2 - 1.5 * deep, seat, scheme)
    return Shape(base)


def _feet(x: tuple[float, float], y: tuple[float, float], lift: float, form: str, scheme: Scheme) -> tuple[Piece, ...]:
    made: list[Solid] = []
    for px in (x[0] + 0.08, x[1] - 0.08):
        for py in (y[0] + 0.08, y[1] - 0.08):
            if form == "legs":
                made.append(rod((px, py, 0), (px, py, lift + 0.03), 0.014, 0.022, 10))
            else:
                made.append(box((px - 0.03, px + 0.03), (py - 0.03, py + 0.03), (0, lift + 0.005), 0.004))
    return pieces("feet", made, scheme.accent)


def _arms(form: str, w: float, d: float, lift: float, seat: float, arm: float, h: float, scheme: Scheme) -> tuple[Piece, ...]:
    """Return both arms: square, slim, or rolled; a tub's arms run as high as its back."""
    made: list[Solid] = []
    top = min(h - 0.03 if form == "tub" else seat + 0.2, h - 0.02)
    for s in (-1, 1):
        x = (w / 2 - arm, w / 2) if s > 0 else (-w / 2, -w / 2 + arm)
        if form == "roll":
            made.append(cushion((x[0] + 0.03 * (s > 0), x[1] - 0.03 * (s < 0)), (-d / 2 + 0.03, d / 2 - 0.03), (lift, top - 0.09), 0.03))
            made.append(rod(((x[0] + x[1]) / 2, -d / 2 + 0.015, top - 0.08), ((x[0] + x[1]) / 2, d / 2 - 0.04, top - 0.08), 0.085, n=14))
        else:
            made.append(cushion(x, (-d / 2 + 0.01, d / 2 - 0.01), (lift + 0.005, top), 0.035 if form != "legs" else 0.025))
    return pieces("arms", made, scheme.soft)


def _cushions(
    x: tuple[float, float], y: tuple[float, float], seat: float, h: float, seats: int, deep: float, scheme: Scheme
) -> tuple[Piece, ...]:
    xs = np.linspace(x[0] + 0.002, x[1] - 0.002, seats + 1)
    pads, backs = [], []
    for a, b in itertools.pairwise(xs):
        pads.append(cushion((a + 0.002, b - 0.002), (y[0], y[1] - 0.3 * deep), (seat - 0.13, seat + 0.02), 0.05, 3))
        tilted = cushion((a + 0.004, b - 0.004), (y[1] - 0.75 * deep, y[1] - 0.02), (seat + 0.02, h), 0.06, 3)
        backs.append(tilted.turned("x", -0.1, (0, y[1] - 0.3 * deep, seat + 0.1)))
    return pieces("seat_cushions", pads, scheme.soft) + pieces("back_cushions", backs, scheme.soft)


def _pillows(rng: np.random.Generator, x: float, y: float, seat: float, scheme: Scheme) -> tuple[Piece, ...]:
    made = []
    for s in ([-1, 1], [-1], [1])[int(rng.integers(3))]:
        px = s * (x - 0.25)
        pad = cushion((px - 0.21, px + 0.21), (y - 0.05, y + 0.08), (seat + 0.03, seat + 0.43), 0.06, 3)
        made.append(pad.turned("x", -0.25, (0, y, seat)).turned("z", -0.2 * s, (px, y, 0)))
    return pieces("pillows", made, scheme.second)


def l_shaped_sofa(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a sofa along the back and a chaise that reaches forward at one end (`form`: left or right, seen from the front)."""
    w, d, h = size
    main = min(0.98, 0.55 * d)
    style = pick(rng, "track legs")
    lift = 0.05 if style == "track" else 0.14
    seat, arm, deep = 0.43 * min(1.0, h / 0.78), 0.15, 0.2
    long = min(1.0, 0.36 * w)
    y0 = d / 2 - main  # front of the main part
    chaise_x = (-w / 2, -w / 2 + long)
    base = _feet((-w / 2, w / 2), (y0, d / 2), lift, style, scheme) + _feet(chaise_x, (-d / 2, y0), lift, style, scheme)
    base += pieces("frame", cushion((-w / 2 + 0.01, w / 2 - 0.01), (y0 + 0.02, d / 2), (lift, seat - 0.13), 0.02), scheme.soft)
    base += pieces(
        "frame_chaise", cushion((chaise_x[0] + 0.01, chaise_x[1]), (-d / 2 + 0.02, y0 + 0.05), (lift, seat - 0.13), 0.02), scheme.soft
    )
    base += pieces("back", cushion((-w / 2, w / 2), (d / 2 - 0.6 * deep, d / 2), (lift, h - 0.05), 0.045), scheme.soft)
    top = seat + 0.2
    base += pieces("arms", cushion((w / 2 - arm, w / 2), (y0 + 0.01, d / 2 - 0.02), (lift, top), 0.04), scheme.soft)
    base += pieces("arm_chaise", cushion((-w / 2, -w / 2 + arm), (y0 + 0.2, d / 2 - 0.02), (lift, top), 0.04), scheme.soft)
    seats = max(1, round((w - long - arm) / 0.75))
    base += _cushions((chaise_x[1], w / 2 - arm), (y0, d / 2 - 0.6 * deep), seat, h, seats, deep, scheme)
    pad = [cushion((-w / 2 + arm + 0.002, chaise_x[1] - 0.002), (y0 + 0.2, d / 2 - 0.9 * deep), (seat - 0.13, seat + 0.02), 0.05, 3)]
    pad.append(cushion((-w / 2 + 0.005, chaise_x[1] - 0.002), (-d / 2, y0 + 0.198), (seat - 0.13, seat + 0.02), 0.05, 3))
    back = cushion((-w / 2 + arm + 0.004, chaise_x[1] - 0.004), (d / 2 - 1.35 * deep, d / 2 - 0.7 * deep), (seat + 0.02, h), 0.06, 3)
    base += pieces("chaise_cushions", [*pad, back.turned("x", -0.1, (0, d / 2 - 0.9 * deep, seat + 0.1))], scheme.soft)
    base += _pillows(rng, w / 2 - arm, d / 2 - 1.5 * deep, seat, scheme)
    if form == "right":
        base = tuple(Piece(p.name, p.solid.mirrored(), p.finish, p.part) for p in base)
    return Shape(base)


def lazy_sofa(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a bean bag with a raised back."""
    w, d, h = size
    seat = min(0.4, 0.55 * h)
    bag = revolve([(0.40 * w, 0.0), (0.48 * w, 0.25 * seat), (0.5 * w, 0.5 * seat), (0.46 * w, 0.82 * seat), (0.36 * w, seat)], 24)
    made = pieces("bag", [s.scaled(np.array([1, d / w, 1])) for s in bag], scheme.soft)
    back = cushion((-0.42 * w, 0.42 * w), (0.16 * d, 0.46 * d), (0.35 * seat, h), 0.14 * w, 4)
    return Shape(made + pieces("back", back.turned("x", -0.12, (0, 0.4 * d, seat)), scheme.soft))


def chaise_longue(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a long seat with a raised back at its end and one arm."""
    w, d, h = size
    seat = 0.42
    base = _feet((-w / 2, w / 2), (-d / 2, d / 2), 0.14, "legs", scheme)
    base += pieces("frame", cushion((-w / 2 + 0.01, w / 2 - 0.01), (-d / 2 + 0.02, d / 2 - 0.02), (0.14, seat - 0.12), 0.02), scheme.soft)
    base += pieces("seat", cushion((-w / 2, w / 2), (-d / 2, d / 2 - 0.16), (seat - 0.12, seat + 0.02), 0.05, 3), scheme.soft)
    base += pieces("back", cushion((-w / 2, w / 2), (d / 2 - 0.2, d / 2), (0.16, h), 0.07, 3), scheme.soft)
    s = -1 if rng.random() < 0.5 else 1
    x = (w / 2 - 0.1, w / 2) if s > 0 else (-w / 2, -w / 2 + 0.1)
    base += pieces("arm", cushion(x, (0.0, d / 2 - 0.1), (seat + 0.021, seat + 0.22), 0.04), scheme.soft)
    roll = rod((-0.4 * w, d / 2 - 0.29, seat + 0.1), (0.4 * w, d / 2 - 0.29, seat + 0.1), 0.08, n=14)
    return Shape(base + pieces("bolster", roll, scheme.second))
