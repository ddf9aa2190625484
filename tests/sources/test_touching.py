"""Colliders become fewer and plainer, and are felt for the same."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull

from pipeline import taxonomy
from pipeline.sources.meshes.mesh_solids import convex_part, distances_outside
from pipeline.sources.meshes.near_boxes import CORNERS
from pipeline.sources.meshes.small_parts import without_feet
from pipeline.sources.meshes.touching import (
    ANY,
    FELT,
    OVER,
    TouchTolerances,
    drop_unfelt,
    merge_by_touch,
    simplify_pieces,
    touch_tolerances,
)


def block(low, high):
    return convex_part(np.array(low) + CORNERS * (np.array(high, float) - np.array(low)), 1.0)


def even(tolerance):
    """The same everywhere."""
    return lambda points, normals: np.full(len(points), tolerance)


def ring(count, inner, outer, height):
    """The staves of a cup without a floor."""
    made = []
    for k in range(count):
        a = 2 * np.pi * (k + np.array([0, 1])) / count
        flat = np.concatenate([r * np.stack([np.cos(a), np.sin(a)], axis=1) for r in (inner, outer)])
        made.append(convex_part(np.concatenate([np.column_stack([flat, np.full(4, z)]) for z in (0, height)]), 1.0))
    return made


def test_a_ring_has_fewer_staves_and_stays_hollow():
    staves = ring(40, 0.036, 0.04, 0.09)
    found = merge_by_touch(staves, even(0.005))
    assert 4 < len(found) <= 12
    for piece in found:  # no point of a face is further inwards than the tolerance
        faces = piece.hull[piece.faces]
        middle = faces.mean(axis=1)
        assert np.linalg.norm(middle[:, :2], axis=1).min() > 0.036 * np.cos(np.pi / 40) - 0.005


def test_boards_of_a_box_stay_apart_and_those_in_line_become_one():
    side, floor = block((0, 0, 0), (0.02, 0.4, 0.5)), block((0.02, 0, 0), (0.5, 0.4, 0.02))
    assert len(merge_by_touch([side, floor], even(0.005))) == 2
    assert len(merge_by_touch([floor, block((0.5, 0, 0), (0.9, 0.4, 0.02))], even(0.005))) == 1


def test_what_is_small_is_changed_less():
    thin = [block((0, 0, 0), (0.1, 0.1, 0.004)), block((0.02, 0.02, 0.004), (0.03, 0.03, 0.007))]
    assert len(simplify_pieces(thin, TouchTolerances())) == 2
    assert len(simplify_pieces(thin, TouchTolerances(0.03, 0.03, 0.03))) == 1


def test_a_cup_is_true_from_without_and_holds_something_within():
    floor = block((-0.025, -0.025, 0), (0.025, 0.025, 0.006))
    found = simplify_pieces([*ring(24, 0.036, 0.04, 0.09), floor], TouchTolerances(vessel=True))
    assert len(found) <= 8
    for piece in found:
        assert np.linalg.norm(piece.hull[:, :2], axis=1).max() < 0.04 + 1e-9
        assert (ConvexHull(piece.hull).equations @ [0.02, 0.0, 0.03, 1.0]).max() > 0


def test_what_is_closed_is_a_disc():
    (found,) = simplify_pieces(ring(24, 0.036, 0.04, 0.09), TouchTolerances(closed=True))
    assert found.hull_volume > 0.95 * np.pi * 0.04**2 * 0.09


def test_legs_are_one_block_where_no_hand_comes_and_legs_elsewhere():
    legs = [block((x, y, 0), (x + 0.04, y + 0.04, 0.15)) for x in (0, 0.5) for y in (0, 0.4)]
    bottom, back = block((0, 0, 0.15), (0.54, 0.44, 0.17)), block((0, 0.42, 0.17), (0.54, 0.44, 0.6))
    assert len(simplify_pieces([*legs, bottom, back], TouchTolerances(under=0.2))) == 2
    assert len(simplify_pieces([*legs, bottom, back], TouchTolerances())) == 6


def test_no_block_stands_in_the_corner_of_an_l_shaped_sofa():
    seats = [block((0, 0, 0.15), (3, 1, 0.45)), block((0, 1, 0.15), (1, 2, 0.45))]
    plinth = [block((0.05, 0.05, 0), (2.95, 0.95, 0.15)), block((0.05, 0.95, 0), (0.95, 1.95, 0.15))]
    legs = [block((x, y, 0), (x + 0.05, y + 0.05, 0.15)) for x, y in ((0, 0), (2.9, 0), (2.9, 0.9), (0, 1.9), (0.9, 1.9), (0.9, 0.9))]
    for under in (plinth, legs):
        found = simplify_pieces([*seats, *under], TouchTolerances(0.045, 0.08, 0.15, under=0.4, cell=0.02))
        assert all(distances_outside(np.array([[2.0, 1.5, z]]), ConvexHull(p.hull).equations)[0] > 0.4 for p in found for z in (0.05, 0.3))
        assert len(found) <= 4


def test_what_lies_within_other_pieces_is_not_felt():
    rails = [block((0, 0, 0.2), (0.03, 2, 0.4)), block((1.37, 0, 0.2), (1.4, 2, 0.4))]
    mattress = block((0.03, 0, 0.25), (1.37, 2, 0.4))
    (whole,) = simplify_pieces([*rails, mattress], TouchTolerances(sides=0.06, down=0.15))
    assert np.allclose([whole.hull.min(axis=0), whole.hull.max(axis=0)], [[0, 0, 0.2], [1.4, 2, 0.4]])
    assert len(simplify_pieces([*rails, mattress], TouchTolerances())) == 3


def test_a_gap_that_something_else_closes_is_not_felt():
    """Two rails before a headboard, a millimetre off."""
    rails = [block((x, 0, 0), (x + 0.1, 1, 0.1)) for x in (0, 0.3)]
    board = block((0, 1.001, 0), (0.4, 1.02, 5))
    assert len(merge_by_touch([*rails, board], lambda at, normals: np.where(normals[:, 1] > 0.9, 0.01, 0.2), 0.25)) == 2


def test_what_is_felt_the_same_without_a_piece_has_none():
    worktop, bottom = block((0, 0, 0), (1, 0.6, 0.03)), block((0.3, 0.2, 0.03), (0.5, 0.4, 0.042))
    assert drop_unfelt([worktop, bottom], even(0.015)) == (worktop,)
    assert len(drop_unfelt([worktop, bottom], even(0.005))) == 2


def test_a_vessel_keeps_its_floor():
    tub = [block((0, 0, 0), (1.6, 0.7, 0.05)), block((0.1, 0.1, 0.05), (1.5, 0.6, 0.15))]
    assert len(drop_unfelt(tub, even(0.15))) == 2


def test_furniture_that_is_shut_is_a_block_and_open_furniture_keeps_its_boards():
    sides = [((0, 0, 0), (0.02, 0.4, 0.8)), ((0.58, 0, 0), (0.6, 0.4, 0.8)), ((0, 0.39, 0), (0.6, 0.4, 0.8)), ((0, 0, 0), (0.6, 0.4, 0.02))]
    boards = [block(*b) for b in (*sides, ((0, 0, 0.78), (0.6, 0.4, 0.8)), ((0.02, 0, 0.4), (0.58, 0.39, 0.42)))]
    assert len(simplify_pieces([*boards, block((0, 0, 0), (0.6, 0.02, 0.8))], TouchTolerances(cell=0.02))) == 1
    assert len(simplify_pieces(boards, TouchTolerances(cell=0.02))) == 6


def test_shelves_on_both_sides_of_a_board_are_one():
    board = block((0.49, 0, 0), (0.51, 0.4, 1))
    shelves = [block((0, 0, 0.5), (0.49, 0.4, 0.52)), block((0.51, 0, 0.5), (1, 0.4, 0.52))]
    assert len(simplify_pieces([board, *shelves], TouchTolerances())) == 2


def test_a_frame_becomes_one_with_what_it_holds():
    rails = [
        block(*b)
        for b in (((0, 0, 0), (0.02, 1, 0.1)), ((0.98, 0, 0), (1, 1, 0.1)), ((0, 0, 0), (1, 0.02, 0.1)), ((0, 0.98, 0), (1, 1, 0.1)))
    ]
    filling = block((0.02, 0.02, 0), (0.98, 0.98, 0.09))
    knob = block((0.4, -0.2, 0.02), (0.6, -0.1, 0.08))
    assert sorted(len(p.hull) for p in merge_by_touch([*rails, filling, knob], even(0.012))) == [8, 8]


def test_what_is_only_seen_is_one_piece():
    boards = [block((x, 0, 0), (x + 0.1, 0.02, 1)) for x in (0, 2)]
    assert len(simplify_pieces(boards, FELT["seen"])) == 1


def test_soft_things_lie_flat_however_round_they_are():
    turn = np.random.default_rng(0).normal(size=(400, 3))
    ball = convex_part(turn / np.linalg.norm(turn, axis=1)[:, None] * [0.2, 0.15, 0.05], 1.0)
    (lies,) = simplify_pieces([ball], FELT["soft"])
    sole = lies.hull[lies.hull[:, 2] < lies.hull[:, 2].min() + 1e-6]
    assert np.ptp(sole[:, 0]) > 0.25
    assert np.ptp(sole[:, 1]) > 0.19
    assert len(sole) <= 8


def test_no_edge_of_a_soft_thing_all_but_lies():
    """PhysX takes such an edge for part of the sole, and the towel creeps."""
    rings = ((0.85, 0.0), (0.94, 0.004), (0.98, 0.011), (1.0, 0.02), (1.0, 0.17))
    corners = [(0.15 * s * x, 0.1 * s * y, z) for s, z in rings for x, y in ((-1, -0.9), (-0.9, -1), (0.9, 1), (1, 0.9), (1, -1), (-1, 1))]
    (lies,) = simplify_pieces([convex_part(np.array(corners), 1.0)], FELT["soft"])
    heights = lies.hull[:, 2]
    assert not ((heights > 1e-6) & (heights < 0.02)).any()


def test_cushions_have_level_tops():
    swell = convex_part(
        np.array([(x, y, 0.1 - 0.02 * (x * x + y * y)) for x in np.linspace(-1, 1, 7) for y in np.linspace(-1, 1, 7)] + [(0, 0, 0)]), 1.0
    )
    (found,) = simplify_pieces([swell], TouchTolerances(up=0.035, lift=0.05))
    assert np.ptp(found.hull[found.hull[:, 2] > 0.1 - 1e-9][:, :2], axis=0).min() > 1.9


def test_a_bar_before_a_door_has_no_feet_and_fingers_come_behind_it():
    door, bar = block((-0.2, 0, 0), (0.2, 0.02, 0.7)), block((-0.08, -0.032, 0.6), (0.08, -0.02, 0.612))
    feet = [block((x, -0.026, 0.601), (x + 0.01, -5e-5, 0.611)) for x in (-0.06, 0.05)]
    found = simplify_pieces([door, bar, *feet], TouchTolerances())
    assert sorted(len(p.hull) for p in found) == [8, 8]
    assert {round(float(np.ptp(p.hull[:, 1])), 3) for p in found} == {0.02, 0.012}


def test_a_chain_of_small_pieces_keeps_its_links_and_a_peg_stays():
    door = block((-0.2, 0, 0), (0.2, 0.02, 0.7))
    links = [block((x, -0.1, 0.6), (x + 0.03, -0.09, 0.61)) for x in (-0.045, -0.015, 0.015)]
    assert without_feet([door, *links]) == [door, *links]
    peg = block((0.1, -0.03, 0.3), (0.11, 0, 0.31))
    assert without_feet([door, peg]) == [door, peg]


def test_a_lid_keeps_its_knob():
    turns = 2 * np.pi * np.arange(24) / 24
    disc = convex_part(
        np.concatenate([np.column_stack([r * np.cos(turns), r * np.sin(turns), np.full(24, z)]) for r, z in ((0.1, 0), (0.06, 0.012))]), 1.0
    )
    knob = convex_part(
        np.concatenate([np.column_stack([0.018 * np.cos(turns), 0.018 * np.sin(turns), np.full(24, z)]) for z in (0.013, 0.04)]), 1.0
    )
    assert len(simplify_pieces([disc, knob], TouchTolerances(vessel=True))) == 2


def test_spindles_of_a_bed_are_one_and_table_legs_stay():
    spindles = [block((x, 1.0, 0.45), (x + 0.014, 1.012, 1.0)) for x in np.arange(-0.6, 0.61, 0.133)]
    rails = [block((-0.62, 1.0, z), (0.63, 1.02, z + 0.03)) for z in (0.45, 0.97)]
    mattress = block((-0.62, -1.0, 0), (0.63, 1.0, 0.5))
    categories = taxonomy.load().categories
    assert len(simplify_pieces([*spindles, *rails, mattress], touch_tolerances(categories["double_bed"], opens=False))) == 2
    legs = [block((x, y, 0), (x + 0.04, y + 0.04, 0.7)) for x in (0, 0.5) for y in (0, 0.4)]
    top = block((0, 0, 0.7), (0.54, 0.44, 0.72))
    assert len(simplify_pieces([*legs, top], touch_tolerances(categories["dining_table"], opens=False))) == 5


def test_under_a_bar_nothing_is_felt_that_the_bar_does_not_keep_one_from():
    arch = [
        convex_part(np.array([(x, y + d, z) for x in (0, 0.02) for y, z in ends for d in (0, 0.02)]), 1.0)
        for ends in (((0, 0), (0.1, 0.04)), ((0.1, 0.04), (0.2, 0)))
    ]
    assert len(merge_by_touch(arch, even(0.01), 0.02)) == 2
    assert len(merge_by_touch(arch, even(0.01), 0.02, sag=0.05)) == 1
    top = block((-0.5, -0.5, 0.06), (0.5, 0.7, 0.08))  # under a worktop one reaches into a drawer
    assert len(merge_by_touch([*arch, top], even(0.01), 0.02, sag=0.05)) == 3


def test_a_cup_with_its_handle_is_truer_than_a_bottle():
    categories = taxonomy.load().categories
    assert touch_tolerances(categories["cup"], opens=False).sides < touch_tolerances(categories["bottle"], opens=False).sides


def test_nothing_is_felt_above_what_a_robot_comes_to():
    how = touch_tolerances(taxonomy.load().categories["wardrobe"], opens=False)
    assert (how.over, touch_tolerances(taxonomy.load().categories["wall_cabinet"], opens=False).over) == (OVER, ANY)
    for height, count in ((2.15, 3), (1.55, 4)):
        sides = [block((x, 0, 0), (x + 0.02, 0.6, height)) for x in (0.0, 1.0)]
        shelf, top = block((0.02, 0, 0.7 * height), (1.0, 0.6, 0.7 * height + 0.02)), block((0.0, 0, height), (1.02, 0.6, height + 0.03))
        assert len(simplify_pieces([*sides, shelf, top], how)) == count
