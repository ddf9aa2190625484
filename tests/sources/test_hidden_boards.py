"""A chest has no boards that nobody can touch, and what holds things stays."""

from __future__ import annotations

import numpy as np

from pipeline.entities.asset import Link
from pipeline.rendering.boxes import box
from pipeline.sources.articulated.hidden_boards import without_hidden
from pipeline.sources.articulated.shape import ShapeJoint


def link(name, boards):
    made = tuple(box(key, *ends) for key, ends in boards.items())
    return Link(name, made, made, 1.0, np.zeros(3), np.eye(3))


def chest(wall):
    """A chest of one drawer whose sides are `wall` [m] high, under a top 0.3 m up."""
    base = link(
        "base",
        {
            "top": ((-0.22, -0.22, 0.3), (0.22, 0.22, 0.32)),
            "left": ((-0.22, -0.2, 0), (-0.2, 0.22, 0.3)),
            "right": ((0.2, -0.2, 0), (0.22, 0.22, 0.3)),
            "back": ((-0.2, 0.212, 0), (0.2, 0.22, 0.3)),
            "bottom": ((-0.2, -0.2, 0), (0.2, 0.212, 0.02)),
        },
    )
    drawer = link(
        "drawer",
        {
            "front": ((-0.22, -0.22, 0.01), (0.22, -0.202, 0.298)),
            "floor": ((-0.196, -0.202, 0.024), (0.196, 0.198, 0.032)),
            "wall_left": ((-0.196, -0.202, 0.032), (-0.184, 0.198, wall)),
            "wall_right": ((0.184, -0.202, 0.032), (0.196, 0.198, wall)),
            "end": ((-0.184, 0.186, 0.032), (0.184, 0.198, wall)),
        },
    )
    joint = ShapeJoint("slide", "prismatic", 0, 1, np.array([0.0, -1.0, 0.0]), np.zeros(3), 0.0, 0.3, "slider_drawer")
    return [base, drawer], [joint]


def names(found):
    return {c.name for c in found.colliders}


def test_boards_along_the_walls_of_a_shut_drawer_are_left_out():
    base, drawer = without_hidden(*chest(0.296))
    assert "top" in names(base)
    assert not names(base) & {"left", "right", "back"}
    assert "end" in names(drawer)


def test_a_drawer_keeps_its_back_before_that_of_the_carcass():
    """It is pulled out, and what stands in it would fall off behind."""
    base, drawer = without_hidden(*chest(0.12))
    assert names(base) >= {"top", "left", "right", "back"}
    assert names(drawer) == {"front", "floor", "wall_left", "wall_right", "end"}


def test_what_has_no_drawer_stays_as_it_is():
    links, _ = chest(0.2)
    assert without_hidden(links, []) == links
