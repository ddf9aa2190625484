"""What the houses say of the models in them, read before the models: declared boxes and categories, by model.

A model's own files say neither its unit nor, in a few thousand rooms of the release, its category; the records of the
scenes that use it do.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pipeline.sources.front_file import Furniture, furniture_record
from pipeline.sources.guarded import MAX_CONTAINERS, MAX_JSON, Folder
from pipeline.sources.reasons import SourceError
from pipeline.taxonomy import Taxonomy

_KEY = re.compile(rb'"furniture"\s*:\s*(?=\[)')
MAX_LIST = 8 << 20  # bytes of one file's list of furniture; real ones have some 20 kB
MAX_BOXES = 32  # declared boxes of one model that are kept


@dataclass(slots=True)
class Hint:
    """What records say of one model: boxes (w, d, h) [m], and how often which category, super-category or title group."""

    boxes: list[tuple[float, float, float]] = field(default_factory=list)
    categories: Counter[str] = field(default_factory=Counter)
    kinds: Counter[str] = field(default_factory=Counter)

    def box(self) -> NDArray[np.float64] | None:
        """Return the middle one of the declared boxes per axis (3,) [m], or None."""
        return np.median(np.array(self.boxes), axis=0) if self.boxes else None

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
        found, _ = json.JSONDecoder().raw_decode(part.decode("utf-8", "replace"))
    except (SourceError, ValueError, RecursionError):
        return []
    made = (furniture_record(r) for r in found if isinstance(r, dict))
    return [r for r in made if r.valid and r.jid]


def hints(houses: Iterable[Iterable[Furniture]], taxonomy: Taxonomy) -> Mapping[str, Hint]:
    """Gather the records of all houses by model."""
    found: dict[str, Hint] = {}
    for record in (r for house in houses for r in house):
        hint = found.setdefault(record.jid, Hint())
        if record.box and len(hint.boxes) < MAX_BOXES:
            hint.boxes.append(record.box)
        named = taxonomy.from_future(record.category) or taxonomy.from_title(record.title)
        if named:
            hint.categories[named] += 1
        else:
            hint.kinds.update(name for name in kinds_of(record) if taxonomy.of_kind(name))
    return found


def kinds_of(record: Furniture) -> Iterator[str]:
    """Yield the names of a record that may be a super-category or a title group."""
    yield record.category
    yield record.title.split("/", 1)[0]
