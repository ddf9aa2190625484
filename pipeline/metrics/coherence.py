"""Whether the things of a home go together: one style, sets of one model, one finish; and how many there are."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from pipeline.card import cards
from pipeline.metrics.intervals import Mean, bootstrap
from pipeline.metrics.rows import Row, by_room

ALIKE = 10.0  # finishes that differ by no more look alike from across a room [CIELAB]


def coherence(
    rng: np.random.Generator, objects: Iterable[Row], styles: Mapping[str, str], finishes: Mapping[str, NDArray[np.float64]]
) -> dict[str, Mean]:
    """Return figures of the homes whose objects these are; `styles` and `finishes` (3,) CIELAB by asset, of those that have one.

    "things": of all kinds, a home. "style": share of a home's furniture (what the layout model places) that is of its commonest style. "one model of ...": share of
    the rooms with several chairs, nightstands and other things that come in sets (`set` on their cards) in which all are one model.
    "finish of ...": share of a room's things of a group (`finish` on their cards) that look like one another, for the largest such part.
    """
    rooms = by_room(objects)
    homes: dict[str, list[Row]] = {}
    for (scene_id, _), rows in rooms.items():
        homes.setdefault(scene_id, []).extend(rows)
    figures: dict[str, list[float]] = {"things": [len(rows) for rows in homes.values()]}
    known = cards().values()
    furniture = {card.name for card in known if card.layout}
    styled = [
        [styles[row["asset_id"]] for row in rows if row["category"] in furniture and row["asset_id"] in styles] for rows in homes.values()
    ]
    figures["style"] = [Counter(own).most_common(1)[0][1] / len(own) for own in styled if len(own) > 1]
    for category in (card.name for card in known if card.set):
        models = [[row["asset_id"] for row in rows if row["category"] == category] for rows in rooms.values()]
        figures[f"one model of {category}"] = [float(len(set(own)) == 1) for own in models if len(own) > 1]
    for group in sorted({card.finish for card in known} - {""}):
        members = {card.name for card in known if card.finish == group}
        colours = [
            [finishes[row["asset_id"]] for row in rows if row["category"] in members and row["asset_id"] in finishes]
            for rows in rooms.values()
        ]
        figures[f"finish of {group}"] = [_alike(own) for own in colours if len(own) > 1]
    return {name: bootstrap(rng, values) for name, values in figures.items() if values}


def _alike(colours: Sequence[NDArray[np.float64]]) -> float:
    """Return the share of colours (3,) that are within ALIKE of one of them, at the one that has most."""
    own = np.array(colours, float)
    apart = np.linalg.norm(own[:, None] - own[None], axis=2)
    return float((apart <= ALIKE).mean(1).max())


def tastes(assets: Iterable[Row], latents: Iterable[Row]) -> tuple[dict[str, str], dict[str, NDArray[np.float64]]]:
    """Return styles and finishes by asset, from rows of the assets table and of the latents table; assets without are missing."""
    styles = {row["asset_id"]: row["style"] for row in assets if row["style"]}
    return styles, {row["asset_id"]: np.array(row["finish"]) for row in latents if row["finish"] is not None}
