"""Sampling: from noise that is keyed by what it is for, to rooms full of proposals."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from pipeline import seeds, taxonomy
from pipeline.diffusion.batch import RoomBatch, room_batch
from pipeline.diffusion.checkpoint import Header, load_weights
from pipeline.diffusion.context import Library, Proposal, RoomContext
from pipeline.diffusion.demands import impose
from pipeline.diffusion.denoiser import Denoiser
from pipeline.diffusion.floor import floor_tokens
from pipeline.diffusion.guidance import Guide, shift
from pipeline.diffusion.repeats import Bounds
from pipeline.diffusion.schedule import Schedule, at, levels, linear
from pipeline.diffusion.settings import SampleSettings
from pipeline.errors import ContentError

Key = tuple[int, int, int]  # home index, room number, attempt
Expect = Callable[[Tensor, float, float], Tensor]  # x (B, N, D), alpha, sigma -> expected x0
Shift = Callable[[Tensor, float], Tensor]  # x0, level -> shift of the mean
Noise = Callable[[int], Tensor]  # number of the draw -> standard normal (B, N, D)


def ddim(expect: Expect, steer: Shift, noise: Noise, schedule: Schedule, at_levels: Sequence[float]) -> Tensor:
    """Run the deterministic sampler (Song et al. 2021, eta = 0) down `at_levels` and then to level 0."""
    x = noise(0)
    for level, following in zip(at_levels, (*at_levels[1:], 0.0), strict=True):
        (alpha, sigma), (alpha_next, sigma_next) = at(schedule, level), at(schedule, following)
        x0 = expect(x, alpha, sigma)
        eps = (x - alpha * x0) / sigma
        x = alpha_next * x0 + sigma_next * eps + steer(x0, level)
    return x


def ancestral(expect: Expect, steer: Shift, noise: Noise, schedule: Schedule) -> Tensor:
    """Run all T steps of DDPM: x_{t-1} ~ N(posterior mean + shift, posterior variance). The reference."""
    x = noise(0)
    beta, alpha, sigma, variance = schedule.beta, schedule.alpha, schedule.sigma, schedule.posterior_variance
    for t in range(schedule.timesteps, 0, -1):
        x0 = expect(x, float(alpha[t]), float(sigma[t]))
        toward = float(alpha[t - 1] * beta[t] / sigma[t] ** 2)
        keep = float(np.sqrt(1 - beta[t]) * sigma[t - 1] ** 2 / sigma[t] ** 2)
        x = toward * x0 + keep * x + steer(x0, float(t))
        if t > 1:
            x = x + float(np.sqrt(variance[t])) * noise(schedule.timesteps - t + 1)
    return x


@dataclass(frozen=True, slots=True)
class Sampler:
    """A trained layout model, ready to furnish rooms.

    The answer for a room depends on nothing but the weights, the settings, the seed, its key and its context: noise is
    keyed, and rooms go through the net in batches of a fixed shape.
    """

    net: Denoiser
    header: Header
    settings: SampleSettings
    seed: int
    library: Library | None = None

    @classmethod
    def load(cls, path: Path, settings: SampleSettings, seed: int, library: Library | None = None, device: str = "cpu") -> Sampler:
        """Read the weights. `library` (an AssetIndex) tells what joints sweep. Raises ContentError (see checkpoint)."""
        net, header = load_weights(path)
        return cls(net.to(torch.device(device)), header, settings, seed, library)

    @property
    def slots(self) -> int:
        """Most objects that a room can get."""
        return self.header.slots

    def unguided(self) -> Sampler:
        """Return the baseline: same weights, same noise, no guidance and no count told."""
        plain = replace(self.settings, quantity=False, articulation="none", count_condition=False, snap_below=0)
        return replace(self, settings=plain)

    def sample_rooms(self, rooms: Sequence[RoomContext], keys: Sequence[Key]) -> list[list[Proposal]]:
        """Furnish rooms; `keys` gives (home index, room number, attempt) for each. Proposals come in slot order."""
        found: list[list[Proposal]] = [[] for _ in rooms]
        with one_thread(), torch.no_grad():
            for slots, listed in self._parts(rooms):
                x0 = self._batch([rooms[i] for i in listed], [keys[i] for i in listed], slots).cpu()
                for i, x in zip(listed, x0, strict=False):  # the padding is left over
                    found[i] = self.net.codec.proposals(x, rooms[i])
        return found

    def _parts(self, rooms: Sequence[RoomContext]) -> Iterator[tuple[int, list[int]]]:
        """Cut rooms into batches of equal slots: yields the number of slots and the indices of the rooms."""
        asks = self.settings.quantity or self.settings.count_condition
        needed = [self.header.slots_for(r.layout_type, (r.n_target if asks else None) or _named(r)) for r in rooms]
        for slots in sorted(set(needed)):
            alike = [i for i, n in enumerate(needed) if n == slots]
            for start in range(0, len(alike), self.settings.batch):
                yield slots, alike[start : start + self.settings.batch]

    def _batch(self, rooms: Sequence[RoomContext], keys: Sequence[Key], slots: int) -> Tensor:
        """Sample one padded batch: x0 (batch, slots, D). The padding repeats the first room."""
        lacking = self.settings.batch - len(rooms)
        rooms, keys = [*rooms, *[rooms[0]] * lacking], [*keys, *[keys[0]] * lacking]
        device = self.net.head.weight.device
        told = self._told(rooms).to(device)
        counts = torch.tensor([-1 if r.n_target is None else min(r.n_target, slots) for r in rooms], device=device)
        demands = [room.demands for room in rooms]
        code = self.net.floor_code(told)
        bounds = self._bounds(rooms, device)
        guide = Guide(told, counts, self.library, openable_classes(self.header.norm.classes).to(device), self.settings)
        schedule, ones = linear(self.header.timesteps), torch.ones(len(rooms), device=device)
        thousandth = 1000 / self.header.timesteps

        def expect(x: Tensor, alpha: float, sigma: float) -> Tensor:
            x0, _ = self.net.expected(x, alpha * ones, sigma * ones, told, code, bounds)
            return impose(x0, demands, self.header.norm.classes)

        def steer(x0: Tensor, level: float) -> Tensor:
            return shift(guide, self.net.codec, x0, level * thousandth)

        def noise(draw: int) -> Tensor:
            shape = (slots, self.header.norm.channels)
            return torch.from_numpy(np.stack([seeds.normal(self.seed, "diffusion", draw, *key, shape=shape) for key in keys])).to(device)

        if self.settings.sampler == "ancestral":
            return ancestral(expect, steer, noise, schedule)
        s = self.settings
        return ddim(expect, steer, noise, schedule, levels(schedule.timesteps, s.steps_coarse, s.steps_middle, s.steps_fine))

    def _bounds(self, rooms: Sequence[RoomContext], device: torch.device) -> Bounds:
        """Return how often each room may take what: as often as rooms of its type hold it, or as is demanded."""
        order = {name: k for k, name in enumerate(self.header.norm.classes)}
        held = [self.header.held[self.header.layouts.index(r.layout_type)] if self.header.held else () for r in rooms]
        asked = [
            [([order[c] for c in d.categories if c in order], max(d.least, 1) if d.most is None else d.most) for d in room.demands]
            for room in rooms
        ]
        return Bounds.of(held, asked, len(order), device)

    def _told(self, rooms: Sequence[RoomContext]) -> RoomBatch:
        """Encode the rooms' floors, types and (where told) counts."""
        unknown = sorted({r.layout_type for r in rooms} - set(self.header.layouts))
        if unknown:
            raise ContentError(f"the layout model knows no room type {unknown[0]!r}", f"use one of {', '.join(self.header.layouts)}")
        counts = [-1 if r.n_target is None or not self.settings.count_condition else r.n_target for r in rooms]
        layouts = [self.header.layouts.index(r.layout_type) for r in rooms]
        return room_batch([floor_tokens(r) for r in rooms], layouts, counts, [r.height for r in rooms])


def _named(room: RoomContext) -> int | None:
    """Return how many objects a room must have room for beside what it usually holds, None where nothing is demanded."""
    least = sum(d.least for d in room.demands)
    return 2 * least + 6 if least else None


def openable_classes(classes: Sequence[str]) -> Tensor:
    """Return which classes (C,) can come from PartNet: the lookup by class of the paper's heuristic."""
    known = taxonomy.load().categories
    return torch.tensor([bool(known[c].partnet) if c in known else False for c in classes])


@contextmanager
def one_thread() -> Iterator[None]:
    """Use one torch thread: two of them on two busy cores are many times slower, and sums differ between counts."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)
