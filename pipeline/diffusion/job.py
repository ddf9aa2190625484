"""A training job: what one process of a run reads and holds."""

import os
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import torch

from pipeline import taxonomy
from pipeline.diffusion.batch import collate
from pipeline.diffusion.checkpoint import FORMAT, Header, load_weights, require_vocabulary
from pipeline.diffusion.codec import Codec, Normalisation
from pipeline.diffusion.inventory import Holdings, Inventory, initial_inventory, room_features
from pipeline.diffusion.poses import UNTOLD, pose_weights
from pipeline.diffusion.process_group import ProcessGroup
from pipeline.diffusion.rooms import SHAPES, TABLES, Example, Sets, layout_weights, read_sets, stacked
from pipeline.diffusion.set_transformer import SetTransformer
from pipeline.diffusion.settings import TrainSettings
from pipeline.diffusion.training import Rooms, Trainer
from pipeline.errors import ContentError
from pipeline.manifest import digest, sha256_file
from pipeline.tensors import Checkpoint

CHECKPOINT = "models/checkpoint/denoiser.safetensors"
INVENTORY_CHECKPOINT = "models/checkpoint/inventory.safetensors"
WEIGHTS = "models/denoiser.safetensors"
RELEASED = "weights/denoiser.safetensors"


class Job(NamedTuple):
    """What one process trains: the state, the rooms, the rooms of the validation split; the inventory model as it begins; where both are kept meanwhile."""

    trainer: Trainer
    data: Rooms
    checked: Rooms
    sets: Sets
    header: Header
    inventory: Inventory
    checkpoint: Checkpoint
    inventory_checkpoint: Checkpoint


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
    files = {name: sha256_file(root / name) for name in (*TABLES, SHAPES, *([RELEASED] if settings.start == "released" else []))}
    key = digest([FORMAT, asdict(settings), asdict(header), seed, threads, group.size, device.type, files])
    checkpoint = Checkpoint(root / CHECKPOINT, key)
    trainer.done = checkpoint.resume(trainer.nets, trainer.optimiser)
    data, checked = (rooms_of(part, header, device) for part in (sets.train, sets.val or sets.train[:64]))
    return Job(trainer, data, checked, sets, header, inventory, checkpoint, Checkpoint(root / INVENTORY_CHECKPOINT, key))


def load_released(path: Path, wanted: Header) -> tuple[SetTransformer, Inventory, Header]:
    """Read the released weights. Raises ContentError when their vocabulary or shape is not that of the data and params.yaml.

    Their normalisation is kept: with another the same numbers would mean other rooms.
    """
    net, inventory, header = load_weights(path)
    for name in ("slots", "model", "inventory_width"):
        if getattr(header, name) != getattr(wanted, name):
            raise ContentError(
                f"{path} was trained with other {name} ({getattr(header, name)}) than params.yaml says ({getattr(wanted, name)})",
                "set train.start: scratch in params.yaml, or these numbers",
            )
    require_vocabulary(path, header, "set train.start: scratch in params.yaml")
    return net, inventory, header


def rooms_of(examples: Sequence[Example], header: Header, device: torch.device) -> Rooms:
    """Stack examples as they are trained on."""
    rooms, objects = collate(examples, Codec(header.norm), header.slots)
    objects = replace(objects, weights=pose_weights(objects.classes, objects.poses, len(header.norm.classes)))
    counts = np.array([len(e.classes) for e in examples], np.int64)
    return Rooms(rooms.to(device), objects.to(device), layout_weights(examples), counts)


def load(root: Path, settings: TrainSettings) -> tuple[Sets, Header]:
    """Read the tables into rooms, and fix what travels with the weights."""
    words, sets = taxonomy.load(), read_sets(root, settings.slots)
    norm = Normalisation.of(*stacked(sets.train), words.names)
    return sets, Header(norm, words.layout_types, settings.slots, settings.model, settings.inventory.width)


def holdings(examples: Sequence[Example], header: Header) -> Holdings:
    """Return what rooms hold, as the inventory model learns it."""
    features = np.stack([room_features(e.floor, e.context.height) for e in examples])
    layouts = np.array([e.layout for e in examples], np.int64)
    kinds = len(header.norm.classes)
    classes, poses = np.full((len(examples), header.slots), kinds), np.full((len(examples), header.slots), UNTOLD)
    for row, e in enumerate(examples):
        order = np.argsort(e.classes, kind="stable")
        classes[row, : len(order)], poses[row, : len(order)] = e.classes[order], e.poses[order]
    return Holdings(features, layouts, np.stack([np.bincount(e.classes, minlength=kinds) for e in examples]), classes, poses)
