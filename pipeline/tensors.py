"""Nets on disk: safetensors with a header of text, written whole or not at all; checkpoints, by which a killed training goes on.

And what all trainings share: draws by key, steps down a gradient.
"""

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save
from torch import Tensor, isfinite, nn

from pipeline import params, seeds
from pipeline.errors import ContentError
from pipeline.manifest import canonical, write_bytes

T = TypeVar("T")
N = TypeVar("N", bound=nn.Module)
Groups = dict[str, dict[str, Tensor]]
CHECKPOINT = "sfgen-checkpoint-2"
AGAIN = "delete it: training starts afresh without it"


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


def read_header(path: Path, header: Mapping[str, str], key: str, form: str, remedy: str) -> dict[str, Any]:
    """Return what a file's header says in JSON under `key`, less its `format`. Raises ContentError where that is no mapping, or of another format than `form`."""
    try:
        said = json.loads(header.get(key, "{}"))
    except (ValueError, RecursionError) as error:
        raise ContentError(f"{path}: its header is no JSON ({error})", remedy) from error
    if not isinstance(said, dict) or said.pop("format", None) != form:
        raise ContentError(f"{path} is of another format than {form}", remedy)
    return said


def build_header(cls: type[T], value: Any, where: str, path: Path, remedy: str) -> T:
    """Build the dataclass `cls` from what a file's header says, every key and type checked. Raises ContentError that names the file, not params.yaml."""
    try:
        return params.build(cls, value, where, str(path))
    except ContentError as error:
        said = error.message if error.message.startswith(str(path)) else f"{path}: {error.message}"
        raise ContentError(said, remedy) from error


def flatten(groups: Mapping[str, Mapping[str, Tensor]]) -> dict[str, Tensor]:
    """Return named groups of tensors as one, by `<group>/<name>`."""
    return {f"{group}/{name}": value for group, state in groups.items() for name, value in state.items()}


def grouped(path: Path, tensors: Mapping[str, Tensor], remedy: str) -> Groups:
    """Undo `flatten`. Raises ContentError for a name that is of no group."""
    groups: Groups = {}
    for name, value in tensors.items():
        group, slash, own = name.partition("/")
        if not slash:
            raise ContentError(f"{path} holds a tensor of no net ({name})", remedy)
        groups.setdefault(group, {})[own] = value
    return groups


def generator(seed: int, name: str, *keys: int | str) -> torch.Generator:
    """Return a generator whose draws hang on a key alone (see `seeds.key`)."""
    return torch.Generator().manual_seed(seeds.key(seed, name, *keys) % 2**63)


def initial(build: Callable[[], N], seed: int, name: str, *keys: int | str) -> N:
    """Build a net whose weights are drawn by a key alone."""
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seeds.key(seed, name, *keys) % 2**63)
        return build()


def cosine(share: float) -> float:
    """Return what is left of a learning rate that falls along a cosine, after a share of the training."""
    return 0.5 * (1 + math.cos(math.pi * share))


def advance(optimiser: torch.optim.Optimizer, rate: float, clip: float) -> None:
    """Clip the gradients at a norm, take a step along them at a learning rate, and forget them."""
    for group in optimiser.param_groups:
        group["lr"] = rate
    nn.utils.clip_grad_norm_([p for group in optimiser.param_groups for p in group["params"]], clip)
    optimiser.step()
    optimiser.zero_grad()


@dataclass(frozen=True, slots=True)
class Checkpoint:
    """The file in which a training is kept while it runs. `digest` is that of all it depends on: what is of another one is not taken up."""

    path: Path
    digest: str

    def save(self, step: int, groups: Mapping[str, Mapping[str, Tensor]]) -> None:
        """Write named groups of tensors (weights, averages, moments) after `step` steps."""
        text = canonical({"format": CHECKPOINT, "digest": self.digest, "step": step}).decode()
        save_tensors(self.path, flatten(groups), {"checkpoint": text})

    def load(self) -> tuple[int, Groups] | None:
        """Return the step and the groups, or None where there is none, it is damaged, or of another digest: training then starts afresh."""
        try:
            tensors, headers = load_tensors(self.path, AGAIN)
            header = read_header(self.path, headers, "checkpoint", CHECKPOINT, AGAIN)
            groups = grouped(self.path, tensors, AGAIN)
        except ContentError:
            return None
        step = header.get("step")
        return (step, groups) if type(step) is int and header.get("digest") == self.digest else None

    def keep(self, step: int, net: nn.Module, adam: torch.optim.Optimizer, rng: torch.Generator | None = None) -> None:
        """Write a net with the moments of its optimiser and, where draws come from one generator, the state of that."""
        moments = {f"{i}/{kind}": value for i, entry in adam.state_dict()["state"].items() for kind, value in entry.items()}
        self.save(step, {"net": net.state_dict(), "adam": moments, "rng": {"state": rng.get_state()} if rng else {}})

    def resume(self, net: nn.Module, adam: torch.optim.Optimizer, rng: torch.Generator | None = None) -> int:
        """Take up what `keep` wrote, if it did; returns the number of steps done."""
        found = self.load()
        if found is None:
            return 0
        step, groups = found
        state: dict[int, dict[str, Tensor]] = {}
        for key, value in groups["adam"].items():
            i, kind = key.split("/")
            state.setdefault(int(i), {})[kind] = value
        net.load_state_dict(groups["net"])
        adam.load_state_dict({**adam.state_dict(), "state": state})
        if rng:
            rng.set_state(groups["rng"]["state"])
        return step

    def remove(self) -> None:
        """Delete the file: what was trained is written."""
        self.path.unlink(missing_ok=True)
