"""Batches of rooms as tensors, and the augmentation that maps a room onto its mirror image."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Self

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from pipeline.diffusion.codec import CHANNELS, YAW, Codec
from pipeline.diffusion.context import KINDS, Floor
from pipeline.diffusion.poses import UNTOLD
from pipeline.diffusion.rooms import SWEEPS, Example
from pipeline.diffusion.settings import MOST_SLOTS

BUCKETS = (4, 8, 12, 16, 24, MOST_SLOTS)  # slots that the rooms of a batch are padded to


class Rows:
    """Tensors of B rooms each, as the fields of a dataclass."""

    __slots__ = ()

    def to(self, device: torch.device) -> Self:
        """Move all tensors."""
        return type(self)(*(getattr(self, f.name).to(device) for f in fields(self)))  # type: ignore[arg-type]

    def rows(self, index: Tensor) -> Self:
        """Take some rooms."""
        return type(self)(*(getattr(self, f.name)[index] for f in fields(self)))  # type: ignore[arg-type]


@dataclass(frozen=True, slots=True)
class RoomBatch(Rows):
    """B rooms as the denoiser is told about them; M floor tokens each (see `floor.Floor`).

    `layout` (B,) type, `height` (B,) of the ceiling [m].
    """

    ends: Tensor
    normal: Tensor
    kind: Tensor
    hinge: Tensor
    sill: Tensor
    mask: Tensor
    layout: Tensor
    height: Tensor

    def __len__(self) -> int:
        return len(self.layout)

    def trimmed(self) -> RoomBatch:
        """Drop token places that no room uses; real tokens first, in their order."""
        order = (~self.mask).to(torch.uint8).argsort(dim=1, stable=True)[:, : int(self.mask.sum(1).max())]
        row = torch.arange(len(self), device=order.device)[:, None]
        return replace(self, **{f.name: getattr(self, f.name)[row, order] for f in fields(Floor)})

    @property
    def walls(self) -> Tensor:
        """Which tokens (B, M) are walls, the polygon's edges."""
        return self.mask & (self.kind == KINDS.index("wall"))


@dataclass(frozen=True, slots=True)
class Objects(Rows):
    """The objects of B rooms: `classes` (B, N), C for padding; `poses` (B, N); `channels` (B, N, 40) normalised; `sweeps` (B, N, K, 2, 3) [m].

    `weights` (B, N) of their errors where their poses are told.
    """

    classes: Tensor
    poses: Tensor
    channels: Tensor
    sweeps: Tensor
    weights: Tensor

    def first(self, slots: int) -> Objects:
        """Take the first slots; objects come first, so none is lost where a room has no more than that."""
        return type(self)(*(getattr(self, f.name)[:, :slots] for f in fields(self)))


def bucket_of(counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return how many slots rooms of so many objects are padded to."""
    return np.array(BUCKETS)[np.searchsorted(BUCKETS, counts)]


def room_batch(floors: Sequence[Floor], layouts: Sequence[int], heights: Sequence[float]) -> RoomBatch:
    """Stack rooms."""
    stacked = [torch.from_numpy(np.stack([getattr(floor, f.name) for floor in floors])) for f in fields(Floor)]
    stacked += [torch.tensor(layouts), torch.tensor(heights, dtype=torch.float32)]
    return RoomBatch(*stacked)


def collate(examples: Sequence[Example], codec: Codec, slots: int) -> tuple[RoomBatch, Objects]:
    """Pad examples to `slots` and stack them."""
    classes = torch.full((len(examples), slots), codec.classes)
    poses = torch.full((len(examples), slots), UNTOLD)
    channels = torch.zeros(len(examples), slots, CHANNELS)
    sweeps = torch.full((len(examples), slots, SWEEPS, 2, 3), torch.nan)
    for i, example in enumerate(examples):
        n = len(example.classes)
        classes[i, :n], poses[i, :n] = torch.from_numpy(example.classes), torch.from_numpy(example.poses)
        channels[i, :n] = codec.normalise(torch.from_numpy(example.continuous).float(), classes[i, :n])
        sweeps[i, :n] = torch.from_numpy(example.sweeps)
    rooms = room_batch([e.floor for e in examples], [e.layout for e in examples], [e.context.height for e in examples])
    return rooms, Objects(classes, poses, channels, sweeps, torch.ones(len(examples), slots))


def reflections(rng: torch.Generator, count: int) -> Tensor:
    """Draw matrices (count, 2, 2): for half of the rooms their mirror image. Rotations would tell the net nothing: it turns with the room."""
    flip = 1.0 - 2.0 * torch.randint(2, (count,), generator=rng)
    return torch.diag_embed(torch.stack([flip, torch.ones(count)], -1))


def moved_rooms(rooms: RoomBatch, motion: Tensor) -> RoomBatch:
    """Apply motions (B, 2, 2) to rooms. A mirror image turns segments round, so that the polygon stays counter-clockwise."""
    mirrored = torch.linalg.det(motion) < 0
    ends = rooms.ends @ motion.transpose(1, 2)[:, None]
    ends = torch.where(mirrored[:, None, None, None], ends.flip(2), ends)
    hinge = torch.where(mirrored[:, None] & (rooms.hinge >= 0), 1 - rooms.hinge, rooms.hinge)
    return replace(rooms, ends=ends, normal=rooms.normal @ motion.transpose(1, 2), hinge=hinge)


def moved_objects(objects: Objects, motion: Tensor) -> Objects:
    """Apply motions (B, 2, 2) to objects.

    A box is symmetric, so its size (w, d, h) stays; the front (sin yaw, -cos yaw) is moved as a vector, which for a
    mirror image gives the reflected yaw; what joints sweep is mirrored in the object's x. The shape latent is kept: the
    mirror image of a model is taken for the model.
    """
    x = objects.channels.clone()
    x[..., :2] = x[..., :2] @ motion.transpose(1, 2)  # x and y share one scale and have mean 0
    front = torch.stack([x[..., YAW.start + 1], -x[..., YAW.start]], -1) @ motion.transpose(1, 2)
    x[..., YAW] = torch.stack([-front[..., 1], front[..., 0]], -1)
    mirrored = (torch.linalg.det(motion) < 0)[:, None, None, None]
    low, high = objects.sweeps[..., 0, :], objects.sweeps[..., 1, :]
    turned = torch.stack([torch.cat([-high[..., :1], low[..., 1:]], -1), torch.cat([-low[..., :1], high[..., 1:]], -1)], -2)
    return replace(objects, channels=x, sweeps=torch.where(mirrored[..., None], turned, objects.sweeps))
