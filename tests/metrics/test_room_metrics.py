"""Relation rates, two-sample tests, novelty: right on rooms that were furnished by hand, and blind to no harm."""

import numpy as np
import pytest

from pipeline.metrics import novelty, relations
from pipeline.metrics.layout_features import features
from pipeline.metrics.rules import RULES, backs
from pipeline.metrics.two_samples import forest_accuracy, frechet, kernel_distance, linear_accuracy
from pipeline.metrics.views import HARMS, jitter, permute_yaws, spoilt, swap_places
from pipeline.relations import learning
from pipeline.relations.arrangement import make_arrangement
from tests.relations.making import bedrooms

SQUARE = np.array([[0.0, 0], [5, 0], [5, 5], [0, 5]])
CHAIR, TABLE, SOFA, UNIT = (0.5, 0.5, 0.9), (1.4, 0.8, 0.75), (2.0, 0.9, 0.8), (0.6, 0.6, 0.9)


def room(*things, kind="living_dining_room"):
    return make_arrangement("room", kind, SQUARE, [(c, [x, y, 0.0], yaw, size) for c, x, y, yaw, size in things])


def verdicts(name, *things, **said):
    return list(RULES[name](room(*things, **said)))


TABLE_AT = ("dining_table", 2.5, 2.5, 0.0, TABLE)


@pytest.mark.parametrize(
    ("x", "y", "yaw", "right"),
    [
        (2.2, 1.9, np.pi, True),  # before the long side, facing it
        (2.2, 1.9, 0.0, False),  # with its back to it
        (1.4, 2.5, np.pi / 2, True),  # at its end
        (1.4, 2.5, -np.pi / 2, False),
        (2.2, 1.3, np.pi, False),  # half a metre away
    ],
)
def test_chairs_at_their_table(x, y, yaw, right):
    assert verdicts("chair at its table", TABLE_AT, ("dining_chair", x, y, yaw, CHAIR)) == [right]


def test_a_rule_without_a_case_says_nothing():
    assert verdicts("chair at its table", ("dining_chair", 1, 1, 0.0, CHAIR)) == []
    assert verdicts("bathroom has shower or tub", kind="bedroom") == []


def test_sofa_coffee_table_and_screen():
    sofa, table = ("multi_seat_sofa", 2.5, 4.5, 0.0, SOFA), ("coffee_table", 2.5, 3.4, 0.0, (1.0, 0.6, 0.4))
    screen = ("tv_stand", 2.5, 0.3, np.pi, (1.6, 0.4, 0.5))
    assert verdicts("sofa looks at the TV stand", sofa, screen) == [True]
    assert verdicts("sofa looks at the TV stand", sofa, ("tv_stand", 2.5, 0.3, 0.0, (1.6, 0.4, 0.5))) == [False]
    assert verdicts("sofa looks at the TV stand", ("multi_seat_sofa", 2.5, 4.5, np.pi, SOFA), screen) == [False]
    assert verdicts("coffee table before a sofa", sofa, table) == [True]
    assert verdicts("coffee table before a sofa", ("multi_seat_sofa", 2.5, 4.5, np.pi, SOFA), table) == [False]


def test_nightstands_and_kitchen_units():
    bed = ("double_bed", 2.5, 3.9, 0.0, (1.8, 2.1, 0.5))
    stand = (0.45, 0.4, 0.5)
    assert verdicts("nightstand at the bed", bed, ("nightstand", 3.7, 4.75, 0.0, stand)) == [True]
    assert verdicts("nightstand at the bed", bed, ("nightstand", 3.7, 3.0, 0.0, stand)) == [False]
    assert verdicts("nightstand at the bed", bed, ("nightstand", 3.7, 4.75, np.pi, stand)) == [False]
    row = [("kitchen_cabinet", x, 4.7, 0.0, UNIT) for x in (1.0, 1.62, 3.5)]
    assert verdicts("kitchen unit in a run", *row, kind="kitchen") == [True, True, False]
    assert verdicts("kitchen unit in a run", row[0], ("oven", 1.62, 4.7, np.pi, UNIT), kind="kitchen") == [False, False]


def test_backs_and_straightness():
    rule = backs(frozenset({"wardrobe"}))
    wardrobe = (1.0, 0.6, 2.0)
    assert list(rule(room(("wardrobe", 2, 4.7, 0.0, wardrobe)))) == [True]
    assert list(rule(room(("wardrobe", 2, 4.7, np.pi, wardrobe)))) == [False]
    assert list(rule(room(("wardrobe", 2, 4.3, 0.0, wardrobe)))) == [False]
    assert verdicts("straight, to 3 degrees", ("wardrobe", 2, 2, np.pi / 2 + 0.04, wardrobe)) == [True]
    assert verdicts("straight, to 3 degrees", ("wardrobe", 2, 2, np.pi / 2 + 0.06, wardrobe)) == [False]


@pytest.fixture(scope="module")
def samples():
    rng = np.random.default_rng(1)
    made = bedrooms(rng, 200)
    return made[:100], made[100:], learning.fit(made)


def test_learnt_relations_are_rates_and_harm_breaks_them(samples):
    real, other, known = samples
    rng = np.random.default_rng(2)
    found = relations.compare(rng, {"real": real, "other": other, "jittered": [jitter(rng, r) for r in other]}, known)
    learnt = (
        found["learnt"]["double_bed at nightstand"]
        if "double_bed at nightstand" in found["learnt"]
        else found["learnt"]["nightstand at double_bed"]
    )
    assert learnt["real"]["rate"] > 0.95
    assert learnt["other"]["rate"] > 0.95
    assert learnt["jittered"]["rate"] < 0.3
    back = found["rates"]["back at the wall"]
    assert back["real"]["rate"] > 0.95 > back["jittered"]["rate"]
    assert found["objects"]["all"]["real"]["mean"] == 5
    assert "bedroom" in found["objects"]


@pytest.mark.parametrize("harm", [*HARMS.values(), spoilt])
def test_the_forest_sees_every_harm_and_nothing_where_there_is_none(samples, harm):
    real, other, _ = samples
    rng = np.random.default_rng(3)
    names = [str(k) for k in range(100)]
    plain = features(real)
    assert forest_accuracy(0, plain, features([harm(rng, r) for r in real]), names, names)["rate"] >= 0.8
    assert forest_accuracy(0, plain, features(other), names, names)["rate"] < 0.65


def test_harm_keeps_what_it_does_not_spoil():
    rng = np.random.default_rng(0)
    before = bedrooms(rng, 1)[0]
    moved = jitter(rng, before)
    assert np.allclose(np.linalg.norm((moved.position - before.position)[:, :2], axis=1), 0.2)
    assert sorted(permute_yaws(rng, before).yaw) == pytest.approx(sorted(before.yaw))
    assert sorted(map(tuple, swap_places(rng, before).position[:, :2])) == sorted(map(tuple, before.position[:, :2]))
    empty = make_arrangement("empty", "bedroom", SQUARE, [])
    assert spoilt(rng, empty).categories == ()
    assert features([empty]).shape == features([before]).shape


def test_distances_between_gaussians():
    rng = np.random.default_rng(0)
    a, b = rng.normal(size=(4000, 3)), rng.normal(size=(4000, 3)) * [1, 2, 1] + [1, 0, 0]
    assert frechet(a, b) == pytest.approx(1 + (2 - 1) ** 2, abs=0.15)  # |mean difference|^2 + (sigma - sigma')^2
    assert frechet(a, a) == pytest.approx(0, abs=1e-6)
    same, other = kernel_distance(rng, a[:2000], a[2000:]), kernel_distance(rng, a, b)
    assert same["low"] < 0 < same["high"]
    assert other["low"] > 0
    names = [str(k) for k in range(400)]
    assert linear_accuracy(0, a[:400], a[400:800], names, names)["rate"] == pytest.approx(0.5, abs=0.08)
    assert linear_accuracy(0, a[:400], b[:400] + 3, names, names)["rate"] > 0.9


def test_copies_are_found_whatever_way_they_are_turned(samples):
    real, other, _ = samples
    found = novelty.novelty(real[:20], other[:20], other[20:])
    assert found["copies"] == 0
    copies = novelty.novelty(real[:20], other[:20], [*real[10:30], *other[20:]])
    assert copies["copies"] == 10
    mirrored = make_arrangement(
        "m",
        "bedroom",
        real[0].polygon * [-1, 1],
        [(c, p * [-1, 1, 1], -y, s) for c, p, y, s in zip(real[0].categories, real[0].position, real[0].yaw, real[0].size, strict=True)],
    )
    assert novelty.distance(mirrored, real[0]) == pytest.approx(0, abs=1e-9)
    assert novelty.distance(real[0], make_arrangement("e", "bedroom", SQUARE, [])) == 1
