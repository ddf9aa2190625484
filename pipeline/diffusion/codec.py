"""Rooms as tensors and back: N objects of D = 40 channels, their classes beside them.

Channels: position 3 | size 3 | cos yaw, sin yaw | latent 32, normalised to unit variance by constants that travel with
the weights. x and y share one scale, so that a rotation of the room is a rotation of the channels. The class of an object
is known before its geometry (see `inventory`), so height, size and latent are measured against the mean and spread of
their class: a nightstand's size is settled as early as a wardrobe's, and what stands beside it can be placed to fit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from pipeline.diffusion.context import Proposal, RoomContext

LATENT = 32
POSITION, SIZE, YAW, SHAPE = slice(0, 3), slice(3, 6), slice(6, 8), slice(8, 8 + LATENT)
CHANNELS = 8 + LATENT
LEAST_SPREAD = 0.03  # of a class's heights and sizes [m], and of its latents
PRIOR = 3.0  # objects of all classes that count beside a class's own, so that a class with one model has a spread


@dataclass(frozen=True, slots=True)
class Normalisation:
    """Means and scales (C, 40) of the channels by class, and the class names in order. Position x, y and yaw are the same for all."""

    mean: tuple[tuple[float, ...], ...]
    scale: tuple[tuple[float, ...], ...]
    classes: tuple[str, ...]

    @classmethod
    def of(cls, continuous: NDArray[np.float64], labels: NDArray[np.int64], classes: tuple[str, ...]) -> Normalisation:
        """Measure the constants on rows (n, 40) of metres, cos, sin and raw latents, and their class indices (n,)."""
        count, every, spread = len(classes), continuous.mean(0), continuous.var(0)
        per_class = np.bincount(labels, minlength=count).astype(float)[:, None]
        total, squares = np.zeros((count, CHANNELS)), np.zeros((count, CHANNELS))
        np.add.at(total, labels, continuous)
        mean = (total + PRIOR * every) / (per_class + PRIOR)
        np.add.at(squares, labels, (continuous - mean[labels]) ** 2)
        scale = np.sqrt((squares + np.minimum(PRIOR, 1.0) * spread / 4) / (per_class + np.minimum(PRIOR, 1.0)))
        scale = np.maximum(scale, LEAST_SPREAD)
        mean[:, :2], mean[:, YAW], scale[:, YAW] = 0.0, 0.0, 1.0
        scale[:, :2] = np.sqrt((continuous[:, :2] ** 2).mean())
        return cls(_round_table(mean), _round_table(scale), classes)


class Codec:
    """Normalisation as tensors on a device; tables have a last row for the class C, which is padding."""

    def __init__(self, norm: Normalisation, device: torch.device | None = None) -> None:
        self.norm = norm
        self.classes = len(norm.classes)
        mean, scale = torch.tensor(norm.mean), torch.tensor(norm.scale)
        self.mean = torch.cat([mean, mean.mean(0, keepdim=True)]).to(device)
        self.scale = torch.cat([scale, scale.mean(0, keepdim=True)]).to(device)
        self.reach = float(scale[0, 0])  # scale of x and y [m]

    def normalise(self, continuous: Tensor, classes: Tensor) -> Tensor:
        """Metres, radians' cos and sin, raw latents (..., 40) of objects of `classes` (...) to unit variance."""
        return (continuous - self.mean[classes]) / self.scale[classes]

    def metric(self, channels: Tensor, classes: Tensor) -> Tensor:
        """Undo `normalised`; also takes the first k <= 40 channels alone."""
        k = channels.shape[-1]
        return channels * self.scale[classes, :k] + self.mean[classes, :k]

    def proposals(self, x0: Tensor, classes: Tensor, context: RoomContext) -> list[Proposal]:
        """Decode one room, x0 (N, 40) and `classes` (N,), into its objects, in slot order; class C is padding."""
        occupied = classes < self.classes
        values = self.metric(x0[occupied], classes[occupied]).double().cpu().numpy()
        return proposals_of(values, [self.norm.classes[label] for label in classes[occupied].tolist()], context)


def proposals_of(rows: NDArray[np.float64], names: Sequence[str], context: RoomContext) -> list[Proposal]:
    """Return objects as proposals: `rows` (n, 40) of metres in the room frame, cos, sin and raw latents, and their categories."""
    origin = np.array([*context.centre, context.elevation])
    return [
        Proposal(
            name, row[POSITION] + origin, float(np.arctan2(row[7], row[6])), np.maximum(row[SIZE], 0.02), row[SHAPE].astype(np.float32)
        )
        for row, name in zip(rows, names, strict=True)
    ]


def _round_table(table: NDArray[np.float64]) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(round(float(v), 6) for v in row) for row in table)
