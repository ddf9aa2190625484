"""Training of the net for plan views: two cross-entropies and a regression, on turned and mirrored views."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor
from torch.nn.functional import cross_entropy, mse_loss

from pipeline.features.net import ViewNet

BATCH = 128
RATE = 3e-3
EVERY = 500  # steps that are reported together


class Progress(NamedTuple):
    """Steps done; over the last of them the mean loss, and the shares of rooms and states that were told right."""

    done: int
    loss: float
    rooms: float
    states: float


class Examples(NamedTuple):
    """Plan views (N, 64, 64, 3) in 8 bits, their kinds of room and states (N,), their layout features (N, L)."""

    views: NDArray[np.uint8]
    rooms: NDArray[np.intp]
    states: NDArray[np.intp]
    layout: NDArray[np.float64]


def train(rng: np.random.Generator, net: ViewNet, examples: Examples, steps: int, device: torch.device) -> Iterator[Progress]:
    """Train on `device`, yielding every EVERY steps and at the end. Half of a batch are intact rooms (state 0), half harmed ones."""
    optimiser = torch.optim.AdamW(net.to(device).parameters(), RATE, weight_decay=1e-2)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, RATE, max(2, steps))
    scaled = (examples.layout - examples.layout.mean(0)) / np.maximum(examples.layout.std(0), 1e-3)
    views, kinds, states = (torch.from_numpy(part).to(device) for part in examples[:3])
    layout = torch.from_numpy(scaled).float().to(device)
    halves = [np.flatnonzero(examples.states == 0), np.flatnonzero(examples.states > 0)]
    net.train()
    total, since = torch.zeros(3, device=device), 0
    for step in range(steps):
        drawn = np.concatenate([half[rng.integers(len(half), size=BATCH // 2)] for half in halves])
        batch = torch.from_numpy(drawn).to(device)
        room, state, features = net(_augment(rng, views[batch]))
        loss = cross_entropy(room, kinds[batch]) + 2 * cross_entropy(state, states[batch]) + 3 * mse_loss(features, layout[batch])
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        schedule.step()
        right = [(logits.argmax(1) == truth[batch]).float().mean() for logits, truth in ((room, kinds), (state, states))]
        total, since = total + torch.stack([loss.detach(), *right]), since + 1
        if (step + 1) % EVERY == 0 or step + 1 == steps:
            yield Progress(step + 1, *(round(v, 4) for v in (total / since).tolist()))
            total, since = torch.zeros(3, device=device), 0


def _augment(rng: np.random.Generator, views: Tensor) -> Tensor:
    """Turn a batch by some quarters and mirror it, or not: a room stays a room."""
    turned = torch.rot90(views, int(rng.integers(4)), (1, 2))
    return turned.flip(2) if rng.integers(2) else turned
