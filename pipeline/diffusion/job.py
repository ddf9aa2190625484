"""A training job: what one process of a run reads and holds."""

from __future__ import annotations

import os
from dataclasses import asdict
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray

from pipeline import tables, taxonomy
from pipeline.diffusion.batch import Objects, RoomBatch, stacked
from pipeline.diffusion.checkpoint import Header, load_checkpoint
from pipeline.diffusion.codec import Codec, Normalisation
from pipeline.diffusion.rooms import Sets, held_classes, layout_weights, sets_of, small_types, stacked_rows, sweeps_by_asset
from pipeline.diffusion.settings import TrainSettings
from pipeline.diffusion.team import Team
from pipeline.diffusion.training import Trainer
from pipeline.errors import ContentError
from pipeline.manifest import digest, sha256_file
from schemas.assets import ASSET_JOINTS, LATENTS
from schemas.objects import OBJECTS
from schemas.openings import OPENINGS
from schemas.rooms import ROOMS
from schemas.scenes import SCENES

INPUTS = {"scenes": SCENES, "rooms": ROOMS, "openings": OPENINGS, "objects": OBJECTS}
CHECKPOINT = "models/checkpoint/denoiser.safetensors"


class Job(NamedTuple):
    """What one process trains: the state, the rooms with their weights, the rooms of the validation split."""

    trainer: Trainer
    rooms: RoomBatch
    objects: Objects
    weights: NDArray[np.float64]
    checked: tuple[RoomBatch, Objects]
    sets: Sets
    header: Header
    key: str


def open_job(root: Path, settings: TrainSettings, seed: int, team: Team) -> Job:
    """Read the data and take up the checkpoint of the same data and settings, if there is one."""
    threads = settings.threads or os.cpu_count() or 1
    torch.set_num_threads(threads)
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    sets, header = load(root, settings)
    codec = Codec(header.norm)
    rooms, objects = stacked(sets.train, codec, settings.slots)
    checked_rooms, checked_objects = stacked(sets.val or sets.train[:64], codec, settings.slots)
    per_epoch = -(-len(sets.train) // settings.batch)
    total = settings.epochs * per_epoch if settings.epochs else settings.steps
    trainer = Trainer(seed, header, settings, total, per_epoch, device, team)
    key = digest([asdict(settings), asdict(header), seed, threads, team.size, device.type, inputs(root)])
    found = load_checkpoint(root / CHECKPOINT, key)
    if found:
        trainer.restore(*found)
    checked = checked_rooms.to(device), checked_objects.to(device)
    return Job(trainer, rooms.to(device), objects.to(device), layout_weights(sets.train), checked, sets, header, key)


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
    supers = [words.categories[name].super for name in words.names]
    kinds = [[k for k, kind in enumerate(supers) if kind == wanted] for wanted in sorted(set(supers))]
    return sets, Header(
        norm,
        words.layout_types,
        settings.slots,
        settings.timesteps,
        settings.model,
        small_types(sets, words.layout_types, settings.few_slots) if settings.few_share else (),
        settings.few_slots if settings.few_share else settings.slots,
        held_classes(sets, words.layout_types, kinds),
    )


def inputs(root: Path) -> dict[str, str]:
    """Return the digests of the files that training depends on."""
    names = [f"data/tables/{n}.parquet" for n in (*INPUTS, "asset_joints")] + ["data/latents/latents.parquet"]
    return {name: sha256_file(root / name) for name in names}
