"""Nets on disk: safetensors with a header of text, written whole or not at all."""

from collections.abc import Mapping
from pathlib import Path

from safetensors import SafetensorError, safe_open
from safetensors.torch import save
from torch import Tensor, isfinite, nn

from pipeline.errors import ContentError
from pipeline.manifest import write_bytes


def save_tensors(path: Path, tensors: Mapping[str, Tensor], header: Mapping[str, str]) -> None:
    """Write named tensors and a header."""
    write_bytes(path, save({name: value.detach().cpu().contiguous() for name, value in sorted(tensors.items())}, dict(header)))


def load_tensors(path: Path, remedy: str) -> tuple[dict[str, Tensor], dict[str, str]]:
    """Read tensors and header. Raises ContentError when the file is missing, broken, or holds what is no number."""
    if not path.is_file():
        raise ContentError(f"{path} is missing", remedy)
    try:
        with safe_open(path, "pt") as handle:
            tensors, header = {name: handle.get_tensor(name) for name in handle.keys()}, handle.metadata() or {}  # noqa: SIM118 - not a dict
    except (OSError, SafetensorError) as error:
        raise ContentError(f"{path} is no safetensors file ({str(error).splitlines()[0]})", remedy) from error
    if broken := [name for name, value in tensors.items() if not bool(isfinite(value).all())]:
        raise ContentError(f"{path} holds numbers that are not finite ({broken[0]} ...)", remedy)
    return tensors, header


def load_state(net: nn.Module, tensors: Mapping[str, Tensor], path: Path, remedy: str) -> None:
    """Give a net the tensors that were read from a file. Raises ContentError where they are those of another net."""
    try:
        net.load_state_dict(tensors)
    except RuntimeError as error:
        raise ContentError(f"{path} does not fit the net ({str(error).splitlines()[0]})", remedy) from error
