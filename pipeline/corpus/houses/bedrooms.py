"""Bedrooms and children's rooms: a bed with its head to a wall, and everything around it."""

import math

import numpy as np

from pipeline.corpus.furniture.catalogue import Model
from pipeline.corpus.houses.arranger import Arranger
from pipeline.corpus.houses.room_occupancy import Spot, ahead, back_gap, on_side, shift_spot

FARTHEST_TV = 1.2  # most free floor between a bed's foot and the TV stand [m]
FOOT, SIDE = 0.6, 0.5  # free floor at the foot and beside a bed [m]
BESIDE = ((0.52, 0.75), (0.47, 0.62), (0.42, 0.52), (0.4, 0.45))
"""What is left beside a double bed, for nightstands and to get in, drawn from a range at each attempt: less, before the bed becomes a smaller one [m]."""
SEATS = frozenset({"armchair", "lounge_chair", "lazy_sofa", "chaise_longue_sofa", "stool", "plant", "floor_lamp"})


def furnish_bedroom(arranger: Arranger) -> None:
    """Furnish a bedroom, or a child's room."""
    category = arranger.choose("bed")
    bed = place_bed(arranger, category)
    if bed is None and category == "double_bed":
        bed = place_bed(arranger, "single_bed")
    if bed is not None:
        nightstands(arranger, bed, int(arranger.choose("nightstands")))
    pieces = arranger.wishes("pieces")
    if bed is not None and "tv_stand" in pieces:
        tv_opposite(arranger, bed)
    at_walls(arranger, [p for p in pieces if p != "tv_stand"])
    if bed is not None and arranger.wants("bench"):
        bed_end_stool(arranger, bed)
    extras(arranger)
    if arranger.wants("wall_lamp"):
        arranger.on_wall("wall_lamp", 1.5)
    arranger.light([(bed[1].x, bed[1].y)] if bed is not None and arranger.wants("lamp_over_bed") else [])


def at_walls(arranger: Arranger, pieces: list[str]) -> None:
    """Put desks with their chairs and other large pieces to the walls, in either order."""
    if arranger.chance(0.5):
        pieces.reverse()
    for piece in pieces:
        if piece in {"desk", "dressing_table"}:
            arranger.pair_at_wall(piece)
        else:
            arranger.at_wall(piece, corner=0.8, tries=6)


def extras(arranger: Arranger) -> None:
    """Put the smaller pieces that the room wants: seats into corners, the others to walls."""
    for category in arranger.wishes("extras"):
        if category in SEATS:
            arranger.in_corner(category)
        else:
            arranger.at_wall(category)


def place_bed(arranger: Arranger, category: str) -> tuple[Model, Spot] | None:
    """Put the bed's head to a wall where both its long sides can be reached, or at least one."""
    space, rng = arranger.space, arranger.rng
    short = min(space.bounds[2] - space.bounds[0], space.bounds[3] - space.bounds[1])
    width = max(short - (1.0 if category == "double_bed" else 0.6), 1.5)
    for attempt in range(8):
        model = arranger.pick(category, width=width, depth=max(short - 0.4, 2.05))
        if model is None:
            return None
        if attempt < 2:  # beds are as large as the room lets them: of three, the largest
            others = [arranger.pick(category, width=width, depth=max(short - 0.4, 2.05)) for _ in range(2)]
            model = max([model, *(m for m in others if m)], key=lambda m: m.size[0] + 1.5 * m.size[1])
        space.blind = attempt >= 1 or arranger.chance(0.15)  # a headboard before a window: now and then
        beside = float(rng.uniform(*BESIDE[min(attempt, len(BESIDE) - 1)])) if attempt < 6 and category == "double_bed" else 0.0
        candidates = _bed_spots(arranger, model, beside)
        space.blind = False
        if candidates:
            weights = np.array([w for w, _ in candidates])
            spot = candidates[int(rng.choice(len(candidates), p=weights / weights.sum()))][1]
            w, d, _ = model.size
            clearances = [shift_spot(spot, 0.0, d / 2 + FOOT / 2).box(w * 0.8, FOOT)]
            for sign in (-1, 1):
                lane = shift_spot(spot, sign * (w / 2 + SIDE / 2), 0.3).box(SIDE, d - 0.6)
                if space.clear(lane):
                    clearances.append(lane)
            space.add(model, spot, clearances=clearances)
            return model, spot
        if attempt >= 1:
            width = max(model.size[0] * 0.96, arranger.stock.least(category)[0])
    return None


def _bed_spots(arranger: Arranger, model: Model, beside: float) -> list[tuple[float, Spot]]:
    """Return weighted places for a bed with `beside` metres free on both sides (0: one side may touch a wall).

    The middle of a wall, and walls that see the door from aside, weigh more.
    """
    space, rng = arranger.space, arranger.rng
    w, d, h = model.size
    gap = back_gap(rng)
    aside = 0.8 if beside else 5.0  # a narrow bed often stands along a wall
    candidates: list[tuple[float, Spot]] = []
    for i, side in enumerate(space.sides):
        for a, b in space.spans(side, d + gap, FOOT, 0.0, h):
            room = b - a
            if room < w + 2 * beside:
                continue
            middle = (a + b) / 2 + float(rng.normal(0, 0.08)) if room > w + 2 * beside + 0.2 else (a + b) / 2
            at = float(np.clip(middle, a + w / 2 + beside, b - w / 2 - beside))
            candidates.append((3.0 * (1.0 + min(room - w, 2.5)), on_side(space, i, at, d, gap)))
            lean = w / 2 + (beside or 0.005 + abs(float(rng.normal(0, 0.02))))
            if room > w + 2 * beside + 0.4:
                candidates += [(aside, on_side(space, i, a + lean, d, gap)), (aside, on_side(space, i, b - lean, d, gap))]
    return candidates


def nightstands(arranger: Arranger, bed: tuple[Model, Spot], count: int) -> None:
    """Put nightstands beside the head, backs flush with the bed's back; a pair is of one model."""
    model, spot = bed
    signs = [-1, 1] if count == 2 else [int(arranger.rng.choice([-1, 1]))] * count
    width = 0.75
    for attempt in range(5):
        stand = arranger.pick("nightstand", width=width, depth=0.44 if attempt < 3 else math.inf)
        if stand is None:
            return
        gap = float(abs(arranger.rng.normal(0.08, 0.04)) + 0.01)
        back = -(model.size[1] - stand.size[1]) / 2
        places = [shift_spot(spot, sign * (model.size[0] / 2 + stand.size[0] / 2 + gap), back) for sign in signs]
        fitting = [p for p in places if arranger.space.nestle(stand, p, dry=True)]
        if len(fitting) == len(places) or attempt == 4:
            for place in fitting:
                arranger.space.nestle(stand, place)
            return
        width = max(stand.size[0] * 0.9, arranger.stock.least("nightstand")[0])


def tv_opposite(arranger: Arranger, bed: tuple[Model, Spot]) -> bool:
    """Put a TV stand to the wall that the bed looks at, level with the bed's middle."""
    space = arranger.space
    model, spot = bed
    facing = [i for i, s in enumerate(space.sides) if abs(np.cos(s.yaw - spot.yaw) + 1) < 1e-6]
    for stand in arranger.smaller("tv_stand", 3, 0.9, width=2.4, depth=0.55):
        for i in facing:
            side = space.sides[i]
            s, _ = side.along((spot.x, spot.y, spot.x, spot.y))
            if not 0 < s < side.length:
                continue
            place = on_side(space, i, s + float(arranger.rng.normal(0, 0.04)), stand.size[1], back_gap(arranger.rng))
            away = abs((place.x - spot.x) * np.sin(spot.yaw) - (place.y - spot.y) * np.cos(spot.yaw))
            before = ahead(place, stand.size[1], 0.4, stand.size[0])
            if 0.6 < away - model.size[1] / 2 - stand.size[1] / 2 < FARTHEST_TV and space.try_add(stand, place, clearances=[before]):
                return True
    return False


def bed_end_stool(arranger: Arranger, bed: tuple[Model, Spot]) -> bool:
    """Put a bench at the foot of the bed."""
    model, spot = bed
    stool = arranger.pick("stool", width=model.size[0], depth=0.6)
    if stool is None:
        return False
    place = shift_spot(spot, float(arranger.rng.normal(0, 0.04)), model.size[1] / 2 + stool.size[1] / 2 + 0.04)
    return arranger.space.nestle(stool, place)
