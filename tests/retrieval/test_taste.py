"""One taste: a drawn style and finish go first where sizes allow, sets are of one model, and a library without styles is served too."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.entities.asset import Asset, Link, Material, Mesh
from pipeline.rendering.surface_colour import finish_of
from pipeline.retrieval.index import AssetIndex, Taste, sets
from pipeline.retrieval.taste import TIMBER, draw_finishes, draw_style, tasteful
from tests.geometry.furniture import box

DARK, LIGHT = np.array([30.0, 10.0, 10.0]), np.array([80.0, 5.0, 20.0])
FINISHES = {"dark": DARK.tolist(), "light": LIGHT.tolist(), "plain": None}


def row(asset_id, category, size, style=""):
    return {
        "asset_id": asset_id,
        "category": category,
        "size": size,
        "style": style,
        "split": "train",
        "articulated": False,
        "openable": False,
    }


ROWS = [
    row("chair_dark", "dining_chair", [0.45, 0.5, 0.9], "Nordic"),
    row("chair_light", "dining_chair", [0.5, 0.5, 0.85], "Modern"),
    row("desk_dark", "desk", [1.2, 0.6, 0.75], "Nordic"),
    row("desk_light", "desk", [1.3, 0.6, 0.75], "Modern"),
    row("desk_plain", "desk", [0.6, 0.4, 0.75]),
    row("table_dark", "dining_table", [1.4, 0.8, 0.75], "Nordic"),
]
INDEX = AssetIndex.from_tables(
    ROWS, [{"asset_id": r["asset_id"], "latent": np.zeros(32), "finish": FINISHES[r["asset_id"].split("_")[1]]} for r in ROWS]
)


def asked(taste, asks, index=INDEX):
    names, sizes, positions = zip(*asks, strict=True)
    found = tasteful(index, taste, names, np.array(sizes), np.zeros((len(asks), 32)), np.array(positions))
    return [m.asset_id if m else None for m in found]


DESK = [("desk", [1.25, 0.6, 0.75], [0, 0, 0])]


def test_style_decides_between_what_fits_alike_and_a_wish_goes_further():
    assert asked(Taste("Nordic"), DESK) == ["desk_dark"]
    assert asked(Taste("Modern"), DESK) == ["desk_light"]
    small = [("desk", [0.6, 0.4, 0.75], [0, 0, 0])]
    assert asked(Taste("Modern"), small) == ["desk_plain"]  # a drawn style does not ask for a desk of twice the size
    assert asked(Taste("Modern", wished=True), [("dining_chair", [0.3, 0.3, 0.4], [0, 0, 0])]) == ["chair_light"]


def test_finish_decides_where_there_is_no_style():
    bare = replace(INDEX, styles=np.zeros_like(INDEX.styles))
    assert draw_style(np.random.default_rng(0), bare) == ""
    assert asked(Taste(finishes={TIMBER: DARK}), DESK, bare) == ["desk_dark"]
    assert asked(Taste(finishes={TIMBER: LIGHT}), DESK, bare) == ["desk_light"]
    assert asked(Taste(finishes={TIMBER: np.full(3, np.nan)}), DESK, bare) == asked(Taste(), DESK, bare)


def test_chairs_at_one_table_are_one_model_of_one_size():
    table = ("dining_table", [1.4, 0.8, 0.75], [0, 0, 0])
    chairs = [("dining_chair", [0.44, 0.5, 0.9], [0.5, 0.7, 0]), ("dining_chair", [0.51, 0.5, 0.84], [-0.5, 0.7, 0])]
    assert len(set(asked(Taste(), chairs))) == 2
    assert len(set(asked(Taste(), [table, *chairs])[1:])) == 1
    assert sets(["dining_table", "dining_chair", "dining_chair"], np.array([[0, 0, 0], [1, 0, 0], [9, 0, 0.0]])) == []
    assert asked(Taste(), [("wardrobe", [1, 1, 2], [0, 0, 0])]) == [None]


def test_draws_are_of_the_style_and_depend_on_the_generator_alone():
    styles = {draw_style(np.random.default_rng(seed), INDEX) for seed in range(20)}
    assert styles == {"Nordic", "Modern"}
    found = draw_finishes(np.random.default_rng(1), INDEX, "Nordic")
    assert found[TIMBER] == pytest.approx(DARK)
    assert set(found) == {TIMBER}  # the library has neither kitchen units nor sofas


def test_the_finish_is_the_colour_of_most_of_the_surface():
    wood, steel = Material("wood", (0.4, 0.2, 0.1)), Material("steel", (0.6, 0.6, 0.6))
    big, small = box((0, 0, 0), (1, 1, 1)), replace(box((0, 0, 1), (0.1, 0.1, 1.1)), material=1)
    link = Link("base", (big, small), (big, small), 1.0, np.zeros(3), np.eye(3))
    asset = Asset("a", "desk", np.ones(3), (link,), (), (wood, steel), "test", "a", "CC0-1.0")
    lightness, red, yellow = finish_of(asset)
    assert (lightness, red > 0, yellow > 0) == (pytest.approx(56.3, abs=3.0), True, True)
    empty = replace(link, visuals=(Mesh("none", np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int32)),))
    assert np.isnan(finish_of(replace(asset, links=(empty,)))).all()


def test_the_guidance_hears_of_the_asset_that_the_room_will_retrieve():
    tastes = [Taste("Nordic"), Taste("Modern"), Taste(finishes={TIMBER: DARK}), None]
    size, pair = [1.26, 0.6, 0.75], [("desk", [1.26, 0.6, 0.75], [0, 0, 0])]
    sizes, _ = INDEX.lookup(tastes, [["desk"]] * 4, np.zeros((4, 1, 3)), np.array([[size]] * 4), np.zeros((4, 1, 32)))
    for taste, placed in zip(tastes, sizes, strict=True):
        match = tasteful(INDEX, taste or Taste(), ["desk"], np.array([size]), np.zeros((1, 32)), np.zeros((1, 3)))[0]
        np.testing.assert_array_equal(placed[0], match.size)
    assert asked(tastes[0], pair) != asked(tastes[1], pair)
