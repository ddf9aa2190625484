from dataclasses import replace

import numpy as np

from pipeline import taxonomy
from pipeline.diffusion.context import CategoryBounds, RoomContext
from pipeline.entities.plan import Plan, Room
from pipeline.floorplan.program.floor_program import Furniture
from pipeline.homes.furnish import _parts, category_bounds, usual_bounds
from pipeline.homes.request import RoomJob


def job(layout_type, count=None, wishes=(), sides=(4, 3)):
    counts = [{"category": c, "min": d.least, "max": d.most} for d in wishes for c in d.categories]
    plan = Plan((Room("room", layout_type, np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * np.array(sides, float)),), (), "room")
    return RoomJob(plan, "room", layout_type, 0, 0, count=count, furniture=Furniture.model_validate({"counts": counts}))


def bounds(job, words):
    return category_bounds(job, job.layout_type, job.kinds, words)


def test_a_room_is_to_hold_what_makes_it_that_room():
    words = taxonomy.load()
    asked = bounds(job("kitchen"), words)
    assert [d.categories for d in asked] == list(words.layouts["kitchen"].needs)
    assert all(d.least == 1 for d in asked)
    assert bounds(job("hallway"), words) == ()


def test_a_stated_number_of_things_is_not_crowded_by_essentials():
    assert bounds(job("kitchen", count=2), taxonomy.load()) == ()


def test_a_wish_takes_the_place_of_an_essential():
    none = CategoryBounds(("oven",), most=0)
    asked = bounds(job("kitchen", wishes=[none]), taxonomy.load())
    assert [d for d in asked if "oven" in d.categories] == [none]
    assert any(d.least == 1 and "sink_cabinet" in d.categories for d in asked)


def test_no_tub_stands_in_a_wc_unless_it_is_wished_for():
    words = taxonomy.load()
    bath, wc = (replace(job("bathroom", wishes=w), plan=Plan((replace(job("bathroom").room, type=kind),), (), "room"))
                for kind, w in (("bathroom", ()), ("wc", ())))  # fmt: skip
    assert CategoryBounds(("shower", "bathtub"), 1) in bounds(bath, words)
    assert CategoryBounds(("shower", "bathtub"), 0, 0) in bounds(wc, words)
    asked = bounds(replace(wc, furniture=job("bathroom", wishes=[CategoryBounds(("shower",), 1)]).furniture), words)
    assert CategoryBounds(("bathtub",), 0, 0) in asked


def test_a_studio_is_not_for_children_whatever_the_try():
    words = taxonomy.load()
    rooms = [replace(job("studio_room"), layout_type="living_room+bedroom", attempt=attempt) for attempt in range(5)]
    for asked in (category_bounds(room, "bedroom", room.kinds, words) for room in rooms):
        assert not any("kids_bed" in d.categories for d in asked if d.least)
        assert any("kids_bed" in d.categories and d.most == 0 for d in asked)
        assert any(d.least == 1 and {"double_bed", "single_bed"}.intersection(d.categories) for d in asked)


def test_later_tries_insist_on_another_bed():
    words = taxonomy.load()
    (group,) = words.layouts["bedroom"].needs
    tries = [(0, 0), (0, 1), (0, 2), (0, 3), (1, 3)]
    asked = [bounds(replace(job("bedroom"), plan_attempt=plan, attempt=attempt), words) for plan, attempt in tries]
    assert asked[0] == asked[1] == (CategoryBounds(group, 1),)
    assert [a[0].categories for a in asked[2:4]] == [("single_bed",), ("kids_bed",)]
    assert all(CategoryBounds(tuple(c for c in group if c not in a[0].categories), 0, 0) in a for a in asked[2:])
    assert asked[4] == asked[3]


def test_a_share_of_rooms_is_asked_for_what_is_usual():
    words = taxonomy.load()
    (usual,) = words.layouts["bedroom"].usual
    rng = np.random.default_rng(0)
    asked = [usual_bounds(job("bedroom"), "bedroom", words, rng) for _ in range(400)]
    assert set(asked) == {(), (CategoryBounds(usual.of, 1),)}
    assert abs(np.mean([bool(a) for a in asked]) - usual.share) < 0.1
    for silent in (
        job("bedroom", count=3),
        replace(job("bedroom"), attempt=3),
        job("bedroom", wishes=[CategoryBounds(("wardrobe",), most=0)]),
        job("hallway"),
    ):
        assert not any(usual_bounds(silent, silent.layout_type, words, rng) for _ in range(20))


def test_a_studio_is_asked_for_a_wardrobe_oftener_than_a_bedroom_and_never_for_a_childs():
    words = taxonomy.load()
    studio = replace(job("studio_room"), layout_type="bedroom+living_room")
    rng = np.random.default_rng(0)
    asked = [usual_bounds(studio, "bedroom", words, rng) for _ in range(400)]
    assert set(asked) == {(), (CategoryBounds(("wardrobe", "cabinet"), 1),)}
    own, others = words.types["studio_room"].usual[0].share, words.layouts["bedroom"].usual[0].share
    assert abs(np.mean([bool(a) for a in asked]) - (1 - (1 - own) * (1 - others))) < 0.06
    elsewhere = {c for _ in range(50) for bounds in usual_bounds(studio, "living_room", words, rng) for c in bounds.categories}
    assert elsewhere == {"coffee_table"}


def test_a_wc_is_asked_for_a_lamp():
    words = taxonomy.load()
    wc = replace(job("wc"), layout_type="bathroom")
    assert usual_bounds(wc, "bathroom", words, np.random.default_rng(0)) == (CategoryBounds(("ceiling_lamp",), 1),)


def test_a_studio_is_asked_for_a_table_where_the_floor_is_enough():
    words = taxonomy.load()
    rng = np.random.default_rng(0)
    for sides, there in (((4, 3), False), ((6, 5), True)):
        studio = replace(job("studio_room", sides=sides), layout_type="bedroom+living_room")
        asked = {c for _ in range(30) for bounds in usual_bounds(studio, "living_room", words, rng) for c in bounds.categories}
        assert ("dining_table" in asked) == there


def test_every_part_is_told_what_is_not_alone():
    words = taxonomy.load()
    studio = job("living_room+bedroom")
    whole = RoomContext.of(studio.plan, "room", studio.layout_type)
    told = [part.company for part in _parts(studio, whole, words, np.random.default_rng(0))]
    assert told == [tuple((c.of, c.also, c.least) for c in words.company)] * 2
    assert {("desk",), ("dining_table",)} <= {of for of, *_ in told[0]}


def test_what_is_wished_for_stands_in_the_part_where_it_usually_does():
    words = taxonomy.load()
    wishes = [CategoryBounds(("wardrobe",), 1), CategoryBounds(("coffee_table",), 1, 2), CategoryBounds(("stool",), 0, 0)]
    studio = job("bedroom+living_room", wishes=wishes)
    asked = {kind: category_bounds(studio, kind, studio.kinds, words) for kind in studio.kinds}
    assert CategoryBounds(("wardrobe",), 1) in asked["bedroom"]
    assert CategoryBounds(("wardrobe",), 0) in asked["living_room"]
    assert CategoryBounds(("coffee_table",), 1, 2) in asked["living_room"]
    assert all(CategoryBounds(("stool",), 0, 0) in bounds for bounds in asked.values())
    (bed,) = words.layouts["bedroom"].needs
    assert CategoryBounds(bed, 1) in asked["bedroom"]
    assert CategoryBounds(bed, 1) not in asked["living_room"]
    assert bed in studio.essentials(words)
