"""Weights and checkpoints on disk: safetensors only, written whole or not at all."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save
from torch import Tensor, nn

from pipeline.diffusion.codec import Normalisation
from pipeline.diffusion.inventory import Inventory
from pipeline.diffusion.set_transformer import SetTransformer
from pipeline.diffusion.settings import ModelSettings
from pipeline.errors import ContentError
from pipeline.manifest import canonical, write_bytes
from pipeline.params import build

FORMAT = "sfgen-denoiser-4"
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
    tensors = {f"{name}/{k}": v.detach().cpu().contiguous() for name, net in nets.items() for k, v in net.state_dict().items()}
    write_bytes(path, save(dict(sorted(tensors.items())), {"layout": text}))


def load_weights(path: Path) -> tuple[SetTransformer, Inventory, Header]:
    """Read a layout model. Raises ContentError when the file is missing, truncated, of another format, or holds what is no number."""
    tensors, value = _read(path, "layout")
    try:
        header = Header(
            Normalisation.of_json(value["norm"]),
            tuple(value["layouts"]),
            value["slots"],
            build(ModelSettings, value["model"], "train.model"),
            value["inventory_width"],
        )
        nets = {"denoiser": build_net(header), "inventory": build_inventory(header)}
        for name, net in nets.items():
            net.load_state_dict({k.removeprefix(f"{name}/"): v for k, v in tensors.items() if k.startswith(f"{name}/")})
    except (KeyError, RuntimeError, TypeError) as error:
        raise ContentError(f"{path} does not hold a layout model ({FORMAT})", REMEDY) from error
    broken = sorted(k for k, v in tensors.items() if not bool(torch.isfinite(v).all()))
    if broken:
        raise ContentError(f"{path} holds values that are no numbers ({broken[0]} ...)", REMEDY)
    denoiser, inventory = nets["denoiser"].eval(), nets["inventory"].eval()
    assert isinstance(denoiser, SetTransformer)
    assert isinstance(inventory, Inventory)
    return denoiser, inventory, header


def save_checkpoint(path: Path, digest: str, step: int, groups: dict[str, dict[str, Tensor]]) -> None:
    """Write a checkpoint: named groups of tensors (weights, averages, moments), the step, and the digest of what it is of."""
    tensors = {f"{group}/{k}": v.detach().cpu().contiguous() for group, state in groups.items() for k, v in state.items()}
    header = canonical({"format": FORMAT, "digest": digest, "step": step}).decode()
    write_bytes(path, save(dict(sorted(tensors.items())), {"checkpoint": header}))


def load_checkpoint(path: Path, digest: str) -> tuple[int, dict[str, dict[str, Tensor]]] | None:
    """Read a checkpoint, or None where there is none, it is damaged, or of another digest: training then starts afresh."""
    if not path.is_file():
        return None
    try:
        tensors, header = _read(path, "checkpoint")
    except ContentError:
        return None
    if header.get("digest") != digest:
        return None
    groups: dict[str, dict[str, Tensor]] = {}
    for key, value in tensors.items():
        group, name = key.split("/", 1)
        groups.setdefault(group, {})[name] = value
    return int(header["step"]), groups


def _read(path: Path, key: str) -> tuple[dict[str, torch.Tensor], dict[str, Any]]:
    try:
        with safe_open(path, "pt") as handle:
            header = json.loads((handle.metadata() or {})[key])
            if header["format"] != FORMAT:
                raise ContentError(f"{path} is of another format than {FORMAT}", REMEDY)
            return {k: handle.get_tensor(k) for k in handle.keys()}, header  # noqa: SIM118 - not a dict
    except (OSError, SafetensorError, KeyError, ValueError) as error:
        msg = f"cannot read {path} ({str(error).splitlines()[0]})"
        raise ContentError(msg, REMEDY) from error
