"""One house from (seed, index, stock): planned, then furnished room by room, several tries each, the one kept in which a robot gets around best."""

import uuid
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from pipeline import taxonomy
from pipeline.corpus import front_statistics
from pipeline.corpus.houses import bedrooms, kitchens, living, rates, small_things
from pipeline.corpus.houses.arranger import Arranger
from pipeline.corpus.houses.planner import BLOCK, CORRIDORS, KINDS, agenda, make_plan
from pipeline.corpus.houses.rates import Deal
from pipeline.corpus.houses.records import House, Item
from pipeline.corpus.houses.room_occupancy import Space, problems
from pipeline.corpus.houses.stock import Stock
from pipeline.entities.plan import Plan
from pipeline.seeds import generator, key

TRIES = 4
FIRST: Mapping[str, Callable[[Arranger], None]] = {  # what stands in groups, by kind of room, before its recipe of rates.yaml is followed
    "bedroom": bedrooms.furnish_bedroom,
    "kids_room": bedrooms.furnish_bedroom,
    "living_room": lambda arranger: living.furnish_living(arranger, dining=arranger.wants("dining_too")),
    "living_dining_room": lambda arranger: living.furnish_living(arranger, dining=True),
    "dining_room": living.furnish_dining_corner,
    "kitchen": kitchens.furnish_kitchen,
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
    chances = rates.load()
    tries: list[tuple[tuple[int, int, int], Arranger]] = []
    for attempt in range(TRIES):
        rng = generator(seed, "furnish", index, number, attempt)
        space = Space(number, room, openings)
        arranger = Arranger(rng, space, stock, style, chances[KINDS[room.type]], deal)
        if kind in FIRST:
            FIRST[kind](arranger)
        arranger.follow(chances["recipes"].get(kind, ()), rich=rich)
        cut_off, far = problems(space)
        present = {i.model.category for i in space.items}
        missing = sum(present.isdisjoint(wanted) for wanted in chances["musts"].get(kind, ()))
        tries.append(((missing, cut_off, len(far)), arranger))
        if not any(tries[-1][0]):
            break
    best = min(tries, key=lambda attempt: attempt[0])[1]
    tidy(best.space)
    small_things.add_small_things(best, openings, kind)
    return tuple(best.space.items)


def tidy(space: Space) -> None:
    """Take away, latest first, what still cuts a door off or cannot be approached; lamps and big pieces stay if they can."""
    for _ in range(6):
        cut_off, far = problems(space)
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
        scores.append((problems(space)[0], -k))
    space.items = items
    return -min(scores)[1]


def make_house(seed: int, index: int, stock: Stock) -> House:
    """Plan and furnish house `index`."""
    rng = generator(seed, "house", index)
    wanted = agenda(seed, index)
    plan = make_plan(rng, wanted.rooms)
    style = str(rng.choice(stock.styles)) if stock.styles else ""  # what the house prefers
    rich = set(rooms_to_furnish(plan, wanted.rooms))
    beyond, bare = front_statistics.load().beyond, rates.load()["bare"]
    items: list[Item] = []
    empty = []
    counts: Counter[str] = Counter()
    for number, room in enumerate(plan.rooms):
        kind = layout_type(room.type)
        extra = room.type.lower() in beyond or kind in {"hallway", "storage"}
        placed: tuple[Item, ...] = ()
        if number in rich or (kind and extra and rng.random() >= bare[kind]):
            recipe = KINDS[room.type]
            deal = wanted.deal(seed, room.type, counts[recipe], index % BLOCK)
            counts[recipe] += 1
            placed = furnish_room(seed, index, number, plan, stock, style, deal, rich=number in rich)
        items += [item if item.support < 0 else replace(item, support=item.support + len(items)) for item in placed]
        empty.append(not placed)
    return House(str(uuid.UUID(int=key(seed, "uid", index), version=4)), index, plan, tuple(items), tuple(empty))


def rooms_to_furnish(plan: Plan, furnished: Sequence[str]) -> list[int]:
    """Return the rooms that are furnished as the agenda asks for: the first ones of each type."""
    left = Counter("Hallway" if t in CORRIDORS else t for t in furnished)
    numbers = []
    for number, room in enumerate(plan.rooms):
        name = "Hallway" if room.type in CORRIDORS else room.type
        if left[name]:
            left[name] -= 1
            numbers.append(number)
    return numbers
