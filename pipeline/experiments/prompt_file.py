"""Files of prompts: text with a prompt a line, or YAML, JSON or JSON lines with ground truth; checked before anything is planned."""

from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from pipeline.errors import ContentError
from pipeline.metrics.plan_checks import CHECKS, MEASURES, NEEDS
from pipeline.shards import read_entries, require_prompt

Json = dict[str, Any]
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
    """Read a file of prompts as `shards.read_entries` does, each with its ground truth. Raises as that does, and ContentError naming the entry that is wrong."""
    return [_case(entry, f"{name} of {path}", name) for name, entry in read_entries(path, REMEDY)]


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
    for name in check.keys() & MEASURES:
        if isinstance(check[name], bool) or not isinstance(check[name], int | float):
            raise ContentError(f"{where}: {name!r} of the constraint {kind!r} is no number", REMEDY)
    for name, wanted in (("rooms", list), ("avoid", list), ("any_room", list), ("exclude", list), ("zones", dict)):
        if name in check and not isinstance(check[name], wanted):
            raise ContentError(f"{where}: {name!r} of the constraint {kind!r} is no {wanted.__name__}", REMEDY)
