"""Bookcases and open shelves, with books on them."""

from dataclasses import replace

import numpy as np

from pipeline.corpus.furniture.casework import Cell, Column, case
from pipeline.corpus.furniture.finishes import LACQUERS, Finish, Scheme, one_of
from pipeline.corpus.furniture.intervals import around
from pipeline.corpus.furniture.shape import Piece, Pieces, Shape, pieces
from pipeline.corpus.furniture.solids import box
from pipeline.corpus.furniture.storage import case_style, doors_of, front_style


def bookshelf(rng: np.random.Generator, form: str, w: float, d: float, h: float, scheme: Scheme) -> Shape:
    """Open shelves, open shelves over doors, or glass doors."""
    style = front_style(rng, scheme, "slab shaker")
    how = replace(case_style(rng, scheme, style, "plinth plinth none square", (0.07, 0.1)), overhang=0.0)
    if form == "ladder":
        return ladder_shelf(w, d, h, scheme, max(4, round(h / 0.38)))
    count = max(1, min(4, round(w / 0.8)))
    rows = max(3, round(h / 0.36))
    if form == "open":
        columns = [Column(1, (Cell("open", 1, rows - 1),)) for _ in range(count)]
    elif form == "glass":
        glass = replace(style, panel="glass")
        door = doors_of(rng, w / count, 1.0, rows - 2)
        columns = [Column(1, (replace(door, panel=glass, share=3.0), Cell("drawer", 0.55))) for _ in range(count)]
    else:
        columns = [Column(1, (Cell("open", 1.9, rows - 3), doors_of(rng, w / count, 0.9, 1))) for _ in range(count)]
    shape = case((w, d, h), columns, how)
    return Shape(shape.base + (books(rng, shape) if form == "open" else ()), shape.movers)


BOOK_COLORS = ("terracotta", "navy", "sage", "ivory", "anthracite", "mustard", "dusty_blue")


def books(rng: np.random.Generator, shape: Shape) -> Pieces:
    """Return a few rows of books on the boards of open shelves."""
    parts: list[Piece] = []
    palette = [Finish(f"book_{n}", LACQUERS[n], 0.8, density=600) for n in BOOK_COLORS[:4]]
    boards = [p for p in shape.base if "_board_" in p.name or p.name == "bottom"]
    for board in boards:
        low, high = board.solid.bounds()
        if rng.random() < 0.45 or high[0] - low[0] < 0.2:
            continue
        x, y = low[0] + 0.01 + float(rng.uniform(0, 0.4)) * (high[0] - low[0]), low[1] + 0.02
        for _ in range(int(rng.integers(2, 6))):
            t, tall, deep = float(rng.uniform(0.02, 0.05)), float(rng.uniform(0.16, 0.24)), float(rng.uniform(0.12, 0.17))
            if x + t > high[0] - 0.01:
                break
            parts += pieces("books", box((x, x + t), (y, min(y + deep, high[1])), (high[2], high[2] + tall)), one_of(rng, palette))
            x += t + 0.0015
    return tuple(parts)


def ladder_shelf(w: float, d: float, h: float, scheme: Scheme, rows: int) -> Shape:
    """Boards in two side frames of square posts, open at the back."""
    t = 0.028
    posts = [box((x, x + t), (y, y + t), (0, h), 0.002) for x in (-w / 2, w / 2 - t) for y in (-d / 2, d / 2 - t)]
    rungs = [box((x + 0.004, x + t - 0.004), around(d / 2 - t), (z, z + 0.03)) for x in (-w / 2, w / 2 - t) for z in (0.08, h - 0.06)]
    base = pieces("frame", posts + rungs, scheme.accent)
    for k in range(rows):
        z = 0.12 + (h - 0.2) * k / (rows - 1)
        base += pieces(f"board_{k}", box(around(w / 2 - t), around(d / 2 - 0.002), (z, z + 0.02), 0.002), scheme.body)
    return Shape(base)


def shelf(rng: np.random.Generator, form: str, w: float, d: float, h: float, scheme: Scheme) -> Shape:
    """Build a ladder shelf, a frame with uprights, or stacked cubes."""
    if form == "cubes":
        style = front_style(rng, scheme)
        how = replace(case_style(rng, scheme, style, "none plinth", (0, 0)), overhang=0.0)
        rows = max(1, round(h / 0.36))
        count = max(1, round(w / 0.4))
        columns = [Column(1, (Cell("open"),) * rows)] * count
        shape = case((w, d, h), columns, how, reserve=0.0)
        return Shape(shape.base + books(rng, shape))
    return ladder_shelf(w, d, h, scheme, max(2, round(h / (0.3 if form == "frame" else 0.4))))
