"""Weights and checkpoints on disk: safetensors only, written whole or not at all."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save
from torch import Tensor

from pipeline.diffusion.codec import Normalisation
from pipeline.diffusion.denoiser import Denoiser
from pipeline.diffusion.repeats import Held
from pipeline.diffusion.settings import ModelSettings
from pipeline.errors import ContentError
from pipeline.manifest import canonical, write_bytes
from pipeline.params import build

FORMAT = "sfgen-denoiser-3"
REMEDY = "run `make run`, or `dvc repro train`, which makes it"


@dataclass(frozen=True, slots=True)
class Header:
    """What travels with the weights: layout types in order, slots, levels, the model's settings.

    Rooms of the layout types `few` get `few_slots` instead of `slots` (see `slots_for`). `held` lists, per layout type, the classes
    that its training rooms hold, by their place in `norm.classes`, each and by kind, with how many of them one room holds; nothing else is
    sampled there, and nothing more often. An empty list: anything.
    """

    norm: Normalisation
    layouts: tuple[str, ...]
    slots: int
    timesteps: int
    model: ModelSettings
    few: tuple[str, ...] = ()
    few_slots: int = 12
    held: tuple[Held, ...] = ()

    def slots_for(self, layout: str, count: int | None) -> int:
        """Return how many slots a room gets: few where these hold the asked count, or what such rooms hold, with two to spare."""
        fits = layout in self.few if count is None else count <= self.few_slots - 2
        return min(self.few_slots, self.slots) if fits else self.slots


def build_net(header: Header) -> Denoiser:
    """Build the net that a header describes."""
    return Denoiser(header.norm, len(header.layouts), header.model)


def save_weights(path: Path, header: Header, tensors: dict[str, Tensor]) -> None:
    """Write the weights of a denoiser."""
    text = canonical({"format": FORMAT, **asdict(header)}).decode()
    write_bytes(path, save({k: v.detach().cpu().contiguous() for k, v in sorted(tensors.items())}, {"denoiser": text}))


def load_weights(path: Path) -> tuple[Denoiser, Header]:
    """Read a denoiser. Raises ContentError when the file is missing, truncated or of another format."""
    tensors, value = _read(path, "denoiser")
    try:
        header = Header(
            Normalisation.of_json(value["norm"]),
            tuple(value["layouts"]),
            value["slots"],
            value["timesteps"],
            build(ModelSettings, value["model"], "train.model"),
            tuple(value["few"]),
            value["few_slots"],
            tuple(tuple((tuple(group), count) for group, count in held) for held in value["held"]),
        )
        net = build_net(header)
        net.load_state_dict(tensors)
    except (KeyError, RuntimeError) as error:
        raise ContentError(f"{path} does not hold a layout model ({FORMAT})", REMEDY) from error
    return net.eval(), header


def save_checkpoint(path: Path, digest: str, step: int, groups: dict[str, dict[str, Tensor]]) -> None:
    """Write a checkpoint: named groups of tensors (weights, averages, moments), the step, and the digest of what it is of."""
    tensors = {f"{group}/{k}": v.detach().cpu().contiguous() for group, held in groups.items() for k, v in held.items()}
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
