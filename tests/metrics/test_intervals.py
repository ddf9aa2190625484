import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pipeline.metrics.intervals import bootstrap, rate, wilson


@given(st.integers(0, 300), st.integers(1, 300))
def test_wilson_holds_the_share_and_mirrors(k, n):
    k = min(k, n)
    low, high = wilson(k, n)
    assert 0 <= low <= k / n <= high <= 1
    mirrored = wilson(n - k, n)
    assert (1 - mirrored[1], 1 - mirrored[0]) == pytest.approx((low, high))


def test_wilson_of_a_known_case():
    # 95 of 100: Newcombe 1998, method 3.
    assert wilson(95, 100) == pytest.approx((0.8882, 0.9785), abs=1e-4)
    assert rate(0, 0) == {"rate": 0.0, "low": 0.0, "high": 1.0, "successes": 0, "n": 0}


def test_more_trials_narrow_the_interval():
    widths = [np.diff(wilson(n // 2, n))[0] for n in (10, 100, 1000)]
    assert widths == sorted(widths, reverse=True)


def test_bootstrap_covers_the_mean():
    rng = np.random.default_rng(0)
    hits = 0
    for _ in range(200):
        found = bootstrap(rng, rng.normal(size=40).tolist(), 300)
        assert found["low"] <= found["mean"] <= found["high"]
        hits += found["low"] <= 0 <= found["high"]
    assert 175 <= hits <= 200
    assert bootstrap(rng, [])["n"] == 0
    assert bootstrap(rng, [2.0, 2.0]) == {"mean": 2.0, "low": 2.0, "high": 2.0, "n": 2}
