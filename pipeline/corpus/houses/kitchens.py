"""Kitchens: a run of base units along a wall, appliances in it, the fridge at its end, wall units above."""

from pipeline.corpus.furniture.catalogue import Model
from pipeline.corpus.houses.arranger import Arranger, free_front
from pipeline.corpus.houses.room_occupancy import FILLER, ahead, on_side

FRONT = 0.75  # free floor before a run: an open door and a cook [m]
SEAM = 0.002
SMALL = 7.0  # kitchens of less floor have no other wall for a refrigerator [m2]
NEEDED = frozenset({"sink_cabinet", "oven", "refrigerator", "kitchen_cabinet"})
"""Nobody cooks without one of each: their least widths are kept free until they stand."""
TAP = 0.16  # how far a tap rises above its worktop, at most [m]
HUNG_AT = 1.45  # underside of the wall units [m]


def furnish_kitchen(arranger: Arranger) -> None:
    """Furnish a kitchen with one run, or two that meet in a corner or face each other."""
    middle = ["kitchen_cabinet", "oven"]
    middle += ["dishwasher"] if arranger.wants("dishwasher") else []
    middle += ["kitchen_cabinet"] if arranger.wants("second_cabinet") else []
    arranger.rng.shuffle(middle)
    # One thing stands between sink and cooker, where one puts down what one cuts.
    middle.insert({0: 2, 1: 0}.get(middle.index("oven"), 1), "sink_cabinet")
    wanted = [*middle, "kitchen_cabinet", "kitchen_cabinet", "kitchen_cabinet"]
    if arranger.wants("fridge_in_run") or arranger.space.area < SMALL:
        wanted = ["refrigerator", *wanted]
    left = run(arranger, wanted)
    others = sorted((c for c in left if c != "kitchen_cabinet"), key=lambda c: (c != "refrigerator", c not in NEEDED))
    if others or not stands(arranger, "kitchen_cabinet"):
        run(arranger, [*(unit for c in others for unit in (c, "kitchen_cabinet")), "kitchen_cabinet"])
    if not stands(arranger, "refrigerator"):
        arranger.at_wall("refrigerator", corner=0.95)


def stands(arranger: Arranger, category: str) -> bool:
    """Say whether the kitchen has one of the category."""
    return any(item.model.category == category for item in arranger.space.items)


def run(arranger: Arranger, wanted: list[str]) -> list[str]:
    """Fill the longest free stretch of wall with units side by side; return what did not fit."""
    space, rng = arranger.space, arranger.rng
    depth = 0.66
    stretches = [(b - a, i, a, b) for i, side in enumerate(space.sides) for a, b in space.spans(side, depth, FRONT, 0.0, 0.95)]
    stretches = [s for s in stretches if s[0] >= 0.65]
    if not stretches:
        return wanted
    longest = max(s[0] for s in stretches)
    good = [s for s in stretches if s[0] > 0.8 * longest]
    length, i, a, b = good[int(rng.integers(len(good)))]
    low_corner, high_corner = a < 0.05, b > space.sides[i].length - 0.05
    forward = low_corner if low_corner != high_corner else arranger.chance(0.5)
    near, far = (low_corner, high_corner) if forward else (high_corner, low_corner)
    at = FILLER if near else 0.005
    length -= FILLER if far else 0.0
    needed = NEEDED.intersection(wanted)
    if sum(arranger.stock.least(c)[0] + SEAM for c in needed) > length - at:
        needed -= {"kitchen_cabinet"}
    left: list[str] = []
    placed: list[tuple[Model, float]] = []
    for number, category in enumerate(wanted):
        later = needed.intersection(wanted[number + 1 :]) - {category, *(m.category for m, _ in placed)}
        spare = length - at - sum(arranger.stock.least(c)[0] + SEAM for c in later)
        model = arranger.pick(category, width=spare, depth=0.75)
        if model is None or (category == "kitchen_cabinet" and spare < 0.3):
            left.append(category)
            continue
        s = a + at + model.size[0] / 2 if forward else b - at - model.size[0] / 2
        spot = on_side(space, i, s, model.size[1], 0.004)
        front = ahead(spot, model.size[1], free_front(category, 0.65), model.size[0])
        if not space.try_add(model, spot, clearances=[front], slender=TAP if category == "sink_cabinet" else 0.0):
            left.append(category)
            continue
        placed.append((model, s))
        at += model.size[0] + SEAM
    above(arranger, i, placed)
    return left


def above(arranger: Arranger, side: int, placed: list[tuple[Model, float]]) -> None:
    """Hang wall units over a run, clear of windows and fridge, and stand a microwave on one base unit."""
    base = [(model, s) for model, s in placed if model.category != "refrigerator"]
    if not base:
        return
    hang(arranger, side, min(s - m.size[0] / 2 for m, s in base), max(s + m.size[0] / 2 for m, s in base))
    space = arranger.space
    if not arranger.wants("microwave") or stands(arranger, "microwave"):
        return
    for model, s in base:
        if model.category == "kitchen_cabinet":
            oven = arranger.pick("microwave", width=model.size[0] - 0.02, depth=model.size[1] - 0.02)
            if oven is not None and space.try_add(oven, on_side(space, side, s, oven.size[1], 0.05), model.size[2] + 0.001):
                return


def hang(arranger: Arranger, side: int, low: float, high: float) -> None:
    """Fill the wall above a run from `low` to `high` along it with wall units; here and there one is left out."""
    space = arranger.space
    tallest = space.height - HUNG_AT - 0.1
    for a, b in space.spans(space.sides[side], 0.42, 0.0, HUNG_AT, HUNG_AT + 0.7):
        at, end = max(a, low), min(b, high)
        while (unit := arranger.pick("wall_cabinet", width=end - at - SEAM, height=tallest)) is not None:
            spot = on_side(space, side, at + SEAM + unit.size[0] / 2, unit.size[1], 0.004)
            if arranger.chance(0.85) and space.try_add(unit, spot, HUNG_AT):
                way = ahead(spot, unit.size[1], unit.size[0], unit.size[0])
                space.swept.append((way, HUNG_AT, HUNG_AT + unit.size[2]))  # no lamp hangs before its doors
            at += SEAM + unit.size[0]
