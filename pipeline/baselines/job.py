"""What a run of the baselines reads and holds: the training rooms as tensors, and the networks that are trained on them."""

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import torch
from torch import Tensor, nn

from pipeline import seeds, taxonomy
from pipeline.baselines import atiss, diffuscene, scenefoundry
from pipeline.baselines.rooms import Furniture, Outlines, furniture, outlines
from pipeline.baselines.scaling import Scaling
from pipeline.baselines.settings import BaselineSettings
from pipeline.baselines.training import Trainer
from pipeline.diffusion.rooms import Sets, layout_weights, read_sets
from pipeline.diffusion.sampling import openable_classes

NETS = ("diffuscene", "atiss", "scenefoundry")  # what is trained; PhyScene-type guidance steers the first


@dataclass(frozen=True, slots=True)
class Job:
    """The training rooms with their `weights` (R,), all `sets`, and the vocabulary: room types, and which classes open (C,)."""

    outlines: Outlines
    furniture: Furniture
    weights: Tensor
    scaling: Scaling
    sets: Sets
    layouts: tuple[str, ...]
    opens: Tensor


def open_job(root: Path, settings: BaselineSettings) -> Job:
    """Read data/tables and data/latents. Raises ContentError where there is nothing to train on."""
    words, sets = taxonomy.load(), read_sets(root, settings.slots)
    objects = furniture(sets.train, len(words.names), settings.slots)
    rooms = outlines([e.floor for e in sets.train], [e.layout for e in sets.train], settings.points)
    weights, scaling = torch.from_numpy(layout_weights(sets.train)), Scaling.of(objects, words.names)
    return Job(rooms, objects, weights, scaling, sets, words.layout_types, openable_classes(words.names)[:-1])


def trainer(name: str, job: Job, settings: BaselineSettings, seed: int) -> Trainer:
    """Return an untrained baseline with its loss."""
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seeds.key(seed, "baseline-init", name) % 2**63)
        net: nn.Module = (atiss.Autoregressive if name == "atiss" else diffuscene.Denoiser)(job.scaling, len(job.layouts), settings)
    losses: dict[str, Any] = {
        "atiss": atiss.loss,
        "diffuscene": diffuscene.loss,
        "scenefoundry": partial(scenefoundry.loss, opens=job.opens),
    }
    return Trainer(name, net, losses[name], settings, seed)
