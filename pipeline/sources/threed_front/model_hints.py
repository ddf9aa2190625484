"""What the houses say of the models in them, read before the models: declared boxes and categories, by model.

A model's own files say neither its unit nor, in a few thousand rooms of the release, its category; the records of the
scenes that use it do.
"""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from pipeline import taxonomy
from pipeline.arrays import Floats
from pipeline.sources.threed_front.furniture import stated_category
from pipeline.sources.threed_front.house import load_house
from pipeline.sources.threed_front.house_file import Furniture
from pipeline.taxonomy import Taxonomy

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

    def box(self) -> Floats | None:
        """Return the middle one of the declared boxes per axis (3,) [m], or None."""
        return np.median(np.array(self.boxes), axis=0) if self.boxes else None

    def mounts(self) -> frozenset[str]:
        """Return how a lamp of it may be mounted, by where it is placed; all ways where nobody knows."""
        if not self.feet:
            return frozenset({"floor", "wall", "ceiling"})
        return frozenset({"floor"} if float(np.median(self.feet)) < ON_FLOOR else {"wall", "ceiling"})

    def category(self) -> str:
        """Return the category that most records give, or ""."""
        return _commonest(self.categories)

    def kind(self) -> str:
        """Return the super-category or title group that most records give, or ""."""
        return _commonest(self.kinds)


def _commonest(names: Counter[str]) -> str:
    return min(names, key=lambda name: (-names[name], name), default="")


def records(root: Path, file: str) -> list[Furniture]:
    """Return the valid furniture records of one house file, those of lamps with the height at which they are placed.

    A file that cannot be read raises SourceError here as well as when the house itself is read.
    """
    house, words = load_house(root, file), taxonomy.load()
    feet = {child.ref: float(child.position[1]) for room in house.rooms for child in room.children}
    valid = (record for record in house.furniture.values() if record.valid and record.jid)
    return [replace(r, foot=feet.get(r.uid)) if _is_some_lamp(r, words) else r for r in valid]


def _is_some_lamp(record: Furniture, words: Taxonomy) -> bool:
    return stated_category(record, words) is None and any("floor_lamp" in words.of_kind(name) for name in record.kinds)


def hints(houses: Iterable[Iterable[Furniture]], words: Taxonomy) -> Mapping[str, Hint]:
    """Gather the records of all houses by model."""
    by_model: dict[str, Hint] = {}
    for record in (r for house in houses for r in house):
        hint = by_model.setdefault(record.jid, Hint())
        if record.box and len(hint.boxes) < MAX_BOXES:
            hint.boxes.append(record.box)
        if record.foot is not None and len(hint.feet) < MAX_BOXES:
            hint.feet.append(record.foot)
        if named := stated_category(record, words):
            hint.categories[named] += 1
        else:
            hint.kinds.update(name for name in record.kinds if words.of_kind(name))
    return by_model
