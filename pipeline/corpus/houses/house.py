"""One house from (seed, index, stock)."""

import uuid
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from pipeline.corpus import front_statistics
from pipeline.corpus.houses import furnish, rates
from pipeline.corpus.houses.planner import make_plan
from pipeline.corpus.houses.records import House, Item
from pipeline.corpus.houses.room_sampling import BLOCK, CORRIDORS, KINDS, agenda
from pipeline.corpus.houses.stock import Stock
from pipeline.entities.plan import Plan
from pipeline.seeds import generator, key


def make_house(seed: int, index: int, stock: Stock) -> House:
    """Plan and furnish house `index`."""
    rng = generator(seed, "house", index)
    wanted = agenda(seed, index)
    plan = make_plan(rng, wanted.rooms)
    style = furnish.style_of(rng, stock)
    rich = set(rooms_to_furnish(plan, wanted.rooms))
    beyond, bare = front_statistics.load().beyond, rates.load()["bare"]
    items: list[Item] = []
    empty = []
    counts: Counter[str] = Counter()
    for number, room in enumerate(plan.rooms):
        kind = furnish.layout_type(room.type)
        extra = room.type.lower() in beyond or kind in {"hallway", "storage"}
        placed: tuple[Item, ...] = ()
        if number in rich or (kind and extra and rng.random() >= bare[kind]):
            recipe = KINDS[room.type]
            deal = wanted.deal(seed, room.type, counts[recipe], index % BLOCK)
            counts[recipe] += 1
            placed = furnish.furnish_room(seed, index, number, plan, stock, style, deal, rich=number in rich)
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
