import numpy as np
import pytest
import torch

from pipeline import seeds
from pipeline.diffusion.context import CategoryBounds, RoomContext, RoomOpening, floor_tokens
from pipeline.diffusion.inventory import (
    DRAWS,
    Ask,
    Holdings,
    Inventory,
    draw_inventories,
    fit,
    free_stretches,
    initial_inventory,
    repair_counts,
    room_features,
)
from pipeline.diffusion.poses import UNTOLD
from pipeline.diffusion.settings import InventorySettings
from tests.diffusion.small_world import CLASSES, LAYOUTS, make_examples

BED, NIGHTSTAND, TABLE, CHAIR = (CLASSES.index(c) for c in ("double_bed", "nightstand", "dining_table", "dining_chair"))


@pytest.fixture(scope="module")
def rooms():
    made = make_examples(200)
    features = np.stack([room_features(e.floor, e.context.height) for e in made])
    classes, poses = (
        np.stack([np.pad(v, (0, 12 - len(v)), constant_values=c) for v in each])
        for each, c in (([e.classes for e in made], len(CLASSES)), ([e.poses for e in made], UNTOLD))
    )
    counts = np.stack([np.bincount(e.classes, minlength=len(CLASSES)) for e in made])
    return Holdings(features, np.array([e.layout for e in made]), counts, classes, poses)


@pytest.fixture(scope="module")
def net(rooms):
    torch.set_num_threads(1)
    return fit(initial_inventory(rooms, len(LAYOUTS), 16, 0), rooms, InventorySettings(16, steps=150, batch=64), 0)


def drawn(net, rooms, asks, seed=0):
    features, layouts, *_ = rooms
    n = len(asks)
    uniform = seeds.generator(seed, "draws").random((n, DRAWS, len(CLASSES)))
    return np.stack(draw_inventories(net, torch.from_numpy(features[:n]), torch.from_numpy(layouts[:n]), asks, uniform))


def test_rooms_hold_what_rooms_of_their_type_hold(net, rooms):
    found = drawn(net, rooms, [Ask(None)] * 200)
    layouts, counts = rooms[1], rooms[2]
    for layout in range(len(LAYOUTS)):
        real, made = (c[layouts[:200] == layout].mean(0) for c in (counts, found))
        np.testing.assert_allclose(made, real, atol=0.2)


def test_the_tail_of_the_net_is_never_drawn_and_what_is_asked_for_all_the_same_is_the_least(rooms):
    tailed = initial_inventory(rooms, len(LAYOUTS), 16, 0)
    with torch.no_grad():
        tailed.own[:] = torch.log(torch.tensor([0.7, 0.28, *[0.002] * 11]))
    found = drawn(tailed, rooms, [Ask(None)] * 200)
    assert found.max() == 1
    asked = drawn(tailed, rooms, [Ask.of(None, (CategoryBounds(("dining_chair",), 2),), CLASSES)] * 200)
    assert (asked[:, CHAIR] == 2).all()


@pytest.mark.parametrize("total", [1, 3, 7, 24])
def test_a_told_number_is_met_exactly(net, rooms, total):
    assert (drawn(net, rooms, [Ask(total)] * 20).sum(1) == total).all()


def test_demands_are_met_with_and_without_a_number(net, rooms):
    asks = [
        Ask.of(None, (CategoryBounds(("nightstand",), 3),), CLASSES),
        Ask.of(9, (CategoryBounds(("dining_chair",), 5, 5),), CLASSES),
        Ask.of(None, (CategoryBounds(("double_bed", "dining_table"), 2, 2), CategoryBounds(("nightstand",), 0, 0)), CLASSES),
        Ask.of(4, (CategoryBounds(("wardrobe",), 1, 1), CategoryBounds(("double_bed",), 0, 0)), CLASSES),
    ]
    found = drawn(net, rooms, asks)
    for ask, counts in zip(asks, found, strict=True):
        assert ask.met_by(counts[None])[0]
    assert found[1, CHAIR] == 5


def test_free_draws_that_meet_a_wish_are_not_distorted(net, rooms):
    """Every dining room of the small world holds four chairs: to ask for one chair at least changes nothing."""
    wish = Ask.of(None, (CategoryBounds(("dining_chair", "double_bed"), 1),), CLASSES)
    assert (drawn(net, rooms, [wish] * 60) == drawn(net, rooms, [Ask(None)] * 60)).all(1).mean() > 0.9


def test_what_is_not_there_alone_gets_company_and_does_not_go(rooms):
    either = Inventory(len(CLASSES), len(LAYOUTS), 16)  # none or one of each class, by the toss of a coin
    with torch.no_grad():
        either.own[..., 2:] = -30.0
    bound, pair = (CategoryBounds(("wardrobe",), 0, 1),), ((("nightstand",), ("double_bed", "unknown"), 1),)
    ask = Ask.of(None, bound, CLASSES, company=pair)
    free, asked = drawn(either, rooms, [Ask(None)] * 60), drawn(either, rooms, [ask] * 60)
    whole = ask.met_by(free)
    assert 30 < whole.sum() < 58
    assert (asked[whole] == free[whole]).all()
    assert ask.met_by(asked).all()
    assert {tuple(row) for row in asked[:, [NIGHTSTAND, BED]]} == {(0, 0), (0, 1), (1, 1)}
    assert (asked[:, NIGHTSTAND] >= free[:, NIGHTSTAND]).all(), "who was drawn without company stays, and gets it"
    never = Ask.of(None, (*bound, CategoryBounds(("nightstand",), 0, 0), CategoryBounds(("double_bed",), 1)), CLASSES, company=pair)
    assert (drawn(either, rooms, [never] * 20)[:, [NIGHTSTAND, BED]] == [0, 1]).all(), "what is asked for outright goes before"


def test_what_is_asked_for_comes_with_its_company_and_what_is_said_of_that_stands(rooms):
    """A desk that is asked for had no chair: only what was drawn unasked got company."""
    seldom = Inventory(len(CLASSES), len(LAYOUTS), 16)  # nothing, nearly always; beds rather than chairs
    with torch.no_grad():
        seldom.own[..., 1:] = -12.0
        seldom.own[BED, :, 1] = -9.0
    pair = ((("nightstand",), ("dining_chair", "double_bed", "unknown"), 1),)
    wish = CategoryBounds(("nightstand",), 1)
    asked = drawn(seldom, rooms, [Ask.of(None, (wish,), CLASSES, company=pair)] * 30)
    chair = CLASSES.index("dining_chair")
    assert (asked[:, [NIGHTSTAND, BED]] == 1).all(), "of a group comes what rooms of the type hold most of"
    assert (asked.sum(1) == 2).all()
    bare = Ask.of(None, (wish, CategoryBounds(("double_bed", "dining_chair"), 0, 0)), CLASSES, company=pair)
    assert (drawn(seldom, rooms, [bare] * 30)[:, [NIGHTSTAND, BED, chair]] == [1, 0, 0]).all()


def test_company_may_be_of_several(net, rooms):
    """Dining rooms of the small world hold four chairs at a table; five are as rare as they are asked for."""
    ask = Ask.of(None, (), CLASSES, company=((("dining_table",), ("dining_chair",), 5),))
    free, asked = drawn(net, rooms, [Ask(None)] * 60), drawn(net, rooms, [ask] * 60)
    tables = free[:, CLASSES.index("dining_table")] > 0
    assert tables.any()
    assert (asked[tables][:, CLASSES.index("dining_table")] > 0).all()
    assert (asked[tables][:, CHAIR] >= 5).all()
    assert (asked[~tables] == free[~tables]).all()


def test_what_no_draw_meets_is_mended():
    usual = np.array([1.0, 2.0, 0.0, 0.0, 0.0, 0.5])
    ask = Ask(6, (((0,), 1, 1), ((2, 3), 2, None)))
    found = repair_counts(np.array([0, 0, 0, 0, 0, 9]), ask, usual)
    assert ask.met_by(found[None])[0]
    assert found[0] == 1


def test_a_room_is_never_empty_unless_nothing_may_be_there():
    assert repair_counts(np.zeros(3, np.int64), Ask(None), np.array([0.2, 0.9, 0.1])).tolist() == [0, 1, 0]
    nothing = Ask(None, (((0, 1, 2), 0, 0),))
    assert repair_counts(np.zeros(3, np.int64), nothing, np.array([0.2, 0.9, 0.1])).sum() == 0


def test_a_wish_for_a_class_that_the_model_does_not_know_asks_nothing():
    assert Ask.of(None, (CategoryBounds(("spaceship",), 1),), CLASSES).bounds == ()


def test_the_likelihood_is_a_distribution_over_counts(rooms):
    torch.manual_seed(0)
    small = Inventory(2, len(LAYOUTS), 8)
    with torch.no_grad():
        for p in small.parameters():
            p.normal_(0, 0.5)
        counts = torch.cartesian_prod(torch.arange(13), torch.arange(13))
        n = len(counts)
        features, kinds = torch.from_numpy(rooms[0][:1]).expand(n, -1), torch.zeros(n, dtype=torch.long)
        total = small(features, kinds, counts, torch.zeros(n, dtype=torch.bool)).exp().sum()
    assert float(total) == pytest.approx(1, abs=1e-4)


def test_features_do_not_change_when_the_room_is_turned():
    from dataclasses import replace

    floor = make_examples(1)[0].floor
    turn = np.array([[0, -1], [1, 0]], np.float32)
    turned = replace(floor, ends=floor.ends @ turn.T, normal=floor.normal @ turn.T)
    np.testing.assert_allclose(room_features(turned, 2.7), room_features(floor, 2.7), atol=1e-5)


@pytest.mark.parametrize(
    ("door", "hinge", "free", "before_windows"),
    [
        ((1.0, 1.9), 0, (3.0, 3.0, 2.1, 1.5), (4.0, 3.0, 3.0, 2.1)),
        ((0.1, 1.0), 0, (3.0, 3.0, 2.1, 1.5), (4.0, 3.0, 3.0, 2.1)),  # its leaf turns before the side wall, 0.9 m of which are lost
        ((0.1, 1.0), -1, (3.0, 3.0, 2.5, 1.5), (4.0, 3.0, 3.0, 2.5)),  # no leaf: half a metre to walk
    ],
)
def test_furniture_stands_where_neither_openings_nor_leaves_are(door, hinge, free, before_windows):
    polygon = np.array([[0, 0], [4, 0], [4, 3], [0, 3]], float)
    openings = (
        RoomOpening("door", np.array([[door[0], 0], [door[1], 0]]), hinge=hinge),
        RoomOpening("window", np.array([[2.5, 3], [1.5, 3]]), sill=0.9),
    )
    found = free_stretches(floor_tokens(RoomContext("bedroom", polygon, openings)))
    expected = [sorted(row, reverse=True) for row in (free, before_windows)]
    np.testing.assert_allclose(found, expected, atol=1e-5)


def test_the_fit_is_the_same_every_time(rooms):
    settings = InventorySettings(8, steps=5, batch=16)
    one, two = (fit(initial_inventory(rooms, len(LAYOUTS), 8, 3), rooms, settings, 3) for _ in range(2))
    assert all(torch.equal(a, b) for a, b in zip(one.state_dict().values(), two.state_dict().values(), strict=True))


def test_what_a_room_needs_does_not_make_it_fuller(net, rooms):
    """To ask for a thing that most rooms lack changes what they hold, not how much."""
    wish = Ask.of(None, (CategoryBounds(("dining_chair",), 1), CategoryBounds(("wardrobe",), 1)), CLASSES)
    asked, free = drawn(net, rooms, [wish] * 200), drawn(net, rooms, [Ask(None)] * 200)
    assert (asked[:, CHAIR] > 0).all()
    assert (free[:, CHAIR] == 0).mean() > 0.3
    assert asked.sum(1).mean() == pytest.approx(free.sum(1).mean(), rel=0.02)


def test_what_is_unwanted_stays_out_and_nothing_is_asked_of_the_rest(net, rooms):
    none = Ask.of(None, (CategoryBounds(("dining_chair",), 0, 0),), CLASSES)
    found = drawn(net, rooms, [none] * 60)
    assert (found[:, CHAIR] == 0).all()
    assert (found.sum(1) > 0).all()
    assert repair_counts(np.array([0, 0, 2]), Ask(3, (((0, 1, 2), 0, 0),)), np.ones(3)).sum() == 0
