"""Living and dining rooms: a sofa that looks at the TV, a coffee table between them, seats around it; a table with chairs that face it square on, and a lamp above it."""

import math
from dataclasses import dataclass

import numpy as np

from pipeline.corpus.furniture.catalogue import Model
from pipeline.corpus.houses.arranger import Arranger
from pipeline.corpus.houses.rates import load
from pipeline.corpus.houses.room_occupancy import Side, Space, Spot, ahead, back_gap, meets, on_side, shift_spot

ACROSS = 0.6  # usual distance of a chair's middle from the table's long axis [m]: it reaches under a deep table
UNDER = 0.35  # most of a chair's depth that is under the table
OFF_LAMP = 0.1  # deviation of the lamp from the table's middle [m]
DEEPEST = {2: 0.95, 4: 1.0, 6: 1.15, 8: 1.5}  # depth of a table for so many, where there is one [m]
BEHIND = 0.3  # free floor behind a chair [m]
SQUARE = 1.25  # four sit around a table whose length is at most so many times its depth, one on each side
SQUARE_SHARE = 0.35  # share of the tables for four that are square, where there is one


def furnish_dining_corner(arranger: Arranger) -> None:
    """Put a table with chairs where there is room for them; fewer chairs and a smaller table if there is not."""
    rates = load()["dining"]
    count = int(arranger.deal.choose("chairs", rates["chairs"]))
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
        square = arranger.stock.pick(arranger.rng, "dining_table", arranger.style, (most, most, math.inf), narrowest=least)
        if square is not None and _is_square(square):
            return square
    along = {2: 1, 4: 2, 6: 2 if arranger.chance(0.4) else 3, 8: 3}[count]
    need = along * (chair.size[0] + 0.04)
    most = {2: 1.5, 4: 1.9, 6: 2.5, 8: 3.2}[count]
    for depth in (DEEPEST[count], math.inf):
        limits = (max(most, need + 0.3), depth, math.inf)
        model = arranger.stock.pick(arranger.rng, "dining_table", arranger.style, limits, narrowest=need)
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
        box = spot.box(width, depth)
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
        dx, dy = float(np.clip(rng.normal(0, OFF_LAMP), -0.16, 0.16)), float(rng.normal(0, OFF_LAMP / 3))
        arranger.lamp("pendant_lamp", spot.x + dx, spot.y + dy, spot.yaw)
    return True


@dataclass(frozen=True, slots=True)
class Lounge:
    """The seating group: the sofa's model and spot, and the spot of the coffee table if there is one."""

    sofa: Model
    spot: Spot
    table: tuple[Model, Spot] | None


def furnish_living(arranger: Arranger, *, dining: bool) -> None:
    """Furnish a living room, with a dining corner if asked for."""
    lounge = place_lounge(arranger, aside=dining)
    if lounge is not None:
        seats(arranger, lounge)
    if dining and arranger.wants("dining"):
        furnish_dining_corner(arranger)
    for category in arranger.wishes("pieces"):
        arranger.at_wall(category)
    for category in arranger.wishes("extras"):
        arranger.in_corner(category)
    over = lounge.table[1] if lounge is not None and lounge.table is not None else None
    arranger.light([] if over is None else [(over.x, over.y)])


def place_lounge(arranger: Arranger, *, aside: bool) -> Lounge | None:
    """Choose sofa, TV wall and coffee table together: the best of many tries. `aside`: leave one end of the room to dining."""
    with_tv = arranger.wants("tv_stand")
    category = arranger.choose("sofa")
    width, widest = 3.4, 2.7
    best: tuple[float, Model, Spot, Model | None, Spot | None] | None = None
    for _ in range(6):
        sofa = arranger.pick(category, width=width)
        stand = arranger.pick("tv_stand", width=widest) if with_tv else None
        if sofa is None:
            break
        for score, spot, tv in _sofa_places(arranger, sofa, stand, aside=aside):
            if score > 0 and (best is None or score > best[0]):
                best = score, sofa, spot, stand, tv
        if best is not None and (best[4] is not None or not with_tv):
            break
        width = sofa.size[0] * 0.95
        widest = stand.size[0] * 0.9 if stand is not None else widest
        if category in {"l_shaped_sofa", "multi_seat_sofa"} and width < 2.0 and best is None:
            category, width = "loveseat_sofa", 2.2
    return None if best is None else _set_lounge(arranger, *best[1:])


def _sofa_places(arranger: Arranger, sofa: Model, stand: Model | None, *, aside: bool) -> list[tuple[float, Spot, Spot | None]]:
    """Return (score, sofa, TV stand): backs to a wall, or drawn forward where the room is deep."""
    space, rng = arranger.space, arranger.rng
    w, d, h = sofa.size
    gap = back_gap(rng) + 0.02
    candidates: list[tuple[float, Spot, Spot | None]] = []
    for i, side in enumerate(space.sides):
        for a, b in space.spans(side, d + gap, 1.1, 0.0, h):
            if b - a < w + 0.02:
                continue
            for s in np.unique(np.clip([(a + b) / 2, a + w / 2 + 0.55, b - w / 2 - 0.55, *rng.uniform(a, b, 2)], a + w / 2, b - w / 2)):
                depth = _sight(space, side, float(s))
                if depth < d + 1.3:
                    continue
                spot, tv, look = on_side(space, i, float(s), d, gap), None, depth - d / 2
                if stand is not None:
                    look = depth - gap - d / 2 - stand.size[1] / 2
                    if look > 4.2:  # too far for the TV: the sofa comes forward and leaves a passage behind it
                        shift = look - float(rng.uniform(2.7, 3.9))
                        if shift > 0.75:
                            spot, look = shift_spot(spot, 0.0, shift), look - shift
                    tv = _tv_place(arranger, spot, side, stand, depth)
                score = 1.0 + rng.random() + min(b - a - w, 2.0) * 0.3
                score += 3.0 if tv is not None else -1.0 if stand is not None else 0.0
                score += 3.0 * _off_centre(space, spot) if aside else 0.0
                score -= 2.0 * max(0.0, look - 4.2) + 2.0 * max(0.0, 2.1 - look)
                if space.fits(spot.box(w, d), 0.0, h):
                    candidates.append((score, spot, tv))
    return candidates


def _off_centre(space: Space, spot: Spot) -> float:
    """Return how far a spot is from the middle of the room's longer side: 0 in the middle, 1 at an end."""
    x0, y0, x1, y1 = space.bounds
    across, value, low, high = (x1 - x0, spot.x, x0, x1) if x1 - x0 > y1 - y0 else (y1 - y0, spot.y, y0, y1)
    return abs(2 * value - low - high) / across


def _sight(space: Space, side: Side, s: float) -> float:
    """Return how far one sees from a wall at `s`, in a lane 1 m wide, up to the first thing that stands [m]."""
    lane = side.strip(max(0.0, s - 0.5), min(side.length, s + 0.5), 0.01, 12.0)
    depths = [max(0.0, side.off(r)[0]) for r, low, _ in space.solids if low < 1.0 and meets(lane, r, 0.01)]
    return min(depths, default=0.0)


def _tv_place(arranger: Arranger, sofa: Spot, side: Side, stand: Model, depth: float) -> Spot | None:
    """Return the TV stand's place at the wall that the sofa looks at; None where there is a door or no wall."""
    w, d, h = stand.size
    gap = back_gap(arranger.rng)
    s, _ = side.along((sofa.x, sofa.y, sofa.x, sofa.y))
    x, y = side.point(s + float(arranger.rng.normal(0, 0.08)), depth - gap - d / 2)
    spot = Spot(x, y, math.remainder(sofa.yaw + math.pi, 2 * math.pi))
    return spot if arranger.space.fits(spot.box(w, d), 0.0, h) else None


def _set_lounge(arranger: Arranger, sofa: Model, spot: Spot, stand: Model | None, tv: Spot | None) -> Lounge:
    """Put the chosen group down, and a coffee table 0.3-0.5 m in front of the sofa."""
    space, rng = arranger.space, arranger.rng
    d = sofa.size[1]
    space.add(sofa, spot)
    reach = 2.2
    if stand is not None and tv is not None:
        space.add(stand, tv)
        reach = abs((tv.x - spot.x) * math.sin(spot.yaw) - (tv.y - spot.y) * math.cos(spot.yaw)) - d / 2 - stand.size[1] / 2
    placed = None
    deepest = reach - 0.85
    for _ in range(4 if arranger.wants("coffee_table") else 0):
        table = arranger.pick("coffee_table", width=max(0.9, sofa.size[0] * 0.75), depth=deepest)
        if table is None or placed is not None:
            break
        place = shift_spot(spot, float(rng.normal(0, 0.06)), d / 2 + table.size[1] / 2 + float(rng.uniform(0.3, 0.48)))
        if space.try_add(table, place):
            placed = (table, place)
        deepest = table.size[1] * 0.85
    if placed is None and arranger.chance(0.3):
        table = arranger.pick("round_end_table") or arranger.pick("corner_side_table")
        if table is not None:
            space.try_add(table, shift_spot(spot, float(rng.normal(0, 0.1)), d / 2 + table.size[1] / 2 + 0.35))
    if tv is not None:  # nobody dines between sofa and TV
        space.clearances.append(ahead(spot, d, max(0.4, reach), min(1.4, sofa.size[0])))
    return Lounge(sofa, spot, placed)


def seats(arranger: Arranger, lounge: Lounge) -> None:
    """Put side tables beside the sofa; armchairs, lounge chairs and stools around the coffee table, facing it."""
    rng, space = arranger.rng, arranger.space
    count = int(arranger.choose("side_tables"))
    signs = [-1, 1] if count == 2 else [int(rng.choice([-1, 1]))] * count
    side_table = arranger.pick("corner_side_table")
    for sign in signs:
        if side_table is not None:
            back = -(lounge.sofa.size[1] - side_table.size[1]) / 2 + float(abs(rng.normal(0, 0.05)))
            across = sign * (lounge.sofa.size[0] / 2 + side_table.size[0] / 2 + float(rng.uniform(0.02, 0.1)))
            space.try_add(side_table, shift_spot(lounge.spot, across, back))
    wanted = arranger.wishes("seats")
    if "chinese_chairs" in wanted:
        wanted[wanted.index("chinese_chairs") :] = ["chinese_chair", "chinese_chair"]
    free = [-1, 1] if arranger.chance(0.5) else [1, -1]
    twin: dict[str, Model | None] = {}
    for category in wanted:
        model = twin.setdefault(category, arranger.pick(category))
        if model is not None and not _around(arranger, lounge, model, free):
            arranger.in_corner(category)


def _around(arranger: Arranger, lounge: Lounge, model: Model, free: list[int]) -> bool:
    """Put a seat at a free flank of the coffee table, square to the sofa or a little oblique."""
    rng = arranger.rng
    table = lounge.table
    reach = table[0].size[0] / 2 if table else 0.4
    ahead_by = (lounge.sofa.size[1] / 2 + 0.4 + (table[0].size[1] / 2 if table else 0.4)) + 0.1
    for sign in list(free):
        oblique = float(rng.uniform(0.25, 0.7)) * (-sign) if arranger.chance(arranger.rates["oblique_seat"]) else 0.0
        half = max(model.size[0], model.size[1]) / 2 if oblique else model.size[1] / 2
        across = sign * (reach + half + float(rng.uniform(0.35, 0.6)))
        place = shift_spot(lounge.spot, across, ahead_by + (0.1 if oblique else 0.0), -sign * math.pi / 2 + oblique)
        if arranger.space.try_add(model, place):
            free.remove(sign)
            return True
    return False
