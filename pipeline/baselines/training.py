"""Training for a stated number of CPU seconds, the same for every baseline."""

import copy
import math
import time
from collections.abc import Callable, Iterator
from typing import NamedTuple

import torch
from torch import Tensor, nn

from pipeline import seeds
from pipeline.baselines.rooms import Furniture, Outlines
from pipeline.baselines.settings import BaselineSettings
from pipeline.diffusion.training import follow

Loss = Callable[[nn.Module, Outlines, Furniture, torch.Generator], Tensor]


class Step(NamedTuple):
    """What one step reports: the number of steps done, the CPU seconds spent, the loss."""

    done: int
    spent: float
    loss: float


class Trainer:
    """Owns the state of a run: the net, its moving average, Adam's moments, the steps and CPU seconds so far.

    The learning rate falls along a cosine of the share of the seconds that is spent, so the number of steps, and with it
    the weights, hang on the machine.
    """

    def __init__(self, name: str, net: nn.Module, loss: Loss, settings: BaselineSettings, seed: int) -> None:
        self.name, self.net, self.loss, self.settings, self.seed = name, net, loss, settings, seed
        self.average = copy.deepcopy(net).eval().requires_grad_(False)
        self.adam = torch.optim.Adam(net.parameters(), lr=settings.learning_rate)
        self.done, self.spent = 0, 0.0

    def step(self, outlines: Outlines, furniture: Furniture, weights: Tensor) -> Step:
        """Take one step on rooms drawn by `weights` (R,), each turned by some quarters. All draws are keyed by (seed, name, step)."""
        start, s = time.process_time(), self.settings
        rng = torch.Generator().manual_seed(seeds.key(self.seed, "baseline", self.name, self.done) % 2**63)
        rows = torch.multinomial(weights, s.batch, replacement=True, generator=rng)
        quarters = torch.randint(4, (s.batch,), generator=rng)
        value = self.loss(self.net.train(), outlines.rows(rows).turned(quarters), furniture.rows(rows).turned(quarters), rng)
        self.adam.zero_grad()
        value.backward()  # type: ignore[no-untyped-call]
        torch.nn.utils.clip_grad_norm_(self.net.parameters(), s.clip)
        for group in self.adam.param_groups:
            group["lr"] = s.learning_rate * 0.5 * (1 + math.cos(math.pi * min(self.spent / s.seconds, 1.0)))
        self.adam.step()
        follow(self.average, self.net, s.ema, self.done)
        self.done += 1
        self.spent += time.process_time() - start
        return Step(self.done, self.spent, float(value.detach()))


def train(trainer: Trainer, outlines: Outlines, furniture: Furniture, weights: Tensor) -> Iterator[Step]:
    """Train until the seconds are spent, yielding each step."""
    while trainer.spent < trainer.settings.seconds:
        yield trainer.step(outlines, furniture, weights)
