"""What stands on what, from boxes alone."""

import numpy as np
import pytest

from pipeline import taxonomy
from pipeline.sources.settings import FrontFilters
from pipeline.sources.threed_front.furniture import Placed, find_overlaps, hangs_in_air, supports
from pipeline.sources.threed_front.house_file import Child
from pipeline.sources.threed_front.poses import Pose

WORDS = taxonomy.load()


def thing(category, x, y, z, size):
    pose = Pose(np.array([x, y, z]), 0.0, np.array(size), mirrored=False)
    return Placed(Child.__new__(Child), "jid", category, "asset", pose, np.ones(3), openable=False, notes=())


TABLE = thing("coffee_table", 1, 1, 0.015, (1.0, 0.6, 0.4))
SHELF = thing("bookshelf", 3, 1, 0, (1.0, 0.3, 2.0))


@pytest.mark.parametrize(
    ("made", "on"),
    [
        (thing("cup", 1.2, 1.1, 0.415, (0.1, 0.1, 0.1)), 0),  # on the table
        (thing("book", 3.1, 1, 0.9, (0.2, 0.25, 0.03)), 1),  # in the shelf
        (thing("vase", 3.1, 1, 2.0, (0.2, 0.2, 0.3)), 1),  # on the shelf
        (thing("cup", 2.0, 1.1, 0.415, (0.1, 0.1, 0.1)), -1),  # beside the table
        (thing("bucket", 2.0, 2.0, 0.0, (0.3, 0.3, 0.3)), -1),
        (thing("pendant_lamp", 1.0, 1.0, 1.5, (0.3, 0.3, 0.5)), -1),
    ],
)
def test_a_thing_stands_on_the_top_it_starts_at_or_in_the_box_around_it(made, on):
    rug = thing("rug", 1, 1, 0, (2.0, 1.4, 0.015))
    found = supports([TABLE, SHELF, rug, made], WORDS)
    assert found == [2, -1, -1, on]


def test_small_things_in_the_air_are_told_and_pictures_are_not():
    assert hangs_in_air(thing("cup", 0, 0, 0.4, (0.1, 0.1, 0.1)), -1, WORDS)
    assert not hangs_in_air(thing("cup", 0, 0, 0.4, (0.1, 0.1, 0.1)), 0, WORDS)
    assert not hangs_in_air(thing("picture", 0, 0, 1.4, (0.6, 0.03, 0.5)), -1, WORDS)
    assert not hangs_in_air(thing("wardrobe", 0, 0, 0.4, (1.0, 0.6, 2.0)), -1, WORDS)


def test_things_inside_furniture_do_not_overlap_it():
    book = thing("book", 3.1, 1, 0.9, (0.2, 0.25, 0.03))
    chair = thing("dining_chair", 3.1, 1, 0.0, (0.4, 0.3, 0.8))
    assert set(find_overlaps([SHELF, book, chair], FrontFilters(), WORDS)) == {2}
