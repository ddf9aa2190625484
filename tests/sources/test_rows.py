"""Rows of like things are one block each; what touches, what is unlike and what a hand comes between stays as it is."""

from __future__ import annotations

import numpy as np

from pipeline import taxonomy
from pipeline.sources.meshes.mesh_solids import convex_part
from pipeline.sources.meshes.near_boxes import CORNERS
from pipeline.sources.meshes.small_parts import rows_as_blocks
from pipeline.sources.meshes.touching import ANY, OVER, simplify_pieces, touch_tolerances


def block(low, high):
    return convex_part(np.array(low) + CORNERS * (np.array(high, float) - np.array(low)), 1.0)


def bottle(x, y=0.0, z=0.0, size=(0.06, 0.25, 0.06)):
    return block((x, y, z), np.array((x, y, z)) + size)


def test_bottles_of_a_rack_are_one_block_a_board():
    boards = [[bottle(0.09 * k, z=z) for k in range(4)] for z in (0.0, 0.3)]
    found = rows_as_blocks([bottle for board in boards for bottle in board])
    assert [np.ptp(p.hull, axis=0).round(3).tolist() for p in found] == [[0.33, 0.25, 0.06]] * 2


def test_grates_of_a_hob_are_one_block():
    grates = [bottle(x, y, 0.88, (0.2, 0.2, 0.03)) for x in (0.0, 0.24) for y in (0.0, 0.23)]
    (found,) = rows_as_blocks(grates)
    assert np.ptp(found.hull, axis=0).round(3).tolist() == [0.44, 0.43, 0.03]


def test_quarters_of_a_basin_two_boards_and_what_stands_apart_stay():
    basin = [bottle(0.0), bottle(0.06)]
    sides = [bottle(0.0, size=(0.02, 0.5, 0.8)), bottle(0.05, size=(0.02, 0.5, 0.8))]
    apart = [bottle(0.0), bottle(0.12)]
    unlike = [bottle(0.0), bottle(0.08, size=(0.06, 0.25, 0.12))]
    for pieces in (basin, sides, apart, unlike):
        assert len(rows_as_blocks(pieces)) == 2


def test_nothing_is_felt_above_what_a_robot_comes_to():
    how = touch_tolerances(taxonomy.load().categories["wardrobe"], opens=False)
    assert (how.over, touch_tolerances(taxonomy.load().categories["wall_cabinet"], opens=False).over) == (OVER, ANY)
    sides = [bottle(x, size=(0.02, 0.6, 2.15)) for x in (0.0, 1.0)]
    shelf, top = bottle(0.02, z=1.5, size=(0.98, 0.6, 0.02)), bottle(0.0, z=2.15, size=(1.02, 0.6, 0.03))
    assert len(simplify_pieces([*sides, shelf, top], how)) == 3
    lower = [bottle(x, size=(0.02, 0.6, 1.55)) for x in (0.0, 1.0)]
    assert (
        len(simplify_pieces([*lower, bottle(0.02, z=0.9, size=(0.98, 0.6, 0.02)), bottle(0.0, z=1.55, size=(1.02, 0.6, 0.03))], how)) == 4
    )
