"""What each home of a dataset is asked to be: a list of prompts that is gone through in turn, or a mix drawn by weight."""

import itertools
import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from pipeline.errors import ContentError, UsageError
from pipeline.manifest import digest
from pipeline.seeds import generator

LONGEST = 20_000  # characters of a prompt; the longest of the paper has some 300
MOST_BYTES = 16 << 20
LISTS = {".yaml": "YAML", ".yml": "YAML", ".json": "JSON", ".jsonl": "JSON lines", ".ndjson": "JSON lines"}  # files that are no plain text


@dataclass(frozen=True, slots=True)
class Mix:
    """Prompts, with weights when they are drawn, without when home i takes prompt i modulo their number.

    An empty mix asks for nothing: every home draws its program from the prior.
    """

    prompts: tuple[str, ...] = ()
    weights: tuple[float, ...] = ()
    places: tuple[str, ...] = ()  # of each prompt: "line 3 of prompts.txt"

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
    """Read a file of prompts: text, whose lines are taken in turn, or a list of {prompt, weight}, which is drawn from.

    Raises as `read_entries` does, and UsageError for an empty or over-long prompt.
    """
    remedy = "write a list of entries `- {prompt: ..., weight: 2}`"
    entries = {f"{name} of {path}": entry for name, entry in read_entries(path, remedy)}
    drawn = [_entry(entry, place, remedy) for place, entry in entries.items()]
    weights = tuple(weight for _, weight in drawn) if path.suffix.lower() in LISTS else ()
    return Mix(tuple(prompt for prompt, _ in drawn), weights, tuple(entries))


def read_entries(path: Path, remedy: str) -> list[tuple[str, object]]:
    """Return the entries of a file of prompts by name: the lines of a text ("line 3"; `#` begins a comment), or what a list in YAML, JSON or JSON lines holds.

    Raises UsageError for a path that is no file or holds no prompt, ContentError for a file that cannot be read; `remedy` says what a
    list is to hold.
    """
    if not path.is_file():
        known = "give a text file with a prompt a line, or a list in YAML or JSON"
        raise UsageError(f"{path} is {'not a file' if path.exists() else 'missing'}", known)
    if path.stat().st_size > MOST_BYTES:
        raise ContentError(f"{path} is larger than {MOST_BYTES >> 20} MiB", "give fewer prompts")
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise ContentError(f"cannot read {path} ({error})", "give a text file in UTF-8") from error
    lines = [(f"line {n}", line) for n, line in enumerate(text.splitlines(), 1) if line.strip()]
    kind = LISTS.get(path.suffix.lower(), "")
    if kind == "JSON lines":
        entries = [(name, _parsed(f"{name} of {path}", line, "JSON", remedy)) for name, line in lines]
    elif kind:
        listed = _parsed(path, text, kind, remedy) if lines else None
        if not isinstance(listed, list | None):
            raise ContentError(f"{path} is not a list", remedy)
        entries = [(f"entry {n}", entry) for n, entry in enumerate(listed or (), 1)]
    else:
        entries = [(name, line) for name, line in lines if not line.lstrip().startswith("#")]
    if not entries:
        raise UsageError(f"{path} holds no prompt", "write one prompt a line")
    return entries


def _parsed(where: object, text: str, kind: str, remedy: str) -> Any:
    try:
        return yaml.safe_load(text) if kind == "YAML" else json.loads(text)
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise ContentError(f"{where} is not {kind} ({str(error).splitlines()[0]})", remedy) from error


def _entry(item: Any, where: str, remedy: str) -> tuple[str, float]:
    if isinstance(item, str):
        return require_prompt(item, where), 1.0
    if not isinstance(item, dict) or not isinstance(item.get("prompt"), str) or item.keys() - {"prompt", "weight"}:
        raise ContentError(f"{where} is not {{prompt, weight}}", remedy)
    weight = item.get("weight", 1)
    if isinstance(weight, bool) or not isinstance(weight, (int, float)) or not math.isfinite(weight) or weight <= 0:
        raise ContentError(f"{where} has the weight {weight!r}", "give a number above 0")
    return require_prompt(item["prompt"], where), float(weight)
