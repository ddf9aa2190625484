"""Bedrooms and children's rooms: a bed with its head to a wall, and everything around it.

Rates per room follow the class counts of 3,900 filtered bedrooms of 3D-FRONT (about 5.0 objects a room).
"""

from __future__ import annotations

import numpy as np

from pipeline.corpus.houses.arranger import Arranger
from pipeline.corpus.houses.records import Model
from pipeline.corpus.houses.space import Spot, ahead, back_gap, box_of, on_side, shifted

FOOT = 0.6
SIDE = 0.5
"""Free floor at the foot and beside a bed [m]."""
# Single pieces tried in a bedroom after bed, nightstands, wardrobe and TV stand: category -> chance.
EXTRAS = {
    "cabinet": 0.11,
    "bookshelf": 0.045,
    "shelf": 0.05,
    "children_cabinet": 0.06,
    "corner_side_table": 0.08,
    "round_end_table": 0.04,
    "sideboard": 0.015,
    "armchair": 0.05,
    "lounge_chair": 0.12,
    "chaise_longue_sofa": 0.005,
    "lazy_sofa": 0.005,
    "plant": 0.04,
    "floor_lamp": 0.03,
}
KIDS_EXTRAS = {"children_cabinet": 0.55, "bookshelf": 0.3, "shelf": 0.2, "cabinet": 0.15, "stool": 0.15, "plant": 0.1}


def furnish_bedroom(arranger: Arranger) -> None:
    """Furnish a bedroom of grown-ups."""
    category = str(arranger.rng.choice(["double_bed", "single_bed", "kids_bed"], p=[0.855, 0.105, 0.04]))
    bed = place_bed(arranger, category)
    if bed is None and category == "double_bed":
        bed = place_bed(arranger, "single_bed")
    if bed is not None:
        nightstands(arranger, bed, int(arranger.rng.choice([0, 1, 2], p=[0.06, 0.20, 0.74])))
    if bed is not None and arranger.chance(0.42):
        tv_opposite(arranger, bed)
    pieces = [
        w for w, share in (("desk", 0.16), ("dressing_table", 0.19), ("wardrobe", 0.98), ("wardrobe", 0.04)) if arranger.chance(share)
    ]
    if arranger.chance(0.5):
        pieces.reverse()
    for piece in pieces:
        if piece == "wardrobe":
            arranger.at_wall("wardrobe", corner=0.8, tries=6)
        else:
            chairs = ("dining_chair", "lounge_chair", "lounge_chair") if piece == "desk" else ("dressing_chair", "dressing_chair", "stool")
            arranger.pair_at_wall(piece, chairs, 0.95)
    if bed is not None and arranger.chance(0.07):
        bed_end_stool(arranger, bed)
    extras(arranger, EXTRAS)
    if arranger.chance(0.04):
        arranger.on_wall("wall_lamp", 1.5)
    x, y = (bed[1].x, bed[1].y) if bed is not None and arranger.chance(0.35) else arranger.middles()[0]
    mark = arranger.rng.random()
    if mark < 0.95:
        category = "pendant_lamp" if mark < 0.65 else "ceiling_lamp"
        if not arranger.lamp(category, x, y):
            arranger.light(*((1.0, 0.0) if category == "pendant_lamp" else (0.0, 1.0)))


def furnish_kids_room(arranger: Arranger) -> None:
    """Furnish a child's room."""
    bed = place_bed(arranger, "kids_bed" if arranger.chance(0.6) else "single_bed")
    if bed is not None:
        nightstands(arranger, bed, int(arranger.rng.choice([0, 1, 2], p=[0.35, 0.5, 0.15])))
    if arranger.chance(0.6):
        arranger.pair_at_wall("desk", ("dining_chair", "lounge_chair", "dressing_chair"), 0.9)
    if arranger.chance(0.55):
        arranger.at_wall("wardrobe", corner=0.8, tries=5)
    extras(arranger, KIDS_EXTRAS)
    if arranger.chance(0.12):
        arranger.on_wall("wall_lamp", 1.5)
    arranger.light(0.5, 0.45)


def extras(arranger: Arranger, rates: dict[str, float]) -> None:
    """Try each category with its chance, in a fixed order."""
    for category, share in rates.items():
        if not arranger.chance(share):
            continue
        if category in {"armchair", "lounge_chair", "lazy_sofa", "chaise_longue_sofa", "plant", "floor_lamp"}:
            arranger.in_corner(category)
        else:
            arranger.at_wall(category)


def place_bed(arranger: Arranger, category: str) -> tuple[Model, Spot] | None:
    """Put the bed's head to a wall where both its long sides can be reached, or at least one."""
    space, rng = arranger.space, arranger.rng
    short = min(space.bounds[2] - space.bounds[0], space.bounds[3] - space.bounds[1])
    width = max(short - (1.0 if category == "double_bed" else 0.6), 1.5)
    for attempt in range(6):
        model = arranger.pick(category, width=width, depth=max(short - 0.5, 2.05))
        if model is None:
            return None
        space.blind = attempt >= 2 or arranger.chance(0.15)  # a headboard before a window: now and then
        found = _bed_spots(arranger, model, both=attempt < 4 and category == "double_bed")
        space.blind = False
        if found:
            weights = np.array([w for w, _ in found])
            spot = found[int(rng.choice(len(found), p=weights / weights.sum()))][1]
            w, d, _ = model.size
            keep = [box_of(*_at(shifted(spot, 0.0, d / 2 + FOOT / 2)), w * 0.8, FOOT)]
            for sign in (-1, 1):
                lane = box_of(*_at(shifted(spot, sign * (w / 2 + SIDE / 2), 0.3)), SIDE, d - 0.6)
                if space.clear(lane):
                    keep.append(lane)
            space.add(model, spot, keep=keep)
            return model, spot
        width = max(model.size[0] * 0.9, arranger.stock.least(category)[0])
    return None


def _bed_spots(arranger: Arranger, model: Model, *, both: bool) -> list[tuple[float, Spot]]:
    """Return weighted places for a bed. The middle of a wall, and walls that see the door from aside, weigh more."""
    space, rng = arranger.space, arranger.rng
    w, d, h = model.size
    gap = back_gap(rng)
    aside = 0.8 if both else 5.0  # a narrow bed often stands along a wall
    found: list[tuple[float, Spot]] = []
    for i, side in enumerate(space.sides):
        for a, b in space.spans(side, d + gap, FOOT, 0.0, h):
            room = b - a
            beside = SIDE + 0.08 if both else 0.0
            if room < w + 2 * beside:
                continue
            middle = (a + b) / 2 + float(rng.normal(0, 0.08)) if room > w + 2 * beside + 0.2 else (a + b) / 2
            found.append(
                (
                    3.0 * (1.0 + min(room - w, 2.5)),
                    on_side(space, i, float(np.clip(middle, a + w / 2 + beside, b - w / 2 - beside)), d, gap),
                )
            )
            lean = w / 2 + (beside if both else 0.02)
            if room > w + 2 * beside + 0.4:
                found += [(aside, on_side(space, i, a + lean, d, gap)), (aside, on_side(space, i, b - lean, d, gap))]
    return found


def nightstands(arranger: Arranger, bed: tuple[Model, Spot], count: int) -> None:
    """Put nightstands beside the head, backs flush with the bed's back; a pair is of one model."""
    model, spot = bed
    signs = [-1, 1] if count == 2 else [int(arranger.rng.choice([-1, 1]))] * count
    width = 0.75
    for attempt in range(5):
        stand = arranger.pick("nightstand", width=width)
        if stand is None:
            return
        gap = float(abs(arranger.rng.normal(0.04, 0.03)) + 0.01)
        back = -(model.size[1] - stand.size[1]) / 2
        places = [shifted(spot, sign * (model.size[0] / 2 + stand.size[0] / 2 + gap), back) for sign in signs]
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
    width = 2.4
    for _ in range(3):
        stand = arranger.pick("tv_stand", width=width, depth=0.55)
        if stand is None:
            return False
        for i in facing:
            side = space.sides[i]
            s, _ = side.along((spot.x, spot.y, spot.x, spot.y))
            if not 0 < s < side.length:
                continue
            place = on_side(space, i, s + float(arranger.rng.normal(0, 0.04)), stand.size[1], back_gap(arranger.rng))
            away = abs((place.x - spot.x) * np.sin(spot.yaw) - (place.y - spot.y) * np.cos(spot.yaw))
            if away - model.size[1] / 2 - stand.size[1] / 2 > 0.6 and space.try_add(
                stand, place, keep=[ahead(place, stand.size[1], 0.4, stand.size[0])]
            ):
                return True
        width = stand.size[0] * 0.9
    return False


def bed_end_stool(arranger: Arranger, bed: tuple[Model, Spot]) -> bool:
    """Put a bench at the foot of the bed."""
    model, spot = bed
    stool = arranger.pick("stool", width=model.size[0], depth=0.6)
    if stool is None:
        return False
    place = shifted(spot, float(arranger.rng.normal(0, 0.04)), model.size[1] / 2 + stool.size[1] / 2 + 0.04)
    return arranger.space.nestle(stool, place)


def _at(spot: Spot) -> tuple[float, float, float]:
    return spot.x, spot.y, spot.yaw
