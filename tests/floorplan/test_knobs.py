"""The knob experiment: programs in which every term can move, what counts as monotone, and the picture of it."""

import pytest

from benchmarks.knobs import VALUES, draw, knob_table, monotone, subjects
from pipeline.floorplan.search.energy import TERMS


@pytest.fixture(scope="module")
def table():
    return knob_table(2)


def test_every_knob_has_a_program_and_a_row_per_value(table):
    assert list(subjects()) == list(table) == list(TERMS)
    for found in table.values():
        assert len(found["mean"]) == len(found["error"]) == len(VALUES) == len(found["step"]) + 1
        assert found["ends"][0] == pytest.approx(sum(step for step, _ in found["step"]), abs=1e-4)


@pytest.mark.parametrize(
    ("steps", "ends", "falls"),
    [
        ([[-1.0, 0.1], [-1.0, 0.1]], [-2.0, 0.2], True),
        ([[-1.0, 0.1], [0.05, 0.1]], [-0.95, 0.2], True),  # within its error
        ([[-1.0, 0.1], [0.2, 0.1]], [-0.8, 0.2], False),
        ([[-0.1, 0.1], [-0.1, 0.1]], [-0.2, 0.1], False),  # too little
        ([[0.0, 0.0], [0.0, 0.0]], [0.0, 0.0], False),
    ],
)
def test_monotone_needs_steps_and_ends(steps, ends, falls):
    assert monotone({"step": steps, "ends": ends}) is falls


def test_the_table_is_drawn(table, tmp_path):
    draw(table, 2, tmp_path / "knobs.png")
    assert (tmp_path / "knobs.png").read_bytes().startswith(b"\x89PNG")
