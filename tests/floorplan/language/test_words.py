"""Numbers, amounts, typing errors."""

import pytest

from pipeline.floorplan.language.items import number_at, sentences
from pipeline.floorplan.language.lexicon import plural
from pipeline.floorplan.language.spelling import distance, repair
from pipeline.floorplan.language.tokens import tokenize


@pytest.mark.parametrize(
    ("text", "value"),
    [("seven", 7), ("twenty five", 25), ("1,900", 1900), ("one hundred and ten", 110), ("2.5", 2.5), ("2,5", 2.5), ("two hundred", 200), ("1.250", 1250)],
)  # fmt: skip
def test_numbers(text, value):
    assert number_at(tokenize(text), 0)[0] == value


@pytest.mark.parametrize(
    ("text", "low", "high", "bound", "unit"),
    [
        ("at least 18 m²", 18, None, "least", "area"),
        ("10 to 12 m²", 10, 12, "", "area"),
        ("10-12 sqm", 10, 12, "", "area"),
        ("7 m² or more", 7, None, "least", "area"),
        ("about 100 sq ft", 9.2903, None, "about", "area"),
        ("1.2 m", 1.2, None, "", "length"),
        ("90 cm", 0.9, None, "", "length"),
        ("70 %", 0.7, None, "", "share"),
        ("eight pieces of furniture", 8, None, "", "pieces"),
    ],
)
def test_amounts(text, low, high, bound, unit):
    (item,) = sentences(tokenize(text))[0]
    assert item.number == pytest.approx(low)
    assert item.high == (None if high is None else pytest.approx(high))
    assert (item.bound, item.unit) == (bound, unit)


@pytest.mark.parametrize(
    ("wrong", "right"),
    [("bedrom", "bedroom"), ("kichten", "kitchen"), ("batroom", "bathroom"), ("livign", "living"), ("balconny", "balcony")],
)
def test_typing_errors_are_repaired(wrong, right):
    assert repair(tokenize(wrong))[0].text == right


@pytest.mark.parametrize("word", ["house", "couch", "both", "tall", "without", "xylophone"])
def test_other_words_are_left_alone(word):
    assert repair(tokenize(word))[0].text == word


def test_distance_is_a_bounded_metric():
    assert distance("kitchen", "kitchen", 2) == 0
    assert distance("ktichen", "kitchen", 2) == 1  # neighbours swapped
    assert distance("abc", "xyz", 2) == 3
    assert distance("hall", "halls", 2) == distance("halls", "hall", 2) == 1


def test_plurals():
    assert [plural(w) for w in ("balcony", "bath", "walk in closet", "wc", "library")] == [
        "balconies",
        "baths",
        "walk in closets",
        "wcs",
        "libraries",
    ]
