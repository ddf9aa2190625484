"""A run of the baselines: the training rooms as tensors, networks trained for a stated number of CPU seconds, rooms furnished by each."""

import copy
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import torch
from torch import Tensor, nn

from pipeline import taxonomy
from pipeline.baselines import atiss, diffuscene, scenefoundry
from pipeline.baselines.diffuscene import Denoiser, Guide
from pipeline.baselines.physcene import Guidance
from pipeline.baselines.rooms import BaselineSettings, Found, Furniture, Outlines, Scaling, furniture, outlines
from pipeline.baselines.scenefoundry import Constraints
from pipeline.diffusion.codec import LATENT, proposals_of
from pipeline.diffusion.context import Proposal, RoomContext, floor_tokens
from pipeline.diffusion.rooms import Sets, layout_weights, read_sets
from pipeline.diffusion.sampling import openable_classes
from pipeline.diffusion.training import follow
from pipeline.tensors import advance, cosine, generator, initial

NETS = ("diffuscene", "atiss", "scenefoundry")  # what is trained; PhyScene-type guidance steers the first
BASELINES = {"atiss": "atiss", "diffuscene": "diffuscene", "physcene": "diffuscene", "scenefoundry": "scenefoundry"}  # and its net
Loss = Callable[[nn.Module, Outlines, Furniture, torch.Generator], Tensor]


@dataclass(frozen=True, slots=True)
class Job:
    """The training rooms with their `weights` (R,), all `sets`, and the vocabulary: room types, and which classes open (C,)."""

    outlines: Outlines
    furniture: Furniture
    weights: Tensor
    scaling: Scaling
    sets: Sets
    layouts: tuple[str, ...]
    opens: Tensor


def open_job(root: Path, settings: BaselineSettings) -> Job:
    """Read data/tables and data/latents. Raises ContentError where there is nothing to train on."""
    words, sets = taxonomy.load(), read_sets(root, settings.slots)
    objects = furniture(sets.train, len(words.names), settings.slots)
    rooms = outlines([e.floor for e in sets.train], [e.layout for e in sets.train], settings.points)
    weights, scaling = torch.from_numpy(layout_weights(sets.train)), Scaling.of(objects, words.names)
    return Job(rooms, objects, weights, scaling, sets, words.layout_types, torch.from_numpy(openable_classes(words.names)[:-1]))


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
        rng = generator(self.seed, "baseline", self.name, self.done)
        rows = torch.multinomial(weights, s.batch, replacement=True, generator=rng)
        quarters = torch.randint(4, (s.batch,), generator=rng)
        value = self.loss(self.net.train(), outlines.rows(rows).turned(quarters), furniture.rows(rows).turned(quarters), rng)
        value.backward()  # type: ignore[no-untyped-call]
        advance(self.adam, s.learning_rate * cosine(min(self.spent / s.seconds, 1.0)), s.clip)
        follow(self.average, self.net, s.ema, self.done)
        self.done += 1
        self.spent += time.process_time() - start
        return Step(self.done, self.spent, float(value.detach()))


def train(trainer: Trainer, outlines: Outlines, furniture: Furniture, weights: Tensor) -> Iterator[Step]:
    """Train until the seconds are spent, yielding each step."""
    while trainer.spent < trainer.settings.seconds:
        yield trainer.step(outlines, furniture, weights)


def trainer(name: str, job: Job, settings: BaselineSettings, seed: int) -> Trainer:
    """Return an untrained baseline with its loss."""
    kinds: dict[str, tuple[type[nn.Module], Any]] = {
        "atiss": (atiss.Autoregressive, atiss.loss),
        "diffuscene": (Denoiser, diffuscene.loss),
        "scenefoundry": (Denoiser, partial(scenefoundry.loss, opens=job.opens)),
    }
    kind, loss = kinds[name]
    net = initial(lambda: kind(job.scaling, len(job.layouts), settings), seed, "baseline-init", name)
    return Trainer(name, net, loss, settings, seed)


def furnish(
    name: str, net: nn.Module, job: Job, settings: BaselineSettings, seed: int, rooms: Sequence[RoomContext]
) -> list[list[Proposal]]:
    """Furnish rooms as baseline `name` does, with its trained net. Numbers that are asked for (`n_target`) are heard by SceneFoundry's guidance alone."""
    proposals: list[list[Proposal]] = []
    for start in range(0, len(rooms), settings.sample_batch):
        part = rooms[start : start + settings.sample_batch]
        rng = generator(seed, "baseline-sample", start)
        floors = outlines([floor_tokens(r) for r in part], [job.layouts.index(r.layout_type) for r in part], settings.points)
        if isinstance(net, Denoiser):
            found = job.scaling.decode(diffuscene.sample(net, floors, rng, _guide(name, job, settings, part)))
        else:
            assert isinstance(net, atiss.Autoregressive)
            found = atiss.sample(net, floors, rng)
        proposals += [_proposals(found, i, job, room) for i, room in enumerate(part)]
    return proposals


def _guide(name: str, job: Job, settings: BaselineSettings, rooms: Sequence[RoomContext]) -> Guide | None:
    if name == "physcene":
        return Guidance(job.scaling, [room.polygon - room.centre for room in rooms], job.opens)
    if name == "scenefoundry":
        counts = torch.tensor([-1 if room.n_target is None else room.n_target for room in rooms])
        return Constraints(job.scaling, settings, counts, job.opens)
    return None


def _proposals(found: Found, room: int, job: Job, context: RoomContext) -> list[Proposal]:
    """Read one room: boxes stand on their bottoms, in the world. Baselines are compared as boxes, so no shape is asked for."""
    there = found.occupied[room]
    boxes = found.boxes[room, there].double().numpy()
    boxes[:, 2] -= np.maximum(boxes[:, 5], 0.02) / 2
    names = [job.scaling.classes[k] for k in found.labels[room, there].tolist()]
    return proposals_of(np.concatenate([boxes, np.zeros((len(boxes), LATENT))], 1), names, context)
