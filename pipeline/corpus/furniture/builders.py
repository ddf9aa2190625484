"""The functions that build models, as the cards of categories name them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from pipeline.card import cards
from pipeline.corpus.furniture import (
    appliances,
    bath,
    beds,
    ceiling_lamps,
    containers,
    countertop,
    desks,
    dining_tables,
    doorways,
    electronics,
    homeware,
    kids_beds,
    kitchen,
    lamps,
    linen,
    lounge,
    plants,
    seating,
    shelves,
    side_tables,
    sofas,
    stools,
    storage,
    tableware,
    textiles,
    wall_decor,
)
from pipeline.corpus.furniture.finishes import Scheme
from pipeline.corpus.furniture.shape import Shape
from pipeline.errors import ContentError

Builder = Callable[[np.random.Generator, str, Sequence[float], Scheme], Shape]

MODULES = (
    appliances, bath, beds, ceiling_lamps, containers, countertop, desks, doorways, electronics, homeware, kids_beds, kitchen, lamps, linen,
    lounge, plants, seating, shelves, side_tables, sofas, stools, storage, dining_tables, tableware, textiles, wall_decor,
)  # fmt: skip


def builder(category: str) -> Builder:
    """Return the function that the card of a category names as "module.function". Raises ContentError where there is none."""
    module, _, name = cards()[category].corpus.builder.partition(".")
    function: Builder | None = getattr(next((m for m in MODULES if m.__name__.endswith(f".{module}")), None), name, None)
    if function is None:
        raise ContentError(f"manifests/categories/{category}.yaml: no builder {module}.{name}", "see pipeline/corpus/furniture/builders.py")
    return function
