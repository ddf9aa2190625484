"""Training of the denoiser: a loop that yields, so that the caller logs, saves and stops."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from pipeline import seeds
from pipeline.diffusion.batch import Objects, RoomBatch, motions, moved_objects, moved_rooms
from pipeline.diffusion.checkpoint import Header, build_net
from pipeline.diffusion.denoiser import Denoiser
from pipeline.diffusion.loss import Levels, denoising_loss, draw
from pipeline.diffusion.schedule import linear
from pipeline.diffusion.settings import TrainSettings
from pipeline.diffusion.team import ALONE, Team


class Step(NamedTuple):
    """What one step reports: the number of steps done, the terms of the loss, the learning rate."""

    done: int
    geometry: float
    shape: float
    classes: float
    rate: float


class Trainer:
    """Owns the state of a training run: weights, their moving average, the optimiser's moments, the step."""

    def __init__(
        self, seed: int, header: Header, settings: TrainSettings, total: int, per_epoch: int, device: torch.device, team: Team = ALONE
    ) -> None:
        with torch.random.fork_rng(devices=[]):
            torch.manual_seed(seeds.key(seed, "denoiser-init") % 2**63)
            self.net = build_net(header).to(device)
        self.average = copy.deepcopy(self.net).eval().requires_grad_(False)
        self.seed, self.settings, self.total, self.per_epoch, self.device, self.done = seed, settings, total, per_epoch, device, 0
        self.team = team
        self.levels = Levels.of(linear(settings.timesteps), device)
        self.optimiser = torch.optim.AdamW(
            self.net.parameters(), lr=settings.learning_rate, weight_decay=settings.weight_decay, betas=(0.9, 0.98), fused=True
        )

    def rate(self, step: int) -> float:
        """Learning rate at a step: a short warm-up, then a cosine to zero, or halving every `decay_every` epochs."""
        s = self.settings
        warm = min(1.0, (step + 1) / max(s.warmup, 1))
        if s.decay == "cosine":
            return s.learning_rate * warm * 0.5 * (1 + math.cos(math.pi * step / self.total))
        return s.learning_rate * warm * 0.5 ** (step // self.per_epoch // s.decay_every)

    def step(self, rooms: RoomBatch, objects: Objects, weights: NDArray[np.float64]) -> Step:
        """Take one step on rooms drawn by `weights` (n,). All it draws comes from a generator keyed by (seed, step).

        Every member of a team draws the whole batch and computes its share of it, so that the number of members
        changes nothing but the order of sums.
        """
        s = self.settings
        rng = torch.Generator().manual_seed(seeds.key(self.seed, "train-step", self.done) % 2**63)
        chances = torch.from_numpy(weights)
        small = (rooms.count <= s.few_slots - 2).cpu()
        # Most rooms hold few objects; a step on these alone, with half the slots, costs less than half.
        few = bool(torch.rand(1, generator=rng) < s.few_share) and bool(small.any()) and s.few_slots < s.slots
        rows = torch.multinomial(chances * small if few else chances, s.batch, replacement=True, generator=rng)
        slots = s.few_slots if few else s.slots
        motion = motions(rng, s.batch, s.tilt).to(self.device)
        drawn = draw(rng, s.batch, slots, self.net.norm.channels, s.timesteps, s.low_noise, s.count_known)
        own = self.team.share(s.batch)
        rows, motion = rows[own].to(self.device), motion[own]
        seen = moved_objects(objects.rows(rows).first(slots), motion, self.net.codec)
        told = moved_rooms(rooms.rows(rows).trimmed(), motion)
        loss = denoising_loss(self.net.train(), self.levels, told, seen, type(drawn)(*(v[own].to(self.device) for v in drawn)), s)
        geometry, shape, classes = (term.mean() for term in loss)
        rate = self.rate(self.done)
        for group in self.optimiser.param_groups:
            group["lr"] = rate
        self.optimiser.zero_grad(set_to_none=True)
        (geometry + s.latent_weight * shape + s.class_weight * classes).backward()
        terms = self.team.averaged(list(self.net.parameters()), torch.stack([geometry, shape, classes]).detach())
        torch.nn.utils.clip_grad_norm_(self.net.parameters(), s.clip)
        self.optimiser.step()
        self._follow()
        self.done += 1
        mean_geometry, mean_shape, mean_classes = terms.tolist()
        return Step(self.done, mean_geometry, mean_shape, mean_classes, rate)

    def groups(self) -> dict[str, dict[str, Tensor]]:
        """Return everything that a checkpoint holds."""
        names = [name for name, _ in self.net.named_parameters()]
        state = self.optimiser.state_dict()["state"]
        moments = {f"{names[i]}/{k}": v for i, entry in state.items() for k, v in entry.items()}
        return {"net": dict(self.net.state_dict()), "average": dict(self.average.state_dict()), "optimiser": moments}

    def restore(self, done: int, groups: dict[str, dict[str, Tensor]]) -> None:
        """Continue from a checkpoint."""
        self.net.load_state_dict(groups["net"])
        self.average.load_state_dict(groups["average"])
        order = {name: i for i, (name, _) in enumerate(self.net.named_parameters())}
        state: dict[int, dict[str, Tensor]] = {}
        for key, value in groups.get("optimiser", {}).items():
            name, kind = key.rsplit("/", 1)
            state.setdefault(order[name], {})[kind] = value
        self.optimiser.load_state_dict({**self.optimiser.state_dict(), "state": state})
        self.done = done

    @torch.no_grad()
    def _follow(self) -> None:
        """Move the average towards the weights; faster at first, so that it is not a memory of the random start."""
        decay = min(self.settings.ema, (1 + self.done) / (10 + self.done))
        for slow, fast in zip(self.average.parameters(), self.net.parameters(), strict=True):
            slow.lerp_(fast, 1 - decay)


def train(
    trainer: Trainer, rooms: RoomBatch, objects: Objects, weights: NDArray[np.float64], save: Callable[[Trainer], None] | None = None
) -> Iterator[Step]:
    """Train to the end, yielding each step; `save` is called every `checkpoint_every` steps and at the end."""
    while trainer.done < trainer.total:
        yield trainer.step(rooms, objects, weights)
        if save and (trainer.done % trainer.settings.checkpoint_every == 0 or trainer.done == trainer.total):
            save(trainer)


@torch.no_grad()
def validation(
    net: Denoiser, levels: Levels, rooms: RoomBatch, objects: Objects, settings: TrainSettings, seed: int
) -> dict[str, dict[str, float]]:
    """Return the mean loss terms at five noise levels, with noise keyed by (seed, level): the same at every call."""
    found: dict[str, dict[str, float]] = {}
    device = rooms.layout.device
    for t in (5, 50, 200, 400, 700):
        level = max(1, round(t * settings.timesteps / 1000))
        rng = torch.Generator().manual_seed(seeds.key(seed, "validate", t) % 2**63)
        terms = []
        for rows in torch.arange(len(rooms)).split(settings.batch):
            drawn = draw(rng, len(rows), objects.classes.shape[1], net.norm.channels, settings.timesteps, 0.0, 1.0)
            drawn = type(drawn)(*(v.to(device) for v in drawn))._replace(t=torch.full((len(rows),), level, device=device))
            plain = replace(settings, constraint=False)  # validation measures denoising alone
            terms.append(torch.stack(denoising_loss(net.eval(), levels, rooms.rows(rows), objects.rows(rows), drawn, plain)))
        mean = torch.cat(terms, 1).mean(1).tolist()
        found[f"t{t}"] = dict(zip(("geometry", "shape", "classes"), (round(v, 6) for v in mean), strict=True))
    return found
