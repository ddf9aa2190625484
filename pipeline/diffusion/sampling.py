"""Sampling: from noise that is keyed by what it is for, to rooms full of proposals."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from pipeline import seeds, taxonomy
from pipeline.arrays import Bools, Floats, Ints
from pipeline.diffusion.batch import RoomBatch, room_batch
from pipeline.diffusion.checkpoint import Header, load_weights
from pipeline.diffusion.codec import CHANNELS
from pipeline.diffusion.context import Floor, Library, Proposal, RoomContext, floor_tokens
from pipeline.diffusion.guidance import PRESSED, Guidance
from pipeline.diffusion.inventory import DRAWS, Ask, Inventory, draw_inventories, room_features
from pipeline.diffusion.schedule import denoise, levels, paper_levels
from pipeline.diffusion.set_transformer import FEW, SetTransformer
from pipeline.diffusion.settings import MOST_SLOTS, SampleSettings
from pipeline.errors import ContentError

Key = tuple[int, int, int]  # home index, room number, attempt
# Slots and floor tokens that the rooms of a batch are padded to: few shapes, for an evaluation costs more by its operations than by its rooms.
SLOTS, TOKENS = (6, 12, 24, MOST_SLOTS), (16, 32)
FEW_SHAPES = (12, 24, MOST_SLOTS), (32,)  # of rooms that are drawn again, which are few


@dataclass(frozen=True, slots=True)
class Sampler:
    """A trained layout model, ready to furnish rooms.

    The answer for a room depends on nothing but the weights, the settings, the seed, its key and its context: noise is
    keyed, a batch holds rooms of one shape, and matrix products give a row the same bits whatever the other rows, from FEW rows on.
    """

    net: SetTransformer
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
        """Furnish rooms; `keys` gives (home index, room number, attempt) for each."""
        floors = [floor_tokens(r) for r in rooms]
        return self.arrange(rooms, keys, self.inventories(rooms, keys, floors), floors)

    def inventories(self, rooms: Sequence[RoomContext], keys: Sequence[Key], floors: Sequence[Floor]) -> list[NDArray[np.int64]]:
        """Draw what each room holds: class indices (n,), rising. Told numbers and category_bounds are met, at most `slots` objects."""
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
                features = torch.from_numpy(np.stack([room_features(floors[i], rooms[i].height) for i in padded]))
                told = [rooms[i].n_target if self.settings.quantity else None for i in padded]
                asks = [
                    Ask.of(n, rooms[i].category_bounds, classes, self.slots, rooms[i].company) for n, i in zip(told, padded, strict=True)
                ]
                uniform = np.stack([seeds.generator(self.seed, "inventory", *keys[i]).random((DRAWS, len(classes))) for i in padded])
                kinds = torch.tensor([layouts[i] for i in padded])
                room_counts += draw_inventories(self.inventory, features, kinds, asks, uniform)[: len(part)]
        return [np.repeat(np.arange(len(classes)), counts) for counts in room_counts]

    def arrange(
        self, rooms: Sequence[RoomContext], keys: Sequence[Key], inventories: Sequence[NDArray[np.int64]], floors: Sequence[Floor]
    ) -> list[list[Proposal]]:
        """Arrange what rooms hold: `inventories` are class indices (n,) per room. Proposals come in that order."""
        proposals: list[list[Proposal]] = [[] for _ in rooms]
        pressed = np.full(len(rooms), np.inf)
        layouts = self._layouts(rooms)
        pending = [i for i, held in enumerate(inventories) if len(held)]
        with one_thread(), torch.no_grad():
            for draw in range(1 + self.settings.redraws):
                for slots, tokens, part in self._batches(pending, floors, inventories, FEW_SHAPES if draw else (SLOTS, TOKENS)):
                    conditioning = room_batch([floors[i] for i in part], [layouts[i] for i in part], [rooms[i].height for i in part])
                    classes = np.full((len(part), slots), len(self.header.norm.classes))
                    for row, i in enumerate(part):
                        classes[row, : len(inventories[i])] = inventories[i]
                    labels = torch.from_numpy(classes).to(self.net.codec.mean.device)
                    drawn = [(*keys[i], draw) if draw else keys[i] for i in part]
                    clean, depths = self._batch(conditioning.first(tokens), labels, drawn, [rooms[i].taste for i in part])
                    for i, x0, mine, depth in zip(part, clean, labels, depths, strict=True):
                        if not draw or depth < pressed[i]:
                            proposals[i], pressed[i] = self.net.codec.proposals(x0, mine, rooms[i]), depth
                pending = [i for i in pending if pressed[i] > PRESSED]
        return proposals

    def _batches(
        self, chosen: Sequence[int], floors: Sequence[Floor], inventories: Sequence[Ints], shapes: tuple[Sequence[int], Sequence[int]]
    ) -> Iterator[tuple[int, int, list[int]]]:
        """Cut the `chosen` rooms into batches of one shape: yields slots, floor tokens, and the indices of the rooms. A room's shape is its own."""
        slots = {i: shapes[0][bisect_left(shapes[0], len(inventories[i]))] for i in chosen}
        tokens = {i: shapes[1][bisect_left(shapes[1], int(floors[i].mask.sum()))] for i in chosen}
        for shape in sorted({(slots[i], tokens[i]) for i in chosen}):
            alike = [i for i in chosen if (slots[i], tokens[i]) == shape]
            for start in range(0, len(alike), self.settings.batch):
                yield *shape, alike[start : start + self.settings.batch]

    def _batch(self, rooms: RoomBatch, classes: Tensor, keys: Sequence[tuple[int, ...]], tastes: Sequence[Any]) -> tuple[Tensor, Floats]:
        """Sample one padded batch of objects of `classes` (batch, slots): x0 (batch, slots, 40) on their device, and how deep the worst overlap of each room is [m]."""
        device = classes.device
        rooms = rooms.to(device)
        code, ones = self.net.floor_code(rooms, classes), torch.ones(len(keys), device=device)
        names = self.header.norm.classes
        guidance = Guidance.of(
            self.net.codec, rooms, tastes, classes, self.library, openable_classes(names), tuck_roles(names), self.settings
        )

        before: Tensor | None = None

        def expect(x: Tensor, level: float) -> Tensor:
            nonlocal before
            with torch.inference_mode():
                before = self.net.expected(x, classes, level * ones, rooms, code, before)
            return before

        rngs = [seeds.generator(self.seed, "diffusion", *key) for key in keys]

        def noise() -> Tensor:
            shape = (classes.shape[1], CHANNELS)
            return torch.from_numpy(np.stack([rng.standard_normal(shape, np.float32) for rng in rngs])).to(device)

        count = self.settings.evaluations
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
