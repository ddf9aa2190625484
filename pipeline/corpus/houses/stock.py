"""The furniture that houses are furnished from, by category, and where things can lie on and in it: the level tops of its solids."""

import functools
import math
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline import style
from pipeline.card import cards
from pipeline.corpus.furniture.assembly import shape_of
from pipeline.corpus.furniture.catalogue import SERIES, Model
from pipeline.geometry.convex import rectangle_in

LEVEL = 1e-4  # vertices within this height of the highest lie on the top [m]
LEAST = 0.07  # narrowest top that anything lies on [m]
STYLE_WEIGHT = 3.0  # how much likelier a model in the house's own style is taken than another
SERIES_WEIGHT = 60.0  # the same of the series that the house's kitchen is of


@dataclass(frozen=True, slots=True)
class Surfaces:
    """A model's solids and tops, object frame [m].

    `boxes` (n, 2, 3) are the solids' bounds, `tops` (m, 5) the level rectangles (x0, y0, x1, y1, z).
    """

    boxes: NDArray[np.float64]
    tops: NDArray[np.float64]


@functools.lru_cache(maxsize=2048)
def surfaces_of(model: Model) -> Surfaces:
    """Return the surfaces of a model at rest."""
    boxes, tops = [], []
    for piece in shape_of(model).pieces():
        vertices = piece.solid.vertices
        boxes.append(piece.solid.bounds())
        on_top = (vertices[:, 2] > vertices[:, 2].max() - LEVEL).tolist()
        faces = [vertices[list(face)] for face in piece.solid.faces if all(on_top[k] for k in face)]
        tops += [(*inside, float(face[:, 2].max())) for face in faces if (inside := rectangle_in(face[:, :2], LEAST))]
    return Surfaces(np.array(boxes).reshape(-1, 2, 3), np.array(tops).reshape(-1, 5))


class Stock:
    """Models by category, in the catalogue's order; `surfaces` tells where things can lie on a model (by default nowhere)."""

    def __init__(self, models: Sequence[Model], surfaces: Callable[..., Surfaces | None] = lambda _: None) -> None:
        self.surfaces = surfaces
        self.by_category: dict[str, list[Model]] = defaultdict(list)
        for model in models:
            self.by_category[model.category].append(model)
        self.styles = tuple(sorted({m.style for m in models if m.style}))

    def pick(self, rng: np.random.Generator, category: str, style_name: str, most: Sequence[float], narrowest: float = 0.0) -> Model | None:
        """Draw a model of a category no larger than `most` (w, d, h) and no narrower than that [m]; None if there is none."""
        models = self.by_category.get(category, ())
        fitting = [m for m in models if m.size[0] >= narrowest and all(a <= b for a, b in zip(m.size, most, strict=True))]
        if not fitting:
            return None
        series = cards()[category].corpus.series
        wanted, more = (self._series_of(style_name), SERIES_WEIGHT) if series else (style_name, STYLE_WEIGHT)
        weights = [more if m.style == wanted else 1.0 for m in fitting]
        mark = rng.random() * sum(weights)
        for model, weight in zip(fitting, weights, strict=True):
            mark -= weight
            if mark <= 0:
                return model
        return fitting[-1]

    def _series_of(self, style_name: str) -> str:
        """Return the series of kitchen units that goes with a house's style: its own where there is one."""
        names = style.load().groups[SERIES]
        return style_name if style_name in names or style_name not in self.styles else names[self.styles.index(style_name) % len(names)]

    def least(self, category: str) -> tuple[float, float]:
        """Return the smallest width and depth among a category's models [m]; infinite if there is none."""
        models = self.by_category.get(category, ())
        return min((m.size[0] for m in models), default=math.inf), min((m.size[1] for m in models), default=math.inf)
