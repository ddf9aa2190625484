import math

import numpy as np
import pytest
import torch

from pipeline import seeds
from pipeline.diffusion.schedule import FIRST, LAST, alpha_sigma, alpha_sigma_of, alpha_squared, denoise, lambda_of, levels, paper_levels


def test_the_paper_s_schedule():
    share = alpha_squared()
    assert len(share) == 1001
    assert share[0] == 1
    np.testing.assert_allclose(share[1:] / share[:-1], 1 - np.linspace(1e-4, 0.02, 1000))


def test_levels_of_the_paper_are_log_signal_to_noise_ratios():
    share = alpha_squared()
    for t in (1, 10, 100, 1000):
        assert lambda_of(t) == pytest.approx(math.log(share[t] / (1 - share[t])))
    assert lambda_of(100) < lambda_of(55.5) < lambda_of(10)
    assert len(paper_levels()) == 1000
    assert np.all(np.diff(paper_levels()) > 0)


@pytest.mark.parametrize("count", [2, 8, 36])
def test_few_levels_are_even_and_reach_both_ends(count):
    chosen = np.array(levels(count))
    assert (chosen[0], chosen[-1]) == (FIRST, LAST)
    np.testing.assert_allclose(np.diff(chosen), (LAST - FIRST) / (count - 1))


def test_alpha_and_sigma_are_those_of_the_level():
    for level in (-6.0, 0.0, 3.0):
        alpha, sigma = alpha_sigma_of(level)
        assert alpha**2 + sigma**2 == pytest.approx(1)
        assert math.log(alpha**2 / sigma**2) == pytest.approx(level)
        assert [float(v) for v in alpha_sigma(torch.tensor(level))] == pytest.approx([alpha, sigma], rel=1e-5)


MEAN, SPREAD = 1.5, 0.4


def exact(x, level):
    """The expectation of x_0 given x_t for data that are N(1.5, 0.4^2)."""
    alpha, sigma = alpha_sigma_of(level)
    gain = alpha * SPREAD**2 / (alpha**2 * SPREAD**2 + sigma**2)
    return MEAN + gain * (x - alpha * MEAN)


def still(x0, level):
    return x0


def noise():
    rng = seeds.generator(3, "gauss")
    return lambda: torch.from_numpy(rng.standard_normal((4000, 1, 1), np.float32))


@pytest.mark.parametrize("eta", [0.0, 0.5, 1.0])
def test_every_solver_draws_the_gaussian_that_the_denoiser_knows(eta):
    x = denoise(exact, still, noise(), np.linspace(-9, 12, 120).tolist(), eta)
    assert float(x.mean()) == pytest.approx(MEAN, abs=0.03)
    assert float(x.std()) == pytest.approx(SPREAD, rel=0.08)


@pytest.mark.parametrize("eta", [0.0, 1.0])
def test_a_few_steps_keep_the_spread_of_the_data(eta):
    """Steps of first order, which take x0 as constant, come out with .35 and .30 of the .4 here."""
    assert float(denoise(exact, still, noise(), levels(12), eta).std()) == pytest.approx(SPREAD, rel=0.06)


def test_the_thousand_levels_of_the_paper_are_the_reference():
    x = denoise(exact, still, noise(), paper_levels())
    assert float(x.mean()) == pytest.approx(MEAN, abs=0.03)
    assert float(x.std()) == pytest.approx(SPREAD, rel=0.06)


def test_without_noise_it_is_an_invertible_map_that_keeps_the_order():
    x = denoise(exact, still, noise(), levels(40), 0.0).flatten()
    assert float(x[noise()().flatten().argsort()].diff().min()) > -1e-6


def test_with_noise_it_forgets_where_it_began():
    x = denoise(exact, still, noise(), levels(40)).flatten()
    assert abs(float(np.corrcoef(x, noise()().flatten())[0, 1])) < 0.1


def test_guidance_moves_the_sample_its_way():
    plain = denoise(exact, still, noise(), levels(30))
    pushed = denoise(exact, lambda x0, level: x0 + 0.05 * (level > 6), noise(), levels(30))
    assert float((pushed - plain).min()) > 0.04
