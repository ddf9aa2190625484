"""The VAE on disk, the settings in its header."""

import json
from dataclasses import asdict
from pathlib import Path

from pipeline.errors import ContentError
from pipeline.latents.settings import EncodeSettings
from pipeline.latents.vae import PointVae
from pipeline.manifest import canonical
from pipeline.params import build
from pipeline.tensors import load_state, load_tensors, save_tensors

FORMAT = "sfgen-vae-1"
REMEDY = "run `dvc repro encode`"


def save_vae(path: Path, net: PointVae, settings: EncodeSettings) -> None:
    """Write the weights (atomically)."""
    save_tensors(path, net.state_dict(), {"vae": canonical({"format": FORMAT, "settings": asdict(settings)}).decode()})


def load_vae(path: Path) -> tuple[PointVae, EncodeSettings]:
    """Read the weights. Raises ContentError when the file is missing, truncated or of another format."""
    tensors, headers = load_tensors(path, REMEDY)
    header = json.loads(headers.get("vae", "{}"))
    if header.get("format") != FORMAT:
        raise ContentError(f"{path} does not hold the shape encoder ({FORMAT})", REMEDY)
    settings = build(EncodeSettings, header["settings"], "encode")
    net = PointVae.of(settings)
    load_state(net, tensors, path, REMEDY)
    return net.eval(), settings
