"""Guidance: how a sampling step is shifted so that constraint functions go down.

Paper eq. guided_step shifts the mean by lambda Sigma grad phi, printed with a plus; phi is a penalty, so the shift here
is -grad phi times a step length. Sigma is 1e-4 and less in these windows and would only rescale lambda: step lengths are
given in the unit of what moves, and clipped.
"""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from pipeline.diffusion.batch import RoomBatch
from pipeline.diffusion.codec import CONTINUOUS, EMPTY_SCALE, SHAPE, SIZE, Codec
from pipeline.diffusion.constraints import articulated_collision, heuristic_sweeps, quantity
from pipeline.diffusion.context import Library
from pipeline.diffusion.relations import boxes_of
from pipeline.diffusion.settings import SampleSettings

LOGIT = 8.0  # the empty channel's two values as logits: +-4


@dataclass(frozen=True, slots=True)
class Guide:
    """What guides a batch: the rooms, the counts (B,) that are asked for (-1: none), the library, the classes that open."""

    rooms: RoomBatch
    counts: Tensor
    library: Library | None
    opens: Tensor
    settings: SampleSettings


def shift(guide: Guide, codec: Codec, x0: Tensor, level: float) -> Tensor:
    """Return the shift (B, N, D) of the mean at a level of T = 1000, from the expected clean slots x0."""
    s = guide.settings
    total = torch.zeros_like(x0)
    if s.quantity and level < s.quantity_below:
        total[..., -1] += quantity_descent(x0[..., -1], guide.counts) * s.quantity_scale
    snaps = guide.library is not None and level < s.snap_below
    guides = s.articulation != "none" and level < s.articulation_below
    if not (snaps or guides):
        return total
    size, sweeps = _looked_up(guide, codec, x0)
    if snaps:
        total[..., : SIZE.stop] += size_shift(codec, x0, size)
    if guides:
        moved = x0 + total
        if s.articulation == "heuristic":
            metric = codec.metric(moved[..., : SIZE.stop])[..., SIZE]
            sweeps = heuristic_sweeps(metric, guide.opens[codec.labels(x0)])
        total[..., :8] += articulation_descent(codec, moved, codec.occupied(x0), sweeps, guide.rooms, s)
    return total


def quantity_descent(empty: Tensor, counts: Tensor) -> Tensor:
    """Return -grad phi_quantity with regard to the empty channel (B, N) read as a logit, in channel units."""
    logit = (LOGIT / EMPTY_SCALE * empty).detach().requires_grad_()
    with torch.enable_grad():
        (gradient,) = torch.autograd.grad(quantity(logit, counts).sum(), logit)
    return -EMPTY_SCALE * gradient


def articulation_descent(codec: Codec, x0: Tensor, occupied: Tensor, sweeps: Tensor | None, rooms: RoomBatch, s: SampleSettings) -> Tensor:
    """Return the step (B, N, 8) down phi_articoll: position x, y and yaw move, size and height stay."""
    metric = codec.metric(x0[..., :8]).detach().requires_grad_()
    with torch.enable_grad():
        phi = articulated_collision(boxes_of(metric), occupied, sweeps, rooms)
        (gradient,) = torch.autograd.grad(phi.sum(), metric)
    step = torch.zeros_like(metric)
    move = -s.articulation_scale * gradient[..., :2]
    length = torch.linalg.vector_norm(move, dim=-1, keepdim=True)
    step[..., :2] = move * (s.clip / length.clamp_min(1e-9)).clamp_max(1.0) / codec.scale[:2]
    step[..., 6:8] = (-s.turn_scale * s.articulation_scale * gradient[..., 6:8]).clamp(-s.clip, s.clip)
    return step


def size_shift(codec: Codec, x0: Tensor, size: Tensor) -> Tensor:
    """Return the shift (B, N, 6) that gives slots the size [m] of their assets and leaves their backs where they are."""
    metric = codec.metric(x0[..., :8])
    grown = size - metric[..., SIZE]
    axis = metric[..., 6:8] / torch.linalg.vector_norm(metric[..., 6:8], dim=-1, keepdim=True).clamp_min(1e-3)
    front = torch.stack([axis[..., 1], -axis[..., 0]], -1)
    move = torch.zeros_like(metric[..., : SIZE.stop])
    move[..., :2] = front * grown[..., 1:2] / 2
    move[..., SIZE] = grown
    return move / codec.scale[: SIZE.stop]


def _looked_up(guide: Guide, codec: Codec, x0: Tensor) -> tuple[Tensor, Tensor | None]:
    """Ask the library for each occupied slot's asset: its size (B, N, 3) [m] and its sweeps (B, N, K, 2, 3) [m]."""
    metric = codec.metric(x0[..., :CONTINUOUS])
    size = metric[..., SIZE].clamp_min(0.02)
    if guide.library is None:
        return size, None
    labels, occupied = codec.labels(x0).tolist(), codec.occupied(x0).tolist()
    names = [
        [codec.norm.classes[c] if there else None for c, there in zip(*row, strict=True)] for row in zip(labels, occupied, strict=True)
    ]
    placed, sweeps = guide.library.lookup(names, size.double().cpu().numpy(), metric[..., SHAPE].cpu().numpy())
    return torch.from_numpy(placed).to(x0), torch.from_numpy(sweeps).to(x0)
