"""Weights and checkpoints of the baselines on disk: safetensors, written whole or not at all."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

from safetensors import SafetensorError, safe_open
from safetensors.torch import save
from torch import Tensor

from pipeline.baselines.scaling import Scaling
from pipeline.baselines.training import Trainer
from pipeline.errors import ContentError
from pipeline.manifest import canonical, write_bytes

FORMAT = "sfgen-baseline-1"
REMEDY = "delete it and run `python -m stages.baselines` again"


def write(path: Path, digest: str, trainer: Trainer, scaling: Scaling) -> None:
    """Write the state of a training run, finished or not, with the digest of what it is of."""
    tensors = {f"{group}/{k}": v.detach().cpu().contiguous() for group, held in trainer.groups().items() for k, v in held.items()}
    header = {"format": FORMAT, "digest": digest, "done": trainer.done, "spent": trainer.spent, "scaling": asdict(scaling)}
    write_bytes(path, save(dict(sorted(tensors.items())), {"baseline": canonical(header).decode()}))


def restore(path: Path, digest: str, trainer: Trainer) -> bool:
    """Continue the run at `path`, if there is one of the same digest; return whether there was.

    Raises ContentError when the file is damaged.
    """
    if not path.is_file():
        return False
    groups, header = _read(path)
    if header.get("digest") != digest:
        return False
    trainer.restore(int(header["done"]), float(header["spent"]), groups)
    return True


def _read(path: Path) -> tuple[dict[str, dict[str, Tensor]], dict[str, Any]]:
    groups: dict[str, dict[str, Tensor]] = {}
    try:
        with safe_open(path, "pt") as handle:
            header: dict[str, Any] = json.loads((handle.metadata() or {})["baseline"])
            for key in handle.keys():  # noqa: SIM118 - not a dict
                group, name = key.split("/", 1)
                groups.setdefault(group, {})[name] = handle.get_tensor(key)
    except (OSError, SafetensorError, KeyError, ValueError) as error:
        raise ContentError(f"cannot read {path} ({str(error).splitlines()[0]})", REMEDY) from error
    if header.get("format") != FORMAT:
        raise ContentError(f"{path} is of another format than {FORMAT}", REMEDY)
    return groups, header
