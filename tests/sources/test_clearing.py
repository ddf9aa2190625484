"""Furniture out of walls and of each other: the least moves, in boxes made by hand."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from shapely.geometry import Polygon, box

from pipeline import taxonomy
from pipeline.sources.threed_front.clearing import GAP, SLACK, move_apart
from pipeline.sources.threed_front.furniture import Placed
from pipeline.sources.threed_front.house_file import Child
from pipeline.sources.threed_front.notches import CELLS
from pipeline.sources.threed_front.poses import Pose

WORDS = taxonomy.load()
ROOM = box(0, 0, 4, 3)
FARTHEST = 0.6


def piece(category, x, y, size, *, yaw=0.0, z=0.0, shape=b""):
    pose = Pose(np.array([x, y, z]), yaw, np.array(size), mirrored=False)
    return Placed(Child.__new__(Child), "jid", category, "asset", pose, np.ones(3), openable=False, notes=(), shape=shape)


def places(pieces, floor=ROOM, farthest=FARTHEST):
    return [tuple(np.round(p.pose.position[:2], 4)) for p in move_apart(pieces, floor, WORDS, farthest)]


def test_what_stands_free_stays_to_the_bit_and_has_no_note():
    pieces = [piece("wardrobe", 1, 2.69, (1.2, 0.6, 2.2)), piece("desk", 3, 2.69, (1.2, 0.6, 0.75))]
    assert move_apart(pieces, ROOM, WORDS, FARTHEST) == pieces


@pytest.mark.parametrize("yaw", [0.0, np.pi / 2, 0.3])
def test_a_piece_in_a_wall_comes_out_of_it_square_to_the_wall(yaw):
    deep = abs(1.2 * np.sin(yaw)) / 2 + abs(0.6 * np.cos(yaw)) / 2
    assert places([piece("wardrobe", 2, 3 - deep + 0.1, (1.2, 0.6, 2.2), yaw=yaw)]) == [(2.0, pytest.approx(3 - deep - GAP, abs=1e-4))]


def test_a_piece_in_a_corner_comes_out_of_both_walls():
    assert places([piece("plant", 0.1, 2.85, (0.4, 0.4, 1.0))]) == [(pytest.approx(0.2 + GAP), pytest.approx(2.8 - GAP))]


def test_a_piece_in_the_corner_that_juts_into_a_room_takes_the_shorter_way():
    corner = Polygon([(0, 0), (4, 0), (4, 3), (2, 3), (2, 2), (0, 2)])
    assert places([piece("cabinet", 2.35, 1.78, (0.8, 0.5, 1.0))], corner) == [(2.35, pytest.approx(1.75 - GAP))]


def test_one_of_two_pieces_gives_way_and_comes_to_stand_where_something_is_behind_it():
    """Three units in a row, the middle one pushed into the last: it goes back, rather than the last one on."""
    row = [piece("kitchen_cabinet", x, 2.697, (0.6, 0.6, 0.9)) for x in (0.302, 1.1, 1.506)]
    first, middle, last = places(row)
    assert (first, last) == ((0.302, 2.697), (1.506, 2.697))
    assert middle == (pytest.approx(1.506 - 0.6 - GAP, abs=1e-4), 2.697)


def test_chairs_stay_under_tables_and_tables_in_the_notch_of_a_sofa():
    table, chair = piece("dining_table", 2, 1.5, (1.6, 0.9, 0.75)), piece("dining_chair", 2, 0.95, (0.5, 0.5, 0.9))
    assert move_apart([table, chair], ROOM, WORDS, FARTHEST) == [table, chair]
    mask = np.zeros(CELLS, bool)
    mask[:, 12:, :] = mask[:8, :, :] = True  # an L: its back, and a third of its width
    sofa = piece("l_shaped_sofa", 2, 1.5, (2.4, 1.6, 0.8), shape=np.packbits(mask).tobytes())
    low = piece("coffee_table", 2.6, 1.05, (0.9, 0.6, 0.4))
    assert move_apart([sofa, low], ROOM, WORDS, FARTHEST) == [sofa, low]
    assert move_apart([replace(sofa, shape=b""), low], ROOM, WORDS, FARTHEST) != [sofa, low]


def test_what_stands_on_a_piece_moves_with_it_and_what_stands_on_a_rug_moves_alone():
    stand, lamp = piece("nightstand", 0.2, 1, (0.5, 0.4, 0.5)), piece("table_lamp", 0.2, 1, (0.2, 0.2, 0.4), z=0.5)
    made = move_apart([stand, lamp], ROOM, WORDS, FARTHEST)
    assert made[0].pose.position[0] == made[1].pose.position[0] == pytest.approx(0.25 + GAP)
    assert made[1].pose.position[2] == 0.5
    rug = piece("rug", 1, 1, (2.0, 1.9, 0.015))
    made = move_apart([rug, piece("armchair", 0.35, 1, (0.8, 0.8, 0.8), z=0.015)], ROOM, WORDS, FARTHEST)
    assert made[0] == rug
    assert made[1].pose.position[0] == pytest.approx(0.4 + GAP)


def test_lamps_rugs_and_things_above_each_other_do_not_conflict():
    pieces = [
        piece("ceiling_lamp", 2, 1.5, (0.6, 0.6, 0.3), z=2.4),
        piece("wardrobe", 2, 1.5, (1.2, 0.6, 2.5)),
        piece("rug", 2, 1.5, (2.0, 1.4, 0.015)),
        piece("kitchen_cabinet", 3.6, 2.69, (0.6, 0.6, 0.9)),
        piece("wall_cabinet", 3.6, 2.8, (0.6, 0.38, 0.7), z=1.45),
    ]
    assert move_apart(pieces, ROOM, WORDS, FARTHEST) == pieces


def test_nothing_is_moved_farther_than_it_may_be():
    deep = piece("wardrobe", 2, 3.1, (1.2, 1.4, 2.2))  # .8 m in the wall
    assert move_apart([deep], ROOM, WORDS, FARTHEST) == [deep]
    assert places([deep], farthest=1.0) == [(2.0, pytest.approx(2.3 - GAP))]


def harm(room):
    """What boxes share and what of them is in walls [m2]."""
    boxes = [p.footprint() for p in room]
    return sum(a.intersection(b).area for a, b in itertools.combinations(boxes, 2)) + sum(b.difference(ROOM).area for b in boxes)


@pytest.mark.parametrize("seed", range(20))
def test_no_room_is_worse_for_it(seed):
    """Rooms strewn at random: what boxes share, with each other and with walls, does not grow; nothing leaves its reach."""
    rng = np.random.default_rng(seed)
    names = ["wardrobe", "desk", "armchair", "cabinet", "plant", "nightstand"]
    pieces = [
        piece(
            str(rng.choice(names)), *rng.uniform([0, 0], [4, 3]), (*rng.uniform(0.3, 1.0, 2), 0.9), yaw=float(rng.choice([0.0, 1.57, 0.4]))
        )
        for _ in range(7)
    ]
    made = move_apart(pieces, ROOM, WORDS, FARTHEST)
    before, after = (harm(room) for room in (pieces, made))
    assert after <= before
    walls = ROOM.buffer(SLACK + 1e-4)
    for old, new in zip(pieces, made, strict=True):
        assert np.linalg.norm(new.pose.position - old.pose.position) <= FARTHEST + 1e-4
        assert walls.covers(new.footprint()) or not ROOM.covers(old.footprint())
        assert bool(new.notes) == (new.pose is not old.pose)
