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
from pipeline.diffusion.loss import Levels, denoising_loss, draw
from pipeline.diffusion.optimiser import Optimiser
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
        self.optimiser = Optimiser(self.net, settings)
        self.few = torch.tensor([name in header.few for name in header.layouts], device=device)

    def rate(self, step: int) -> float:
        """Learning rate at a step: a short warm-up, then a cosine or a straight line to zero, or halving every `decay_every` epochs."""
        s = self.settings
        warm = min(1.0, (step + 1) / max(s.warmup, 1))
        if s.decay == "linear":
            return s.learning_rate * warm * (1 - step / self.total)
        if s.decay == "cosine":
            return s.learning_rate * warm * 0.5 * (1 + math.cos(math.pi * step / self.total))
        return s.learning_rate * warm * 0.5 ** (step // self.per_epoch // s.decay_every)

    def small(self, rooms: RoomBatch) -> Tensor:
        """Return which rooms (n,) are sampled with few slots: those of types that hold little, and that do hold little."""
        return self.few[rooms.layout] & (rooms.count <= self.settings.few_slots - 2)

    def chosen(self, rng: torch.Generator, rooms: RoomBatch, weights: NDArray[np.float64]) -> tuple[Tensor, int]:
        """Draw the rows of a step's rooms by `weights` (n,), and the number of slots that they get.

        A step sees either rooms with few slots or rooms with all of them, as they will be sampled, and fewer of the latter,
        so that both cost the same. Large rooms hold half of all objects; in mixed batches they would be a tenth.
        """
        s, chances, small = self.settings, torch.from_numpy(weights), self.small(rooms).cpu()
        few = bool(torch.rand(1, generator=rng) < s.few_share)
        few = bool(small.any()) if few else not bool((~small).any())
        chances = chances * ((rooms.count <= s.few_slots - 2).cpu() if few else ~small)
        return torch.multinomial(
            chances, s.batch if few else s.many_batch, replacement=True, generator=rng
        ), s.few_slots if few else s.slots

    def step(self, rooms: RoomBatch, objects: Objects, weights: NDArray[np.float64]) -> Step:
        """Take one step on rooms drawn by `weights` (n,). All it draws comes from a generator keyed by (seed, step).

        Every member of a team draws the whole batch and computes its share of it, so that the number of members
        changes nothing but the order of sums.
        """
        s = self.settings
        rng = torch.Generator().manual_seed(seeds.key(self.seed, "train-step", self.done) % 2**63)
        rows, slots = self.chosen(rng, rooms, weights)
        batch = len(rows)
        motion = motions(rng, batch, s.tilt).to(self.device)
        drawn = draw(rng, batch, slots, self.net.norm.channels, s.timesteps, s.low_noise, s.count_known)
        own = self.team.share(batch)
        rows, motion = rows[own].to(self.device), motion[own]
        seen = moved_objects(objects.rows(rows).first(slots), motion, self.net.codec)
        told = moved_rooms(rooms.rows(rows).trimmed(), motion)
        loss = denoising_loss(self.net.train(), self.levels, told, seen, type(drawn)(*(v[own].to(self.device) for v in drawn)), s)
        geometry, shape, classes = (term.mean() for term in loss)
        rate = self.rate(self.done)
        (geometry + s.latent_weight * shape + s.class_weight * classes).backward()
        terms = self.team.averaged(list(self.net.parameters()), torch.stack([geometry, shape, classes]).detach())
        torch.nn.utils.clip_grad_norm_(self.net.parameters(), s.clip)
        self.optimiser.step(rate)
        self._follow()
        self.done += 1
        mean_geometry, mean_shape, mean_classes = terms.tolist()
        return Step(self.done, mean_geometry, mean_shape, mean_classes, rate)

    def groups(self) -> dict[str, dict[str, Tensor]]:
        """Return everything that a checkpoint holds."""
        return {"net": dict(self.net.state_dict()), "average": dict(self.average.state_dict()), "optimiser": self.optimiser.moments()}

    def restore(self, done: int, groups: dict[str, dict[str, Tensor]]) -> None:
        """Continue from a checkpoint."""
        self.net.load_state_dict(groups["net"])
        self.average.load_state_dict(groups["average"])
        self.optimiser.restore(groups.get("optimiser", {}))
        self.done = done

    @torch.no_grad()
    def _follow(self) -> None:
        """Move the average towards the weights; faster at first, so that it is not a memory of the random start."""
        decay = min(self.settings.ema, (1 + self.done) / (10 + self.done))
        torch._foreach_lerp_(list(self.average.parameters()), list(self.net.parameters()), 1 - decay)


def train(
    trainer: Trainer, rooms: RoomBatch, objects: Objects, weights: NDArray[np.float64], save: Callable[[Trainer], None] | None = None
) -> Iterator[Step]:
    """Train to the end, yielding each step; `save` is called every `checkpoint_every` steps and at the end."""
    while trainer.done < trainer.total:
        yield trainer.step(rooms, objects, weights)
        if save and (trainer.done % trainer.settings.checkpoint_every == 0 or trainer.done == trainer.total):
            save(trainer)


@torch.no_grad()
def validation(trainer: Trainer, rooms: RoomBatch, objects: Objects) -> dict[str, dict[str, float]]:
    """Return the averaged net's mean loss terms at five noise levels, each room with the slots that it is sampled with.

    The noise is keyed by (seed, level), and so the same at every call.
    """
    found: dict[str, dict[str, float]] = {}
    settings, net, small = trainer.settings, trainer.average, trainer.small(rooms)
    parts = [(slots, torch.nonzero(mask)[:, 0]) for slots, mask in ((settings.few_slots, small), (settings.slots, ~small))]
    for t in (5, 50, 200, 400, 700):
        level = max(1, round(t * settings.timesteps / 1000))
        rng = torch.Generator().manual_seed(seeds.key(trainer.seed, "validate", t) % 2**63)
        terms = []
        for slots, rows in [(slots, rows) for slots, listed in parts for rows in listed.split(settings.batch) if len(rows)]:
            drawn = draw(rng, len(rows), slots, net.norm.channels, settings.timesteps, 0.0, 1.0)
            drawn = type(drawn)(*(v.to(trainer.device) for v in drawn))
            drawn = drawn._replace(t=torch.full((len(rows),), level, device=trainer.device))
            plain = replace(settings, constraint=False)  # validation measures denoising alone
            seen = objects.rows(rows).first(slots)
            terms.append(torch.stack(denoising_loss(net, trainer.levels, rooms.rows(rows), seen, drawn, plain)))
        mean = torch.cat(terms, 1).mean(1).tolist()
        found[f"t{t}"] = dict(zip(("geometry", "shape", "classes"), (round(v, 6) for v in mean), strict=True))
    return found
