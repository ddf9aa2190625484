"""The defects of real scene files, at the rates counted on 12 of them (manifests/calibration/front.yaml, defects).

`disturb` changes the furniture itself, `litter` says what else a file holds, `in_centimetres` which models have the wrong unit.
"""

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from shapely.geometry import Point, Polygon

from pipeline import taxonomy
from pipeline.corpus import front_statistics
from pipeline.corpus.furniture.catalogue import Model
from pipeline.corpus.furniture.finishes import one_of
from pipeline.corpus.houses.records import House, Item
from pipeline.corpus.houses.stock import Stock
from pipeline.seeds import generator

REPLACED = 0.09  # share of furniture whose model was replaced by another, scaled to the old size (40 of 497 records)
OUTWARDS = 0.24  # share of what stands on the floor, beds apart, that is pushed through a wall, where one is near
INTO = 0.36  # share that is pushed into a neighbour, where one is near; chairs under tables overlap besides
FAR = 0.25  # share of the pushed pieces that end half outside, or half in their neighbour; the others by a few centimetres
DOUBLE_CHILD = 0.002
SHAFT_ROOM = 0.15
MIRRORED, MIRRORED_L_SOFAS = 0.004, 0.2
"""Share of valid furniture with a mirrored scale (2 of 288, both L-shaped sofas); the other mirrored children dangle."""
NEAR = 0.8  # nothing is pushed farther than this [m]
IN_ORDER = frozenset({"double_bed", "nightstand", "tv_stand", "coffee_table"})
"""What is never pushed: these stand in line within centimetres in the 12 scenes."""
LOW = 1.0  # what starts higher hangs [m]


@dataclass(frozen=True, slots=True)
class Litter:
    """How many superfluous things a file holds, per kind."""

    dangling: int = 0
    invalid: int = 0
    duplicates: int = 0
    double_children: int = 0
    other_room: bool = False
    shaft_room: bool = False


def litter(rng: np.random.Generator, house: House) -> Litter:
    """Draw the litter of a house's file."""
    known = front_statistics.load().defects
    children = len(house.items) + sum(o.kind not in {"open", "portal"} for o in house.plan.openings)
    rates = {name: count / (of - count) for name, (count, of) in known.items()}
    dangling, invalid, surplus = (int(rng.poisson(rates[name] * children)) for name in ("dangling", "invalid", "surplus"))
    other = bool(rng.random() < rates["floorless"] * len(house.plan.rooms))
    return Litter(dangling, invalid, surplus, int(rng.poisson(DOUBLE_CHILD * children)), other, bool(rng.random() < SHAFT_ROOM))


def in_centimetres(seed: int, models: Sequence[Model]) -> frozenset[str]:
    """Return the ids of the models whose files are in centimetres: at the release's rate, one at least."""
    count, of = front_statistics.load().defects["centimetres"]
    number = max(1, round(count / of * len(models)))
    chosen = generator(seed, "mess", "centimetres").choice(len(models), size=min(number, len(models)), replace=False)
    return frozenset(models[int(k)].model_id for k in chosen)


def disturb(rng: np.random.Generator, house: House, stock: Stock) -> House:
    """Replace, mirror, push around some of the furniture. What carries something keeps its model and moves with what it carries."""
    carried: dict[int, list[int]] = {}
    for k, item in enumerate(house.items):
        carried.setdefault(item.support, []).append(k)
    items = list(house.items)
    floors = [Polygon(room.polygon) for room in house.plan.rooms]
    pieces = [k for k, i in enumerate(items) if i.support < 0 and taxonomy.load().categories[i.model.category].layout]
    for k in pieces:
        if k not in carried:
            item = _swap_model(rng, items[k], stock)
            if rng.random() < (MIRRORED_L_SOFAS if item.model.category == "l_shaped_sofa" else MIRRORED):
                item = dataclasses.replace(item, scale=(-item.scale[0], item.scale[1], item.scale[2]))
            items[k] = item
    standing = [k for k in pieces if items[k].position[2] < LOW]
    for k in standing:
        if items[k].model.category in IN_ORDER:
            continue
        others = [items[m] for m in standing if m != k and items[m].room == items[k].room]
        mark, old = rng.random(), items[k]
        if mark < OUTWARDS:
            items[k] = _outwards(rng, old, floors[old.room])
        elif mark < OUTWARDS + INTO and others:
            items[k] = _into(rng, old, others)
        dx, dy = (items[k].position[axis] - old.position[axis] for axis in (0, 1))
        for m in carried.get(k, ()):
            x, y, z = items[m].position
            items[m] = dataclasses.replace(items[m], position=(x + dx, y + dy, z))
    return dataclasses.replace(house, items=tuple(items))


def _swap_model(rng: np.random.Generator, item: Item, stock: Stock) -> Item:
    """Swap the model for a similar one of its category, scaled in plan to the size of the old one."""
    if rng.random() >= REPLACED:
        return item
    w, d, h = item.model.size
    others = [m for m in stock.by_category[item.model.category] if m.model_id != item.model.model_id]
    similar = [m for m in others if 0.75 < w / m.size[0] < 1.3 and 0.75 < d / m.size[1] < 1.3 and abs(m.size[2] - h) < 0.1]
    if not similar:
        return item
    model = one_of(rng, similar)
    return dataclasses.replace(item, model=model, scale=(w / model.size[0], d / model.size[1], h / model.size[2]))


def _outwards(rng: np.random.Generator, item: Item, floor: Polygon) -> Item:
    """Push a piece through the wall that it is nearest to; one in the middle of the room stays."""
    x0, y0, x1, y1 = item.rect()
    x, y, z = item.position
    middle = Point(x, y)
    edge = floor.exterior.interpolate(floor.exterior.project(middle))
    dx, dy = edge.x - x, edge.y - y
    away = math.hypot(dx, dy)
    half = (x1 - x0) / 2 if abs(dx) > abs(dy) else (y1 - y0) / 2
    if away - half > NEAR or away < 1e-6:
        return item
    inside = float(rng.uniform(0.45, 0.8) if rng.random() < FAR else rng.uniform(0.82, 0.94))
    by = (away - half + 2 * half * (1 - inside)) / away
    return dataclasses.replace(item, position=(x + dx * by, y + dy * by, z))


def _into(rng: np.random.Generator, item: Item, others: list[Item]) -> Item:
    """Push a piece towards its nearest neighbour, until they overlap; one without a near neighbour stays."""
    x, y, z = item.position
    near = min(others, key=lambda o: (o.position[0] - x) ** 2 + (o.position[1] - y) ** 2)
    a, b = item.rect(), near.rect()
    share = float(rng.uniform(0.3, 0.6) if rng.random() < FAR else rng.uniform(0.04, 0.2))
    moves = []
    for low, high in ((0, 2), (1, 3)):
        after, before = b[low] - a[high], a[low] - b[high]  # gaps towards larger and smaller coordinates
        sign, gap = (1.0, after) if after > before else (-1.0, before)
        moves.append(sign * max(0.0, gap + share * min(a[high] - a[low], b[high] - b[low])) if gap > -0.02 else 0.0)
    if max(abs(m) for m in moves) > NEAR:
        return item
    return dataclasses.replace(item, position=(x + moves[0], y + moves[1], z))
