"""The factory's vocabulary: the cards of its categories, layout types, and the names that other people give them."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from pipeline import yaml_text
from pipeline.card import Category, cards

PATH = Path(__file__).resolve().parent.parent / "manifests" / "taxonomy.yaml"


@dataclass(frozen=True, slots=True)
class Taxonomy:
    """Categories by name and the maps of room types.

    `essentials` lists per layout type groups of categories; a room needs one of each group to serve as that room;
    `unwanted` per type of a plan's room what is not put there.
    `styles` and `materials` map lower case to the spelling.
    """

    categories: Mapping[str, Category]
    layout_types: tuple[str, ...]
    essentials: Mapping[str, tuple[tuple[str, ...], ...]]
    unwanted: Mapping[str, tuple[str, ...]]
    front_rooms: Mapping[str, str | None]
    plan_rooms: Mapping[str, str | None]
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
        return next((c.name for c in self.categories.values() if wanted in c.names.future), None)

    def from_title(self, title: str) -> str | None:
        """Return the category for a title "group/kind" of a 3D-FRONT record, such as "sofa/ multi seat sofa", or None."""
        kind = normalise(title).rsplit("/", 1)[-1]
        named = next((c.name for c in self.categories.values() if kind in c.names.titles), None)
        return named or self.from_future(kind) or self.from_future(title)

    def of_kind(self, *names: str) -> tuple[str, ...]:
        """Return the categories that the first known of these super-categories or title groups may be, () for none."""
        for name in map(normalise, names):
            if found := tuple(c.name for c in self.categories.values() if name in c.names.kinds):
                return found
        return ()

    def from_partnet(self, model_cat: str) -> tuple[str, ...]:
        """Return the categories that a PartNet-Mobility object of that model_cat may serve as."""
        return tuple(c.name for c in self.categories.values() if model_cat in c.names.partnet)


def normalise(name: str) -> str:
    """Lower-case and strip the blanks around slashes, as in "Corner / Side Table"."""
    return "/".join(part.strip() for part in name.lower().split("/"))


@functools.cache
def load() -> Taxonomy:
    """Read the cards and manifests/taxonomy.yaml."""
    raw = yaml_text.parse(PATH.read_text(encoding="utf-8"))
    essentials = {kind: tuple(tuple(group) for group in groups) for kind, groups in raw["essentials"].items()}
    unwanted = {kind: tuple(names) for kind, names in raw["unwanted"].items()}
    styles, materials = ({n.lower(): n for n in raw[key]} for key in ("styles", "materials"))
    return Taxonomy(
        cards(),
        tuple(raw["layout_types"]),
        essentials,
        unwanted,
        raw["front_rooms"],
        raw["plan_rooms"],
        styles,
        materials,
    )
