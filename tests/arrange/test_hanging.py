"""Where things hang: clear of openings, of furniture and of what moves; over and beside what they belong to; curtains at windows."""

import numpy as np
import pytest

from pipeline.arrange import Hanging
from pipeline.entities.plan import Opening
from pipeline.homes.clutter import lay_rug
from tests.geometry.furniture import SQUARE, placed

WINDOW = Opening("window", "window", ("room",), np.array([[1.0, 3.12], [2.2, 3.12]]), 1.3, 0.9)
DOOR = Opening("door", "door", ("room",), np.array([[0.3, -0.06], [1.2, -0.06]]), 2.05)
PICTURE = np.array([0.6, 0.03, 0.5])
WHOLE = np.array([[-1.0, 1.0, 0.0, 2.4]])  # a curtain as one piece
DRAWN = np.array([[-1.0, -0.6, 0.0, 2.4], [0.6, 1.0, 0.0, 2.4], [-1.0, 1.0, 2.3, 2.4]])


def walls(*boxes):
    """Boxes are x0, y0, x1, y1, z0, z1."""
    corners = np.array([[(b[0], b[1]), (b[2], b[1]), (b[2], b[3]), (b[0], b[3])] for b in boxes]).reshape(-1, 4, 2)
    heights = np.array([b[4:] for b in boxes]).reshape(-1, 2)
    return Hanging(SQUARE, (WINDOW, DOOR), corners, heights, 2.7)


def test_a_picture_hangs_over_the_middle_of_its_sofa_and_looks_into_the_room():
    sofa = (1.5, 0.0, 3.5, 0.9, 0.0, 0.8)
    (x, y, z), yaw = walls(sofa).hang(np.random.default_rng(0), PICTURE, 1.5, [placed("bed", 2.5, 1.0).footprint()], beside=False, tries=4)
    assert (x, y) == pytest.approx((2.5, 0.019))
    assert z == pytest.approx(1.25)
    assert abs(yaw) == pytest.approx(np.pi, abs=1e-4)  # the front (-y at yaw 0) looks to +y


@pytest.mark.parametrize("seed", range(20))
def test_nothing_hangs_in_openings_behind_tall_things_or_in_each_other(seed):
    rng = np.random.default_rng(seed)
    wardrobe = (3.4, 0.5, 4.0, 2.5, 0.0, 2.2)
    room = walls(wardrobe)
    hung = [found for _ in range(12) if (found := room.hang(rng, PICTURE, 1.5, [], beside=False, tries=6))]
    assert hung
    for k, ((x, y, _), _) in enumerate(hung):
        assert not (y > 2.9 and 0.7 < x < 2.5)  # the window
        assert not (y < 0.1 and x < 1.5)  # the door
        assert not (x > 3.9 and 0.2 < y < 2.8)  # the wardrobe
        assert all(np.linalg.norm(np.array(hung[j][0][:2]) - (x, y)) > 0.3 for j in range(k))


def test_what_belongs_beside_something_hangs_there_or_nowhere():
    vanity = placed("nightstand", 3.0, 0.2, np.pi)
    place = walls().hang(np.random.default_rng(0), PICTURE, 1.2, [vanity.footprint()], beside=True, tries=4)
    assert place is not None
    assert abs(float(place[0][0]) - 3.0) == pytest.approx(0.25 + 0.3 + 0.12)
    assert walls().hang(np.random.default_rng(0), PICTURE, 1.2, [], beside=True, tries=4) is None


def test_curtains_reach_beyond_their_window_and_stop_above_what_stands_there():
    size, low = np.array([2.0, 0.14, 2.4]), (1.2, 2.4, 2.0, 3.0, 0.0, 0.6)
    place, _, scale = walls().before(*walls().windows[0], size, WHOLE, 0.25, (0.03, 0.8))
    assert place[2] == 0.03
    assert (size * scale)[0] == pytest.approx(1.7)
    assert walls(low).before(*walls().windows[0], size, WHOLE, 0.25, (0.03, 0.8))[0][2] == 0.8
    assert walls(low).before(*walls().windows[0], size, DRAWN, 0.25, (0.03, 0.8))[0][2] == 0.03  # it stands between the two panels
    assert walls((1.2, 2.4, 2.0, 3.0, 0.0, 2.2)).before(*walls().windows[0], size, WHOLE, 0.25, (0.03, 0.8)) is None


def test_a_rug_lies_flat_within_the_room_and_off_cabinets():
    size = np.array([2.0, 1.4, 0.015])
    middle, yaw, scale = lay_rug(SQUARE, size, [(2.0, 1.5, 0.0)], [])
    assert (middle.tolist(), yaw) == ([2.0, 1.5], 0.0)
    assert size[2] * scale[2] == pytest.approx(0.004)
    assert scale[0] == 1.15
    assert lay_rug(SQUARE, size, [(2.0, 0.85, 0.0)], [])[2][0] == 1.0  # smaller where the wall is near
    assert lay_rug(SQUARE, size, [(2.0, 1.5, 0.0)], [placed("block", 2.0, 1.5)]) is None
    assert lay_rug(SQUARE, size, [(2.0, 0.7, 0.0), (2.0, 1.5, 0.0)], [])[0].tolist() == [
        2.0,
        0.7,
    ]  # rather small there than large elsewhere
