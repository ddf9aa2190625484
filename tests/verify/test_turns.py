"""What waits for a door is judged with that door open."""

import numpy as np
import pytest

from pipeline.geometry.prerequisites import with_prerequisites
from pipeline.verify import verify_home
from tests.geometry.furniture import LIBRARY, home, inner_drawer, placed
from tests.judging import SETTINGS


def judged(*things, made):
    return verify_home(home(tuple(placed(name, x, y, yaw) for name, x, y, yaw in things)), LIBRARY | {made.asset_id: made}, SETTINGS)


@pytest.fixture
def cabinet(monkeypatch):
    made = with_prerequisites(inner_drawer())
    monkeypatch.setitem(LIBRARY, made.asset_id, made)
    return made


def test_the_judge_opens_the_door_first(cabinet):
    free = judged(("inner", 2.0, 2.74, 0.0), made=cabinet).joints
    assert [(j.joint_id, j.clear, j.after) for j in free[:2]] == [("door", True, ()), ("drawer", True, ("door",))]
    x, y, _ = free[1].stand
    assert np.hypot(x - 1.7, y - 2.48) > 0.6 or x > 1.95 or y < 1.9  # clear of the way of the door


def test_a_drawer_does_not_come_out_when_its_door_is_blocked(cabinet):
    # A nightstand at the left, where the open door ends and no drawer comes.
    found = judged(("inner", 2.0, 2.74, 0.0), ("nightstand", 1.7, 1.8, 0.0), made=cabinet)
    door, drawer = found.joints[:2]
    assert not door.clear
    assert (drawer.clear, drawer.clear_upper, drawer.blocker) == (False, 0.0, door.blocker)
    assert found.joint_rows()[1]["after"] == ["door"]
