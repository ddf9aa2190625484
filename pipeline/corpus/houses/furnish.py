"""Furnishes the rooms of a plan: several tries a room, the one kept in which a robot gets around best."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from pipeline import taxonomy
from pipeline.corpus.houses import bedrooms, dining, kitchens, living, small_rooms, walkable
from pipeline.corpus.houses.arranger import Arranger
from pipeline.corpus.houses.records import Item
from pipeline.corpus.houses.space import Space
from pipeline.corpus.houses.stock import Stock
from pipeline.entities.plan import Plan
from pipeline.seeds import generator

TRIES = 4
RECIPES: Mapping[str, Callable[[Arranger], None]] = {
    "bedroom": bedrooms.furnish_bedroom,
    "kids_room": bedrooms.furnish_kids_room,
    "living_room": lambda arranger: living.furnish_living(arranger, dining=False),
    "living_dining_room": lambda arranger: living.furnish_living(arranger, dining=True),
    "dining_room": dining.furnish_dining,
    "kitchen": kitchens.furnish_kitchen,
    "bathroom": small_rooms.furnish_bathroom,
    "hallway": small_rooms.furnish_hall,
    "study": small_rooms.furnish_study,
    "balcony": small_rooms.furnish_balcony,
    "utility": small_rooms.furnish_utility,
    "storage": small_rooms.furnish_storage,
}
SOFAS = {"multi_seat_sofa", "loveseat_sofa", "l_shaped_sofa", "chaise_longue_sofa", "lazy_sofa"}
# One of each set, or the room is tried again.
MUSTS: Mapping[str, tuple[set[str], ...]] = {
    "bedroom": ({"double_bed", "single_bed", "kids_bed"},),
    "kids_room": ({"kids_bed", "single_bed"},),
    "living_room": (SOFAS,),
    "living_dining_room": (SOFAS, {"dining_table"}),
    "dining_room": ({"dining_table"},),
    "kitchen": ({"sink_cabinet"}, {"refrigerator"}, {"oven"}),
    "bathroom": ({"toilet"}, {"vanity"}, {"shower", "bathtub"}),
    "study": ({"desk"},),
    "utility": ({"washing_machine"},),
}


def layout_type(room_type: str) -> str | None:
    """Return the layout type of a 3D-FRONT room type; None for rooms that are never furnished."""
    return taxonomy.load().front_rooms.get(room_type.lower())


def furnish_room(seed: int, index: int, number: int, plan: Plan, stock: Stock, style: str) -> tuple[Item, ...]:
    """Furnish room `number` of house `index`; the result depends on nothing but the arguments."""
    room = plan.rooms[number]
    kind = layout_type(room.type)
    if kind is None:
        return ()
    openings = [o for o in plan.openings if room.room_id in o.rooms]
    best: tuple[tuple[int, int, int], Space] | None = None
    for attempt in range(TRIES):
        rng = generator(seed, "furnish", index, number, attempt)
        space = Space(number, room, openings)
        RECIPES[kind](Arranger(rng, space, stock, style))
        cut_off, far = walkable.problems(space)
        present = {i.model.category for i in space.items}
        missing = sum(not (wanted & present) for wanted in MUSTS.get(kind, ()))
        score = (missing, cut_off, len(far))
        if best is None or score < best[0]:
            best = score, space
        if score == (0, 0, 0):
            return tuple(space.items)
    assert best is not None
    return tidied(best[1])


def tidied(space: Space) -> tuple[Item, ...]:
    """Take away, latest first, what still cuts a door off or cannot be approached; lamps and big pieces stay if they can."""
    for _ in range(6):
        cut_off, far = walkable.problems(space)
        if not cut_off and not far:
            break
        standing = [k for k, i in enumerate(space.items) if i.position[2] < 1.0]
        if not standing:
            break
        victim = far[-1] if far else _culprit(space, standing)
        space.items.pop(victim)
    return tuple(space.items)


def _culprit(space: Space, standing: list[int]) -> int:
    """Return the item whose removal joins the most doors; the latest of equals."""
    items = space.items
    found = []
    for k in reversed(standing):
        space.items = items[:k] + items[k + 1 :]
        found.append((walkable.problems(space)[0], -k))
    space.items = items
    return -min(found)[1]


def style_of(rng: np.random.Generator, stock: Stock) -> str:
    """Draw the style that a house prefers."""
    return str(rng.choice(list(stock.styles))) if stock.styles else ""
