"""Labels say what a room is and whose, as far as there is room for it."""

import numpy as np
import pytest
from PIL import Image

from pipeline.entities.plan import Room
from pipeline.preview.labels import draw_label, summed_area_table

SIZE = 16


def label(role, side):
    """Return the box of the label of a square bedroom of `side` pixels."""
    image = Image.new("RGB", (400, 400), "white")
    room = Room("a", "bedroom", np.array([[0, 0], [3, 0], [3, 3], [0, 3.0]]), role=role)
    pixels = np.array([[0, 0], [side, 0], [side, side], [0, side]], float)
    return draw_label(image, room, pixels, summed_area_table(np.zeros((400, 400), bool)), SIZE)


def width(box):
    return box[2] - box[0]


@pytest.mark.parametrize("role", ["child", "primary", "guest"])
def test_a_bedroom_of_somebody_says_so(role):
    assert width(label(role, 300)) > width(label("", 300))


def test_where_there_is_no_room_for_that_it_is_a_bedroom_and_then_an_area():
    plain, short = (width(label("", side)) for side in (300, 60))
    assert width(label("primary", plain + 4)) == plain
    assert 0 < short < plain
    assert label("primary", 20) is None
