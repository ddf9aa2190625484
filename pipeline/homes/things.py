"""Small things of a finished home: cups on tables, books on shelves, a laptop on the desk, now and then something in a drawer."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

import numpy as np

from pipeline.arrange import Laying, ThingsSettings
from pipeline.corpus.houses import rates
from pipeline.entities.home import Home, Placement
from pipeline.homes.library import Library

STYLE_WEIGHT = 3.0  # how much likelier a thing in the style of its support is taken than another
# Things with a front, which look where their support looks.
FACING = frozenset(
    {"laptop", "keyboard", "printer", "toaster", "coffee_machine", "table_lamp", "storage_box", "book", "camera", "briefcase"}
)


def expected() -> Mapping[str, Mapping[str, float]]:
    """Return by category of furniture how many of each small thing lie on or in one piece of it, as in the embedded corpus."""
    found: Mapping[str, Mapping[str, float]] = rates.load()["things"]["furniture"]
    return found


def placeable() -> frozenset[str]:
    """Return the categories of small things that homes may hold."""
    return frozenset(name for wanted in expected().values() for name in wanted)


def small_things(home: Home, library: Library, settings: ThingsSettings, rng: np.random.Generator, touch: float) -> tuple[Placement, ...]:
    """Return small things for a home that is sound; each names its `support`. They depend on the home and the generator alone.

    What finds no place in `settings.tries` tries is not missed: nobody has asked for it.
    """
    if settings.rate <= 0:
        return ()
    wanted = expected()
    found: list[Placement] = []
    for room in home.plan.rooms:
        furniture = home.in_room(room.room_id)
        if not any(p.category in wanted for p in furniture):
            continue
        laying = Laying(room.polygon, furniture, library, settings, touch)
        count: Counter[str] = Counter()
        for number, support in enumerate(furniture):
            for category, mean in wanted.get(support.category, {}).items():
                for _ in range(int(mean * settings.rate + rng.random())):
                    asset_id = _picked(rng, library, category, library.rows[support.asset_id]["style"])
                    place = laying.lay(rng, library[asset_id], number, facing=category in FACING) if asset_id else None
                    if place is None:
                        continue
                    name = f"{room.room_id}_{category}_{count[category]}"
                    size = np.round(library[asset_id].size, 4)
                    found.append(Placement(name, room.room_id, category, asset_id, *place, size, support=support.object_id))
                    count[category] += 1
    return tuple(found)


def _picked(rng: np.random.Generator, library: Library, category: str, style: str) -> str:
    """Draw an asset of a category, rather one of that style; "" if the library has none."""
    shelf = library.of(category)
    if not shelf:
        return ""
    weights = np.array([STYLE_WEIGHT if style and library.rows[a]["style"] == style else 1.0 for a in shelf])
    return shelf[int(rng.choice(len(shelf), p=weights / weights.sum()))]
