"""What the baselines read: their numbers in params.yaml; rooms, each an outline and a set of boxes, in tensors; quarter turns of both; and the peers' parametrisation.

That is N slots of [centre 3, size 3, cos, sin, class C, empty, latent 32], everything in [-1, 1].
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from pipeline.diffusion.batch import Rows
from pipeline.diffusion.codec import LATENT
from pipeline.diffusion.context import KINDS, Floor
from pipeline.diffusion.rooms import Example

BOX = 8  # centre 3, size 3 [m], cos, sin of the yaw
PLACE, SIZE, AXIS = slice(0, 3), slice(3, 6), slice(6, 8)


@dataclass(frozen=True, slots=True)
class BaselineSettings:
    """How the baselines are built, trained, sampled and compared."""

    seconds: float = 120.0  # CPU seconds of training, the same for each
    width: int = 128  # channels of the transformers
    layers: int = 4
    heads: int = 4
    points: int = 64  # points of a room's outline
    slots: int = 24  # most objects in a room
    timesteps: int = 1000  # T
    batch: int = 64  # rooms per training step
    learning_rate: float = 1e-3  # at the start; it falls to zero along a cosine while the seconds are spent
    clip: float = 10.0  # gradient norm
    ema: float = 0.995  # of the weights that are sampled from
    iou_weight: float = 0.1  # DiffuScene: weight of the boxes' mean overlap in the loss
    rooms: int = 150  # rooms of the split that each baseline furnishes
    count_rooms: int = 40  # rooms per asked number
    counts: tuple[int, ...] = (5, 8, 12, 16)  # N_target
    steps: int = 100  # levels at which the samplers stop, even in log signal-to-noise; T: all, as the peers and the print have it
    sample_batch: int = 50  # rooms that are sampled together
    quantity_scale: float = 200.0  # SceneFoundry: lambda gamma_1
    articulation_scale: float = 20.0  # SceneFoundry: lambda gamma_2
    train_quantity_scale: float = 200.0  # the same in eq. 1
    train_articulation_scale: float = 2.0


@dataclass(frozen=True, slots=True)
class Outlines(Rows):
    """R rooms to furnish: `points` (R, P, 4), places on the walls [m] and inward normals; `layout` (R,) index of the room type.

    As with the peers, a room is its outline: they are told neither of doors nor of windows.
    """

    points: Tensor
    layout: Tensor

    def __len__(self) -> int:
        return len(self.layout)

    def turned(self, quarters: Tensor) -> Outlines:
        """Turn each room (R,) by so many quarters."""
        turns = quarter_turns(quarters).to(self.points)
        return Outlines(torch.cat([self.points[..., k : k + 2] @ turns.mT for k in (0, 2)], -1), self.layout)


@dataclass(frozen=True, slots=True)
class Furniture(Rows):
    """The slots of R rooms: `classes` (R, N), C for empty; `boxes` (R, N, 8) with the boxes' centres [m]; `latents` (R, N, 32)."""

    classes: Tensor
    boxes: Tensor
    latents: Tensor

    def turned(self, quarters: Tensor) -> Furniture:
        """Turn each room (R,) by so many quarters."""
        turns = quarter_turns(quarters).to(self.boxes)
        place, axis = (self.boxes[..., k : k + 2] @ turns.mT for k in (0, 6))
        return Furniture(self.classes, torch.cat([place, self.boxes[..., 2:6], axis], -1), self.latents)


def quarter_turns(quarters: Tensor) -> Tensor:
    """Return rotations (R, 2, 2) by so many quarters, exact."""
    cos, sin = (torch.tensor(values, device=quarters.device)[quarters % 4] for values in ((1.0, 0.0, -1.0, 0.0), (0.0, 1.0, 0.0, -1.0)))
    return torch.stack([torch.stack([cos, -sin], -1), torch.stack([sin, cos], -1)], -2)


def outline(floor: Floor, count: int) -> NDArray[np.float32]:
    """Return points (count, 4) evenly along the walls, with the normals into the room."""
    walls = floor.mask & (floor.kind == KINDS.index("wall"))
    start, stop, normal = floor.ends[walls, 0], floor.ends[walls, 1], floor.normal[walls]
    length = np.linalg.norm(stop - start, axis=1)
    reached = np.cumsum(length)
    at = (np.arange(count) + 0.5) / count * reached[-1]
    wall = np.minimum(np.searchsorted(reached, at, side="right"), len(length) - 1)
    along = (at - reached[wall] + length[wall]) / np.maximum(length[wall], 1e-9)
    points = start[wall] + along[:, None] * (stop - start)[wall]
    return np.concatenate([points, normal[wall]], 1).astype(np.float32)


def outlines(floors: Sequence[Floor], layouts: Sequence[int], count: int) -> Outlines:
    """Stack rooms."""
    return Outlines(torch.from_numpy(np.stack([outline(f, count) for f in floors])), torch.tensor(layouts))


def furniture(examples: Sequence[Example], classes: int, slots: int) -> Furniture:
    """Pad the objects of examples to `slots`; `classes` is C."""
    labels = torch.full((len(examples), slots), classes)
    boxes, latents = torch.zeros(len(examples), slots, BOX), torch.zeros(len(examples), slots, LATENT)
    for i, example in enumerate(examples):
        n = len(example.classes)
        labels[i, :n] = torch.from_numpy(example.classes)
        own = torch.from_numpy(example.continuous).float()
        boxes[i, :n], latents[i, :n] = own[:, :BOX], own[:, BOX : BOX + LATENT]
        boxes[i, :n, 2] += own[:, 5] / 2  # examples stand on their bottoms, the peers' boxes hang on their centres
    return Furniture(labels, boxes, latents)


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
