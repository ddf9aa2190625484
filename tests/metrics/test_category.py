import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pipeline.metrics.two_samples import ckl, divergence, frequencies

NAMES = ("bed", "chair", "table")


def rows(**counts):
    return [{"category": name} for name, count in counts.items() for _ in range(count)]


@given(st.lists(st.integers(1, 40), min_size=3, max_size=3), st.lists(st.integers(1, 40), min_size=3, max_size=3))
def test_divergence_is_positive_and_zero_only_for_equals(a, b):
    p = frequencies([n for n, k in zip(NAMES, a, strict=True) for _ in range(k)], NAMES)
    q = frequencies([n for n, k in zip(NAMES, b, strict=True) for _ in range(k)], NAMES)
    assert divergence(p, p) == 0
    assert divergence(p, q) >= -1e-5  # the 1e-6 in the logarithms may cost that much


def test_both_directions():
    found = ckl(rows(bed=1, chair=1), rows(bed=3, chair=1), NAMES)
    assert found["real_to_generated"] == pytest.approx(0.5 * math.log(0.5 / 0.75) + 0.5 * math.log(0.5 / 0.25), abs=1e-4)
    assert found["generated_to_real"] == pytest.approx(0.75 * math.log(0.75 / 0.5) + 0.25 * math.log(0.25 / 0.5), abs=1e-4)
    assert (found["real_objects"], found["generated_objects"]) == (2, 4)


def test_a_missing_category_is_finite_and_large():
    assert 5 < ckl(rows(bed=1, chair=1), rows(bed=1), NAMES)["real_to_generated"] < 14
