"""Rooms as tensors and back: N slots of D = 40 + C + 1 channels.

Channels: position 3 | size 3 | cos yaw, sin yaw | latent 32 | class C | empty. All but the class block are normalised to
unit variance by constants that travel with the weights. x and y share one scale, so that a rotation of the room is a
rotation of the channels.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from pipeline.diffusion.context import Proposal, RoomContext

LATENT = 32
POSITION, SIZE, YAW, SHAPE = slice(0, 3), slice(3, 6), slice(6, 8), slice(8, 8 + LATENT)
CONTINUOUS = 8 + LATENT
CLASS_SCALE = 2.0  # a one-hot's height: the class settles at higher noise than the last decimetres of the position
EMPTY_SCALE = 1.5  # the empty channel's, which the quantity guidance must still be able to move at t < 100


@dataclass(frozen=True, slots=True)
class Normalisation:
    """Means and scales of the continuous channels, (40,) each, and the class names in order."""

    mean: tuple[float, ...]
    scale: tuple[float, ...]
    classes: tuple[str, ...]

    @property
    def channels(self) -> int:
        """D."""
        return CONTINUOUS + len(self.classes) + 1

    @classmethod
    def of(cls, continuous: NDArray[np.float64], classes: tuple[str, ...]) -> Normalisation:
        """Measure the constants on rows (n, 40) of metres, cos, sin and raw latents."""
        mean, scale = continuous.mean(0), continuous.std(0)
        mean[:2] = 0.0
        scale[:2] = np.sqrt((continuous[:, :2] ** 2).mean())
        mean[YAW], scale[YAW] = 0.0, 1.0
        scale = np.maximum(scale, 0.05)
        return cls(tuple(round(float(v), 6) for v in mean), tuple(round(float(v), 6) for v in scale), classes)

    @classmethod
    def of_json(cls, value: dict[str, Any]) -> Normalisation:
        """Read what `dataclasses.asdict` wrote."""
        return cls(tuple(value["mean"]), tuple(value["scale"]), tuple(value["classes"]))


class Codec:
    """Normalisation as tensors on a device."""

    def __init__(self, norm: Normalisation, device: torch.device | None = None) -> None:
        self.norm = norm
        self.classes = len(norm.classes)
        self.mean = torch.tensor(norm.mean, dtype=torch.float32, device=device)
        self.scale = torch.tensor(norm.scale, dtype=torch.float32, device=device)

    def normalised(self, continuous: Tensor) -> Tensor:
        """Metres, radians' cos and sin, raw latents (..., 40) to unit variance."""
        return (continuous - self.mean) / self.scale

    def metric(self, continuous: Tensor) -> Tensor:
        """Undo `normalised`; also takes the first k <= 40 channels alone."""
        k = continuous.shape[-1]
        return continuous * self.scale[:k] + self.mean[:k]

    def one_hot(self, classes: Tensor) -> Tensor:
        """Class indices (..., N), C for empty, to the class block (..., N, C + 1)."""
        return self.class_block(torch.nn.functional.one_hot(classes, self.classes + 1).float())

    def class_block(self, probability: Tensor) -> Tensor:
        """Class probabilities (..., C + 1) to the expected class block."""
        return torch.cat([CLASS_SCALE * probability[..., :-1], EMPTY_SCALE * (probability[..., -1:] - 0.5)], -1)

    def evidence(self, block: Tensor, alpha: Tensor, sigma: Tensor) -> Tensor:
        """Return the log-likelihood (..., C + 1), up to a constant, of each class given the noisy class block alone.

        For x = alpha e_c + sigma eps it is alpha x . e_c / sigma^2 - alpha^2 |e_c|^2 / (2 sigma^2). With it as a skip
        connection the net has to learn only the prior of a slot given all the others, so that counts are right early.
        """
        middle = EMPTY_SCALE / 2 * block[..., -1:]
        held = CLASS_SCALE * block[..., :-1] - middle - alpha * CLASS_SCALE**2 / 2
        return torch.cat([held, middle], -1) * (alpha / sigma**2)

    def occupied(self, x0: Tensor) -> Tensor:
        """Which slots (..., N) hold an object: the empty channel lies below its middle."""
        return x0[..., -1] < 0

    def labels(self, x0: Tensor) -> Tensor:
        """Most likely class (..., N) of each slot, were it occupied."""
        return x0[..., CONTINUOUS:-1].argmax(-1)

    def proposals(self, x0: Tensor, context: RoomContext) -> list[Proposal]:
        """Decode one room (N, D) into its objects, in slot order."""
        centre = context.centre
        values = self.metric(x0[:, :CONTINUOUS]).double().cpu().numpy()
        labels, occupied = self.labels(x0).tolist(), self.occupied(x0).tolist()
        return [
            Proposal(
                self.norm.classes[label],
                np.array([row[0] + centre[0], row[1] + centre[1], row[2] + context.elevation]),
                float(np.arctan2(row[7], row[6])),
                np.maximum(row[SIZE], 0.02),
                row[SHAPE].astype(np.float32),
            )
            for row, label, there in zip(values, labels, occupied, strict=True)
            if there
        ]


def continuous_rows(
    positions: NDArray[np.float64], sizes: NDArray[np.float64], yaws: NDArray[np.float64], latents: NDArray[np.float32]
) -> NDArray[np.float64]:
    """Stack objects (n, .) in the room frame into rows (n, 40): position, size [m], cos, sin, latent."""
    return np.concatenate([positions, sizes, np.cos(yaws)[:, None], np.sin(yaws)[:, None], latents], 1)


def class_indices(names: Sequence[str], classes: tuple[str, ...]) -> NDArray[np.int64]:
    """Return the class index of each category name."""
    order = {name: i for i, name in enumerate(classes)}
    return np.array([order[name] for name in names], np.int64)
