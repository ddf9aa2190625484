"""Finished homes carry small things, the same ones every time, and nothing that is said of their furniture changes."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.homes.request import Request
from pipeline.homes.things import expected, placeable
from pipeline.taxonomy import load
from pipeline.verify import verify_home
from tests.geometry import furniture
from tests.homes.conftest import assets, factory_of, library_of

ASKED = [Request(0, "a one-bedroom flat of 60 m2 with a study"), Request(1)]


@pytest.fixture(scope="module")
def stocked(tmp_path_factory):
    small = [furniture.block("cup", "cup", (0.09, 0.09, 0.1)), furniture.block("book", "book", (0.16, 0.22, 0.03)), furniture.flip()]
    made = factory_of(library_of(tmp_path_factory.mktemp("stocked"), [*assets(), *small, furniture.tray_chest()]))
    return replace(made, postopt=replace(made.postopt, things=replace(made.postopt.things, rate=4.0)))


@pytest.fixture(scope="module")
def outcomes(stocked):
    return stocked.make(ASKED, files=False)


def things(outcome):
    return [p for p in outcome.home.placements if p.support]


def test_things_lie_on_furniture_of_their_room(stocked, outcomes):
    assert sum(len(things(o)) for o in outcomes) >= 6
    for outcome in outcomes:
        placed = {p.object_id: p for p in outcome.home.placements}
        for p in things(outcome):
            assert placed[p.support].room_id == p.room_id
            assert p.category in expected()[placed[p.support].category]
            assert np.array_equal(p.scale, np.ones(3))
            assert np.array_equal(p.position, np.round(p.position, 4))
        assert not verify_home(outcome.home, stocked.library, stocked.verify).faults(stocked.verify.policy)
        rows = {r["object_id"]: r["support"] for r in outcome.rows["objects"]}
        assert rows == {p.object_id: p.support for p in outcome.home.placements}


def test_what_is_said_of_furniture_stays(stocked, outcomes):
    bare = replace(stocked, postopt=replace(stocked.postopt, things=replace(stocked.postopt.things, rate=0.0)))
    for without, outcome in zip(bare.make(ASKED, files=False), outcomes, strict=True):
        assert not things(without)
        assert [p.object_id for p in without.home.placements] == [p.object_id for p in outcome.home.placements if not p.support]
        assert without.rows["rooms"] == outcome.rows["rooms"]
        same = ("objects", "openable", "reach", "walkable_paper", "walkable_free", "collisions", "attempts")
        assert [without.rows["scenes"][0][k] for k in same] == [outcome.rows["scenes"][0][k] for k in same]


def test_the_same_home_has_the_same_things(stocked, outcomes):
    (alone,) = stocked.make([ASKED[1]], files=False)
    assert alone.rows == outcomes[1].rows


def test_only_what_can_be_taken_away_is_laid():
    words = load()
    assert all(words.categories[name].loose for name in placeable())
    assert not words.categories["curtain"].loose
    assert not words.categories["room_door"].loose
