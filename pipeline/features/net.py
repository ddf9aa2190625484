"""A small net of our own for plan views: from 64 x 64 pixels to 32 features.

It was trained to tell what kind of room a plan view shows, how many things of each kind stand how far from walls and from
each other (the layout features of `pipeline.metrics`), and how its furniture was disturbed (moved, turned, swapped): its
features look at arrangement, which nets of photographs do not. Training: two cross-entropies and a regression, on turned and mirrored views.
"""

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn
from torch.nn.functional import cross_entropy, mse_loss

from pipeline.errors import ContentError
from pipeline.manifest import digest
from pipeline.tensors import load_state, load_tensors, save_tensors

FEATURES = 32
CHANNELS = (24, 48, 96, 128)
BATCH = 256  # views that are embedded at once
TRAIN_BATCH = 128
RATE = 3e-3
EVERY = 500  # training steps that are reported together
REMEDY = "make them with `python -m stages.features`"


class ViewNet(nn.Module):
    """Four pairs of convolutions, the first of each strided, mean and maximum over the plane, and a line to the features; three heads for training.

    `centre` and `spread` (32,) are the features' mean and standard deviation over training rooms: what `embed` gives is standardised.
    """

    centre: Tensor
    spread: Tensor

    def __init__(self, rooms: int, states: int, layout: int) -> None:
        super().__init__()
        layers: list[nn.Module] = []
        before = 3
        for k, width in enumerate(CHANNELS):
            kernel = 5 if k == 0 else 3
            layers += [nn.Conv2d(before, width, kernel, 2, kernel // 2, bias=False), nn.BatchNorm2d(width), nn.ReLU()]
            layers += [nn.Conv2d(width, width, 3, 1, 1, bias=False), nn.BatchNorm2d(width), nn.ReLU()]
            before = width
        self.body = nn.Sequential(*layers)
        self.line = nn.Linear(2 * before, FEATURES)
        self.room, self.state, self.layout = (nn.Linear(FEATURES, count) for count in (rooms, states, layout))
        self.register_buffer("centre", torch.zeros(FEATURES))
        self.register_buffer("spread", torch.ones(FEATURES))

    def features(self, views: Tensor) -> Tensor:
        """Return the features (B, 32) of plan views (B, 64, 64, 3) in 8 bits."""
        x = views.permute(0, 3, 1, 2).float() / 127.5 - 1
        plane = self.body(x)
        embedding: Tensor = self.line(torch.cat([plane.mean((2, 3)), plane.amax((2, 3))], 1))
        return embedding

    def forward(self, views: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        """Return the logits of room kinds (B, R) and of states (B, S), and layout features (B, L)."""
        features = self.features(views)
        return self.room(features), self.state(features), self.layout(features)


def embed(net: ViewNet, views: NDArray[np.uint8]) -> NDArray[np.float64]:
    """Return the features (N, 32) of plan views (N, 64, 64, 3)."""
    net.eval()
    with torch.inference_mode():
        parts = [(net.features(torch.from_numpy(views[k : k + BATCH])) - net.centre) / net.spread for k in range(0, len(views), BATCH)]
    return np.asarray(torch.cat(parts).double().numpy()) if parts else np.zeros((0, FEATURES))


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
        drawn = np.concatenate([half[rng.integers(len(half), size=TRAIN_BATCH // 2)] for half in halves])
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


def standardise(net: ViewNet, views: NDArray[np.uint8]) -> None:
    """Let the net's features have mean 0 and standard deviation 1 over these views (N, 64, 64, 3)."""
    features = torch.from_numpy(embed(net, views)).float()
    net.centre += net.spread * features.mean(0)
    net.spread *= features.std(0).clamp_min(1e-3)


def header(rooms: Sequence[str], states: Sequence[str], categories: Sequence[str]) -> dict[str, str]:
    """Return what weights must agree with: heads, and the vocabulary whose colours they know."""
    return {"rooms": json.dumps(list(rooms)), "states": json.dumps(list(states)), "categories": digest(list(categories))}


def store(path: Path, net: ViewNet, said: dict[str, str]) -> None:
    """Write weights."""
    save_tensors(path, net.state_dict(), said)


def load(path: Path, said: dict[str, str]) -> ViewNet:
    """Read weights. Raises ContentError where they are missing, broken, or made for another vocabulary or architecture."""
    tensors, metadata = load_tensors(path, REMEDY)
    odd = [key for key in said if metadata.get(key) != said[key]]
    if odd or "layout.bias" not in tensors:
        raise ContentError(f"{path} was made for other {', '.join(odd or ['nets'])}", REMEDY)
    net = ViewNet(len(json.loads(said["rooms"])), len(json.loads(said["states"])), len(tensors["layout.bias"]))
    load_state(net, tensors, path, REMEDY)
    return net
