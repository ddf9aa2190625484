"""DVC stage `train`: the denoiser over object sets. Resumable: a checkpoint of the same data and settings is continued.

Reads data/tables/ and data/latents/, writes models/denoiser.safetensors, models/checkpoint/, metrics/train.json,
plots/loss.csv and DVCLive's folder dvclive/.
"""

from __future__ import annotations

import os
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import torch
from tqdm import tqdm

from pipeline import params, tables, taxonomy
from pipeline.diffusion.batch import stacked
from pipeline.diffusion.checkpoint import Header, load_checkpoint, save_checkpoint, save_weights
from pipeline.diffusion.codec import Codec, Normalisation
from pipeline.diffusion.livelog import LiveLog
from pipeline.diffusion.rooms import Sets, layout_weights, sets_of, small_types, stacked_rows, sweeps_by_asset
from pipeline.diffusion.settings import TrainSettings
from pipeline.diffusion.training import Trainer, train, validation
from pipeline.errors import ContentError
from pipeline.manifest import digest, sha256_file, write_json
from schemas.assets import ASSET_JOINTS, LATENTS
from schemas.objects import OBJECTS
from schemas.openings import OPENINGS
from schemas.rooms import ROOMS
from schemas.scenes import SCENES
from stages.runner import run

INPUTS = {"scenes": SCENES, "rooms": ROOMS, "openings": OPENINGS, "objects": OBJECTS}
CHECKPOINT = "models/checkpoint/denoiser.safetensors"


def main(root: Path) -> None:
    """Train, or go on training, the denoiser of params.yaml."""
    tree = params.read(root / "params.yaml")
    settings, seed = params.section(TrainSettings, tree, "train"), int(tree["seed"])
    threads = settings.threads or os.cpu_count() or 1
    torch.set_num_threads(threads)
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    sets, header = load(root, settings)
    codec = Codec(header.norm)
    rooms, objects = stacked(sets.train, codec, settings.slots)
    rooms, objects = rooms.to(device), objects.to(device)
    per_epoch = -(-len(sets.train) // settings.batch)
    total = settings.epochs * per_epoch if settings.epochs else settings.steps
    trainer = Trainer(seed, header, settings, total, per_epoch, device)
    key = digest([asdict(settings), asdict(header), seed, threads, device.type, inputs(root)])
    found = load_checkpoint(root / CHECKPOINT, key)
    if found:
        trainer.restore(*found)

    def save(state: Trainer) -> None:
        save_checkpoint(root / CHECKPOINT, key, state.done, state.groups())

    checked = stacked(sets.val or sets.train[:64], codec, settings.slots)
    checked_rooms, checked_objects = checked[0].to(device), checked[1].to(device)
    by_level: dict[str, dict[str, float]] = {}
    with LiveLog(root, resume=trainer.done) as log, tqdm(total=total, initial=trainer.done, desc="train", unit="step") as bar:
        for step in train(trainer, rooms, objects, layout_weights(sets.train), save):
            bar.update()
            last = step.done == total
            if step.done % settings.validate_every == 0 or last:
                by_level = validation(trainer.average, trainer.levels, checked_rooms, checked_objects, settings, seed)
            if step.done % 10 == 0 or last:
                bar.set_postfix(geometry=f"{step.geometry:.3f}", classes=f"{step.classes:.3f}", refresh=False)
                log.step(step, by_level)
    by_level = by_level or validation(trainer.average, trainer.levels, checked_rooms, checked_objects, settings, seed)
    save_weights(root / "models/denoiser.safetensors", header, dict(trainer.average.state_dict()))
    write_json(root / "metrics/train.json", report(sets, trainer, by_level))


def load(root: Path, settings: TrainSettings) -> tuple[Sets, Header]:
    """Read the tables into rooms, and fix what travels with the weights."""
    words = taxonomy.load()
    read: dict[str, list[dict[str, Any]]] = {n: tables.read(root / f"data/tables/{n}.parquet", t) for n, t in INPUTS.items()}
    latents = {r["asset_id"]: np.array(r["latent"], np.float32) for r in tables.read(root / "data/latents/latents.parquet", LATENTS)}
    sweeps = sweeps_by_asset(tables.read(root / "data/tables/asset_joints.parquet", ASSET_JOINTS))
    sets = sets_of(read, latents, sweeps, words.names, words.layout_types, settings.slots)
    if not sets.train:
        raise ContentError(
            "data/tables has no furnished room of split train", "raise corpus.houses in params.yaml, or check the rejects table"
        )
    norm = Normalisation.of(stacked_rows(sets.train), words.names)
    return sets, Header(
        norm,
        words.layout_types,
        settings.slots,
        settings.timesteps,
        settings.model,
        small_types(sets, words.layout_types, settings.few_slots),
        settings.few_slots,
    )


def inputs(root: Path) -> dict[str, str]:
    """Return the digests of the files that training depends on."""
    names = [f"data/tables/{n}.parquet" for n in (*INPUTS, "asset_joints")] + ["data/latents/latents.parquet"]
    return {name: sha256_file(root / name) for name in names}


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
