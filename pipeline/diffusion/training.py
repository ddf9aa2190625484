"""Training of the denoiser: a loop that yields, so that the caller logs and stops; its live metrics. Neither git nor network is touched."""

import copy
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from pipeline.diffusion.batch import BUCKETS, Objects, RoomBatch, bucket_of, moved_objects, moved_rooms, reflections
from pipeline.diffusion.checkpoint import Header, build_net
from pipeline.diffusion.loss import Draw, denoising_loss, draw
from pipeline.diffusion.optimiser import Optimiser
from pipeline.diffusion.process_group import ALONE, ProcessGroup
from pipeline.diffusion.set_transformer import SetTransformer
from pipeline.diffusion.settings import TrainSettings
from pipeline.tensors import Checkpoint, advance, cosine, generator, initial

EARLY = 0.5  # weight of the loss of all passes but the last
COLUMNS = ("step", "loss", "geometry", "shape", "rate")  # of plots/loss.csv
LEVELS = (-3.0, -1.0, 0.5, 2.0, 4.0, 6.0)  # lambda at which validation asks


class Step(NamedTuple):
    """What one step reports: the number of steps done, the loss that it minimised, the last pass's terms of it, the learning rate."""

    done: int
    loss: float
    geometry: float
    shape: float
    rate: float


class Rooms(NamedTuple):
    """What is trained on: rooms and their objects, `weights` (n,) by which they are drawn, `counts` (n,) the number of their objects."""

    rooms: RoomBatch
    objects: Objects
    weights: NDArray[np.float64]
    counts: NDArray[np.int64]


Log = Callable[[Step, Mapping[str, Mapping[str, float]]], None]


class Trainer:
    """Owns the state of a training run: weights, their moving average, the optimiser's moments, the step."""

    def __init__(
        self,
        seed: int,
        header: Header,
        settings: TrainSettings,
        total: int,
        per_epoch: int,
        device: torch.device,
        group: ProcessGroup = ALONE,
        start: SetTransformer | None = None,
    ) -> None:
        self.net = (start or initial(lambda: build_net(header), seed, "denoiser-init")).to(device)
        self.net.unbound_rooms()
        self.average = copy.deepcopy(self.net).eval().requires_grad_(False)
        self.nets = nn.ModuleDict({"net": self.net, "average": self.average})  # what a checkpoint keeps
        self.optimiser = Optimiser(self.net, settings)
        self.seed, self.settings, self.total, self.per_epoch, self.device, self.group = seed, settings, total, per_epoch, device, group
        self.done = 0

    def rate(self, step: int) -> float:
        """Learning rate at a step: a short warm-up, then a cosine to zero, or halving every `decay_every` epochs."""
        s = self.settings
        warm = min(1.0, (step + 1) / max(s.warmup, 1))
        left = cosine(step / self.total) if s.decay == "cosine" else 0.5 ** (step // self.per_epoch // s.decay_every)
        return s.learning_rate * warm * left

    def draw_rows(self, rng: torch.Generator, data: Rooms) -> tuple[Tensor, int]:
        """Draw the rows of a step's rooms by their weights, and the number of slots that they get.

        The rooms of a step hold about as many objects each, so that little is padding and every step costs the same; a
        bucket is drawn as often as makes every room's chance its weight, since a step holds fewer of the large ones.
        """
        slots = bucket_of(data.counts)
        share = np.array([data.weights[slots == size].sum() * size for size in BUCKETS])
        size = BUCKETS[int(torch.multinomial(torch.from_numpy(share), 1, generator=rng))]
        count = max(1, self.settings.objects // size // self.group.size) * self.group.size
        chances = torch.from_numpy(np.where(slots == size, data.weights, 0.0))
        return torch.multinomial(chances, count, replacement=True, generator=rng), size

    def step(self, data: Rooms) -> Step:
        """Take one step. All it draws comes from a generator keyed by (seed, step).

        Every process of a group draws the whole batch and computes its share of it, so that the number of processes
        changes nothing but the order of sums.
        """
        s = self.settings
        rng = generator(self.seed, "train-step", self.done)
        rows, slots = self.draw_rows(rng, data)
        reflection = reflections(rng, len(rows)).to(self.device)
        drawn = draw(rng, len(rows), slots)
        own = self.group.share(len(rows))
        rows, reflection = rows[own].to(self.device), reflection[own]
        objects = moved_objects(data.objects.rows(rows).first(slots), reflection)
        rooms = moved_rooms(data.rooms.rows(rows).trimmed(), reflection)
        losses = denoising_loss(self.net.train(), rooms, objects, Draw(*(v[own].to(self.device) for v in drawn)), s)
        geometry, shape = (term.mean() for term in losses[-1])
        total = geometry + s.latent_weight * shape
        for early in losses[:-1]:
            total = total + EARLY * (early.geometry.mean() + s.latent_weight * early.shape.mean())
        rate = self.rate(self.done)
        total.backward()
        terms = self.group.average(list(self.net.parameters()), torch.stack([total, geometry, shape]).detach())
        advance(self.optimiser, rate, s.clip)
        follow(self.average, self.net, s.ema, self.done)
        self.done += 1
        loss, mean_geometry, mean_shape = terms.tolist()
        return Step(self.done, loss, mean_geometry, mean_shape, rate)


@torch.no_grad()
def follow(average: nn.Module, net: nn.Module, ema: float, done: int) -> None:
    """Move the average towards the weights after `done` steps; faster at first, so that it is not a memory of the random start."""
    decay = min(ema, (1 + done) / (10 + done))
    torch._foreach_lerp_(list(average.parameters()), list(net.parameters()), 1 - decay)


def train(trainer: Trainer, data: Rooms, checkpoint: Checkpoint | None = None) -> Iterator[Step]:
    """Train to the end, yielding each step; the state is kept every `checkpoint_every` steps and at the end. With the last step the averaged net bounds its codes by the rooms."""
    while trainer.done < trainer.total:
        step = trainer.step(data)
        if trainer.done == trainer.total:
            trainer.average.bound_rooms(data.rooms, data.objects.classes)
        yield step
        if checkpoint and (trainer.done % trainer.settings.checkpoint_every == 0 or trainer.done == trainer.total):
            checkpoint.keep(trainer.done, trainer.nets, trainer.optimiser)


@torch.no_grad()
def validation(trainer: Trainer, data: Rooms) -> dict[str, dict[str, float]]:
    """Return the averaged net's mean loss terms at six noise levels.

    The noise is keyed by (seed, level), and so the same at every call.
    """
    losses: dict[str, dict[str, float]] = {}
    plain = replace(trainer.settings, constraint=False)  # validation measures denoising alone
    slots = torch.from_numpy(bucket_of(data.counts))
    for level in LEVELS:
        rng = generator(trainer.seed, "validate", round(10 * level) + 100)
        terms = []
        for size in sorted(set(slots.tolist())):
            for rows in torch.nonzero(slots == size)[:, 0].split(max(1, trainer.settings.objects // size)):
                drawn = draw(rng, len(rows), size)._replace(level=torch.full((len(rows),), level))
                drawn = Draw(*(v.to(trainer.device) for v in drawn))
                rooms, objects = data.rooms.rows(rows), data.objects.rows(rows).first(size)
                terms.append(torch.stack(denoising_loss(trainer.average, rooms, objects, drawn, plain)[-1]))
        mean = torch.cat(terms, 1).mean(1).tolist()
        losses[f"lambda {level:g}"] = dict(zip(("geometry", "shape"), (round(v, 6) for v in mean), strict=True))
    return losses


@contextmanager
def live_log(root: Path, resume: int) -> Iterator[Log]:
    """Yield what writes a step, and the validation losses as they stand, to plots/loss.csv and DVCLive. A resumed run keeps the rows up to the step it goes on from."""
    from dvclive.live import Live

    os.environ.setdefault("DVC_NO_ANALYTICS", "1")
    path = root / "plots" / "loss.csv"
    path.parent.mkdir(parents=True, exist_ok=True)
    before = path.read_text(encoding="utf-8").splitlines() if resume and path.is_file() else []
    kept = [row for row in before if row[:1].isdigit() and int(row.split(",")[0]) <= resume]
    with (
        path.open("w", encoding="utf-8") as file,
        Live(str(root / "dvclive"), resume=bool(resume), save_dvc_exp=False, dvcyaml=None, report=None, monitor_system=False) as live,
    ):

        def log(step: Step, by_level: Mapping[str, Mapping[str, float]]) -> None:
            values = [step.done, round(step.loss, 6), round(step.geometry, 6), round(step.shape, 6), round(step.rate, 8)]
            print(*values, sep=",", file=file, flush=True)
            live.step = step.done
            for name, value in zip(COLUMNS[1:], values[1:], strict=True):
                live.log_metric(f"train/{name}", value, plot=True)
            for level, terms in by_level.items():
                for name, value in terms.items():
                    live.log_metric(f"val/{name}/{level}", value, plot=False)

        print(",".join(COLUMNS), *kept, sep="\n", file=file)
        yield log
