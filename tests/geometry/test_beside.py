"""What flanks a larger thing keeps its distance from it when either gets another size."""

import numpy as np
import pytest

from pipeline.geometry.beside import NEAR, sideways

BED, STAND = [1.8, 2.0, 1.0], [0.45, 0.4, 0.6]
WIDER = [0.55, 0.4, 0.6]


def scene(gap=0.08, yaw=0.0, lift=0.0):
    """A nightstand to the right of a bed, both turned by `yaw`; its underside is `lift` above the bed's."""
    u = np.array([np.cos(yaw), np.sin(yaw)])
    beside = (BED[0] + STAND[0]) / 2 + gap
    centres = np.array([[2.0, 2.0, 0.0], [*(np.array([2.0, 2.0]) + beside * u), lift]])
    return centres, np.array([yaw, yaw]), np.array([BED, STAND]), u


def gap_of(centres, yaw, sizes):
    u = np.array([np.cos(yaw), np.sin(yaw)])
    return abs(np.dot(centres[1, :2] - centres[0, :2], u)) - (sizes[0, 0] + sizes[1, 0]) / 2


@pytest.mark.parametrize("yaw", [0.0, 0.7, np.pi / 2, -2.0])
@pytest.mark.parametrize(("bed", "stand"), [(BED, WIDER), ([1.6, 2.0, 1.0], STAND), ([2.0, 2.0, 1.0], [0.4, 0.4, 0.5])])
def test_the_gap_stays_whoever_grows(yaw, bed, stand):
    centres, yaws, before, _ = scene(yaw=yaw)
    after = np.array([bed, stand])
    moves = sideways(centres, yaws, before, after)
    assert not moves[0].any()
    moved = centres.copy()
    moved[:, :2] += moves
    assert gap_of(moved, yaw, after) == pytest.approx(0.08, abs=1e-9)


def test_what_stands_far_or_above_or_askew_stays():
    for centres, yaws, before, _ in (scene(gap=NEAR + 0.01), scene(lift=1.2)):
        assert not sideways(centres, yaws, before, np.array([BED, WIDER])).any()
    centres, yaws, before, _ = scene()
    assert not sideways(centres, yaws + np.array([0.0, 0.4]), before, np.array([BED, WIDER])).any()


def test_a_row_without_room_stays_where_it_is():
    """Between two units that it touches a third can grow to neither side."""
    centres = np.array([[0.5, 0.3, 0.0], [1.25, 0.3, 0.0], [2.0, 0.3, 0.0]])
    before = np.array([[1.0, 0.6, 0.9], [0.5, 0.6, 0.9], [1.0, 0.6, 0.9]])
    after = before + np.array([[0.0], [0.1], [0.0]]) * np.array([1.0, 0.0, 0.0])
    assert not sideways(centres, np.zeros(3), before, after).any()


def test_slots_without_extent_neither_move_nor_count():
    centres, yaws, before, _ = scene()
    padded = np.concatenate([centres, centres[1:] + np.array([0.5, 0.0, 0.0])])
    sizes, after = np.concatenate([before, np.zeros((1, 3))]), np.array([BED, WIDER, BED])
    moves = sideways(padded, np.append(yaws, 0.0), sizes, after)
    assert moves[2].tolist() == [0.0, 0.0]
    np.testing.assert_allclose(moves[1], [0.05, 0.0], atol=1e-12)
