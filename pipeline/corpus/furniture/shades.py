"""Lamp shades: drums, cones, domes, bells, pleats, globes, paper balls, lanterns, cages, cane. Lengths in metres."""

from __future__ import annotations

import itertools
import math

import numpy as np

from pipeline.corpus.furniture.bent import band, curve, tube, turns
from pipeline.corpus.furniture.finishes import GLOW, Finish, Scheme, cane, one_of
from pipeline.corpus.furniture.finishes import shade as tinted
from pipeline.corpus.furniture.shape import Pieces, pieces
from pipeline.corpus.furniture.solids import Interval, Solid, Spot, around, box, circle, revolve, ring, rod, slab

CLOTH = Finish("shade_cloth", (0.80, 0.75, 0.65), 0.9, density=150)
WALL = 0.006


def shade_word(rng: np.random.Generator, scheme: Scheme, without: str) -> str:
    """Draw a form of shade that the style likes."""
    words = [word for word in scheme.manner.shades.split() if word not in without.split()] or ["drum"]
    return one_of(rng, words)


def cord(at: Spot, z: Interval) -> list[Solid]:
    """Return a cord from z[0] up to z[1]."""
    return [rod((*at, z[0]), (*at, z[1]), 0.0035, n=6)]


def rose(h: float, radius: float = 0.055) -> list[Solid]:
    """Return the canopy at the ceiling, at height `h`."""
    return revolve([(radius, h - 0.024), (radius, h - 0.006), (0.9 * radius, h)], 20)


def bulb(z: float, tall: float, at: Spot) -> Pieces:
    """Return a bulb that stands on `z`."""
    return pieces(
        "bulb",
        revolve([(0.2 * tall, z), (0.42 * tall, z + 0.45 * tall), (0.34 * tall, z + 0.75 * tall), (0.1 * tall, z + tall)], 10, at),
        GLOW,
    )


def shade(rng: np.random.Generator, scheme: Scheme, kind: str, radius: float, z: Interval, at: Spot = (0.0, 0.0), n: int = 24) -> Pieces:
    """Return a shade of `radius` over heights `z`: hollow with a bulb and spokes in it, or a lit globe."""
    low, high = z
    tall = high - low
    if kind in ("globe", "paper"):
        return _ball(scheme, kind, radius, z, at, n)
    if kind == "lantern":
        return _lantern(scheme, radius, z, at)
    if kind == "cage":
        return _cage(scheme, radius, z, at)
    metal = scheme.handle
    profiles = {
        "drum": ((1.0, 0.0), (0.9, 1.0)),
        "cone": ((1.0, 0.0), (0.26, 0.92), (0.2, 1.0)),
        "cylinder": ((1.0, 0.0), (1.0, 1.0)),
        "bell": ((1.0, 0.0), (0.82, 0.2), (0.66, 0.55), (0.5, 1.0)),
        "pleated": ((1.0, 0.0), (0.62, 1.0)),
        "mushroom": ((1.0, 0.0), (0.99, 0.2), (0.85, 0.6), (0.5, 0.9), (0.16, 1.0)),
        "rattan": ((0.72, 0.0), (1.0, 0.34), (0.9, 0.66), (0.42, 1.0)),
        "crystal": ((0.7, 0.0), (1.0, 1.0)),
        "dome": tuple((math.cos(a), math.sin(a) / math.sin(1.25)) for a in np.linspace(0.0, 1.25, 5)),
    }
    profile = [(r * radius, low + q * tall) for r, q in profiles[kind]]
    cover = {
        "rattan": cane(rng),
        "cone": scheme.front,
        "dome": metal if rng.random() < 0.6 else scheme.front,
        "mushroom": scheme.front,
        "crystal": GLOW,
    }.get(kind, CLOTH)
    if cover is CLOTH and rng.random() < 0.3:
        cover = Finish("shade_linen", tinted(rng, (0.62, 0.52, 0.38)), 0.9, pattern="weave", density=150)
    parts = pieces("shade", _walls(kind, profile, at, n), cover)
    return parts + _fittings(radius, profile[-1][0], z, at, metal)


def _ball(scheme: Scheme, kind: str, radius: float, z: Interval, at: Spot, n: int) -> Pieces:
    """Build a lit globe with its cap, or a squat ball of paper on a neck."""
    low, high = z
    tall = high - low
    squat = 1.0 if kind == "globe" else 0.92
    steps = [
        (radius * math.cos(a), low + tall / 2 + tall / 2 * math.sin(a) / math.sin(1.45))
        for a in np.linspace(-1.45, 1.45, 11 if n > 16 else 8)
    ]
    parts = pieces("globe", revolve([(r, q * squat + low * (1 - squat)) if kind == "paper" else (r, q) for r, q in steps], n, at), GLOW)
    if kind == "globe":
        return (
            parts + pieces("cap", revolve([(0.3 * radius, high - 0.02 * tall), (0.24 * radius, high)], 12, at), scheme.handle)
            if tall > 0.08 and n > 16
            else parts
        )
    return parts + pieces("neck", revolve([(0.12 * radius, low + squat * tall), (0.12 * radius, high)], 10, at), scheme.timber)


def _walls(kind: str, profile: list[Spot], at: Spot, n: int) -> list[Solid]:
    """Build the wall of an open shade around a profile of (radius, height): rings of n sides, or pleats."""
    walls: list[Solid] = []
    for (r0, z0), (r1, z1) in itertools.pairwise(profile):
        if kind == "pleated":
            path = np.array(
                [
                    (at[0] + (r1 + 0.5 * (r0 - r1)) * s * math.cos(a), at[1] + (r1 + 0.5 * (r0 - r1)) * s * math.sin(a))
                    for a, s in zip(turns(36), itertools.cycle((1.0, 0.965)), strict=False)
                ]
            )
            for stave in band(path, 0.005, (z0, z1), closed=True):
                v = stave.vertices - np.array([*at, 0.0])
                grow = np.where(np.arange(8) < 4, r0, r1)[:, None] / (0.5 * (r0 + r1))
                walls.append(Solid(v * np.concatenate([grow, grow, np.ones((8, 1))], axis=1) + np.array([*at, 0.0]), stave.faces))
        else:
            walls += ring((r0, r1), (max(r0 - WALL, 0.3 * r0), max(r1 - WALL, 0.3 * r1)), (z0, z1), n, at)
    return walls


def _fittings(radius: float, top: float, z: Interval, at: Spot, metal: Finish) -> Pieces:
    """Build the spokes that carry an open shade whose upper rim has radius `top`, its socket and its bulb, where there is room for them."""
    low, high = z
    tall = high - low
    parts: Pieces = ()
    if top > 0.05:  # spokes carry an open shade
        inner = top - 0.5 * WALL
        zt = high - 0.03 * tall - 0.004
        parts += pieces(
            "spider",
            [
                rod((at[0] - s * inner * math.cos(a), at[1] - s * inner * math.sin(a), zt), (at[0], at[1], zt), 0.0025, n=5)
                for a in (0.3,)
                for s in (-1, 1)
            ],
            metal,
        )
    if tall > 0.1:
        parts += (
            pieces("socket", revolve([(0.014, high - 0.45 * tall), (0.014, high - 0.02 * tall)], 8, at), metal)
            + bulb(high - 0.45 * tall - 0.07, 0.07, at)
            if radius > 0.06 and tall > 0.16
            else ()
        )
    return parts


def _lantern(scheme: Scheme, radius: float, z: Interval, at: Spot) -> Pieces:
    """Four paper panes in a frame of thin wood with a cap and a foot."""
    low, high = z
    r = radius / math.sqrt(2) * 1.35
    r = min(r, radius)
    t = 0.016
    wood = scheme.timber
    x, y = at
    posts = [
        box(around(t / 2, x + a * (r - t / 2)), around(t / 2, y + b * (r - t / 2)), (low + 0.012, high - 0.03), 0.002)
        for a in (-1, 1)
        for b in (-1, 1)
    ]
    inner = r - t
    panes = [box(around(0.002, x + s * (r - 0.7 * t)), around(inner, y), (low + 0.012, high - 0.03)) for s in (-1, 1)]
    panes += [box(around(inner, x), around(0.002, y + s * (r - 0.7 * t)), (low + 0.012, high - 0.03)) for s in (-1, 1)]
    bars = [
        box(around(0.003, x + s * (r - 0.3 * t)), around(inner, y), (q, q + 0.006))
        for s in (-1, 1)
        for q in np.linspace(low, high, 5)[1:-1]
    ]
    bars += [
        box(around(inner, x), around(0.003, y + s * (r - 0.3 * t)), (q, q + 0.006))
        for s in (-1, 1)
        for q in np.linspace(low, high, 5)[1:-1]
    ]
    caps = [
        box(around(radius, x), around(radius, y), (high - 0.03, high - 0.015), 0.003),
        box(around(0.6 * radius, x), around(0.6 * radius, y), (high - 0.015, high), 0.003),
    ]
    caps.append(box(around(r, x), around(r, y), (low, low + 0.012), 0.002))
    return pieces("frame", posts + bars + caps, wood) + pieces("panes", panes, GLOW)


def _cage(scheme: Scheme, radius: float, z: Interval, at: Spot) -> Pieces:
    """Bent wires around a bare bulb, hoops that hold them, a cap with the socket."""
    low, high = z
    tall = high - low
    metal = scheme.handle
    shape = [(0.34, 0.0), (0.8, 0.14), (1.0, 0.42), (0.8, 0.7), (0.3, 0.9)]
    parts: Pieces = ()
    for a in turns(8):
        c, s = math.cos(a), math.sin(a)
        path = curve([(at[0] + (r * radius - 0.004) * c, at[1] + (r * radius - 0.004) * s, low + q * tall) for r, q in shape], 1)
        parts += pieces("wires", tube(path, 0.0035, 5), metal)
    hoop = [(at[0] + (0.34 * radius + 0.002) * math.cos(a), at[1] + (0.34 * radius + 0.002) * math.sin(a)) for a in turns(12)]
    parts += pieces("hoop", tube([(p[0], p[1], low + 0.004) for p in hoop], 0.004, 5, closed=True), metal)
    cap = revolve([(0.36 * radius, high - 0.12 * tall), (0.36 * radius, high - 0.05 * tall), (0.1 * radius, high)], 14, at)
    parts += pieces("cap", cap, metal) + pieces("foot", slab(circle(0.3 * radius, 10, at), (low + 0.002, low + 0.004)), metal)
    return parts + bulb(high - 0.12 * tall - 0.5 * tall, 0.5 * tall, at)
