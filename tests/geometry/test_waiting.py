"""Which joints wait for others, from geometry alone."""

from pipeline.corpus.furniture.assembly import build
from pipeline.corpus.furniture.catalogue import catalogue
from pipeline.geometry.waiting import ordered, waiting
from tests.geometry.furniture import inner_drawer


def test_a_drawer_waits_for_the_door_before_it():
    assert waiting(inner_drawer()) == [(), (0,)]
    assert waiting(inner_drawer(outer=True)) == [(), ()]
    assert [j.after for j in ordered(inner_drawer()).joints] == [(), ("door",)]


def test_what_an_open_door_does_not_help_waits_for_nothing():
    assert waiting(inner_drawer(angle=0.3)) == [(), ()]  # the door is still in the way when it is open


def test_the_catalogue_says_the_same():
    """What the builders declare is found again; a key under a flap can travel, it only cannot be reached."""
    by_form = {(m.category, m.form): m for m in catalogue(0).partnet}
    declared = 0
    for model in by_form.values():
        made = build(model)
        for joint, found in zip(made.joints, waiting(made), strict=True):
            if joint.part_class != "slider_button":
                assert {made.joints[i].name for i in found} == set(joint.after), (model.model_id, joint.name)
                declared += bool(joint.after)
    assert declared >= 3
