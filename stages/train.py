"""DVC stage `train`: the denoiser over object sets, and the inventory model. Resumable: checkpoints of the same data and settings are continued.

Reads data/tables/ and data/latents/, writes models/denoiser.safetensors, models/checkpoint/, metrics/train.json,
plots/loss.csv and DVCLive's folder dvclive/.
"""

import os
from functools import partial
from pathlib import Path
from typing import Any

import torch
from tqdm import tqdm

from pipeline import params
from pipeline.diffusion.checkpoint import save_weights
from pipeline.diffusion.inventory import fit
from pipeline.diffusion.job import WEIGHTS, Job, holdings, open_job
from pipeline.diffusion.process_group import ProcessGroup, spawn_group
from pipeline.diffusion.rooms import Sets
from pipeline.diffusion.settings import TrainSettings
from pipeline.diffusion.training import Trainer, live_log, train, validation
from pipeline.entry import run
from pipeline.manifest import write_json


def main(root: Path) -> None:
    """Train, or go on training, the denoiser of params.yaml."""
    settings, seed = settings_of(root)
    size = 1 if torch.cuda.is_available() else settings.workers or os.cpu_count() or 1
    job = open_job(root, settings, seed, ProcessGroup(0, size))
    with spawn_group(size, partial(follow, root)):
        lead(root, job, settings)


def settings_of(root: Path) -> tuple[TrainSettings, int]:
    """Read the section `train` of params.yaml, and the seed."""
    tree = params.read(root / "params.yaml")
    return params.section(TrainSettings, tree, "train"), int(tree["seed"])


def follow(root: Path, group: ProcessGroup) -> None:
    """Train beside the first process: the same steps on other rooms of each batch."""
    settings, seed = settings_of(root)
    job = open_job(root, settings, seed, group)
    for _ in train(job.trainer, job.data):
        pass


def lead(root: Path, job: Job, settings: TrainSettings) -> None:
    """Train, validate, log and save; write the weights and what the stage reports."""
    trainer = job.trainer

    by_level: dict[str, dict[str, float]] = {}
    with live_log(root, trainer.done) as log, tqdm(total=trainer.total, initial=trainer.done, desc="train", unit="step") as bar:
        for step in train(trainer, job.data, job.checkpoint):
            bar.update()
            last = step.done == trainer.total
            if step.done % settings.validate_every == 0 or last:
                by_level = validation(trainer, job.checked)
            if step.done % 10 == 0 or last:
                bar.set_postfix(loss=f"{step.loss:.3f}", geometry=f"{step.geometry:.3f}", refresh=False)
                log(step, by_level)
    contents, kept = holdings(job.sets.train, job.header), (job.inventory_checkpoint, settings.checkpoint_every)
    inventory = fit(job.inventory, contents, trainer.settings.inventory, trainer.seed, *kept)
    save_weights(root / WEIGHTS, job.header, {"denoiser": trainer.average, "inventory": inventory})
    job.inventory_checkpoint.remove()
    write_json(root / "metrics/train.json", report(job.sets, trainer, by_level or validation(trainer, job.checked)))


def report(sets: Sets, trainer: Trainer, by_level: dict[str, dict[str, float]]) -> dict[str, Any]:
    """Return metrics/train.json: sizes, rooms left out by reason, and the validation loss by noise level."""
    return {
        "steps": trainer.done,
        "parameters": sum(p.numel() for p in trainer.net.parameters()),
        "rooms": {"train": len(sets.train), "val": len(sets.val), "test": len(sets.test)},
        "rooms_left_out": dict(sets.left_out),
        "val": by_level,
    }


if __name__ == "__main__":
    run(main)
