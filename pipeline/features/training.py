"""Training of the net for plan views: two cross-entropies and a regression, on turned and mirrored views."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from torch.nn.functional import cross_entropy, mse_loss

from pipeline.features.net import ViewNet

BATCH = 64
RATE = 3e-3


class Epoch(NamedTuple):
    """Mean loss over an epoch's batches, and the shares of rooms and states that were told right."""

    loss: float
    rooms: float
    states: float


def train(
    rng: np.random.Generator,
    net: ViewNet,
    views: NDArray[np.uint8],
    rooms: NDArray[np.intp],
    states: NDArray[np.intp],
    layout: NDArray[np.float64],
    epochs: int,
) -> Iterator[Epoch]:
    """Train on views (N, 64, 64, 3) with their kinds of room, states (N,) and layout features (N, L); yield after each epoch."""
    steps = epochs * (len(views) // BATCH)
    optimiser = torch.optim.AdamW(net.parameters(), RATE, weight_decay=1e-2)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, RATE, max(2, steps))
    scaled = (layout - layout.mean(0)) / np.maximum(layout.std(0), 1e-3)
    data = torch.from_numpy(views), torch.from_numpy(rooms), torch.from_numpy(states), torch.from_numpy(scaled).float()
    for _ in range(epochs):
        net.train()
        total = np.zeros(3)
        order = torch.from_numpy(rng.permutation(len(views)))
        batches = [order[k : k + BATCH] for k in range(0, len(order) - BATCH + 1, BATCH)]
        for batch in batches:
            images = _augment(rng, data[0][batch])
            room, state, features = net(images)
            loss = cross_entropy(room, data[1][batch]) + 2 * cross_entropy(state, data[2][batch]) + 3 * mse_loss(features, data[3][batch])
            optimiser.zero_grad()
            loss.backward()
            optimiser.step()
            schedule.step()
            right = [(logits.argmax(1) == data[1 + k][batch]).float().mean().item() for k, logits in enumerate((room, state))]
            total += [loss.item(), *right]
        yield Epoch(*(total / max(1, len(batches))).round(4).tolist())


def _augment(rng: np.random.Generator, views: torch.Tensor) -> torch.Tensor:
    """Turn a batch by some quarters and mirror it, or not: a room stays a room."""
    turned = torch.rot90(views, int(rng.integers(4)), (1, 2))
    return turned.flip(2) if rng.integers(2) else turned
