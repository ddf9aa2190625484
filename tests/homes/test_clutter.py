"""Finished homes carry small things, the same ones every time, and nothing that is said of their furniture changes."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.card import cards
from pipeline.floorplan.program.floor_program import FloorProgram
from pipeline.geometry.polygons import boundary_distance
from pipeline.homes import clutter
from pipeline.homes.furniture_report import deliveries
from pipeline.homes.request import Request
from pipeline.taxonomy import load
from pipeline.verify import verify_home
from tests.geometry import furniture
from tests.homes.conftest import assets, factory_of, library_of

ASKED = [Request(0, "a one-bedroom flat of 60 m2 with a study"), Request(1)]

FLAT = {
    "rug": (2.0, 1.4, 0.015),
    "bath_mat": (0.8, 0.5, 0.012),
    "curtain": (2.1, 0.14, 2.4),
    "blind": (1.4, 0.05, 0.8),
    "picture": (0.7, 0.03, 0.6),
    "mirror": (0.6, 0.03, 0.8),
    "towel": (0.55, 0.08, 0.6),
}


@pytest.fixture(scope="module")
def stocked(tmp_path_factory):
    small = [furniture.block("cup", "cup", (0.09, 0.09, 0.1)), furniture.block("book", "book", (0.16, 0.22, 0.03)), furniture.flip()]
    small += [furniture.block(name, name, size) for name, size in FLAT.items()]
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
            assert p.category in cards()[placed[p.support].category].holds
            assert np.array_equal(p.scale, np.ones(3))
            assert np.array_equal(p.position, np.round(p.position, 4))
        assert not verify_home(outcome.home, stocked.library, stocked.verify).faults(stocked.verify.policy)
        rows = {r["object_id"]: r["support"] for r in outcome.rows["objects"]}
        assert rows == {p.object_id: p.support for p in outcome.home.placements}


def test_what_is_said_of_furniture_stays(stocked, outcomes):
    bare = replace(stocked, postopt=replace(stocked.postopt, things=replace(stocked.postopt.things, rate=0.0)))
    for without, outcome in zip(bare.make(ASKED, files=False), outcomes, strict=True):
        assert not things(without)
        assert [p.object_id for p in without.home.placements] == [
            p.object_id for p in outcome.home.placements if p.category not in load().small
        ]
        assert without.rows["rooms"] == outcome.rows["rooms"]
        same = ("objects", "openable", "reach", "walkable_paper", "walkable_free", "collisions", "attempts")
        assert [without.rows["scenes"][0][k] for k in same] == [outcome.rows["scenes"][0][k] for k in same]


def test_the_same_home_has_the_same_things(stocked, outcomes):
    (alone,) = stocked.make([ASKED[1]], files=False)
    assert alone.rows == outcomes[1].rows


def test_rugs_lie_flat_and_what_hangs_is_at_a_wall(outcomes):
    found = [(o.home.plan, p) for o in outcomes for p in o.home.placements if p.category in FLAT]
    assert {"rug", "curtain", "picture", "mirror"} <= {p.category for _, p in found}
    for plan, p in found:
        if p.category in {"rug", "bath_mat"}:
            assert p.size[2] < 0.005
            assert p.position[2] == plan.elevation(p.room_id)
            continue
        back = p.footprint()[2:]  # the corners behind, at the wall
        polygon = plan.room(p.room_id).polygon
        assert max(boundary_distance(float(x), float(y), polygon) for x, y in back) < 0.01
        assert p.position[2] + p.size[2] < plan.elevation(p.room_id) + plan.room(p.room_id).height


def test_curtains_hang_before_windows_and_nothing_else_does(outcomes):
    for outcome in outcomes:
        windows = [o.segment.mean(0) for o in outcome.home.plan.openings if o.kind == "window"]
        for p in outcome.home.placements:
            if p.category in FLAT and load().categories[p.category].mount == "wall":
                near = min((float(np.linalg.norm(w - p.position[:2])) for w in windows), default=np.inf)
                assert (near < 0.6) == (p.category in {"curtain", "blind"})


def test_what_lies_on_furniture_can_be_taken_away():
    words = load()
    assert all(words.categories[name].loose for card in cards().values() for name in card.holds)
    assert not words.categories["rug"].loose
    besides = {name for room in words.layouts.values() for name in (*room.windows, *room.walls, *([room.rug.category] if room.rug else []))}
    assert besides
    assert not any(words.categories[name].layout for name in besides)
    assert not words.categories["curtain"].loose
    assert not words.categories["room_door"].loose


def rugs(outcome, kind):
    rooms = {r.room_id for r in outcome.home.plan.rooms if r.type == kind}
    return sum(p.category == "rug" and p.room_id in rooms for p in outcome.home.placements)


def test_a_rug_that_is_asked_for_lies_where_it_was_asked_for_and_none_where_it_was_ruled_out(stocked):
    rare = replace(stocked, postopt=replace(stocked.postopt, things=replace(stocked.postopt.things, rate=0.01)))
    words = ("a one-bedroom flat of 60 m2", "the bedroom has a rug", "the living room has no rug")
    without, asked = rare.make([Request(0, words[0]), Request(0, "; ".join(words[:2]))], files=False)
    (ruled_out,) = stocked.make([Request(0, "; ".join(words))], files=False)
    assert [rugs(o, "bedroom") for o in (without, asked, ruled_out)] == [0, 1, 1]
    assert rugs(ruled_out, "living_room") == 0
    program = FloorProgram.model_validate_json(asked.home.program)
    assert ("rug", True) in [(d.what, d.met) for d in deliveries(program, asked.rows, {})]


def test_a_rug_that_finds_no_place_is_refused_as_any_wish_is(stocked, monkeypatch):
    monkeypatch.setattr(clutter, "lay_rug", lambda *_: None)
    (empty,) = stocked.make([Request(0, "a one-bedroom flat of 60 m2; the bedroom has a rug")], files=False)
    assert "category_missed (bed: 0 rug" in str(empty.error)
