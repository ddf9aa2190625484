"""The VAE on disk: safetensors, the settings in its header."""

import json
from dataclasses import asdict
from pathlib import Path

from safetensors import SafetensorError, safe_open
from safetensors.torch import save

from pipeline.errors import ContentError
from pipeline.latents.settings import EncodeSettings
from pipeline.latents.vae import PointVae
from pipeline.manifest import canonical, write_bytes
from pipeline.params import build

FORMAT = "sfgen-vae-1"


def save_vae(path: Path, net: PointVae, settings: EncodeSettings) -> None:
    """Write the weights (atomically)."""
    header = canonical({"format": FORMAT, "settings": asdict(settings)}).decode()
    tensors = {name: value.detach().cpu().contiguous() for name, value in sorted(net.state_dict().items())}
    write_bytes(path, save(tensors, {"vae": header}))


def load_vae(path: Path) -> tuple[PointVae, EncodeSettings]:
    """Read the weights. Raises ContentError when the file is missing, truncated or of another format."""
    try:
        with safe_open(path, "pt") as handle:
            header = json.loads((handle.metadata() or {})["vae"])
            if header["format"] != FORMAT:
                raise ContentError(f"{path} does not hold the shape encoder ({FORMAT})", "run `dvc repro encode`")
            settings = build(EncodeSettings, header["settings"], "encode")
            net = PointVae.of(settings)
            net.load_state_dict({name: handle.get_tensor(name) for name in handle.keys()})  # noqa: SIM118 - not a dict
    except (OSError, SafetensorError, KeyError, ValueError, RuntimeError) as error:
        msg = f"cannot read the shape encoder {path} ({str(error).splitlines()[0]})"
        raise ContentError(msg, "run `dvc repro encode`") from error
    return net.eval(), settings
