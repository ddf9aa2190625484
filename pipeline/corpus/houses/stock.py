"""The furniture that houses are furnished from, by category."""

import math
from collections import defaultdict
from collections.abc import Callable, Sequence

import numpy as np

from pipeline.corpus.furniture.catalogue import Model
from pipeline.corpus.furniture.level_tops import Surfaces

STYLE_WEIGHT = 3.0
"""How much likelier a model in the house's own style is taken than another."""


class Stock:
    """Models by category, in the catalogue's order; `surfaces` tells where things can lie on a model (by default nowhere)."""

    def __init__(self, models: Sequence[Model], surfaces: Callable[..., Surfaces | None] = lambda _: None) -> None:
        self.surfaces = surfaces
        self.by_category: dict[str, list[Model]] = defaultdict(list)
        for model in models:
            self.by_category[model.category].append(model)
        self.styles = tuple(sorted({m.style for m in models if m.style}))

    def pick(
        self,
        rng: np.random.Generator,
        category: str,
        style: str,
        *,
        width: float = math.inf,
        depth: float = math.inf,
        height: float = math.inf,
        narrowest: float = 0.0,
    ) -> Model | None:
        """Draw a model of a category no larger than the limits [m]; None if there is none."""
        fitting = [
            m for m in self.by_category.get(category, ()) if narrowest <= m.size[0] <= width and m.size[1] <= depth and m.size[2] <= height
        ]
        if not fitting:
            return None
        weights = [STYLE_WEIGHT if m.style == style else 1.0 for m in fitting]
        mark = rng.random() * sum(weights)
        for model, weight in zip(fitting, weights, strict=True):
            mark -= weight
            if mark <= 0:
                return model
        return fitting[-1]

    def least(self, category: str) -> tuple[float, float]:
        """Return the smallest width and depth among a category's models [m]; infinite if there is none."""
        models = self.by_category.get(category, ())
        return min((m.size[0] for m in models), default=math.inf), min((m.size[1] for m in models), default=math.inf)
