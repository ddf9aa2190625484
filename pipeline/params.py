"""params.yaml and other files of settings, read strictly: an unknown key, a wrong type or a bad value is an error that names it."""

import dataclasses
import difflib
import functools
import json
import math
import re
import types
import typing
from collections.abc import Hashable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import yaml

from pipeline import yaml_text
from pipeline.errors import ContentError

# Every section of params.yaml: a misspelt one shall not pass as one more.
SECTIONS = (
    "seed",
    "corpus",
    "preprocess",
    "encode",
    "train",
    "sample",
    "retrieval",
    "postopt",
    "verify",
    "dataset",
    "prior",
    "shard",
    "baselines",
    "metrics",
)

FILE = "params.yaml"
T = TypeVar("T")
Tree = dict[str, Any]


def read(path: Path, preset: str | None = None) -> Tree:
    """Read params.yaml and lay the preset over it (`preset` overrides the file's own `preset:` key).

    Raises ContentError when the file is missing, is not YAML, or names an unknown preset.
    """
    try:
        tree = yaml_text.parse(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        msg = f"cannot read {path}: {str(error).splitlines()[0]}"
        raise ContentError(msg, "restore it with `git checkout params.yaml`") from error
    if not isinstance(tree, dict):
        msg = f"{path} is not a mapping of sections"
        raise ContentError(msg, "restore it with `git checkout params.yaml`")
    presets = tree.pop("presets", None) or {}
    name = preset or tree.pop("preset", "quick")
    tree.pop("preset", None)
    for key in tree:
        if key not in SECTIONS:
            raise unknown(str(key), str(key), dict.fromkeys(SECTIONS))
    if "seed" in tree and (type(tree["seed"]) is not int or tree["seed"] < 0):
        raise wrong("seed", tree["seed"], "a whole number from 0 on")
    if name not in presets:
        msg = f"unknown preset {name!r} in {path}"
        raise ContentError(msg, f"use one of {', '.join(presets)}")
    return merge(tree, presets[name] or {}, f"presets.{name}")


def rewritten(text: str, changes: Mapping[tuple[str, ...], str | None]) -> str:
    """Return params.yaml's text with other values for keys, each given by its path of names from the section on; comments and order stay.

    Raises ContentError for a key that does not stand in a line of its own there.
    """
    lines = text.splitlines(keepends=True)
    for path, value in changes.items():
        start, end = -1, len(lines)
        for depth, name in enumerate(path):
            inside = range(start + 1, end)
            line_number = next((i for i in inside if re.match(rf"{'  ' * depth}{name}:(\s|$)", lines[i])), None)
            if line_number is None:
                raise ContentError(f"params.yaml: key {'.'.join(path)} has no line", "restore it with `git checkout params.yaml`")
            start, end = line_number, next((i for i in inside if i > line_number and re.match(rf" {{0,{2 * depth}}}[^\s#]", lines[i])), end)
        comment = re.search(r"\s#\s.*$", lines[start].rstrip("\n"))
        said = "null" if value is None else value if re.fullmatch(r"[\w./][\w./-]*", value) else json.dumps(value, ensure_ascii=False)
        lines[start] = f"{'  ' * (len(path) - 1)}{path[-1]}: {said}{comment.group() if comment else ''}\n"
    return "".join(lines)


def merge(base: Tree, over: Mapping[str, Any], where: str) -> Tree:
    """Lay `over` on `base`, key by key. A key that `base` lacks is an error: presets only change what is there."""
    merged = dict(base)
    for name, value in over.items():
        if name not in base:
            raise unknown(f"{where}.{name}", name, base)
        old = base[name]
        if isinstance(value, Mapping) and not isinstance(old, dict):
            raise ContentError(f"params.yaml: section {name!r} is empty or no mapping", "restore it with `git checkout params.yaml`")
        merged[name] = merge(old, value, f"{where}.{name}") if isinstance(old, dict) and isinstance(value, Mapping) else value
    return merged


def section(cls: type[T], tree: Mapping[str, Any], name: str) -> T:
    """Build the frozen dataclass `cls` from section `name` of params.yaml.

    Raises ContentError for a section or key that is missing or unknown, or a value of the wrong type.
    """
    if name not in tree:
        raise ContentError(f"params.yaml: section {name!r} is missing", "restore it with `git checkout params.yaml`")
    return build(cls, tree[name], name)


def build(cls: type[T], value: Any, where: str, file: str = FILE) -> T:
    """Build dataclass `cls` from a mapping, checking every key and type; `where` is the dotted path in `file`, for messages."""
    remedy = "see the comments in params.yaml" if file == FILE else "compare it with the files beside it"
    if not isinstance(value, Mapping):
        raise ContentError(f"{file}: {where} must be a mapping", remedy)
    fields = {f.name: f for f in dataclasses.fields(cls)}  # type: ignore[arg-type]
    for key in value:
        if key not in fields:
            raise unknown(f"{where}.{key}", str(key), fields, file)
    hints = _hints(typing.cast("Hashable", cls))
    for key, field in fields.items():
        required = field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING
        if key not in value and required:
            raise ContentError(f"{file}: key {where}.{key} is missing", remedy)
    return cls(**{k: convert(hints[k], v, f"{where}.{k}", file) for k, v in value.items()})


@functools.cache
def _hints(cls: Hashable) -> dict[str, Any]:
    return typing.get_type_hints(cls)


def convert(hint: Any, value: Any, where: str, file: str = FILE) -> Any:  # noqa: PLR0911 - one return per kind of type
    """Convert one YAML value to the annotated type, or raise ContentError naming the key."""
    if type(value) is hint and hint is not float:  # the most of them
        return value
    origin, args = typing.get_origin(hint), typing.get_args(hint)
    if origin in {types.UnionType, typing.Union}:
        if value is None and type(None) in args:
            return None
        return convert(next(a for a in args if a is not type(None)), value, where, file)
    if dataclasses.is_dataclass(hint):
        return build(typing.cast("type[Any]", hint), value, where, file)
    if origin is typing.Literal:
        if value in args:
            return value
        raise wrong(where, value, f"one of {', '.join(map(str, args))}", file)
    if origin is tuple:
        if isinstance(value, (list, tuple)) and (args[-1] is Ellipsis or len(args) == len(value)):
            kinds = [args[0]] * len(value) if args[-1] is Ellipsis else args
            return tuple(convert(kind, v, f"{where}[{i}]", file) for i, (kind, v) in enumerate(zip(kinds, value, strict=True)))
        raise wrong(where, value, "a list", file)
    if origin in {dict, Mapping} or str(origin).endswith("abc.Mapping'>"):
        if isinstance(value, Mapping):
            return {convert(args[0], k, where, file): convert(args[1], v, f"{where}.{k}", file) for k, v in value.items()}
        raise wrong(where, value, "a mapping", file)
    if hint is float and isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value):
        return float(value)
    if hint in {int, str, bool} and type(value) is hint:
        return value
    raise wrong(where, value, getattr(hint, "__name__", str(hint)), file)


def unknown(where: str, key: str, known: Mapping[str, Any], file: str = FILE) -> ContentError:
    """Return the error for an unknown key, with the nearest known one."""
    near = difflib.get_close_matches(key, list(known), 1)
    hint = f"did you mean {near[0]!r}?" if near else f"known keys: {', '.join(known)}"
    return ContentError(f"{file}: unknown key {where}", hint)


def wrong(where: str, value: Any, wanted: str, file: str = FILE) -> ContentError:
    """Return the error for a value of the wrong type."""
    return ContentError(f"{file}: {where} = {value!r} is not valid", f"give {wanted}")
