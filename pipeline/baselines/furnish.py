"""Rooms furnished by each baseline, in the words of the layout model: a context in, proposals out."""

from collections.abc import Sequence

import numpy as np
import torch
from torch import nn

from pipeline import seeds
from pipeline.baselines import atiss, diffuscene
from pipeline.baselines.diffuscene import Denoiser, Guide
from pipeline.baselines.job import Job
from pipeline.baselines.physcene import Guidance
from pipeline.baselines.rooms import outlines
from pipeline.baselines.scaling import Found
from pipeline.baselines.scenefoundry import Constraints
from pipeline.baselines.settings import BaselineSettings
from pipeline.diffusion.codec import LATENT, proposals_of
from pipeline.diffusion.context import Proposal, RoomContext
from pipeline.diffusion.floor import floor_tokens

BASELINES = {"atiss": "atiss", "diffuscene": "diffuscene", "physcene": "diffuscene", "scenefoundry": "scenefoundry"}  # and its net


def furnish(
    name: str, net: nn.Module, job: Job, settings: BaselineSettings, seed: int, rooms: Sequence[RoomContext]
) -> list[list[Proposal]]:
    """Furnish rooms as baseline `name` does, with its trained net. Numbers that are asked for (`n_target`) are heard by SceneFoundry's guidance alone."""
    proposals: list[list[Proposal]] = []
    for start in range(0, len(rooms), settings.sample_batch):
        part = rooms[start : start + settings.sample_batch]
        rng = torch.Generator().manual_seed(seeds.key(seed, "baseline-sample", start) % 2**63)
        floors = outlines([floor_tokens(r) for r in part], [job.layouts.index(r.layout_type) for r in part], settings.points)
        if isinstance(net, Denoiser):
            found = job.scaling.decode(diffuscene.sample(net, floors, rng, _guide(name, job, settings, part)))
        else:
            assert isinstance(net, atiss.Autoregressive)
            found = atiss.sample(net, floors, rng)
        proposals += [_proposals(found, i, job, room) for i, room in enumerate(part)]
    return proposals


def _guide(name: str, job: Job, settings: BaselineSettings, rooms: Sequence[RoomContext]) -> Guide | None:
    if name == "physcene":
        return Guidance(job.scaling, [room.polygon - room.centre for room in rooms], job.opens)
    if name == "scenefoundry":
        counts = torch.tensor([-1 if room.n_target is None else room.n_target for room in rooms])
        return Constraints(job.scaling, settings, counts, job.opens)
    return None


def _proposals(found: Found, room: int, job: Job, context: RoomContext) -> list[Proposal]:
    """Read one room: boxes stand on their bottoms, in the world. Baselines are compared as boxes, so no shape is asked for."""
    there = found.occupied[room]
    boxes = found.boxes[room, there].double().numpy()
    boxes[:, 2] -= np.maximum(boxes[:, 5], 0.02) / 2
    names = [job.scaling.classes[k] for k in found.labels[room, there].tolist()]
    return proposals_of(np.concatenate([boxes, np.zeros((len(boxes), LATENT))], 1), names, context)
