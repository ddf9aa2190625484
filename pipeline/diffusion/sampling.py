"""Sampling: from noise that is keyed by what it is for, to rooms full of proposals."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from pipeline import seeds, taxonomy
from pipeline.arrays import Bools, Floats, Ints
from pipeline.diffusion.batch import RoomBatch, room_batch
from pipeline.diffusion.checkpoint import Header, load_weights
from pipeline.diffusion.codec import CHANNELS, Codec
from pipeline.diffusion.context import Floor, Library, Proposal, RoomContext, floor_tokens
from pipeline.diffusion.guidance import PRESSED, Guidance
from pipeline.diffusion.inventory import DRAWS, Ask, Inventory, draw_inventories, room_features
from pipeline.diffusion.poses import draw_poses
from pipeline.diffusion.schedule import Expect, denoise, levels, paper_levels
from pipeline.diffusion.set_transformer import FEW
from pipeline.diffusion.settings import MOST_SLOTS, SampleSettings
from pipeline.errors import ContentError

Singles = NDArray[np.float32]
Key = tuple[int, ...]  # home index, room number, attempt; behind them which draw it is, from the second on


class Denoiser(Protocol):
    """What the sampler asks of a denoiser: the constants of its channels, and for a batch of rooms a function that is called level after level."""

    codec: Codec

    def expectation(self, rooms: RoomBatch, classes: Tensor, poses: Tensor) -> Expect:
        """Return what is expected of noisy slots (B, N, 40) at a level, for rooms whose objects are of `classes` (B, N), C for padding, in `poses` (B, N)."""
        ...


@dataclass(frozen=True, slots=True)
class Sampler:
    """A trained layout model, ready to furnish rooms.

    The answer for a room depends on nothing but the weights, the settings, the seed, its key and its context: noise is
    keyed and drawn for what is there, and on a CPU a room's answer has the same bits whichever others share its batch.
    """

    net: Denoiser
    inventory: Inventory
    header: Header
    settings: SampleSettings
    seed: int
    library: Library | None = None

    @classmethod
    def load(cls, path: Path, settings: SampleSettings, seed: int, library: Library | None = None, device: str = "cpu") -> Sampler:
        """Read the weights. `library` (an AssetIndex) tells what joints sweep. Raises ContentError (see checkpoint)."""
        net, inventory, header = load_weights(path)
        return cls(net.to(torch.device(device)), inventory, header, settings, seed, library)

    @property
    def slots(self) -> int:
        """Most objects that a room can get."""
        return self.header.slots

    def baseline(self) -> Sampler:
        """Return the baseline: same weights, same noise, numbers and sizes as they come, no guidance of geometry."""
        return replace(self, settings=replace(self.settings, quantity=False, articulation="none", snap_below=0))

    def sample_rooms(self, rooms: Sequence[RoomContext], keys: Sequence[Key]) -> list[list[Proposal]]:
        """Furnish rooms; `keys` gives (home index, room number, attempt) for each.

        A room in which something stays pressed is drawn again, `redraws` times at most: first with the same things, then with others. Its least
        pressed draw is kept.
        """
        floors = [floor_tokens(r) for r in rooms]
        features = [room_features(floor, r.height) for floor, r in zip(floors, rooms, strict=True)]
        kept: list[tuple[float, list[Proposal]]] = [(np.inf, [])] * len(rooms)
        pending, held = list(range(len(rooms))), self.inventories(rooms, keys, features)
        for draw in range(1 + self.settings.redraws):
            own, tokens, told = [rooms[i] for i in pending], [floors[i] for i in pending], [features[i] for i in pending]
            drawn = [(*keys[i], draw) if draw else keys[i] for i in pending]
            things = self.inventories(own, drawn, told) if draw > 1 else [held[i] for i in pending]
            for i, furnished in zip(pending, self.arrange(own, drawn, things, tokens, told), strict=True):
                kept[i] = min(kept[i], furnished, key=lambda room: room[0])
            pending = [i for i in pending if kept[i][0] > PRESSED]
        return [proposals for _, proposals in kept]

    def inventories(self, rooms: Sequence[RoomContext], keys: Sequence[Key], features: Sequence[Singles]) -> list[Ints]:
        """Draw what each room holds: class indices (n,), rising; `features` (F,) are of each room. Told numbers and category_bounds are met, at most `slots` objects."""
        layouts = self._layouts(rooms)
        for count in (r.n_target for r in rooms if r.n_target is not None):
            if not 0 <= count <= self.slots:
                raise ContentError(
                    f"{count} objects are asked for in a room, and the layout model knows 0 to {self.slots}", "ask for so many"
                )
        classes, room_counts = self.header.norm.classes, []
        with one_thread():
            for start in range(0, len(rooms), self.settings.batch):
                part = range(start, min(start + self.settings.batch, len(rooms)))
                padded = [*part, *[part[0]] * (FEW - len(part))]
                told = [rooms[i].n_target if self.settings.quantity else None for i in padded]
                asks = [
                    Ask.of(n, rooms[i].category_bounds, classes, self.slots, rooms[i].company) for n, i in zip(told, padded, strict=True)
                ]
                uniform = np.stack([seeds.generator(self.seed, "inventory", *keys[i]).random((DRAWS, len(classes))) for i in padded])
                kinds = torch.tensor([layouts[i] for i in padded])
                room_counts += draw_inventories(
                    self.inventory, torch.from_numpy(np.stack([features[i] for i in padded])), kinds, asks, uniform
                )[: len(part)]
        return [np.repeat(np.arange(len(classes)), counts) for counts in room_counts]

    def arrange(
        self,
        rooms: Sequence[RoomContext],
        keys: Sequence[Key],
        inventories: Sequence[Ints],
        floors: Sequence[Floor],
        features: Sequence[Singles],
    ) -> list[tuple[float, list[Proposal]]]:
        """Arrange what rooms hold: `inventories` are class indices (n,) per room. Returns how deep the worst overlap of each is [m], and proposals in that order."""
        arranged: list[tuple[float, list[Proposal]]] = [(0.0, []) for _ in rooms]
        layouts = self._layouts(rooms)
        with one_thread(), torch.no_grad():
            for part in self._batches(inventories):
                conditioning = room_batch([floors[i] for i in part], [layouts[i] for i in part], [rooms[i].height for i in part])
                classes = np.full((len(part), max(len(inventories[i]) for i in part)), len(self.header.norm.classes))
                for row, i in enumerate(part):
                    classes[row, : len(inventories[i])] = inventories[i]
                own = [keys[i] for i in part]
                poses = self._poses(torch.from_numpy(classes), [features[i] for i in part], conditioning.layout, own)
                labels, poses = (v.to(self.net.codec.mean.device) for v in (torch.from_numpy(classes), poses))
                clean, depths = self._batch(conditioning, labels, poses, own, [rooms[i].taste for i in part])
                for i, x0, mine, depth in zip(part, clean, labels, depths.tolist(), strict=True):
                    arranged[i] = depth, self.net.codec.proposals(x0, mine, rooms[i])
        return arranged

    def _batches(self, inventories: Sequence[Ints]) -> Iterator[list[int]]:
        """Cut the rooms that hold something into batches, those of like numbers of objects together: yields their indices."""
        sizes = np.array([len(held) for held in inventories])
        filled = [int(i) for i in np.argsort(sizes, kind="stable") if sizes[i]]
        for start in range(0, len(filled), self.settings.batch):
            yield filled[start : start + self.settings.batch]

    def _poses(self, classes: Tensor, features: Sequence[Singles], layouts: Tensor, keys: Sequence[Key]) -> Tensor:
        """Draw how the objects of rooms stand, pose classes (batch, slots); few rooms are filled up with copies, for their bits not to hang on their number."""
        rows = [*range(len(keys)), *[0] * (FEW - len(keys))]
        uniform = np.stack([seeds.generator(self.seed, "poses", *key).random(MOST_SLOTS) for key in keys])
        padded = nn.functional.pad(classes, (0, MOST_SLOTS - classes.shape[1]), value=len(self.header.norm.classes))[rows]
        drawn = draw_poses(self.inventory.poses, torch.from_numpy(np.stack(features)[rows]), layouts[rows], padded, uniform[rows])
        return drawn[: len(keys), : classes.shape[1]]

    def _batch(self, rooms: RoomBatch, classes: Tensor, poses: Tensor, keys: Sequence[Key], tastes: Sequence[Any]) -> tuple[Tensor, Floats]:
        """Sample one padded batch of objects of `classes` in `poses` (batch, slots): x0 (batch, slots, 40) on their device, and how deep the worst overlap of each room is [m]."""
        device = classes.device
        rooms = rooms.to(device)
        names = self.header.norm.classes
        guidance = Guidance.of(
            self.net.codec, rooms, tastes, classes, self.library, openable_classes(names), tuck_roles(names), self.settings
        )

        rngs = [seeds.generator(self.seed, "diffusion", *key) for key in keys]
        counts = (classes < len(names)).sum(1).tolist()

        def noise() -> Tensor:
            drawn = torch.zeros(*classes.shape, CHANNELS)
            for row, rng, count in zip(drawn, rngs, counts, strict=True):
                row[:count] = torch.from_numpy(rng.standard_normal((count, CHANNELS), np.float32))
            return drawn.to(device)

        count = self.settings.evaluations
        expect = self.net.expectation(rooms, classes, poses)
        x0 = denoise(expect, partial(guidance.step, self.net.codec), noise, levels(count) if count else paper_levels(), self.settings.eta)
        return x0, guidance.pressure(self.net.codec, x0)

    def _layouts(self, rooms: Sequence[RoomContext]) -> list[int]:
        """Return the indices of the rooms' types."""
        unknown = sorted({r.layout_type for r in rooms} - set(self.header.layouts))
        if unknown:
            raise ContentError(f"the layout model knows no room type {unknown[0]!r}", f"use one of {', '.join(self.header.layouts)}")
        return [self.header.layouts.index(r.layout_type) for r in rooms]


def tuck_roles(classes: Sequence[str]) -> Ints:
    """Return by class (C + 1,), the last one empty: 1 for what stands under tables, 2 for tables, 0 for the rest."""
    known = taxonomy.load().categories
    return np.array([known[name].tuck_role for name in classes] + [0])


def openable_classes(classes: Sequence[str]) -> Bools:
    """Return which classes (C + 1,) can come from PartNet: the lookup by class of the paper's heuristic; padding cannot."""
    known = taxonomy.load().categories
    return np.array([*(bool(known[c].names.partnet) if c in known else False for c in classes), False])


@contextmanager
def one_thread() -> Iterator[None]:
    """Use one torch thread: two of them on two busy cores are many times slower, and sums differ between counts."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)
