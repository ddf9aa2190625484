"""Beds: double, single, children's and bunk beds, with mattress, pillows and cover. The head is at the back (+Y)."""

from __future__ import annotations

import itertools

import numpy as np

from pipeline.corpus.furniture.finishes import BEDDING, MATTRESS, Scheme
from pipeline.corpus.furniture.shape import Piece, Shape, pieces
from pipeline.corpus.furniture.solids import Solid, box, cushion, rod
from pipeline.corpus.furniture.storage import Size, pick

Span = tuple[float, float]


def bed(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a bed with a panel, padded, slatted or tufted headboard."""
    w, d, h = size
    x, y = (-w / 2, w / 2), (-d / 2, d / 2)
    lift = float(rng.uniform(0.1, 0.16))
    frame_top = lift + float(rng.uniform(0.14, 0.2))
    top = min(frame_top + 0.18, 0.55 * h + 0.06)
    head = 0.1 if form in ("upholstered", "tufted") else 0.05
    soft = form in ("upholstered", "tufted")
    side = min(0.04 + 0.05 * soft, 0.03 * w + 0.02)
    base = pieces("headboard", _headboard(form, x, (y[1] - head, y[1]), lift, h), scheme.soft if soft else scheme.body)
    frame: list[Solid]
    rail_y = (y[0], y[1] - head)
    if soft:
        frame = [cushion(x, rail_y, (lift, frame_top), 0.03)]
    else:
        frame = [
            box((x[0], x[0] + side), rail_y, (lift, frame_top), 0.004),
            box((x[1] - side, x[1]), rail_y, (lift, frame_top), 0.004),
            box((x[0] + side, x[1] - side), (y[0], y[0] + side), (lift, frame_top), 0.004),
            box((x[0] + side, x[1] - side), (y[0] + side, y[1] - head), (frame_top - 0.06, frame_top - 0.03)),
        ]
    base += pieces("frame", frame, scheme.soft if soft else scheme.body)
    corners = [(px, py) for px in (x[0] + 0.07, x[1] - 0.07) for py in (y[0] + 0.08, y[1] - head - 0.06)]
    feet = [rod((px, py, 0), (px, py, lift), 0.02, 0.028, 10) for px, py in corners]
    base += pieces("feet", feet, scheme.accent)
    inner_x, inner_y = (x[0] + side, x[1] - side), (y[0] + side, y[1] - head)
    low = frame_top - 0.03 if not soft else frame_top
    return Shape(base + bedding(rng, inner_x, inner_y, low, top, scheme))


def bedding(rng: np.random.Generator, x: Span, y: Span, low: float, top: float, scheme: Scheme) -> tuple[Piece, ...]:
    """Return a mattress from `low` to `top` [m], a duvet over it, pillows at the head, and often a throw at the foot."""
    made = pieces("mattress", cushion((x[0] + 0.01, x[1] - 0.01), (y[0] + 0.01, y[1] - 0.005), (low, top), 0.05, 2), MATTRESS)
    fold = y[1] - 0.62
    duvet = cushion((x[0] - 0.005, x[1] + 0.005), (y[0] + 0.003, fold), (top - 0.09, top + 0.045), 0.045, 3)
    made += pieces("duvet", duvet, BEDDING if rng.random() < 0.5 else scheme.second)
    made += pieces(
        "duvet_fold", cushion((x[0] - 0.003, x[1] + 0.003), (fold - 0.2, fold + 0.02), (top + 0.02, top + 0.065), 0.022), BEDDING
    )
    count = 2 if x[1] - x[0] > 1.25 else 1
    xs = np.linspace(x[0] + 0.03, x[1] - 0.03, count + 1)
    pillows = []
    for a, b in itertools.pairwise(xs):
        middle, half = (a + b) / 2, min(0.36, 0.48 * (b - a))
        pad = cushion((middle - half, middle + half), (y[1] - 0.47, y[1] - 0.07), (top + 0.005, top + 0.135), 0.06, 3)
        pillows.append(pad.turned("x", 0.16, (0, y[1] - 0.47, top)))
    made += pieces("pillows", pillows, BEDDING)
    if rng.random() < 0.6:
        foot = y[0] + 0.22 * (y[1] - y[0])
        throw = cushion((x[0] - 0.012, x[1] + 0.012), (foot, foot + 0.45), (top - 0.12, top + 0.055), 0.03)
        made += pieces("throw", throw, scheme.soft if scheme.soft.name != scheme.second.name else scheme.second)
    return made


def _headboard(form: str, x: Span, y: Span, lift: float, h: float) -> list[Solid]:
    """Return a headboard over `x`, `y` up to `h` [m]."""
    w = x[1] - x[0]
    if form == "upholstered":
        count = max(2, round(w / 0.45))
        xs = np.linspace(x[0], x[1], count + 1)
        return [box(x, (y[0] + 0.05, y[1]), (lift, h - 0.01), 0.006)] + [
            cushion((a + 0.001, b - 0.001), (y[0], y[0] + 0.06), (lift + 0.12, h), 0.028) for a, b in itertools.pairwise(xs)
        ]
    if form == "tufted":
        rows, columns = 3, max(3, round(w / 0.35))
        xs, zs = np.linspace(x[0] + 0.05, x[1] - 0.05, columns + 1), np.linspace(lift + 0.2, h - 0.05, rows + 1)
        frame = [cushion(x, (y[0] + 0.045, y[1]), (lift, h), 0.025)]
        pads = [
            cushion((a, b), (y[0], y[0] + 0.06), (c, e), 0.028, 1) for a, b in itertools.pairwise(xs) for c, e in itertools.pairwise(zs)
        ]
        return frame + pads
    posts = [box((px, px + 0.05), y, (0, h), 0.006) for px in (x[0], x[1] - 0.05)]
    inner = (x[0] + 0.05, x[1] - 0.05)
    if form == "slatted":
        count = max(5, round(w / 0.12))
        xs = np.linspace(inner[0] + 0.05, inner[1] - 0.05, count)
        rails = [box(inner, (y[0] + 0.008, y[1] - 0.008), z, 0.004) for z in ((lift + 0.12, lift + 0.2), (h - 0.09, h - 0.01))]
        return posts + rails + [box((a - 0.014, a + 0.014), (y[0] + 0.015, y[1] - 0.015), (lift + 0.2, h - 0.09), 0.002) for a in xs]
    return [
        *posts,
        box(inner, (y[0] + 0.012, y[1] - 0.008), (lift, h - 0.02), 0.006),
        box((x[0] - 0.0, x[1]), y, (h - 0.001, h + 0.02), 0.006),
    ]


def kids_bed(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a bed with rails all around, a bunk bed with a ladder, or a bed in a house's frame. The sleeper lies along x where it is wide."""
    w, d, h = size
    if form == "bunk":
        return _bunk(rng, size, scheme)
    if form == "house":
        return _house(rng, size, scheme)
    lift = 0.12
    t = 0.04
    x, y = (-w / 2, w / 2), (-d / 2, d / 2)
    low = min(0.38, 0.42 * h)
    posts = [box((px, px + t), (py, py + t), (0, h if py > 0 else 0.75 * h), 0.006) for px in (x[0], x[1] - t) for py in (y[0], y[1] - t)]
    rails = [
        box((x[0] + t, x[1] - t), (y[1] - t, y[1]), (lift, h - 0.03), 0.004),
        box((x[0] + t, x[1] - t), (y[0], y[0] + 0.03), (lift, low), 0.004),
        *(box((px, px + 0.03), (y[0] + t, y[1] - t), (lift, low), 0.004) for px in (x[0] + 0.005, x[1] - 0.035)),
        *(box((px, px + 0.03), (y[0] + t, y[1] - t), (low + 0.1, low + 0.16), 0.004) for px in (x[0] + 0.005, x[1] - 0.035)),
        box((x[0] + t, x[1] - t), (y[0] + 0.03, y[1] - t), (lift + 0.08, lift + 0.1)),
    ]
    base = pieces("frame", posts + rails, scheme.front)
    return Shape(base + bedding(rng, (x[0] + t, x[1] - t), (y[0] + t, y[1] - t), lift + 0.1, low + 0.06, scheme))


def _bunk(rng: np.random.Generator, size: Size, scheme: Scheme) -> Shape:
    """Two berths over each other and a ladder at the front."""
    w, d, h = size
    t = 0.06
    deep = d - 0.06
    x, y = (-w / 2, w / 2), (-d / 2 + 0.06, d / 2)
    posts = [box((px, px + t), (py, py + t), (0, h), 0.006) for px in (x[0], x[1] - t) for py in (y[0], y[1] - t)]
    base = pieces("posts", posts, scheme.front)
    levels = (0.22, 0.22 + 0.52 * h)
    inner_x, inner_y = (x[0] + t, x[1] - t), (y[0] + 0.03, y[1] - 0.03)
    for k, z in enumerate(levels):
        boards = [
            *(box(inner_x, (py, py + 0.03), (z, z + 0.14), 0.003) for py in (y[0], y[1] - 0.03)),
            *(box((px, px + 0.03), (y[0] + t, y[1] - t), (z, z + 0.14), 0.003) for px in (x[0] + 0.01, x[1] - 0.04)),
            box(inner_x, inner_y, (z + 0.02, z + 0.04)),
        ]
        guard = z + 0.14 + 0.62 * (h - levels[1] - 0.14)
        boards += [box((px, px + 0.03), (y[0] + t, y[1] - t), (guard, guard + 0.06), 0.003) for px in (x[0] + 0.01, x[1] - 0.04)]
        if k:
            boards += [box(inner_x, (y[1] - 0.03, y[1]), (guard, guard + 0.06), 0.003)]
            boards += [box((x[0] + t, x[1] - 0.62), (y[0], y[0] + 0.03), (guard, guard + 0.06), 0.003)]
        base += pieces(f"berth_{k}", boards, scheme.front)
        if deep > 0.5:
            base += tuple(
                Piece(f"{p.name}_{k}", p.solid, p.finish)
                for p in bedding(rng, inner_x, inner_y, z + 0.04, z + 0.19, scheme)
                if p.name != "throw"
            )
    ladder: list[Solid] = []
    lx = (x[1] - 0.56, x[1] - 0.12)
    ladder += [box((px - 0.02, px + 0.02), (-d / 2, -d / 2 + 0.05), (0, min(h, levels[1] + 0.5)), 0.004) for px in lx]
    ladder += [
        box((lx[0] + 0.02, lx[1] - 0.02), (-d / 2 + 0.008, -d / 2 + 0.045), (z, z + 0.03), 0.003) for z in np.arange(0.25, levels[1], 0.27)
    ]
    return Shape(base + pieces("ladder", ladder, scheme.accent))


def _house(rng: np.random.Generator, size: Size, scheme: Scheme) -> Shape:
    """Build a low bed inside a frame with a pitched roof."""
    w, d, h = size
    t = 0.05
    x, y = (-w / 2, w / 2), (-d / 2, d / 2)
    eaves = 0.72 * h
    solids = [box((px, px + t), (py, py + t), (0, eaves), 0.005) for px in (x[0], x[1] - t) for py in (y[0], y[1] - t)]
    for py in (y[0] + t / 2, y[1] - t / 2):
        solids += [rod((px, py, eaves - 0.01), (0, py, h - 0.02), 0.024, n=8) for px in (x[0] + t / 2, x[1] - t / 2)]
    solids.append(box((-t / 2, t / 2), y, (h - t, h), 0.004))
    solids += [box((px, px + t), (y[0] + t, y[1] - t), (eaves - t, eaves), 0.004) for px in (x[0], x[1] - t)]
    rails = [box((px, px + 0.03), (y[0] + t, y[1] - t), (0.1, 0.36), 0.004) for px in (x[0] + 0.01, x[1] - 0.04)]
    rails += [box((x[0] + t, x[1] - t), (py, py + 0.03), (0.1, 0.36), 0.004) for py in (y[0] + 0.01, y[1] - 0.04)]
    rails.append(box((x[0] + t, x[1] - t), (y[0] + t, y[1] - t), (0.14, 0.16)))
    base = pieces("house", solids, scheme.front) + pieces("rails", rails, scheme.front if pick(rng, "a b") == "a" else scheme.body)
    return Shape(base + bedding(rng, (x[0] + t, x[1] - t), (y[0] + t, y[1] - t), 0.16, 0.36, scheme))
