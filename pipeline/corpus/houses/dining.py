"""Dining: a table with chairs that face it square on, and a lamp above it."""

import math

import numpy as np

from pipeline.corpus.furniture.catalogue import Model
from pipeline.corpus.houses.arranger import Arranger
from pipeline.corpus.houses.rates import load
from pipeline.corpus.houses.room_occupancy import Spot, box_of, shift_spot

CHAIRS = {"two": 2, "four": 4, "six": 6, "eight": 8}
ACROSS = 0.6
"""Usual distance of a chair's middle from the table's long axis [m]: it reaches under a deep table."""
UNDER = 0.35
"""Most of a chair's depth that is under the table."""
OFF_LAMP = 0.1
"""Deviation of the lamp from the table's middle [m]."""
DEEPEST = {2: 0.95, 4: 1.0, 6: 1.15, 8: 1.5}
"""Depth of a table for so many, where there is one [m]."""
BEHIND = 0.3
"""Free floor behind a chair [m]."""
SQUARE = 1.25
"""Four sit around a table whose length is at most so many times its depth, one on each side."""
SQUARE_SHARE = 0.35
"""Share of the tables for four that are square, where there is one."""


def furnish_dining_corner(arranger: Arranger) -> None:
    """Put a table with chairs where there is room for them; fewer chairs and a smaller table if there is not."""
    rates = load()["dining"]
    count = CHAIRS[arranger.deal.choose("chairs", rates["chairs"])]
    category = "chinese_chair" if arranger.deal.mark("chinese") < rates["chinese"] else "dining_chair"
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
    """Draw a table long enough for half of the chairs on each long side (with six and more, two may sit at the ends; with four, one at each side of a square)."""
    if count == 4 and arranger.chance(SQUARE_SHARE):
        least, most = chair.size[0] + 0.25, chair.size[0] + 0.6
        square = arranger.stock.pick(arranger.rng, "dining_table", arranger.style, width=most, depth=most, narrowest=least)
        if square is not None and _is_square(square):
            return square
    along = {2: 1, 4: 2, 6: 2 if arranger.chance(0.4) else 3, 8: 3}[count]
    need = along * (chair.size[0] + 0.04)
    most = {2: 1.5, 4: 1.9, 6: 2.5, 8: 3.2}[count]
    for depth in (DEEPEST[count], math.inf):
        model = arranger.stock.pick(arranger.rng, "dining_table", arranger.style, width=max(most, need + 0.3), depth=depth, narrowest=need)
        if model is not None:
            return model
    return None


def seats_at(table: Model, chair: Model, count: int, gap: float) -> list[tuple[float, float, float]]:
    """Return (across, ahead, turn) of each chair in the table's frame: long sides first, the ends where a side is full or the table square."""
    w, d, _ = table.size
    fit = 1 if count == 4 and _is_square(table) else max(1, int((w + 0.02) / (chair.size[0] + 0.03)))
    along = min(fit, count // 2)
    ends = count - 2 * along
    xs = [(k + 0.5) / along * w - w / 2 for k in range(along)] if along > 1 else [0.0]
    if along == 2:
        half = max(w / 4, chair.size[0] / 2 + 0.02)
        xs = [-half, half]
    off = _off_table(d, chair, gap)
    side = w / 2 + chair.size[1] / 2 + min(gap, 0.05)
    if along == 1 and ends:  # as far under each side, as far as chairs at a corner leave each other room
        off, side = (max(_off_table(length, chair, gap), sum(chair.size[:2]) / 2 + 0.03) for length in (d, w))
    placed = [(x, sign * off, math.pi if sign > 0 else 0.0) for x in xs for sign in (1, -1)]
    return placed + [(sign * side, 0.0, sign * -math.pi / 2) for sign in (1, -1)][: max(0, ends)]


def _off_table(length: float, chair: Model, gap: float) -> float:
    """Return how far a chair's middle is from that of a table so long in its direction [m]."""
    return max(min(ACROSS, length / 2 + chair.size[1] / 2) + gap, length / 2 + chair.size[1] * (0.5 - UNDER))


def _is_square(table: Model) -> bool:
    return max(table.size[:2]) <= SQUARE * min(table.size[:2])


def _place(arranger: Arranger, table: Model, chair: Model, count: int) -> bool:
    """Try places all over the room, square to the walls, and take the one with the most air; then hang the lamp."""
    space, rng = arranger.space, arranger.rng
    gap = float(rng.uniform(-0.1, 0.05))
    chairs = seats_at(table, chair, count, gap)
    ends = any(abs(c[1]) < 1e-9 for c in chairs)
    width = 2 * max(abs(c[0]) for c in chairs) + (chair.size[1] if ends else chair.size[0])
    width, depth = max(width, table.size[0] + 0.06), 2 * max(abs(c[1]) for c in chairs) + chair.size[1]
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
    under = space.solids[-1][0]
    rates = load()["dining"]
    for across, forward, turn in chairs:
        # Turned away from the table's front by `turn`: the chair looks back at the table.
        sway = float(np.clip(rng.normal(0, 0.012), -0.02, 0.02))
        seat = shift_spot(spot, across + (sway if abs(forward) > 1e-9 else 0.0), forward, turn)
        left_open = arranger.chance(rates["turned_chair"])  # pulled out and turned, as somebody left it
        if left_open and space.try_add(chair, shift_spot(seat, 0.0, -0.25, float(rng.normal(0, 0.5))), under=under):
            continue
        if arranger.chance(rates["askew_chair"]):
            seat = shift_spot(seat, 0.0, -0.04, float(rng.choice([-1, 1]) * rng.uniform(0.05, 0.25)))
        space.try_add(chair, seat, under=under)
    if arranger.deal.mark("dining_lamp") < rates["lamp"]:
        arranger.lamp(
            "pendant_lamp",
            spot.x + float(np.clip(rng.normal(0, OFF_LAMP), -0.16, 0.16)),
            spot.y + float(rng.normal(0, OFF_LAMP / 3)),
            spot.yaw,
        )
    return True
