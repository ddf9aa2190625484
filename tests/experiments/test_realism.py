"""Made rooms beside real ones: the same floors are compared, what is spoilt is seen, and the report shows all of it."""

import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "homes"))
from conftest import factory, library  # noqa: F401 - the factory of rules

from pipeline import tables
from pipeline.entities.home import Home, Placement
from pipeline.entities.plan import Plan, Room
from pipeline.experiments.document import alone, by_type, lineup
from pipeline.experiments.realism import Beside, alike, beside, embeddings, realism_table, shipped_rooms, unseen, view_figures
from pipeline.experiments.trials import FIRST
from pipeline.homes.rows import object_row, room_row, scene_row
from pipeline.manifest import canonical
from pipeline.metrics.views import features_once, spoilt
from pipeline.relations import learning
from pipeline.report.page import render
from pipeline.report.realism import VOID, realism_section
from schemas import OBJECTS, OPENINGS, ROOMS, SCENES
from tests.relations.making import bedrooms

TASTE = {"style": {key: {"mean": 0.8, "low": 0.7, "high": 0.9, "n": 5} for key in ("real", "shipped")}}


def home_of(room, scene_id):
    plan = Plan((Room("bed", "bedroom", room.polygon),), (), "bed")
    things = [
        Placement(f"o_{k}", "bed", name, "asset", room.position[k], float(room.yaw[k]), room.size[k])
        for k, name in enumerate(room.categories)
    ]
    return Home(scene_id, 0, 0, "", "", plan, tuple(things))


def rows_of(homes, split):
    return {
        SCENES: [{**scene_row(home), "split": split} for home in homes],
        ROOMS: [room_row(home.scene_id, home.plan.rooms[0], "bedroom") for home in homes],
        OBJECTS: [object_row(home.scene_id, p, openable=False) for home in homes for p in home.placements],
        OPENINGS: [],
    }


@pytest.fixture(scope="module")
def homes():
    return [home_of(room, f"s_{k}") for k, room in enumerate(bedrooms(np.random.default_rng(0), 120))]


@pytest.fixture(scope="module")
def root(homes, tmp_path_factory):
    folder = tmp_path_factory.mktemp("checkout")
    train, test, shipped = rows_of(homes[:60], "train"), rows_of(homes[60:], "test"), rows_of(homes[:40], "train")
    for table in (SCENES, ROOMS, OBJECTS, OPENINGS):
        tables.write(folder / "data/tables" / f"{table.name}.parquet", table, train[table] + test[table])
        tables.write(folder / "data/shards" / table.name / "shard-00000.parquet", table, shipped[table])
    return folder


@pytest.fixture(scope="module")
def rooms(root, homes):
    found = rows_of([replace(home, scene_id=f"room_{FIRST + k}") for k, home in enumerate(homes[:])][60:], "test")
    drafted = {"rooms": found[ROOMS], "objects": found[OBJECTS]}
    return beside(root, "test", {"guided": drafted})


def test_drafts_are_put_beside_the_rooms_of_their_floors(rooms):
    assert [room.name for room in rooms.samples["guided"]] == [room.name for room in rooms.real]
    assert all(np.allclose(a.position, b.position) for a, b in zip(rooms.samples["guided"], rooms.real, strict=True))
    assert (len(rooms.real), len(rooms.train), len(rooms.samples["shipped"])) == (60, 60, 40)


def test_wcs_are_not_among_the_bathrooms_that_ship(root, homes, tmp_path):
    shipped = rows_of(homes[:3], "train")
    shipped[ROOMS][1]["type"] = "wc"
    for table in (ROOMS, OBJECTS, OPENINGS):
        tables.write(tmp_path / table.name / "shard-00000.parquet", table, shipped[table])
    assert [room.name for room in shipped_rooms(tmp_path)] == ["s_0/bed", "s_2/bed"]


def test_rooms_of_like_type_and_area_are_compared(rooms):
    kitchens = [replace(room, layout_type="kitchen") for room in rooms.train[:7]]
    [(own, other), again] = alike(np.random.default_rng(0), [*rooms.real[:10], *kitchens], [*rooms.train[7:40], *kitchens[:3]], 2)
    assert len(again[0]) == len(own)  # draws are each of all rooms
    assert [r.layout_type for r in own] == [r.layout_type for r in other]
    assert all(abs(np.log(a.area / b.area)) < np.log(1.0801) for a, b in zip(own, other, strict=True))
    assert len({r.name for r in other}) == len(other) > 8
    larger = [replace(room, polygon=1.05 * room.polygon) for room in kitchens[:1]]
    assert alike(np.random.default_rng(0), kitchens[:1], larger, 1) == [([], [])]


@pytest.fixture(scope="module")
def table(rooms):
    rng = np.random.default_rng(1)
    made = {"guided": [spoilt(rng, room) for room in rooms.real], "shipped": rooms.samples["shipped"]}
    return realism_table(0, Beside(rooms.real, rooms.train, made), learning.fit(rooms.train), embeddings(""))


def test_what_is_spoilt_is_seen_and_what_is_real_is_not(table):
    assert table["layout"]["made"]["guided"]["rate"] > 0.8 > table["layout"]["made"]["train"]["rate"]
    assert table["layout"]["harm"]["jittered"]["rate"] > 0.9
    assert "all" not in table["layout"]["blind_to"]["SCA"]
    views = table["views"]["plan-view net"]
    assert views["made"]["guided"]["fid"] > 2 * views["made"]["train"]["fid"]
    assert (
        table["relations"]["rates"]["back at the wall"]["real"]["rate"]
        > 0.9
        > table["relations"]["rates"]["back at the wall"]["guided"]["rate"]
    )
    assert (
        table["novelty"]["shipped"]["copies"] == views["made"]["shipped"]["rooms"] > 30
    )  # the "shipped" rooms of this test are training rooms
    assert table["novelty"]["guided"]["copies"] == 0


def test_what_training_rooms_themselves_reach_stands_beside_and_is_a_mean_over_draws(table, rooms):
    assert table["relations"]["objects"]["all"]["train"]["n"] == 60

    def fid(*draws):
        embed = lambda views: views.reshape(len(views), -1)[:, ::997].astype(float)  # noqa: E731
        return view_figures(np.random.default_rng(0), 0, features_once(embed), {"train": draws}, {"train": draws[:1]}, {})["made"]["train"]

    one, two = ((rooms.real[k : k + 20], rooms.train[k : k + 20]) for k in (0, 20))
    assert fid(one)["fid"] != fid(two)["fid"]
    assert fid(one, two)["fid"] == pytest.approx((fid(one)["fid"] + fid(two)["fid"]) / 2, abs=1e-3)
    assert fid(two, one)["floor"] == pytest.approx(fid(two)["fid"], abs=1e-3)


@pytest.mark.parametrize("train", [0, 2])
def test_a_handful_of_rooms_gives_figures_that_can_be_written(rooms, train):
    few = Beside(rooms.real[:2], rooms.train[:train], {"guided": rooms.real[:2], "shipped": []})
    found = realism_table(0, few, learning.fit([]), embeddings(""))
    assert json.loads(canonical(found)) == found
    assert "drafts, guided" in render("t", "l", [realism_section(found, TASTE, [])])


def test_the_chapter_shows_it_and_calls_a_blind_figure_void(table):
    page = render("t", "l", [realism_section(table, TASTE, [])])
    assert "drafts, guided" in page
    assert "nightstand at the bed" in page
    for turned, shown in ((["turned"], 2), ([], 0)):
        layout = {**table["layout"], "blind_to": {"SCA": turned}}
        views = {name: {**found, "blind_to": {"FID": [], "KID": turned, "SCA": []}} for name, found in table["views"].items()}
        page = render("t", "l", [realism_section({**table, "layout": layout, "views": views}, TASTE, [])])
        assert page.count(VOID) == shown
        assert page.count("KID (turned)") == page.count("SCA (turned)") == shown / 2


def test_each_figure_is_void_where_it_alone_does_not_see_a_harm():
    def figures(fid, kid, sca):
        return {"fid": fid, "kid": {"mean": kid, "low": kid - 0.1, "high": kid + 0.1}, "sca": {"rate": sca}}

    train = figures(1.0, 0.0, 0.5)
    harm = {
        "seen": figures(2.0, 0.2, 0.8),
        "near": figures(1.9, 0.3, 0.9),
        "alike": figures(3.0, 0.19, 0.9),
        "told": figures(3.0, 0.3, 0.79),
    }
    assert unseen(harm, train) == {"FID": ["near"], "KID": ["alike"], "SCA": ["told"]}
    assert unseen(harm, None) == {"FID": [*harm], "KID": [*harm], "SCA": ["told"]}


def test_lineups_show_each_room_twice(factory, homes):  # noqa: F811
    import furniture

    asset = next(iter(factory.library))
    home = furniture.home([], furniture.two_rooms())
    placed = Placement("o_0", home.plan.rooms[0].room_id, factory.library[asset].category, asset, np.array([1.0, 1, 0]), 0.0, np.ones(3))
    furnished = replace(home, placements=(placed,))
    types = {(home.scene_id, room.room_id): "bedroom" for room in home.plan.rooms}
    found = by_type([furnished], types)
    assert found == {"bedroom": [(furnished, placed.room_id)]}
    assert alone(furnished, placed.room_id).plan.entrance == placed.room_id
    hidden, told = lineup(np.random.default_rng(0), found, found, factory.library)
    assert hidden.size == told.size
    assert lineup(np.random.default_rng(0), found, {}, factory.library) is None
