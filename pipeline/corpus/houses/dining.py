"""Dining: a table with chairs that face it square on, and a lamp above it."""

from __future__ import annotations

import math

import numpy as np

from pipeline.corpus.houses.arranger import Arranger
from pipeline.corpus.houses.records import Model
from pipeline.corpus.houses.space import Spot, box_of, shifted

# Chairs at a table: number -> share. Counts of living rooms give 3.7 chairs a table.
CHAIRS = {2: 0.10, 4: 0.55, 6: 0.31, 8: 0.04}
BEHIND = 0.3
"""Free floor behind a chair [m]."""


def furnish_dining(arranger: Arranger) -> None:
    """Furnish a dining room: the table group, then cabinets along the walls."""
    furnish_dining_corner(arranger, chance=1.0)
    for category, share in (("sideboard", 0.6), ("wine_cabinet", 0.35), ("cabinet", 0.2), ("shelf", 0.1), ("bookshelf", 0.12)):
        if arranger.chance(share):
            arranger.at_wall(category)
    for category, share in (("plant", 0.15), ("lounge_chair", 0.08), ("stool", 0.08), ("barstool", 0.1)):
        if arranger.chance(share):
            arranger.in_corner(category)


def furnish_dining_corner(arranger: Arranger, chance: float) -> None:
    """Put a table with chairs where there is room for them; fewer chairs and a smaller table if there is not."""
    rng = arranger.rng
    if not arranger.chance(chance):
        return
    count = int(rng.choice(list(CHAIRS), p=list(CHAIRS.values())))
    category = "chinese_chair" if arranger.chance(0.005) else "dining_chair"
    while count >= 2:
        for _ in range(2):
            chair = arranger.pick(category, width=0.66)
            if chair is None:
                return
            table = _table(arranger, count, chair)
            if table is not None and _place(arranger, table, chair, count):
                return
        count -= 2


def _table(arranger: Arranger, count: int, chair: Model) -> Model | None:
    """Draw a table long enough for half of the chairs on each long side (with six and more, two may sit at the ends)."""
    along = {2: 1, 4: 2, 6: 2 if arranger.chance(0.4) else 3, 8: 3}[count]
    need = along * (chair.size[0] + 0.04)
    most = {2: 1.5, 4: 1.9, 6: 2.5, 8: 3.2}[count]
    for category in ("dining_table",):
        model = arranger.stock.pick(arranger.rng, category, arranger.style, width=max(most, need + 0.3), narrowest=need)
        if model is not None:
            return model
    return None


def seats_at(table: Model, chair: Model, count: int, gap: float) -> list[tuple[float, float, float]]:
    """Return (across, ahead, turn) of each chair in the table's frame: long sides first, the ends where a side is full."""
    w, d, _ = table.size
    fit = max(1, int((w + 0.02) / (chair.size[0] + 0.03)))
    along = min(fit, count // 2)
    ends = count - 2 * along
    xs = [(k + 0.5) / along * w - w / 2 for k in range(along)] if along > 1 else [0.0]
    if along == 2:
        half = max(w / 4, chair.size[0] / 2 + 0.02)
        xs = [-half, half]
    off = d / 2 + chair.size[1] / 2 + gap
    placed = [(x, sign * off, math.pi if sign > 0 else 0.0) for x in xs for sign in (1, -1)]
    side = w / 2 + chair.size[1] / 2 + gap
    return placed + [(sign * side, 0.0, sign * -math.pi / 2) for sign in (1, -1)][: max(0, ends)]


def _place(arranger: Arranger, table: Model, chair: Model, count: int) -> bool:
    """Try places all over the room, square to the walls, and take the one with the most air; then hang the lamp."""
    space, rng = arranger.space, arranger.rng
    gap = float(rng.uniform(0.01, 0.09))
    chairs = seats_at(table, chair, count, gap)
    ends = any(abs(c[1]) < 1e-9 for c in chairs)
    width = table.size[0] + 2 * (chair.size[1] + gap if ends else 0.03)
    depth = table.size[1] + 2 * (chair.size[1] + gap)
    x0, y0, x1, y1 = space.bounds
    best: tuple[float, Spot] | None = None
    for _ in range(45):
        yaw = float(rng.choice([0.0, math.pi / 2]))
        half = (width / 2 + 0.08, depth / 2 + 0.08) if yaw == 0.0 else (depth / 2 + 0.08, width / 2 + 0.08)
        spare = (x1 - x0 - 2 * half[0], y1 - y0 - 2 * half[1])
        if min(spare) <= 0:
            continue
        spot = Spot(x0 + half[0] + spare[0] * float(rng.random()), y0 + half[1] + spare[1] * float(rng.random()), yaw)
        box = box_of(spot.x, spot.y, yaw, width, depth)
        if not space.fits(box, 0.0, 0.75) or not space.clear(box, 0.08):
            continue
        air = sum(space.clear(box, BEHIND * k / 2) for k in (1, 2, 3)) + float(rng.random())
        if best is None or air > best[0]:
            best = air, spot
    if best is None:
        return False
    spot = best[1]
    space.add(table, spot)
    for across, forward, turn in chairs:
        # Turned away from the table's front by `turn`: the chair looks back at the table.
        sway = float(np.clip(rng.normal(0, 0.012), -0.02, 0.02))
        seat = shifted(spot, across + (sway if abs(forward) > 1e-9 else 0.0), forward, turn)
        left_open = arranger.chance(0.09)  # pulled out and turned, as somebody left it
        if left_open and space.try_add(chair, shifted(seat, 0.0, -0.22, float(rng.normal(0, 0.5)))):
            continue
        space.try_add(chair, seat)
    if arranger.chance(0.86):
        arranger.lamp("pendant_lamp", spot.x + float(rng.normal(0, 0.03)), spot.y + float(rng.normal(0, 0.03)), spot.yaw)
    return True
