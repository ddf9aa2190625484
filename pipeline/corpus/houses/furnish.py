"""Furnishes the rooms of a plan: several tries a room, the one kept in which a robot gets around best."""

from collections.abc import Callable, Mapping

import numpy as np

from pipeline import taxonomy
from pipeline.corpus.houses import bedrooms, dining, kitchens, living, rates, small_rooms, small_things, walkable_grid
from pipeline.corpus.houses.arranger import Arranger
from pipeline.corpus.houses.records import Item
from pipeline.corpus.houses.room_occupancy import Space
from pipeline.corpus.houses.room_sampling import KINDS
from pipeline.corpus.houses.stock import Stock
from pipeline.corpus.houses.stratified_draws import Deal
from pipeline.entities.plan import Plan
from pipeline.seeds import generator

TRIES = 4
RECIPES: Mapping[str, Callable[[Arranger, bool], None]] = {
    "bedroom": lambda arranger, _: bedrooms.furnish_bedroom(arranger),
    "kids_room": lambda arranger, _: bedrooms.furnish_kids_room(arranger),
    "living_room": lambda arranger, _: living.furnish_living(arranger, dining=arranger.wants("dining_too")),
    "living_dining_room": lambda arranger, _: living.furnish_living(arranger, dining=True),
    "dining_room": lambda arranger, _: dining.furnish_dining(arranger),
    "kitchen": lambda arranger, _: kitchens.furnish_kitchen(arranger),
    "bathroom": lambda arranger, _: small_rooms.furnish_bathroom(arranger),
    "hallway": lambda arranger, rich: small_rooms.furnish_hall(arranger, rich=rich),
    "study": lambda arranger, _: small_rooms.furnish_study(arranger),
    "balcony": lambda arranger, _: small_rooms.furnish_balcony(arranger),
    "utility": lambda arranger, _: small_rooms.furnish_utility(arranger),
    "storage": lambda arranger, rich: small_rooms.furnish_storage(arranger, rich=rich),
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


def furnish_room(
    seed: int, index: int, number: int, plan: Plan, stock: Stock, style: str, deal: Deal, *, rich: bool = True
) -> tuple[Item, ...]:
    """Furnish room `number` of house `index`; the result depends on nothing but the arguments.

    `rich`: as 3D-FRONT's furnished rooms are; else only with what such a room needs (halls and storage rooms).
    """
    room = plan.rooms[number]
    kind = layout_type(room.type)
    if kind is None:
        return ()
    openings = [o for o in plan.openings if room.room_id in o.rooms]
    best: tuple[tuple[int, int, int], Arranger] | None = None
    for attempt in range(TRIES):
        rng = generator(seed, "furnish", index, number, attempt)
        space = Space(number, room, openings)
        arranger = Arranger(rng, space, stock, style, rates.load()[KINDS[room.type]], deal)
        RECIPES[kind](arranger, rich)
        cut_off, far = walkable_grid.problems(space)
        present = {i.model.category for i in space.items}
        missing = sum(not (wanted & present) for wanted in MUSTS.get(kind, ()))
        score = (missing, cut_off, len(far))
        if best is None or score < best[0]:
            best = score, arranger
        if score == (0, 0, 0):
            break
    assert best is not None
    tidy(best[1].space)
    small_things.add_small_things(best[1], openings, kind)
    return tuple(best[1].space.items)


def tidy(space: Space) -> None:
    """Take away, latest first, what still cuts a door off or cannot be approached; lamps and big pieces stay if they can."""
    for _ in range(6):
        cut_off, far = walkable_grid.problems(space)
        if not cut_off and not far:
            break
        standing = [k for k, i in enumerate(space.items) if i.position[2] < 1.0]
        if not standing:
            break
        victim = far[-1] if far else _culprit(space, standing)
        space.items.pop(victim)
    walls = sum(low < -1.0 for _, low, _ in space.solids)
    space.solids[walls:] = [(i.rect(), i.position[2], i.position[2] + i.size[2]) for i in space.items]


def _culprit(space: Space, standing: list[int]) -> int:
    """Return the item whose removal joins the most doors; the latest of equals."""
    items = space.items
    scores = []
    for k in reversed(standing):
        space.items = items[:k] + items[k + 1 :]
        scores.append((walkable_grid.problems(space)[0], -k))
    space.items = items
    return -min(scores)[1]


def style_of(rng: np.random.Generator, stock: Stock) -> str:
    """Draw the style that a house prefers."""
    return str(rng.choice(list(stock.styles))) if stock.styles else ""
