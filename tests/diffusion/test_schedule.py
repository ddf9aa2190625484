import numpy as np
import pytest
import torch

from pipeline import seeds
from pipeline.diffusion.sampling import ancestral, ddim
from pipeline.diffusion.schedule import at, levels, linear


def test_the_paper_s_schedule():
    s = linear()
    assert s.timesteps == 1000
    assert s.beta[1] == pytest.approx(1e-4)
    assert s.beta[1000] == pytest.approx(0.02)
    np.testing.assert_allclose(s.alpha**2 + s.sigma**2, 1)
    np.testing.assert_allclose(s.alpha[1:] ** 2, np.cumprod(1 - s.beta[1:]))
    assert np.all(np.diff(s.alpha) < 0)
    assert s.alpha[0] == 1
    assert s.alpha[1000] < 0.01


def test_the_posterior_variance_is_between_zero_and_beta():
    s = linear()
    assert s.posterior_variance[1] == 0
    assert np.all(s.posterior_variance[2:] > 0)
    assert np.all(s.posterior_variance <= s.beta + 1e-15)


@pytest.mark.parametrize("timesteps", [100, 1000])
def test_other_lengths_end_as_noisy(timesteps):
    assert linear(timesteps).alpha[-1] < 0.02


@pytest.mark.parametrize(("coarse", "middle", "fine"), [(20, 12, 12), (10, 10, 10), (30, 12, 10)])
def test_windows_hold_their_evaluations(coarse, middle, fine):
    chosen = np.array(levels(1000, coarse, middle, fine))
    assert len(chosen) == coarse + middle + fine
    assert np.all(np.diff(chosen) < 0)
    assert chosen[0] == 1000
    assert chosen[-1] == 1
    assert (chosen < 10).sum() == fine
    assert ((chosen < 100) & (chosen >= 10)).sum() == middle


def test_levels_between_integers_lie_between():
    s = linear()
    for t in (1, 7, 500):
        assert at(s, t) == pytest.approx((s.alpha[t], s.sigma[t]))
        assert s.sigma[t] < at(s, t + 0.5)[1] < s.sigma[t + 1]


MEAN, SPREAD = 1.5, 0.4


def exact(x, alpha, sigma):
    """The expectation of x_0 given x_t for data that are N(1.5, 0.4^2)."""
    gain = alpha * SPREAD**2 / (alpha**2 * SPREAD**2 + sigma**2)
    return MEAN + gain * (x - alpha * MEAN)


def still(x0, level):
    return torch.zeros_like(x0)


def noise(draw):
    return torch.from_numpy(seeds.normal(3, "gauss", draw, shape=(4000, 1, 1)))


def test_both_samplers_draw_the_gaussian_that_the_denoiser_knows():
    schedule = linear()
    for x in (ddim(exact, still, noise, schedule, levels(1000, 30, 12, 12)), ancestral(exact, still, noise, schedule)):
        assert float(x.mean()) == pytest.approx(MEAN, abs=0.03)
        assert float(x.std()) == pytest.approx(SPREAD, rel=0.06)


def test_ddim_is_an_invertible_map_that_keeps_the_order_of_its_noise():
    x = ddim(exact, still, noise, linear(), levels(1000, 20, 12, 12)).flatten()
    assert float(x[noise(0).flatten().argsort()].diff().min()) > -1e-6


def test_a_shift_moves_the_sample_its_way():
    plain = ddim(exact, still, noise, linear(), levels(1000, 20, 12, 12))
    pushed = ddim(exact, lambda x0, level: torch.full_like(x0, 0.05 if level < 10 else 0.0), noise, linear(), levels(1000, 20, 12, 12))
    assert float((pushed - plain).min()) > 0.05
