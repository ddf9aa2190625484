"""Files of prompts: text with a prompt a line, or YAML, JSON or JSON lines with ground truth; checked before anything is planned."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from pipeline.errors import ContentError, UsageError
from pipeline.metrics.plan_checks import CHECKS, MEASURES, NEEDS
from pipeline.shards import require_prompt

Json = dict[str, Any]
MOST_BYTES = 16 << 20
REMEDY = "write a list of {prompt, graph, checks} as manifests/prompts/benchmark.yaml has them; graph and checks may be left out"


class _Loose(BaseModel):
    model_config = ConfigDict(extra="allow", frozen=True, allow_inf_nan=False, coerce_numbers_to_str=True)


class _Room(_Loose):
    id: str
    type: str
    area: Annotated[float, Field(gt=0.0)] | None = None


class _Edge(_Loose):
    a: str
    b: str
    optional: bool = False


class _Graph(_Loose):
    rooms: Annotated[list[_Room], Field(min_length=1, max_length=200)]
    edges: list[_Edge] = []
    area_ratio: dict[str, Annotated[float, Field(ge=0.0)]] | None = None


class _Adjacency(_Loose):
    a: str
    b: str


class _Constraint(_Loose):
    type: str


class _Checks(_Loose):
    presence: dict[str, Annotated[int, Field(ge=0)]] = {}
    absent: list[str] = []
    adjacency: list[_Adjacency] = []
    constraints: list[_Constraint] = []


class _Case(_Loose):
    prompt: Annotated[str, Field(strict=True)]
    id: str = ""
    graph: _Graph | None = None
    checks: _Checks = _Checks()


def read_prompts(path: Path) -> list[Json]:
    """Read a text file (a prompt a line, `#` begins a comment), or a list of prompts in YAML or JSON, or a prompt or case a line (.jsonl).

    Raises UsageError for a path that is no file or holds no prompt, ContentError naming the entry that is wrong.
    """
    if not path.is_file():
        remedy = "give a text file with a prompt a line, or a list in YAML or JSON"
        raise UsageError(f"{path} is {'not a file' if path.exists() else 'missing'}", remedy)
    if path.stat().st_size > MOST_BYTES:
        raise ContentError(f"{path} is larger than {MOST_BYTES >> 20} MiB", "give fewer prompts")
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise ContentError(f"cannot read {path} ({error})", "give a file in UTF-8") from error
    lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip()]
    match path.suffix.lower():
        case ".yaml" | ".yml":
            cases = _cases(path, _yaml(path, text))
        case ".json":
            cases = _cases(path, _json(path, text) if lines else None)
        case ".jsonl" | ".ndjson":
            cases = [_case(_json(f"line {n} of {path}", line), f"line {n} of {path}", f"line {n}") for n, line in lines]
        case _:
            prompts = [(n, line) for n, line in lines if not line.lstrip().startswith("#")]
            cases = [{"id": f"line {n}", "prompt": require_prompt(line, f"line {n} of {path}")} for n, line in prompts]
    if not cases:
        raise UsageError(f"{path} holds no prompt", "write one prompt a line")
    return cases


def _yaml(path: Path, text: str) -> object:
    try:
        return yaml.safe_load(text)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        raise ContentError(f"{path} is not YAML ({str(error).splitlines()[0]})", REMEDY) from error


def _json(where: object, text: str) -> object:
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ContentError(f"{where} is not JSON ({error})", REMEDY) from error


def _cases(path: Path, tree: object) -> list[Json]:
    if tree is None:
        return []
    if not isinstance(tree, list):
        raise ContentError(f"{path} is not a list", REMEDY)
    return [_case(entry, f"entry {n} of {path}", f"entry {n}") for n, entry in enumerate(tree, 1)]


def _case(entry: object, where: str, name: str) -> Json:
    """Check an entry, a prompt or a case, and return it as a case."""
    try:
        read = _Case.model_validate({"prompt": entry} if isinstance(entry, str) else entry)
    except ValidationError as error:
        first = error.errors()[0]
        raise ContentError(f"{where}: {'.'.join(map(str, first['loc']))}: {first['msg']}", REMEDY) from error
    if read.graph:
        _graph(read.graph, where)
    for check in read.checks.constraints:
        _constraint(check.model_dump(), where)
    plain = read.model_dump(exclude_none=True)
    return {**plain, "id": read.id or name, "prompt": require_prompt(read.prompt, where)}


def _graph(graph: _Graph, where: str) -> None:
    count = Counter(r.id for r in graph.rooms)
    if twice := [i for i, n in count.items() if n > 1]:
        raise ContentError(f"{where}: two rooms of the graph are called {twice[0]!r}", "give each an id of its own")
    if loose := [e for e in graph.edges if not {e.a, e.b} <= set(count)]:
        raise ContentError(f"{where}: the edge {loose[0].a}-{loose[0].b} names a room that the graph lacks", REMEDY)
    if not graph.area_ratio and (bare := [r.id for r in graph.rooms if r.area is None]):
        raise ContentError(f"{where}: room {bare[0]!r} of the graph has no area", "give each room an area, or the graph an area_ratio")


def _constraint(check: Mapping[str, Any], where: str) -> None:
    kind = check["type"]
    if kind not in CHECKS:
        raise ContentError(f"{where}: the constraint {kind!r} is unknown", f"known: {', '.join(CHECKS)}")
    for name in NEEDS.get(kind, ()):
        if check.get(name) is None:
            raise ContentError(f"{where}: the constraint {kind!r} lacks {name!r}", REMEDY)
    for name in MEASURES & check.keys():
        if isinstance(check[name], bool) or not isinstance(check[name], int | float):
            raise ContentError(f"{where}: {name!r} of the constraint {kind!r} is no number", REMEDY)
    for name, wanted in (("rooms", list), ("avoid", list), ("any_room", list), ("exclude", list), ("zones", dict)):
        if name in check and not isinstance(check[name], wanted):
            raise ContentError(f"{where}: {name!r} of the constraint {kind!r} is no {wanted.__name__}", REMEDY)
