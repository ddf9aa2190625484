"""Programs: their schema, their completion, their checks, the prior and its words."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from pydantic import ValidationError

from pipeline import params, seeds, taxonomy
from pipeline.errors import ContentError, RefusedError
from pipeline.floorplan import complete, describe, json_schema, parse, prior, solve
from pipeline.floorplan.program.consistency import check, reach
from pipeline.floorplan.program.defaults import DEFAULTS
from pipeline.floorplan.program.floor_program import FloorProgram, Forbid, Furniture, Link, Range, Relation, RoomReq, RoomType, Things
from pipeline.floorplan.program.priors import PriorSettings, plan_types


def room(name, kind, **more):
    return RoomReq(id=name, type=kind, **more)


def program(*rooms, **more):
    return FloorProgram(rooms=rooms, **more)


def test_every_room_type_has_defaults_and_a_place_in_the_taxonomy():
    assert set(RoomType.__args__) == set(DEFAULTS) == set(taxonomy.load().types)
    assert len(DEFAULTS) == 24


def test_schema_describes_and_round_trips():
    schema = json_schema()
    assert schema["title"] == "FloorProgram"
    assert "RoomReq" in schema["$defs"]
    made = prior(np.random.default_rng(3))
    assert FloorProgram.model_validate_json(made.model_dump_json()) == made


@pytest.mark.parametrize(
    "wrong",
    [
        {"rooms": [{"id": "a", "type": "dungeon"}]},
        {"rooms": [{"id": "../x", "type": "bedroom"}]},
        {"rooms": [{"id": "a", "type": "bedroom", "colour": "red"}]},
        {"style": {"area": 4}},
        {"storeys": 4},
        {"total_area": {"min": -1}},
        {"total_area": {"target": float("inf")}},
        {"version": 2},
    ],
)
def test_wrong_programs_do_not_validate(wrong):
    with pytest.raises(ValidationError):
        FloorProgram.model_validate(wrong)


@pytest.mark.parametrize("seed", range(60))
def test_the_prior_draws_sound_programs(seed):
    made = prior(np.random.default_rng(seed))
    check(made)
    assert complete(made) == made
    assert reach(made, made.entrance.into, frozenset()) == {r.id for r in made.rooms}
    kinds = {r.type for r in made.rooms}
    assert "bathroom" in kinds
    assert kinds & {"living_room", "studio_room"} or {"bedroom", "kitchen", "hallway"} <= kinds
    words = describe(made)
    assert words.endswith(".")
    assert words[0] == "A"


def test_rooms_of_the_prior_are_as_large_as_the_training_houses():
    areas: dict[str, list[float]] = {}
    for seed in range(200):
        made = prior(np.random.default_rng(seed))
        dines_apart = any(r.type == "dining_room" for r in made.rooms)
        for r in made.rooms:
            kind = f"living_room, dining {'apart' if dines_apart else 'there'}" if r.type == "living_room" and not r.functions else r.type
            areas.setdefault(kind, []).append(r.area.target)
    means = {
        "living_room, dining there": 33.8,
        "living_room, dining apart": 17.7,
        "dining_room": 17.4,
        "bedroom": 14.3,
        "kitchen": 6.7,
        "bathroom": 4.8,
    }
    for kind, mean in means.items():  # of the rooms of data/tables
        assert 0.9 * mean < np.mean(areas[kind]) < 1.15 * mean, kind


def test_the_prior_is_varied():
    made = [prior(np.random.default_rng(s)) for s in range(300)]
    assert len(Counter(tuple(sorted(r.type for r in p.rooms)) for p in made)) > 110
    assert {sum(r.type == "bedroom" for r in p.rooms) for p in made} == {0, 1, 2, 3, 4, 5, 6}
    assert {p.storeys for p in made} == {1, 2}
    assert {p.footprint.shape for p in made} == {"rectangle", "L"}
    assert prior(np.random.default_rng(5)) == prior(np.random.default_rng(5))


@pytest.mark.parametrize("kind", plan_types())
def test_each_type_of_plan_keeps_to_itself(kind):
    settings = PriorSettings(types={kind: 1.0})
    for seed in range(12):
        made = prior(np.random.default_rng(seed), settings)
        check(made)
        assert complete(made) == made
        assert plan_types()[kind].least <= sum(r.type == "bedroom" for r in made.rooms) <= plan_types()[kind].most
        assert made.storeys == (2 if kind in {"terrace", "detached"} else 1)


def test_weights_decide_what_the_prior_draws():
    one = PriorSettings(bedrooms=(1.0, 0.0, 0.0, 0.0, 0.0, 0.0), types={"flat": 1.0, "studio": 0.0})
    assert {sum(r.type == "bedroom" for r in prior(np.random.default_rng(s), one).rooms) for s in range(20)} == {1}
    for wrong in ({"types": {"igloo": 1.0}}, {"types": {"flat": -1.0}}, {"types": {"flat": 0.0}}, {"types": {}}, {"bedrooms": (1.0,)}):
        with pytest.raises(ContentError, match=r"prior\."):
            PriorSettings(**wrong)
    tree = params.read(Path(__file__).resolve().parents[2] / "params.yaml")
    assert set(params.section(PriorSettings, tree, "prior").types) == set(plan_types())


def homes_with_children(count):
    """Return drawn homes, each without and with its children."""
    draws = ((seeds.generator(7, "program", k), seeds.generator(7, "family", k)) for k in range(count))
    return [(prior(seeds.generator(7, "program", k)), prior(draw, None, family)) for k, (draw, family) in enumerate(draws)]


def test_a_third_to_a_half_of_family_homes_have_children():
    counts = {"two": [], "more": []}
    for _, home in homes_with_children(800):
        beds = [r for r in home.rooms if r.type == "bedroom"]
        children = [r for r in beds if r.role == "child"]
        if len(beds) > 1:
            counts["two" if len(beds) == 2 else "more"].append(len(children))
        largest = max((r.area.target for r in beds), default=0.0)
        assert all(r is not beds[0] and r.area.target < 0.95 * largest for r in children)
    assert 0.28 < np.mean(np.array(counts["two"]) > 0) < 0.40
    assert 0.45 < np.mean(np.array(counts["more"]) > 0) < 0.60
    assert 0.15 < np.mean(np.array(counts["more"]) > 1) < 0.35
    shared = PriorSettings(types={"shared": 1.0})
    assert not any(r.role for r in prior(np.random.default_rng(0), shared, np.random.default_rng(0)).rooms)


def test_children_change_nothing_but_whose_bedroom_it_is():
    homes = homes_with_children(150)
    for without, home in homes:
        roles = tuple(r.model_copy(update={"role": ""}) if r.role == "child" else r for r in home.rooms)
        assert home.model_copy(update={"rooms": roles}) == without
        check(home)
        assert complete(home) == home
    assert homes_with_children(150) == homes
    assert any(home != without for without, home in homes)


def test_descriptions_name_children_and_are_understood_again():
    for without, home in homes_with_children(60):
        children = sum(r.role == "child" for r in home.rooms)
        again = parse(describe(home))
        assert sum(r.role == "child" for r in again.rooms) == children
        assert again.unparsed == ()
        assert children or describe(home) == describe(without)


def test_descriptions_are_understood_again():
    same = 0
    for seed in range(40):
        made = prior(np.random.default_rng(seed))
        again = parse(describe(made))
        same += Counter(r.type for r in made.rooms) == Counter(r.type for r in again.rooms)
    assert same >= 36


def test_completion_adds_what_a_dwelling_needs_and_says_so():
    made = complete(program(room("bed", "bedroom", count=2)))
    by_type = {r.type: r for r in made.rooms}
    assert {"living_room", "kitchen", "bathroom", "hallway"} <= set(by_type)
    assert by_type["hallway"].inferred
    assert not by_type["kitchen"].stated
    assert all(not k.stated for k in made.links)
    assert made.entrance.into == by_type["hallway"].id


@pytest.mark.parametrize(
    ("named", "added"),
    [
        ((), {"studio_room", "kitchen", "bathroom"}),
        (("balcony",), {"studio_room", "kitchen", "bathroom"}),
        (("library", "media_room"), {"living_room", "bedroom", "kitchen", "bathroom"}),
        (("hallway",), {"living_room", "bedroom", "kitchen", "bathroom"}),
        (("garage", "studio_room"), {"kitchen", "bathroom"}),
    ],
)
def test_a_home_of_many_rooms_is_no_studio(named, added):
    rooms = [room(f"r{k}", kind) for k, kind in enumerate(("kitchen", *named))]
    made = {r.type for r in complete(program(*rooms)).rooms}
    assert added <= made
    assert ("studio_room" in made) == ("studio_room" in {*named, *added})


@pytest.mark.parametrize(
    ("floor", "bedrooms", "bathrooms"), [(38.0, 0, 1), (50.0, 1, 1), (75.0, 2, 1), (100.0, 3, 1), (125.0, 4, 2), (400.0, 5, 2)]
)
def test_a_home_of_which_only_the_floor_is_said_has_the_usual_bedrooms(floor, bedrooms, bathrooms):
    made = complete(program(total_area=Range(target=floor, stated=True)))
    counts = Counter(r.type for r in made.rooms)
    assert counts["bedroom"] == bedrooms
    assert counts["studio_room"] == (bedrooms == 0)
    assert counts["bathroom"] == bathrooms
    assert complete(made) == made


@pytest.mark.parametrize(("said", "bedrooms"), [((), 3), (("living_room",), 3), (("bedroom",), 1), (("studio_room",), 0), (("office",), 0)])
def test_rooms_that_are_said_decide_how_one_sleeps(said, bedrooms):
    rooms = [room(f"r{k}", kind) for k, kind in enumerate(said)]
    made = complete(program(*rooms, total_area=Range(target=95.0, stated=True)))
    assert sum(r.type == "bedroom" for r in made.rooms) == bedrooms


@pytest.mark.parametrize("prompt", ["a flat of 12 m x 8 m", "Wohnung, 12 m lang und 8 m breit", "a flat 8 m wide and 12 m long"])
def test_sides_of_a_home_are_its_outline(prompt):
    made = parse(prompt)
    assert made.total_area.target == pytest.approx(96.0)
    assert made.footprint.min_aspect <= 1.5 <= made.footprint.max_aspect
    corners = np.concatenate([r.polygon for r in solve(made, 0).rooms])
    width, depth = np.ptp(corners, axis=0)
    assert max(width, depth) / min(width, depth) == pytest.approx(1.5, rel=0.08)


@pytest.mark.parametrize("prompt", ["a flat of 8 m x 8 m with one bedroom", "a flat 8.1 m by 8 m", "a house 20 m x 4 m"])
def test_sides_may_be_alike_or_as_unlike_as_an_outline_can_be(prompt):
    outline = parse(prompt).footprint
    assert 1.0 <= outline.min_aspect < outline.max_aspect <= 5.0
    assert outline.stated


def test_a_home_that_is_too_narrow_is_refused():
    with pytest.raises(RefusedError, match="as long as wide"):
        parse("a house 20 m x 3 m")


def test_a_kitchen_with_a_dining_table_is_one_to_dine_in():
    wish = Furniture(counts=(Things(category="any_table", min=1), Things(category="any_chair", min=6)))
    made = complete(program(room("kitchen", "kitchen", furniture=wish), room("bed", "bedroom")))
    kitchen = next(r for r in made.rooms if r.id == "kitchen")
    assert kitchen.functions == ("dining",)
    assert kitchen.area.target > complete(program(room("kitchen", "kitchen"), room("bed", "bedroom"))).rooms[0].area.target
    assert complete(made) == made


def test_a_closed_list_stays_closed():
    made = complete(program(room("studio", "studio_room"), room("bath", "bathroom"), only=True))
    assert [r.id for r in made.rooms] == ["studio", "bath"]


def test_no_bathroom_becomes_a_thoroughfare():
    made = complete(
        program(
            room("living", "living_room"), room("hall", "hallway"), room("bed", "bedroom"), room("bath", "bathroom"),
            links=(Link(a="hall", b="bath", stated=True), Link(a="bed", b="bath", stated=True)),
        )
    )  # fmt: skip
    assert any({k.a, k.b} == {"hall", "bed"} for k in made.links)
    check(made)


def test_selectors_name_types():
    made = complete(program(room("bed", "bedroom", count=3), room("hall", "hallway"), links=(Link(a="bedroom", b="hallway", stated=True),)))
    assert sum(k.stated for k in made.links) == 3


def test_area_relations_are_met_by_targets():
    made = complete(
        program(
            room("a", "bedroom"), room("b", "bedroom"), room("c", "bedroom"), total_area=Range(target=90.0, stated=True),
            relations=(Relation(kind="area_order", a="a", b="b", value=1.5), Relation(kind="largest", a="a", b="bedroom")),
        )
    )  # fmt: skip
    area = {r.id: r.area.target for r in made.rooms}
    assert area["a"] >= 1.5 * area["b"]
    assert area["a"] > area["c"]


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (program(room("a", "bedroom", area=Range(min=20.0, max=10.0, stated=True))), "at least 20"),
        (program(room("a", "bedroom"), room("a", "kitchen")), "two rooms"),
        (program(room("bath", "bathroom"), room("bed", "bedroom"), room("hall", "hallway"), relations=(Relation(kind="degree", a="bath", value=1),),
                 links=(Link(a="bath", b="bed", stated=True), Link(a="bath", b="hall", stated=True))), "1 door"),
        (program(room("bed", "bedroom"), room("bath", "bathroom"), room("living", "living_room"), only=True,
                 links=(Link(a="bed", b="bath", stated=True), Link(a="living", b="bed", stated=True)), forbids=(Forbid(what="through", a="bath", avoid="bed"),)), "only through"),
        (program(room("kitchen", "kitchen"), room("living", "living_room"), room("bath", "bathroom"), only=True,
                 links=(Link(a="living", b="bath", stated=True), Link(a="bath", b="kitchen", stated=True)), relations=(Relation(kind="degree", a="kitchen", value=1),)), "1 door"),
    ],
)  # fmt: skip
def test_contradictions_are_refused(made, words):
    with pytest.raises(RefusedError, match=words):
        check(complete(made))


@pytest.mark.parametrize("lower", ["studio_room", "office", "gym", "garage", "bedroom"])
def test_storeys_are_joined_by_the_staircase_alone(lower):
    made = complete(FloorProgram(storeys=2, rooms=(room("a", lower, level=0), room("b", "bathroom", level=1)), only=True))
    level = {r.id: r.level for r in made.rooms if r.type != "staircase"}
    assert all(level[k.a] == level[k.b] for k in made.links if {k.a, k.b} <= set(level))
    assert len(solve(made, 0).rooms) == len(made.rooms)


def test_a_storey_without_a_room_is_refused():
    with pytest.raises(RefusedError, match="level 1 has no room"):
        complete(FloorProgram(storeys=2, rooms=(room("a", "studio_room"), room("b", "bathroom", level=0)), only=True))


def test_a_stated_link_between_storeys_is_refused():
    rooms = (room("kitchen", "kitchen", level=0), room("bed", "bedroom", level=1))
    with pytest.raises(RefusedError, match="different storeys"):
        complete(FloorProgram(storeys=2, rooms=rooms, links=(Link(a="kitchen", b="bed", stated=True),)))
