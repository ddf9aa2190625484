"""A training job: what one process of a run reads and holds."""

import os
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import torch

from pipeline import tables, taxonomy
from pipeline.diffusion.batch import collate
from pipeline.diffusion.checkpoint import Header, load_checkpoint, load_weights
from pipeline.diffusion.codec import Codec, Normalisation
from pipeline.diffusion.inventory import Holdings, Inventory, counts_of, initial_inventory, room_features
from pipeline.diffusion.process_group import ProcessGroup
from pipeline.diffusion.rooms import Example, Sets, layout_weights, sets_of, stacked_classes, stacked_rows, sweeps_by_asset
from pipeline.diffusion.set_transformer import SetTransformer
from pipeline.diffusion.settings import TrainSettings
from pipeline.diffusion.training import Rooms, Trainer
from pipeline.errors import ContentError
from pipeline.manifest import digest, sha256_file
from schemas import ASSET_JOINTS, LATENTS, OBJECTS, OPENINGS, ROOMS, SCENES

INPUTS = {"scenes": SCENES, "rooms": ROOMS, "openings": OPENINGS, "objects": OBJECTS}
CHECKPOINT = "models/checkpoint/denoiser.safetensors"
WEIGHTS = "models/denoiser.safetensors"
RELEASED = "weights/denoiser.safetensors"


class Job(NamedTuple):
    """What one process trains: the state, the rooms, the rooms of the validation split; the inventory model as it begins."""

    trainer: Trainer
    data: Rooms
    checked: Rooms
    sets: Sets
    header: Header
    inventory: Inventory
    key: str


def open_job(root: Path, settings: TrainSettings, seed: int, group: ProcessGroup) -> Job:
    """Read the data and take up the checkpoint of the same data and settings, if there is one; else start, from the released weights where asked."""
    threads = settings.threads or os.cpu_count() or 1
    torch.set_num_threads(threads)
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    sets, header = load(root, settings)
    start: SetTransformer | None = None
    if settings.start == "released":
        start, inventory, header = load_released(root / RELEASED, header)
        tune = settings.tune
        tuned = replace(settings.inventory, steps=tune.inventory_steps, learning_rate=tune.learning_rate)
        settings = replace(settings, steps=tune.steps, epochs=0, learning_rate=tune.learning_rate, inventory=tuned)
    else:
        inventory = initial_inventory(holdings(sets.train, header), len(header.layouts), settings.inventory.width, seed)
    per_epoch = max(1, sum(len(e.classes) for e in sets.train) // settings.objects)
    total = settings.epochs * per_epoch if settings.epochs else settings.steps
    trainer = Trainer(seed, header, settings, total, per_epoch, device, group, start)
    key = digest([asdict(settings), asdict(header), seed, threads, group.size, device.type, inputs(root, settings)])
    checkpoint = load_checkpoint(root / CHECKPOINT, key)
    if checkpoint:
        trainer.restore(*checkpoint)
    data, checked = (rooms_of(part, header, device) for part in (sets.train, sets.val or sets.train[:64]))
    return Job(trainer, data, checked, sets, header, inventory, key)


def load_released(path: Path, wanted: Header) -> tuple[SetTransformer, Inventory, Header]:
    """Read the released weights. Raises ContentError when their vocabulary or shape is not that of the data and params.yaml.

    Their normalisation is kept: with another the same numbers would mean other rooms.
    """
    net, inventory, header = load_weights(path)
    for name in ("layouts", "slots", "model", "inventory_width"):
        if getattr(header, name) != getattr(wanted, name):
            raise ContentError(
                f"{path} was trained with other {name} ({getattr(header, name)}) than params.yaml and the taxonomy say ({getattr(wanted, name)})",
                "set train.start: scratch in params.yaml, or these numbers",
            )
    if header.norm.classes != wanted.norm.classes:
        odd = sorted(set(header.norm.classes) ^ set(wanted.norm.classes)) or ["their order"]
        raise ContentError(
            f"{path} knows other categories than the taxonomy: {', '.join(odd[:5])}", "set train.start: scratch in params.yaml"
        )
    return net, inventory, header


def rooms_of(examples: Sequence[Example], header: Header, device: torch.device) -> Rooms:
    """Stack examples as they are trained on."""
    rooms, objects = collate(examples, Codec(header.norm), header.slots)
    counts = np.array([len(e.classes) for e in examples], np.int64)
    return Rooms(rooms.to(device), objects.to(device), layout_weights(examples), counts)


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
    norm = Normalisation.of(stacked_rows(sets.train), stacked_classes(sets.train), words.names)
    return sets, Header(norm, words.layout_types, settings.slots, settings.model, settings.inventory.width)


def holdings(examples: Sequence[Example], header: Header) -> Holdings:
    """Return what rooms hold, as the inventory model learns it."""
    features = np.stack([room_features(e.floor, e.height) for e in examples])
    layouts = np.array([e.layout for e in examples], np.int64)
    return Holdings(features, layouts, np.stack([counts_of(e.classes, len(header.norm.classes)) for e in examples]))


def inputs(root: Path, settings: TrainSettings) -> dict[str, str]:
    """Return the digests of the files that training depends on."""
    names = [f"data/tables/{n}.parquet" for n in (*INPUTS, "asset_joints")] + ["data/latents/latents.parquet"]
    names += [RELEASED] if settings.start == "released" else []
    return {name: sha256_file(root / name) for name in names}
