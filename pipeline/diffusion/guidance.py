"""Guidance: how the clean slots that a sampling step expects are moved so that constraint functions go down.

Paper eq. guided_step shifts the mean by lambda Sigma grad phi, printed with a plus; phi is a penalty, so the move here is
-grad phi times a step length. Sigma is 1e-4 and less in the paper's window and would only rescale lambda: step lengths are
given in the unit of what moves, and clipped. It is the expected x0 that is moved, and so the mean of the step with it; a
later step can then bring back what the guidance has torn apart.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import torch
from torch import Tensor

from pipeline.diffusion.batch import RoomBatch
from pipeline.diffusion.codec import SHAPE, SIZE, YAW, Codec
from pipeline.diffusion.constraints import articulated_collision, heuristic_sweeps
from pipeline.diffusion.context import Library
from pipeline.diffusion.relations import boxes_of
from pipeline.diffusion.schedule import lambda_of
from pipeline.diffusion.settings import SampleSettings


@dataclass(frozen=True, slots=True)
class Guidance:
    """What guides a batch: the rooms, their tastes, classes (B, N), the library, the classes that open (C + 1,), pairs that may share a place (B, N, N)."""

    rooms: RoomBatch
    tastes: Sequence[Any]
    classes: Tensor
    library: Library | None
    opens: Tensor
    tucked: Tensor
    settings: SampleSettings

    def step(self, codec: Codec, x0: Tensor, level: float) -> Tensor:
        """Return the expected clean channels x0 (B, N, 40) at a level (lambda) as they are wanted."""
        s = self.settings
        snaps = self.library is not None and s.snap_below > 0 and level > lambda_of(s.snap_below)
        guides = s.articulation != "none" and level > lambda_of(s.articulation_below)
        if not (snaps or guides):
            return x0
        size, sweeps = self._looked_up(codec, x0)
        moved = x0.clone()
        if snaps:
            moved[..., : SIZE.stop] += size_shift(codec, x0, self.classes, size)
        if guides:
            if s.articulation == "heuristic":
                sweeps = heuristic_sweeps(codec.metric(moved[..., : SIZE.stop], self.classes)[..., SIZE], self.opens[self.classes])
            for _ in range(s.articulation_steps):
                moved[..., : YAW.stop] += articulation_descent(codec, moved, self.classes, sweeps, self.rooms, s, self.tucked)
        return moved

    def _looked_up(self, codec: Codec, x0: Tensor) -> tuple[Tensor, Tensor | None]:
        """Ask the library for each object's asset: its size (B, N, 3) [m] and its sweeps (B, N, K, 2, 3) [m]."""
        metric = codec.metric(x0, self.classes)
        size = metric[..., SIZE].clamp_min(0.02)
        if self.library is None:
            return size, None
        names = [[codec.norm.classes[c] if c < codec.classes else None for c in row] for row in self.classes.tolist()]
        positions, sizes, latents = (part.double().cpu().numpy() for part in (metric[..., :3], size, metric[..., SHAPE]))
        placed, sweeps = self.library.lookup(self.tastes, names, positions, sizes, latents)
        return torch.from_numpy(placed).to(x0), torch.from_numpy(sweeps).to(x0)


def articulation_descent(
    codec: Codec, x0: Tensor, classes: Tensor, sweeps: Tensor | None, rooms: RoomBatch, s: SampleSettings, tucked: Tensor | None = None
) -> Tensor:
    """Return the step (B, N, 8) down phi_articoll: position x, y and yaw move, size and height stay."""
    metric = codec.metric(x0[..., : YAW.stop], classes).detach().requires_grad_()
    with torch.enable_grad():
        phi = articulated_collision(boxes_of(metric), classes < codec.classes, sweeps, rooms, tucked)
        (gradient,) = torch.autograd.grad(phi.sum(), metric)
    step = torch.zeros_like(metric)
    move = -s.articulation_scale * gradient[..., :2]
    length = torch.linalg.vector_norm(move, dim=-1, keepdim=True)
    step[..., :2] = move * (s.clip / length.clamp_min(1e-9)).clamp_max(1.0) / codec.reach
    step[..., YAW] = (-s.turn_scale * s.articulation_scale * gradient[..., YAW]).clamp(-s.clip, s.clip)
    return step


def size_shift(codec: Codec, x0: Tensor, classes: Tensor, size: Tensor) -> Tensor:
    """Return the shift (B, N, 6) that gives objects the size [m] of their assets and leaves their backs where they are."""
    metric = codec.metric(x0[..., : YAW.stop], classes)
    grown = size - metric[..., SIZE]
    axis = metric[..., YAW] / torch.linalg.vector_norm(metric[..., YAW], dim=-1, keepdim=True).clamp_min(1e-3)
    front = torch.stack([axis[..., 1], -axis[..., 0]], -1)
    move = torch.zeros_like(metric[..., : SIZE.stop])
    move[..., :2] = front * grown[..., 1:2] / 2
    move[..., SIZE] = grown
    return move / codec.scale[classes, : SIZE.stop]
