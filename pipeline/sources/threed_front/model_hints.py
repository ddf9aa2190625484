"""What the houses say of the models in them, read before the models: declared boxes and categories, by model.

A model's own files say neither its unit nor, in a few thousand rooms of the release, its category; the records of the
scenes that use it do.
"""

import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from pipeline import taxonomy
from pipeline.sources.guarded import MAX_CONTAINERS, MAX_JSON, Folder
from pipeline.sources.reasons import SourceError
from pipeline.sources.threed_front.house_file import Furniture, furniture_record
from pipeline.taxonomy import Taxonomy

_SCENE = re.compile(rb'"scene"\s*:\s*(?=\{)')
_KEY = re.compile(rb'"furniture"\s*:\s*(?=\[)')
MAX_LIST = 8 << 20  # bytes of one file's list of furniture; real ones have some 20 kB
MAX_BOXES = 32  # declared boxes of one model that are kept
ON_FLOOR = 0.1  # [m]


@dataclass(slots=True)
class Hint:
    """What records say of one model: boxes (w, d, h) [m], and how often which category, super-category or title group.

    `feet` is how high above the floor it starts where it stands [m]; noted of lamps alone, whose category it tells.
    """

    boxes: list[tuple[float, float, float]] = field(default_factory=list)
    feet: list[float] = field(default_factory=list)
    categories: Counter[str] = field(default_factory=Counter)
    kinds: Counter[str] = field(default_factory=Counter)

    def box(self) -> NDArray[np.float64] | None:
        """Return the middle one of the declared boxes per axis (3,) [m], or None."""
        return np.median(np.array(self.boxes), axis=0) if self.boxes else None

    def mounts(self) -> frozenset[str]:
        """Return how a lamp of it may be mounted, by where it is placed; all ways where nobody knows."""
        if not self.feet:
            return frozenset({"floor", "wall", "ceiling"})
        return frozenset({"floor"} if float(np.median(self.feet)) < ON_FLOOR else {"wall", "ceiling"})

    def category(self) -> str | None:
        """Return the category that most records give, or None."""
        return min(self.categories, key=lambda c: (-self.categories[c], c)) if self.categories else None

    def kind(self) -> str:
        """Return the super-category or title group that most records give, or ""."""
        return min(self.kinds, key=lambda k: (-self.kinds[k], k)) if self.kinds else ""


def records(folder: Folder, file: str) -> list[Furniture]:
    """Return the valid furniture records of one house file, without reading the rest of it.

    A file that cannot be read gives none here: it is reported when the house itself is read.
    """
    try:
        data = folder.read(file, MAX_JSON)
        start = _KEY.search(data)
        if start is None:
            return []
        end = data.find(b'"mesh"', start.end())
        part = data[start.end() : end if end > 0 else start.end() + MAX_LIST]
        if len(part) > MAX_LIST or part.count(b"{") + part.count(b"[") > MAX_CONTAINERS:
            return []
        tree, _ = json.JSONDecoder().raw_decode(part.decode("utf-8", "replace"))
    except (SourceError, ValueError, RecursionError):
        return []
    furniture = (furniture_record(r) for r in tree if isinstance(r, dict))
    valid = [r for r in furniture if r.valid and r.jid]
    lamps = {r.uid for r in valid if _is_some_lamp(r)}
    feet = _feet(data, lamps) if lamps else {}
    return [replace(r, foot=feet.get(r.uid)) for r in valid]


def _is_some_lamp(record: Furniture) -> bool:
    words = taxonomy.load()
    named = words.from_future(record.category) or words.from_title(record.title)
    return named is None and any("floor_lamp" in words.of_kind(name) for name in kinds_of(record))


def _feet(data: bytes, uids: set[str]) -> dict[str, float]:
    """Return how high above the floor those records are placed [m]; what cannot be read is left to whoever reads the house."""
    start = None
    for start in _SCENE.finditer(data):  # noqa: B007 - the last one is meant: the word may occur in a title
        pass
    if start is None:
        return {}
    try:
        scene, _ = json.JSONDecoder().raw_decode(data[start.end() :].decode("utf-8", "replace"))
        children = [c for room in scene["room"] for c in room["children"]]
        return {c["ref"]: float(c["pos"][1]) for c in children if c["ref"] in uids}
    except (ValueError, TypeError, KeyError, IndexError, RecursionError):
        return {}


def hints(houses: Iterable[Iterable[Furniture]], words: Taxonomy) -> Mapping[str, Hint]:
    """Gather the records of all houses by model."""
    by_model: dict[str, Hint] = {}
    for record in (r for house in houses for r in house):
        hint = by_model.setdefault(record.jid, Hint())
        if record.box and len(hint.boxes) < MAX_BOXES:
            hint.boxes.append(record.box)
        if record.foot is not None and len(hint.feet) < MAX_BOXES:
            hint.feet.append(record.foot)
        named = words.from_future(record.category) or words.from_title(record.title)
        if named:
            hint.categories[named] += 1
        else:
            hint.kinds.update(name for name in kinds_of(record) if words.of_kind(name))
    return by_model


def kinds_of(record: Furniture) -> Iterator[str]:
    """Yield the names of a record that may be a super-category or a title group."""
    yield record.category
    yield record.title.split("/", 1)[0]
