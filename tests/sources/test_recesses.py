"""A board that is seen at two depths collides midway between them."""

from __future__ import annotations

import numpy as np

from pipeline.sources.meshes.mesh_solids import parts
from pipeline.sources.meshes.near_boxes import CORNERS, FACES
from pipeline.sources.meshes.recesses import FELT, MOST, stand_midway

DOOR = ((-0.2, 0.0, 0.1), (0.2, 0.02, 0.7))


def block(low, high):
    return np.array(low, float) + CORNERS * (np.array(high, float) - np.array(low, float))


def seen(*blocks):
    return np.concatenate([block(*b)[FACES] for b in blocks])


def framed(front, back):
    """A door with a frame of 6 cm about a panel between two depths."""
    (x0, y0, z0), (x1, y1, z1) = DOOR
    rail = 0.06
    return seen(
        ((x0, y0, z0), (x0 + rail, y1, z1)),
        ((x1 - rail, y0, z0), (x1, y1, z1)),
        ((x0 + rail, y0, z0), (x1 - rail, y1, z0 + rail)),
        ((x0 + rail, y0, z1 - rail), (x1 - rail, y1, z1)),
        ((x0 + rail, front, z0 + rail), (x1 - rail, back, z1 - rail)),
    )


def test_a_framed_door_is_half_its_recess_off_on_both_sides():
    found = stand_midway(block(*DOOR), framed(0.008, 0.014))
    assert np.allclose([found.min(axis=0), found.max(axis=0)], [[-0.2, 0.004, 0.1], [0.2, 0.017, 0.7]], atol=1e-6)
    assert parts(found, FACES)[0].fill > 0.999


def test_of_a_deep_recess_the_larger_part_is_what_is_felt():
    assert np.isclose(stand_midway(block(*DOOR), framed(0.0102, 0.014))[:, 1].min(), 0.0102 - FELT)


def test_no_face_stands_further_back_than_a_fingertip_feels():
    found = stand_midway(block((-0.2, 0.0, 0.1), (0.2, 0.04, 0.7)), framed(0.016, 0.02))
    assert found[:, 1].min() == MOST


def test_plain_boards_and_what_has_a_small_recess_stay():
    assert (stand_midway(block(*DOOR), seen(DOOR)) == block(*DOOR)).all()
    lip = seen(((-0.2, 0.0, 0.1), (0.2, 0.02, 0.64)), ((-0.2, 0.011, 0.64), (0.2, 0.02, 0.7)))
    assert np.allclose(stand_midway(block(*DOOR), lip), block(*DOOR), atol=1e-9)


def test_boards_that_bear_things_and_what_is_seen_through_stay():
    top = ((-0.2, -0.3, 0.5), (0.2, 0.3, 0.52))
    assert (stand_midway(block(*top), seen(((-0.2, -0.3, 0.5), (0.2, 0.3, 0.51)))) == block(*top)).all()
    assert (stand_midway(block(*DOOR), seen(((5, 5, 5), (6, 6, 6)))) == block(*DOOR)).all()
    thin = framed(0.0095, 0.0105)
    assert (stand_midway(block((-0.2, 0.008, 0.1), (0.2, 0.012, 0.7)), thin) == block((-0.2, 0.008, 0.1), (0.2, 0.012, 0.7))).all()
