"""Assembly: a catalogue model becomes a shape of its exact size, by the function that the card of its category names."""

import functools
import importlib
from collections.abc import Callable

import numpy as np

from pipeline import seeds
from pipeline.card import cards
from pipeline.corpus.furniture.catalogue import Model, series_rng
from pipeline.corpus.furniture.finishes import LEATHERS, Finishes, draw_finishes
from pipeline.corpus.furniture.shape import Pieces, Shape, fit_to_size, freeze
from pipeline.errors import ContentError

Builder = Callable[[np.random.Generator, str, float, float, float, Finishes], Shape | Pieces]


def builder(category: str, form: str) -> Builder:
    """Return the function that the card of a category names for a form as "module.function". Raises ContentError where there is none."""
    card = cards()[category].corpus
    module, _, name = (card.forms[form].builder or card.builder).partition(".")
    try:
        function: Builder = getattr(importlib.import_module(f"{__package__}.{module}"), name)
    except (ImportError, AttributeError):
        where = f"manifests/categories/{category}.yaml"
        raise ContentError(f"{where}: no builder {module}.{name}", "name a function of pipeline/corpus/furniture") from None
    return function


def finishes_of(model: Model) -> Finishes:
    """Return the finishes of a model."""
    own = series_rng(model.style) if cards()[model.category].corpus.series else seeds.generator(model.seed, "corpus.furniture.finish")
    return draw_finishes(own, model.style)


def main_material(model: Model) -> str:
    """Return 3D-FUTURE's word for the main material."""
    word = cards()[model.category].corpus.material
    finishes = finishes_of(model)
    if word == "soft":
        return "Leather" if finishes.soft.name.removesuffix("_2") in LEATHERS else "Cloth"
    return word or finishes.material


@functools.lru_cache(maxsize=16)
def shape_of(model: Model) -> Shape:
    """Return the shape of a model, its box exactly `model.size`; static models have their movers fixed."""
    rng = seeds.generator(model.seed, "corpus.furniture.shape")
    built = builder(model.category, model.form)(rng, model.form, *model.size, finishes_of(model))
    shape = fit_to_size(built if isinstance(built, Shape) else Shape(built), model.size)
    return shape if model.articulated else freeze(shape)
