"""Solvers and levels beside each other, with the released weights, on the rooms of the held-out split.

    python -m benchmarks.ablations.solvers FOLDER [solver ...]

Writes FOLDER/<solver>.npz, which `benchmarks.ablations.score` reads.
"""

import math
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from types import MappingProxyType
from unittest.mock import patch

os.environ.setdefault("OMP_NUM_THREADS", "1")

import torch
from torch import Tensor

from benchmarks.ablations.drawing import held_out, write_rooms
from pipeline.diffusion import sampling
from pipeline.diffusion.checkpoint import load_weights
from pipeline.diffusion.rooms import read_sets
from pipeline.diffusion.schedule import FIRST, LAST, Expect, Guide, Noise, alpha_sigma_of, denoise, levels

ROOT = Path(__file__).resolve().parents[2]
WEIGHTS = ROOT / "weights" / "denoiser.safetensors"
Solve = Callable[[Expect, Guide, Noise, Sequence[float], float], Tensor]


def first_order(expect: Expect, guide: Guide, noise: Noise, at_levels: Sequence[float], eta: float) -> Tensor:
    """DDIM (Song et al. 2021) where `eta` is 0, DDPM's ancestral step between levels of any distance where it is 1."""
    x = noise()
    for level, following in pairwise(at_levels):
        x0 = guide(expect(x, level), level)
        (alpha, sigma), (alpha_next, sigma_next) = alpha_sigma_of(level), alpha_sigma_of(following)
        fresh = eta * sigma_next * math.sqrt(-math.expm1(level - following))
        x = alpha_next * x0 + math.sqrt(max(sigma_next**2 - fresh**2, 0.0)) * (x - alpha * x0) / sigma + fresh * noise()
    return guide(expect(x, at_levels[-1]), at_levels[-1])


def churned(expect: Expect, guide: Guide, noise: Noise, at_levels: Sequence[float], churn: float, heun: bool) -> Tensor:
    """Euler's or Heun's steps of Karras et al. 2022, before each of which the noise grows by the share `churn`."""
    x = noise()
    for level, following in pairwise(at_levels):
        noisier = max(level - 2 * math.log1p(churn), FIRST)
        (alpha, sigma), (alpha_more, sigma_more) = alpha_sigma_of(level), alpha_sigma_of(noisier)
        added = math.sqrt(max((sigma_more / alpha_more) ** 2 - (sigma / alpha) ** 2, 0.0))
        x = alpha_more * (x / alpha + added * noise())
        x0 = guide(expect(x, noisier), noisier)
        alpha_next, sigma_next = alpha_sigma_of(following)
        ahead = alpha_next * x0 + sigma_next / sigma_more * (x - alpha_more * x0)
        if heun:
            x0 = (x0 + guide(expect(ahead, following), following)) / 2
            ahead = alpha_next * x0 + sigma_next / sigma_more * (x - alpha_more * x0)
        x = ahead
    return guide(expect(x, at_levels[-1]), at_levels[-1])


def middle_levels(count: int) -> tuple[float, ...]:
    """Return levels that lie closer where arrangement is decided, around lambda 0.5."""
    share = torch.linspace(-1, 1, count, dtype=torch.float64)
    bent = 0.6 * share + 0.4 * share**3
    return tuple((0.5 * (FIRST + LAST) + 0.5 * (LAST - FIRST) * bent).tolist())


@dataclass(frozen=True, slots=True)
class Solver:
    """A solver and what it may cost; `evaluations` 0: the paper's thousand."""

    says: str
    evaluations: int
    solve: Solve
    levels: Callable[[int], tuple[float, ...]] = levels


def at_eta(solve: Solve, eta: float) -> Solve:
    """Return a solver at an eta of its own."""
    return lambda expect, guide, noise, at, _: solve(expect, guide, noise, at, eta)


def solvers() -> dict[str, Solver]:
    """Return all, by name."""
    two: Mapping[str, tuple[str, Solve]] = {
        "ancestral": ("ancestral (eta 1)", at_eta(first_order, 1.0)),
        "half": ("ancestral, eta .5", at_eta(first_order, 0.5)),
        "ddim": ("DDIM (eta 0)", at_eta(first_order, 0.0)),
        "dpm": ("DPM-Solver++(2M)", at_eta(denoise, 0.0)),
        "sde": ("SDE-DPM-Solver++(2M)", at_eta(denoise, 1.0)),
        "churn": ("Euler, churn .4", lambda e, s, n, at, _: churned(e, s, n, at, 0.4, heun=False)),
    }
    every = {
        f"{name}-{count}": Solver(f"{says}, {count}", count, solve) for name, (says, solve) in two.items() for count in (8, 12, 24, 36)
    }
    for count in (12, 24, 36):
        every[f"heun-{count}"] = Solver(f"Heun, churn .4, {count}", count // 2, lambda e, s, n, at, _: churned(e, s, n, at, 0.4, heun=True))
    for count in (8, 12):
        every[f"middle-{count}"] = Solver(
            f"SDE-DPM-Solver++(2M), levels denser in the middle, {count}", count, at_eta(denoise, 1.0), middle_levels
        )
    every["reference"] = Solver("ancestral, the paper's 1,000 levels", 0, at_eta(first_order, 1.0))
    return every


SOLVERS: Mapping[str, Solver] = MappingProxyType(solvers())


def main(folder: Path, names: Sequence[str]) -> None:
    """Furnish, write."""
    net, _, header = load_weights(WEIGHTS)
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    rooms = held_out(read_sets(ROOT, header.slots))
    folder.mkdir(parents=True, exist_ok=True)
    for name in names or SOLVERS:
        own = SOLVERS[name]
        facts = {"says": own.says, "steps": 0, "parameters": sum(p.numel() for p in net.parameters())}
        with patch.multiple(sampling, denoise=own.solve, levels=own.levels):
            write_rooms(folder / f"{name}.npz", net.to(device), header, rooms, own.evaluations, device, facts)
        print(name, flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(Path(sys.argv[1]), sys.argv[2:])
