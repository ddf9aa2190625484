"""Kitchen units of one style are of one series, and are worked at in one height."""

import pytest

from pipeline import style
from pipeline.corpus.furniture.assembly import finishes_of, shape_of
from pipeline.corpus.furniture.catalogue import SERIES, catalogue, corpus_cards

UNITS = sorted(name for name, card in corpus_cards().items() if card.series)
MODELS = [model for seed in (0, 1) for model in (*catalogue(seed).future, *catalogue(seed).partnet)]


def tops(model):
    return [piece for piece in shape_of(model).base if piece.name == "top"]


def test_every_series_has_units_of_each_kind():
    names = set(style.load().groups[SERIES])
    for seed in (0, 1):
        for category in ("kitchen_cabinet", "sink_cabinet", "wall_cabinet"):
            assert {model.style for model in catalogue(seed).partnet if model.category == category} == names, category


@pytest.mark.parametrize("name", style.load().groups[SERIES])
def test_units_of_a_series_have_one_front_one_worktop_and_one_handle(name):
    own = [model for model in MODELS if model.category in UNITS and model.style == name]
    assert len(own) > 10
    assert len({finishes_of(model).front for model in own}) == 1
    assert len({finishes_of(model).handle for model in own}) == 1
    base = [model for model in own if model.category in {"kitchen_cabinet", "sink_cabinet"}]
    assert len({piece.finish for model in base for piece in tops(model)}) == 1


def test_one_works_at_one_height():
    heights = [
        max(piece.solid.bounds()[1, 2] for piece in tops(model))
        for model in MODELS
        if model.category in {"kitchen_cabinet", "sink_cabinet"}
    ]
    assert min(heights) > 0.88
    assert max(heights) < 0.92
