"""The defects of real scene files, at the rates counted on 12 of them ("3D-FRONT format", known defects).

What changes the furniture itself (`disturb`) is kept to some rooms, so that most stay clean; what only litters the file
(`litter`) comes at the full rates.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pipeline.corpus.houses.records import House, Item
from pipeline.corpus.houses.stock import Stock

UNTIDY_ROOMS = 0.18
"""Share of furnished rooms in which one to three pieces stand half outside or in each other."""
REPLACED = 0.09
"""Share of furniture whose model was replaced by another, scaled to the old size (40 of 497 records)."""
MIRRORED_L_SOFAS = 0.35
MIRRORED = 0.003
DANGLING = 0.93
"""Dangling children per furniture child that resolves (448 of 930)."""
INVALID = 0.05
"""Records that are not valid, per valid one (16 to 288)."""
DUPLICATES = 0.05
"""Surplus furniture records per record (16 of 497)."""
DOUBLE_CHILD = 0.002
OTHER_ROOM = 0.7
"""Houses with a pseudo-room without a floor (9 of 12)."""
SHAFT_ROOM = 0.15


@dataclass(frozen=True, slots=True)
class Litter:
    """How many superfluous things a file holds, per kind."""

    dangling: int = 0
    invalid: int = 0
    duplicates: int = 0
    double_children: int = 0
    other_room: bool = False
    shaft_room: bool = False


def litter(rng: np.random.Generator, items: int) -> Litter:
    """Draw the litter of a file with that many pieces of furniture."""
    dangling, invalid, duplicates, double = (int(rng.poisson(rate * items)) for rate in (DANGLING, INVALID, DUPLICATES, DOUBLE_CHILD))
    return Litter(dangling, invalid, duplicates, double, bool(rng.random() < OTHER_ROOM), bool(rng.random() < SHAFT_ROOM))


def disturb(rng: np.random.Generator, house: House, stock: Stock) -> House:
    """Replace, mirror, push around some of the furniture."""
    items = [_mirrored(rng, _replaced(rng, item, stock)) for item in house.items]
    for number in range(len(house.plan.rooms)):
        members = [k for k, i in enumerate(items) if i.room == number and i.position[2] < 1.0]
        if len(members) < 2 or rng.random() >= UNTIDY_ROOMS:
            continue
        for k in rng.choice(members, size=min(len(members), int(rng.integers(1, 4))), replace=False):
            push: Callable[[np.random.Generator, Item, list[Item]], Item] = _outwards if rng.random() < 0.5 else _into
            items[int(k)] = push(rng, items[int(k)], [items[m] for m in members if m != k])
    return dataclasses.replace(house, items=tuple(items))


def _replaced(rng: np.random.Generator, item: Item, stock: Stock) -> Item:
    """Swap the model for a similar one of its category, scaled in plan to the size of the old one."""
    if rng.random() >= REPLACED:
        return item
    w, d, h = item.model.size
    similar = [
        m
        for m in stock.by_category[item.model.category]
        if m.model_id != item.model.model_id and 0.75 < w / m.size[0] < 1.3 and 0.75 < d / m.size[1] < 1.3 and abs(m.size[2] - h) < 0.1
    ]
    if not similar:
        return item
    model = similar[int(rng.integers(len(similar)))]
    # A piece that hangs or carries something keeps its height.
    up = h / model.size[2]
    return dataclasses.replace(item, model=model, scale=(w / model.size[0], d / model.size[1], up))


def _mirrored(rng: np.random.Generator, item: Item) -> Item:
    share = MIRRORED_L_SOFAS if item.model.category == "l_shaped_sofa" else MIRRORED
    if rng.random() >= share:
        return item
    return dataclasses.replace(item, scale=(-item.scale[0], item.scale[1], item.scale[2]))


def _outwards(rng: np.random.Generator, item: Item, _: list[Item]) -> Item:
    """Push a piece backwards, into or through the wall."""
    by = float(rng.uniform(0.1, 0.6)) * item.size[1]
    x, y, z = item.position
    back = (-np.sin(item.yaw), np.cos(item.yaw))
    return dataclasses.replace(item, position=(x + by * float(back[0]), y + by * float(back[1]), z))


def _into(rng: np.random.Generator, item: Item, others: list[Item]) -> Item:
    """Push a piece towards its nearest neighbour, until they overlap."""
    x, y, z = item.position
    near = min(others, key=lambda o: (o.position[0] - x) ** 2 + (o.position[1] - y) ** 2)
    share = float(rng.uniform(0.3, 0.7))
    return dataclasses.replace(item, position=(x + share * (near.position[0] - x), y + share * (near.position[1] - y), z))
