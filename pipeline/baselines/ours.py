"""Our own layout model at the price of the baselines: trained for the same CPU seconds on the same rooms."""

import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import torch

from pipeline.diffusion.checkpoint import save_weights
from pipeline.diffusion.context import Proposal, RoomContext
from pipeline.diffusion.inventory import fit, initial_inventory
from pipeline.diffusion.job import holdings, load, rooms_of
from pipeline.diffusion.sampling import Sampler
from pipeline.diffusion.settings import Articulation, SampleSettings, TrainSettings
from pipeline.diffusion.training import Trainer, train

PROBE = 12  # steps whose cost says how many the seconds hold
CPU = torch.device("cpu")


class Trained(NamedTuple):
    """A layout model, and what it cost: parameters, steps of the denoiser, CPU seconds."""

    sampler: Sampler
    cost: dict[str, float]


def train_model(root: Path, folder: Path, settings: TrainSettings, sample: SampleSettings, seconds: float, seed: int) -> Trained:
    """Train both nets from scratch for so many CPU seconds, reading not counted; the number of steps hangs on the machine."""
    sets, header = load(root, settings)
    data, contents = rooms_of(sets.train, header, CPU), holdings(sets.train, header)
    start = time.process_time()
    inventory = fit(initial_inventory(contents, len(header.layouts), header.inventory_width, seed), contents, settings.inventory, seed)
    probe, before = Trainer(seed, header, settings, PROBE, 1, CPU), time.process_time()
    list(train(probe, data))
    per_step = (time.process_time() - before) / PROBE
    total = max(PROBE, int((seconds - (time.process_time() - start)) / per_step))
    trainer = Trainer(seed, header, replace(settings, steps=total), total, 1, CPU)
    list(train(trainer, data))
    nets = {"denoiser": trainer.average, "inventory": inventory}
    cost = {
        "parameters": sum(p.numel() for net in nets.values() for p in net.parameters()),
        "steps": total,
        "cpu_seconds": round(time.process_time() - start, 1),
    }
    weights = folder / "ours.safetensors"
    save_weights(weights, header, nets)
    return Trained(Sampler.load(weights, sample, seed), cost)


def furnish(sampler: Sampler, articulation: Articulation, rooms: Sequence[RoomContext]) -> list[list[Proposal]]:
    """Furnish rooms, with a told number drawn exactly; a guidance knows the paper's boxes alone ("heuristic"): nothing is retrieved here."""
    sampler = replace(sampler, settings=replace(sampler.settings, quantity=True, articulation=articulation, snap_below=0))
    return sampler.sample_rooms(rooms, [(k, 0, 0) for k in range(len(rooms))])
