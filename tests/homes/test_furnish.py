from types import SimpleNamespace

from pipeline import taxonomy
from pipeline.diffusion.context import Demand
from pipeline.homes.furnish import demands


def job(layout_type, count=None, wishes=()):
    return SimpleNamespace(layout_type=layout_type, count=count, demands=tuple(wishes))


def test_a_room_is_to_hold_what_makes_it_that_room():
    words = taxonomy.load()
    asked = demands(job("kitchen"), words)
    assert [d.categories for d in asked] == list(words.essentials["kitchen"])
    assert all(d.least == 1 for d in asked)
    assert demands(job("hallway"), words) == ()


def test_a_stated_number_of_things_is_not_crowded_by_essentials():
    assert demands(job("kitchen", count=2), taxonomy.load()) == ()


def test_a_wish_takes_the_place_of_an_essential():
    none = Demand(("oven",), most=0)
    asked = demands(job("kitchen", wishes=[none]), taxonomy.load())
    assert [d for d in asked if "oven" in d.categories] == [none]
    assert any(d.least == 1 and "sink_cabinet" in d.categories for d in asked)
