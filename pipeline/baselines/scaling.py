"""The peers' parametrisation: N slots of [centre 3, size 3, cos, sin, class C, empty, latent 32], everything in [-1, 1]."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import torch
from torch import Tensor

from pipeline.baselines.rooms import BOX, Furniture
from pipeline.diffusion.codec import LATENT

PLACE, SIZE, AXIS = slice(0, 3), slice(3, 6), slice(6, 8)


class Found(NamedTuple):
    """Decoded slots: `occupied` (R, N), `labels` (R, N), `boxes` (R, N, 8) with the boxes' centres [m]."""

    occupied: Tensor
    labels: Tensor
    boxes: Tensor


@dataclass(frozen=True, slots=True)
class Scaling:
    """Least and greatest values of the training rooms.

    `low`, `high`: of centre and size (6,) [m]. `latent`: one pair for all latents. Peers measure x and y as the rooms
    stand; here in all four quarter turns, so that what is augmented is not clipped.
    """

    low: tuple[float, ...]
    high: tuple[float, ...]
    latent: tuple[float, float]
    classes: tuple[str, ...]

    @classmethod
    def of(cls, rooms: Furniture, classes: tuple[str, ...]) -> Scaling:
        """Measure the training rooms."""
        there = rooms.classes < len(classes)
        boxes, shapes = rooms.boxes[there], rooms.latents[there]
        low, high = boxes[:, :6].amin(0), boxes[:, :6].amax(0)
        reach = boxes[:, :2].abs().amax()
        low[:2], high[:2] = -reach, reach
        low = low.minimum(high - 1e-3)
        latent = float(shapes.min()), float(max(shapes.max(), shapes.min() + 1e-3))
        return cls(tuple(low.tolist()), tuple(high.tolist()), latent, classes)

    @property
    def empty(self) -> int:
        """Channel that says that a slot is empty."""
        return BOX + len(self.classes)

    @property
    def channels(self) -> int:
        """D."""
        return self.empty + 1 + LATENT

    def encode(self, rooms: Furniture) -> Tensor:
        """Return the slots x0 (R, N, D): min-max scaled and clipped; an empty slot is zeros but for its class."""
        low, high = torch.tensor(self.low).to(rooms.boxes), torch.tensor(self.high).to(rooms.boxes)
        boxes = torch.cat([2 * (rooms.boxes[..., :6] - low) / (high - low) - 1, rooms.boxes[..., AXIS]], -1).clamp(-1, 1)
        latents = (2 * (rooms.latents - self.latent[0]) / (self.latent[1] - self.latent[0]) - 1).clamp(-1, 1)
        there = (rooms.classes < len(self.classes))[..., None]
        one_hot = 2.0 * torch.nn.functional.one_hot(rooms.classes, len(self.classes) + 1).to(boxes) - 1
        return torch.cat([boxes * there, one_hot, latents * there], -1)

    def metric(self, x: Tensor) -> Tensor:
        """Return boxes (..., 8) in metres of slots (..., >= 8); differentiable."""
        low, high = torch.tensor(self.low).to(x), torch.tensor(self.high).to(x)
        return torch.cat([(x[..., :6] + 1) / 2 * (high - low) + low, x[..., AXIS]], -1)

    def occupied(self, x: Tensor) -> Tensor:
        """Which slots (..., N) hold something: the empty channel is not above zero."""
        return x[..., self.empty] <= 0

    def labels(self, x: Tensor) -> Tensor:
        """Most likely class (..., N) of each slot, were it occupied."""
        return x[..., BOX : self.empty].argmax(-1)

    def decode(self, x: Tensor) -> Found:
        """Read slots."""
        return Found(self.occupied(x), self.labels(x), self.metric(x))
