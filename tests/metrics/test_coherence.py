"""Things that go together, things that do not, and how the figures tell."""

import numpy as np
import pytest

from pipeline.metrics.coherence import coherence, tastes

WHITE, CREAM, BLACK = np.array([95.0, 0, 0]), np.array([90.0, 1, 6]), np.array([10.0, 0, 0])


def things(room, *pairs, home="a"):
    return [{"scene_id": home, "room_id": room, "category": category, "asset_id": asset} for category, asset in pairs]


def means(objects, styles=None, finishes=None):
    return {name: value["mean"] for name, value in coherence(np.random.default_rng(0), objects, styles or {}, finishes or {}).items()}


def test_sets_of_one_model_count_by_room():
    same = things("dining", ("dining_chair", "x"), ("dining_chair", "x"), ("dining_table", "t"))
    mixed = things("living", ("dining_chair", "x"), ("dining_chair", "y"))
    lone = things("study", ("dining_chair", "z"))
    figures = means(same + mixed + lone)
    assert figures["one model of dining_chair"] == 0.5
    assert figures["things"] == 6
    assert "one model of nightstand" not in figures


def test_style_is_the_share_of_a_homes_commonest():
    objects = things("r", ("armchair", "a"), ("armchair", "b"), ("armchair", "c"), ("armchair", "plain")) + things(
        "r", ("armchair", "a"), ("armchair", "b"), home="b"
    )
    objects += things("r", ("cup", "c"), ("cup", "c"), ("cup", "c"))  # small things have no say
    figures = means(objects, {"a": "modern", "b": "modern", "c": "classic"})
    assert figures["style"] == pytest.approx((2 / 3 + 1) / 2)


def test_finishes_that_look_alike():
    kitchen = things("k", *(("kitchen_cabinet", name) for name in "abcd"))
    figures = means(kitchen, finishes={"a": WHITE, "b": CREAM, "c": WHITE, "d": BLACK})
    assert figures["finish of kitchen"] == pytest.approx(3 / 4)


def test_what_has_no_style_or_finish_is_left_out():
    styles, finishes = tastes(
        [{"asset_id": "a", "style": ""}, {"asset_id": "b", "style": "modern"}],
        [{"asset_id": "a", "finish": None}, {"asset_id": "b", "finish": [1.0, 2.0, 3.0]}],
    )
    assert styles == {"b": "modern"}
    assert list(finishes) == ["b"]
    assert finishes["b"].tolist() == [1.0, 2.0, 3.0]


def test_no_homes_have_no_figures():
    assert means([]) == {}
