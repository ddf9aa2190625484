"""What each home of a dataset is asked to be: a list of prompts that is gone through in turn, or a mix drawn by weight."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from pipeline.errors import ContentError, UsageError
from pipeline.manifest import digest
from pipeline.seeds import generator

LONGEST = 20_000  # characters of a prompt; the longest of the paper has some 300


@dataclass(frozen=True, slots=True)
class Mix:
    """Prompts, with weights when they are drawn, without when home i takes prompt i modulo their number.

    An empty mix asks for nothing: every home draws its program from the prior.
    """

    prompts: tuple[str, ...] = ()
    weights: tuple[float, ...] = ()

    def prompt(self, seed: int, index: int) -> str:
        """Return the prompt of home `index`; it depends on nothing else, so a dataset can grow."""
        if not self.prompts:
            return ""
        if not self.weights:
            return self.prompts[index % len(self.prompts)]
        mark = generator(seed, "mix", index).random() * sum(self.weights)
        # The last prompt catches a mark that rounding pushes past the sum.
        passed = itertools.accumulate(self.weights)
        return next((p for p, end in zip(self.prompts, passed, strict=True) if mark < end), self.prompts[-1])

    def digest(self) -> str:
        """Return what identifies the mix in a dataset's header."""
        return digest([self.prompts, self.weights])


def require_prompt(text: str, where: str = "the prompt") -> str:
    """Return the prompt without the blanks around it. Raises UsageError when it is empty, over-long or not text."""
    stripped = text.strip()
    if not stripped:
        raise UsageError(f"{where} is empty", 'describe a home, such as "a two-bedroom apartment with an open kitchen"')
    if len(stripped) > LONGEST:
        raise UsageError(f"{where} has {len(stripped)} characters", f"say it in {LONGEST} or fewer")
    if any(not c.isprintable() and not c.isspace() for c in stripped):
        raise UsageError(f"{where} holds control characters", "give plain text")
    return stripped


def read_mix(path: Path) -> Mix:
    """Read a text file (one prompt a line, `#` begins a comment) or a YAML mix (a list of {prompt, weight}).

    Raises UsageError for a missing path, one of the wrong kind, or an empty or over-long prompt; ContentError for a
    file that cannot be read as such.
    """
    if not path.is_file():
        raise UsageError(
            f"{path} is {'not a file' if path.exists() else 'missing'}", "give a text file with a prompt a line, or a YAML mix"
        )
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ContentError(f"cannot read {path} ({error})", "give a text file in UTF-8") from error
    mix = _yaml_mix(path, text) if path.suffix.lower() in {".yaml", ".yml"} else _lines(path, text)
    if not mix.prompts:
        raise UsageError(f"{path} holds no prompt", "write one prompt a line")
    return mix


def _lines(path: Path, text: str) -> Mix:
    kept = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip() and not line.lstrip().startswith("#")]
    return Mix(tuple(require_prompt(line, f"line {n} of {path}") for n, line in kept))


def _yaml_mix(path: Path, text: str) -> Mix:
    remedy = "write a list of entries `- {prompt: ..., weight: 2}`"
    try:
        data = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise ContentError(f"{path} is not YAML ({str(error).splitlines()[0]})", remedy) from error
    if not isinstance(data, list):
        raise ContentError(f"{path} is not a list", remedy)
    entries = [_entry(item, f"entry {n} of {path}", remedy) for n, item in enumerate(data, 1)]
    return Mix(tuple(p for p, _ in entries), tuple(w for _, w in entries))


def _entry(item: Any, where: str, remedy: str) -> tuple[str, float]:
    if isinstance(item, str):
        return require_prompt(item, where), 1.0
    if not isinstance(item, dict) or not isinstance(item.get("prompt"), str) or item.keys() - {"prompt", "weight"}:
        raise ContentError(f"{where} is not {{prompt, weight}}", remedy)
    weight = item.get("weight", 1)
    if isinstance(weight, bool) or not isinstance(weight, (int, float)) or not math.isfinite(weight) or weight <= 0:
        raise ContentError(f"{where} has the weight {weight!r}", "give a number above 0")
    return require_prompt(item["prompt"], where), float(weight)
