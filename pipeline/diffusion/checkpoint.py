"""Weights and checkpoints on disk."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from torch import Tensor, nn

from pipeline.diffusion.codec import Normalisation
from pipeline.diffusion.inventory import Inventory
from pipeline.diffusion.set_transformer import SetTransformer
from pipeline.diffusion.settings import ModelSettings
from pipeline.errors import ContentError
from pipeline.manifest import canonical
from pipeline.params import build
from pipeline.tensors import load_state, load_tensors, save_tensors

FORMAT = "sfgen-denoiser-5"
REMEDY = "run `make run`, or `dvc repro train`, which makes it"


@dataclass(frozen=True, slots=True)
class Header:
    """What travels with the weights: normalisation and classes, layout types in order, most objects of a room, the net's shape."""

    norm: Normalisation
    layouts: tuple[str, ...]
    slots: int
    model: ModelSettings
    inventory_width: int


def build_net(header: Header) -> SetTransformer:
    """Build the net that a header describes."""
    return SetTransformer(header.norm, len(header.layouts), header.model)


def build_inventory(header: Header) -> Inventory:
    """Build the inventory model that a header describes."""
    return Inventory(len(header.norm.classes), len(header.layouts), header.inventory_width)


def save_weights(path: Path, header: Header, nets: Mapping[str, nn.Module]) -> None:
    """Write the weights of a layout model: its `denoiser` and its `inventory`."""
    text = canonical({"format": FORMAT, **asdict(header)}).decode()
    save_tensors(path, _flatten({name: net.state_dict() for name, net in nets.items()}), {"layout": text})


def load_weights(path: Path) -> tuple[SetTransformer, Inventory, Header]:
    """Read a layout model. Raises ContentError when the file is missing, truncated, of another format, or holds what is no number."""
    groups, value = _read(path, "layout")
    try:
        header = Header(
            Normalisation.of_json(value["norm"]),
            tuple(value["layouts"]),
            value["slots"],
            build(ModelSettings, value["model"], "train.model"),
            value["inventory_width"],
        )
    except (KeyError, TypeError) as error:
        raise ContentError(f"{path} does not hold a layout model ({FORMAT})", REMEDY) from error
    denoiser, inventory = build_net(header), build_inventory(header)
    load_state(denoiser, groups.get("denoiser", {}), path, REMEDY)
    load_state(inventory, groups.get("inventory", {}), path, REMEDY)
    return denoiser.eval(), inventory.eval(), header


def save_checkpoint(path: Path, digest: str, step: int, groups: Mapping[str, Mapping[str, Tensor]]) -> None:
    """Write a checkpoint: named groups of tensors (weights, averages, moments), the step, and the digest of what it is of."""
    save_tensors(path, _flatten(groups), {"checkpoint": canonical({"format": FORMAT, "digest": digest, "step": step}).decode()})


def load_checkpoint(path: Path, digest: str) -> tuple[int, dict[str, dict[str, Tensor]]] | None:
    """Read a checkpoint, or None where there is none, it is damaged, or of another digest: training then starts afresh."""
    try:
        groups, header = _read(path, "checkpoint")
    except ContentError:
        return None
    return (int(header["step"]), groups) if header.get("digest") == digest else None


def _flatten(groups: Mapping[str, Mapping[str, Tensor]]) -> dict[str, Tensor]:
    return {f"{group}/{name}": value for group, state in groups.items() for name, value in state.items()}


def _read(path: Path, key: str) -> tuple[dict[str, dict[str, Tensor]], dict[str, Any]]:
    """Read groups of tensors, and what the header says under `key`."""
    tensors, headers = load_tensors(path, REMEDY)
    header = json.loads(headers.get(key, "{}"))
    if header.get("format") != FORMAT:
        raise ContentError(f"{path} is of another format than {FORMAT}", REMEDY)
    groups: dict[str, dict[str, Tensor]] = {}
    for name, value in tensors.items():
        group, own = name.split("/", 1)
        groups.setdefault(group, {})[own] = value
    return groups, header
