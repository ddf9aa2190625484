"""What a run of the baselines reads and holds: the training rooms as tensors, and the networks that are trained on them."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor, nn

from pipeline import seeds, tables, taxonomy
from pipeline.baselines import atiss, diffuscene, scenefoundry
from pipeline.baselines.rooms import Furniture, Outlines, furniture, outlines
from pipeline.baselines.scaling import Scaling
from pipeline.baselines.schedule import Levels
from pipeline.baselines.settings import BaselineSettings
from pipeline.baselines.training import Loss, Trainer
from pipeline.diffusion.rooms import Sets, layout_weights, sets_of
from pipeline.errors import ContentError
from schemas import LATENTS, OBJECTS, OPENINGS, ROOMS, SCENES

INPUTS = {"scenes": SCENES, "rooms": ROOMS, "openings": OPENINGS, "objects": OBJECTS}
NETS = ("diffuscene", "atiss", "scenefoundry")  # what is trained; PhyScene-type guidance steers the first


@dataclass(frozen=True, slots=True)
class Job:
    """The training rooms with their `weights` (R,), all `sets`, the `tables` that they come from, and the vocabulary."""

    outlines: Outlines
    furniture: Furniture
    weights: Tensor
    scaling: Scaling
    sets: Sets
    tables: Mapping[str, list[dict[str, Any]]]
    layouts: tuple[str, ...]
    opens: Tensor


def open_job(root: Path, settings: BaselineSettings) -> Job:
    """Read data/tables and data/latents. Raises ContentError where there is nothing to train on."""
    words = taxonomy.load()
    read = {name: tables.read(root / f"data/tables/{name}.parquet", table) for name, table in INPUTS.items()}
    latents = {r["asset_id"]: np.array(r["latent"], np.float32) for r in tables.read(root / "data/latents/latents.parquet", LATENTS)}
    sets = sets_of(read, latents, {}, words.names, words.layout_types, settings.slots)
    if not sets.train:
        raise ContentError("data/tables has no furnished room of split train", "raise corpus.houses in params.yaml")
    objects = furniture(sets.train, len(words.names), settings.slots)
    rooms = outlines([e.floor for e in sets.train], [e.layout for e in sets.train], settings.points)
    weights = torch.from_numpy(layout_weights(sets.train))
    return Job(rooms, objects, weights, Scaling.of(objects, words.names), sets, read, words.layout_types, openable(words.names))


def openable(classes: tuple[str, ...]) -> Tensor:
    """Return which classes (C,) can come from PartNet: the lookup by class of the paper's heuristic."""
    known = taxonomy.load().categories
    return torch.tensor([name in known and bool(known[name].names.partnet) for name in classes])


def trainer(name: str, job: Job, settings: BaselineSettings, seed: int) -> Trainer:
    """Return an untrained baseline with its loss."""
    levels = Levels.linear(settings.timesteps)
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seeds.key(seed, "baseline-init", name) % 2**63)
        net: nn.Module = (atiss.Autoregressive if name == "atiss" else diffuscene.Denoiser)(job.scaling, len(job.layouts), settings)
    losses: dict[str, Any] = {
        "atiss": atiss.loss,
        "diffuscene": partial(_with_levels, diffuscene.loss, levels),
        "scenefoundry": partial(_with_levels, partial(scenefoundry.loss, opens=job.opens), levels),
    }
    loss: Loss = losses[name]
    return Trainer(name, net, loss, settings, seed)


def _with_levels(loss: Any, levels: Levels, net: nn.Module, rooms: Outlines, things: Furniture, rng: torch.Generator) -> Tensor:
    losses: Tensor = loss(net, levels, rooms, things, rng=rng)
    return losses
