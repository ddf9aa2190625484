"""Rooms furnished by each baseline, in the words of the layout model: a context in, proposals out."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor, nn

from pipeline import seeds
from pipeline.baselines import atiss, diffuscene
from pipeline.baselines.diffuscene import Denoiser, Guide
from pipeline.baselines.physcene import Guidance
from pipeline.baselines.rooms import Outlines, outlines
from pipeline.baselines.scaling import Found, Scaling
from pipeline.baselines.scenefoundry import Constraints
from pipeline.baselines.settings import BaselineSettings
from pipeline.diffusion.codec import LATENT
from pipeline.diffusion.context import Proposal, RoomContext
from pipeline.diffusion.floor import floor_tokens

BASELINES = {"atiss": "atiss", "diffuscene": "diffuscene", "physcene": "diffuscene", "scenefoundry": "scenefoundry"}  # and its net


@dataclass(frozen=True, slots=True)
class Baselines:
    """The trained networks by name, with what sampling needs beside: room types in order, classes that open (C,), the seed."""

    nets: Mapping[str, nn.Module]
    scaling: Scaling
    settings: BaselineSettings
    layouts: tuple[str, ...]
    opens: Tensor
    seed: int

    def furnish(self, name: str, rooms: Sequence[RoomContext]) -> list[list[Proposal]]:
        """Furnish rooms as baseline `name` does. Numbers that are asked for (`n_target`) are heard by SceneFoundry's guidance alone."""
        proposals: list[list[Proposal]] = []
        for start in range(0, len(rooms), self.settings.sample_batch):
            part = rooms[start : start + self.settings.sample_batch]
            rng = torch.Generator().manual_seed(seeds.key(self.seed, "baseline-sample", start) % 2**63)
            samples = self._sample(name, part, rng)
            proposals += [self._proposals(samples, i, room) for i, room in enumerate(part)]
        return proposals

    def _sample(self, name: str, rooms: Sequence[RoomContext], rng: torch.Generator) -> Found:
        net, floor_outlines = self.nets[BASELINES[name]].eval(), self._outlines(rooms)
        if isinstance(net, atiss.Autoregressive):
            return atiss.sample(net, floor_outlines, rng)
        if not isinstance(net, Denoiser):
            raise TypeError(name)
        return self.scaling.decode(diffuscene.sample(net, floor_outlines, rng, self._guide(name, rooms)))

    def _guide(self, name: str, rooms: Sequence[RoomContext]) -> Guide | None:
        if name == "physcene":
            return Guidance(self.scaling, [room.polygon - room.centre for room in rooms], self.opens)
        if name == "scenefoundry":
            counts = torch.tensor([-1 if room.n_target is None else room.n_target for room in rooms])
            return Constraints(self.scaling, self.settings, counts, self.opens)
        return None

    def _outlines(self, rooms: Sequence[RoomContext]) -> Outlines:
        return outlines([floor_tokens(r) for r in rooms], [self.layouts.index(r.layout_type) for r in rooms], self.settings.points)

    def _proposals(self, samples: Found, room: int, context: RoomContext) -> list[Proposal]:
        """Read one room: boxes stand on their bottoms, in the world. Baselines are compared as boxes, so no shape is asked for."""
        there = samples.occupied[room]
        boxes = samples.boxes[room, there].double().numpy()
        origin = np.array([*context.centre, context.elevation])
        size = np.maximum(boxes[:, 3:6], 0.02)
        place = boxes[:, :3] + origin - size * [0, 0, 0.5]
        yaw = np.arctan2(boxes[:, 7], boxes[:, 6])
        names = [self.scaling.classes[k] for k in samples.labels[room, there].tolist()]
        return [Proposal(*row, np.zeros(LATENT, np.float32)) for row in zip(names, place, yaw.tolist(), size, strict=True)]
