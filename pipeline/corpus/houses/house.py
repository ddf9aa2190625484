"""One house from (seed, index, stock)."""

from __future__ import annotations

import uuid

from pipeline.corpus.houses import furnish
from pipeline.corpus.houses.planner import make_plan
from pipeline.corpus.houses.records import House, Item
from pipeline.corpus.houses.stock import Stock
from pipeline.seeds import generator, key

# Share of rooms that were never furnished, by layout type (most kitchens and baths of 3D-FRONT hold no released models; ours do).
EMPTY = {"bedroom": 0.02, "kids_room": 0.02, "hallway": 0.08, "balcony": 0.08, "storage": 0.08}


def make_house(seed: int, index: int, stock: Stock) -> House:
    """Plan and furnish house `index`."""
    rng = generator(seed, "house", index)
    plan = make_plan(rng)
    style = furnish.style_of(rng, stock)
    items: list[Item] = []
    empty = []
    for number, room in enumerate(plan.rooms):
        kind = furnish.layout_type(room.type)
        bare = kind is None or bool(rng.random() < EMPTY.get(kind, 0.01))
        placed = () if bare else furnish.furnish_room(seed, index, number, plan, stock, style)
        items += placed
        empty.append(not placed)
    return House(str(uuid.UUID(int=key(seed, "uid", index), version=4)), index, plan, tuple(items), tuple(empty))
