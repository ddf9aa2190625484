"""The factory's vocabulary: categories, layout types, and the names that other people give them."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import yaml

PATH = Path(__file__).resolve().parent.parent / "manifests" / "taxonomy.yaml"


@dataclass(frozen=True, slots=True)
class Category:
    """One object category. `future` are 3D-FUTURE's names (normalised), `partnet` the model_cat it can come from.

    The layout model learns the categories with `layout`; the others are small things that lie on or in furniture. What is `fixed`
    belongs to the floor.
    """

    name: str
    super: str
    future: tuple[str, ...]
    partnet: tuple[str, ...]
    mount: Literal["floor", "wall", "ceiling"]
    size: tuple[float, float, float] | None
    layout: bool = True
    fixed: bool = False

    @property
    def loose(self) -> bool:
        """Whether it lies where it was put and can be taken away: a body of its own in simulators. Not so a rug, under furniture."""
        return not self.layout and self.mount == "floor" and not self.fixed


@dataclass(frozen=True, slots=True)
class Taxonomy:
    """Categories by name and the maps of room types.

    `essentials` lists per layout type groups of categories; a room needs one of each group to serve as that room;
    `unwanted` per type of a plan's room what is not put there.
    `titles` maps kinds of 3D-FRONT's record titles to categories; `kinds` maps 3D-FUTURE's super-categories and the
    groups of those titles to the categories that they may be; `styles` and `materials` map lower case to the spelling.
    """

    categories: Mapping[str, Category]
    layout_types: tuple[str, ...]
    essentials: Mapping[str, tuple[tuple[str, ...], ...]]
    unwanted: Mapping[str, tuple[str, ...]]
    front_rooms: Mapping[str, str | None]
    plan_rooms: Mapping[str, str | None]
    titles: Mapping[str, str]
    kinds: Mapping[str, tuple[str, ...]]
    styles: Mapping[str, str]
    materials: Mapping[str, str]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the layout model's categories, in class order."""
        return tuple(c.name for c in self.categories.values() if c.layout)

    @property
    def small(self) -> frozenset[str]:
        """Names of the categories that the layout model does not learn."""
        return frozenset(c.name for c in self.categories.values() if not c.layout)

    def from_future(self, name: str) -> str | None:
        """Return the category for a 3D-FUTURE name of any spelling, or None."""
        wanted = normalise(name)
        return next((c.name for c in self.categories.values() if wanted in c.future), None)

    def from_title(self, title: str) -> str | None:
        """Return the category for a title "group/kind" of a 3D-FRONT record, such as "sofa/ multi seat sofa", or None."""
        kind = normalise(title).rsplit("/", 1)[-1]
        return self.titles.get(kind) or self.from_future(kind) or self.from_future(title)

    def of_kind(self, *names: str) -> tuple[str, ...]:
        """Return the categories that the first known of these super-categories or title groups may be, () for none."""
        return next((self.kinds[n] for n in map(normalise, names) if n in self.kinds), ())

    def from_partnet(self, model_cat: str) -> tuple[str, ...]:
        """Return the categories that a PartNet-Mobility object of that model_cat may serve as."""
        return tuple(c.name for c in self.categories.values() if model_cat in c.partnet)


def normalise(name: str) -> str:
    """Lower-case and strip the blanks around slashes, as in "Corner / Side Table"."""
    return "/".join(part.strip() for part in name.lower().split("/"))


@functools.cache
def load() -> Taxonomy:
    """Read manifests/taxonomy.yaml."""
    raw = yaml.safe_load(PATH.read_text(encoding="utf-8"))
    categories = {
        name: Category(
            name,
            entry["super"],
            tuple(normalise(n) for n in entry.get("future", ())),
            tuple(entry.get("partnet", ())),
            entry.get("mount", "floor"),
            tuple(entry["size"]) if "size" in entry else None,
            entry.get("layout", True),
            entry.get("fixed", False),
        )
        for name, entry in raw["categories"].items()
    }
    essentials = {kind: tuple(tuple(group) for group in groups) for kind, groups in raw["essentials"].items()}
    unwanted = {kind: tuple(names) for kind, names in raw["unwanted"].items()}
    kinds = {name: tuple(members) for name, members in raw["kinds"].items()}
    styles, materials = ({n.lower(): n for n in raw[key]} for key in ("styles", "materials"))
    return Taxonomy(
        categories,
        tuple(raw["layout_types"]),
        essentials,
        unwanted,
        raw["front_rooms"],
        raw["plan_rooms"],
        raw["titles"],
        kinds,
        styles,
        materials,
    )
