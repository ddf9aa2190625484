"""Programs whose plans once had a fault that no other test shows."""

import numpy as np
import pytest

from pipeline.entities.plan import Room
from pipeline.floorplan.realise.realisation import NARROW, _is_narrow
from tests.floorplan.attempts import attempt


@pytest.mark.parametrize("number", [461, 620, 705, 1019, 2288])
def test_programs_of_the_prior_that_failed_once(number):
    assert attempt(("prior", number))[1] == []


def test_a_program_of_an_independent_generator_that_failed_once():
    assert attempt(("trees", 626))[1] == []


@pytest.mark.parametrize(
    ("width", "arm", "narrow"), [(NARROW, 2.0, False), (NARROW - 0.01, 2.0, True), (2.0, NARROW, False), (2.0, NARROW - 0.01, True)]
)
def test_narrow_rooms(width, arm, narrow):
    straight = np.array([[0, 0], [3, 0], [3, width], [0, width]], float)
    ell = np.array([[0, 0], [4, 0], [4, arm], [2, arm], [2, 3], [0, 3]], float)
    assert _is_narrow(Room("a", "wc", straight if width < 2 else ell, 0)) == narrow
