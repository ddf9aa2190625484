"""The four data sets that ATISS and DiffuScene cut 3D-FRONT into: their classes, our categories for them, their filters.

Facts of the peers' published configurations: bedrooms have 21 classes, living and dining rooms 24, libraries 25.
"""

import functools
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from pipeline.card import cards

BED_CLASSES = (
    "armchair", "bookshelf", "cabinet", "ceiling_lamp", "chair", "children_cabinet", "coffee_table", "desk", "double_bed",
    "dressing_chair", "dressing_table", "kids_bed", "nightstand", "pendant_lamp", "shelf", "single_bed", "sofa", "stool", "table",
    "tv_stand", "wardrobe",
)  # fmt: skip
LIVING_CLASSES = (
    "armchair", "bookshelf", "cabinet", "ceiling_lamp", "chaise_longue_sofa", "chinese_chair", "coffee_table", "console_table",
    "corner_side_table", "desk", "dining_chair", "dining_table", "l_shaped_sofa", "lazy_sofa", "lounge_chair", "loveseat_sofa",
    "multi_seat_sofa", "pendant_lamp", "round_end_table", "shelf", "stool", "tv_stand", "wardrobe", "wine_cabinet",
)  # fmt: skip
LIBRARY_CLASSES = tuple(sorted({*LIVING_CLASSES, "dressing_table", "dressing_chair"} - {"tv_stand"}))
BEDS = frozenset({"double_bed", "single_bed", "kids_bed"})
LEAST, HIGHEST, LOWEST = 3, 4.0, -0.005  # objects; [m] their top and bottom


@functools.cache
def _labels(label_set: str) -> Mapping[str, str]:
    return {name: card.names.peers[label_set] for name, card in cards().items() if label_set in card.names.peers}


@dataclass(frozen=True, slots=True)
class Kind:
    """One data set: rooms whose type contains `word`.

    `label_set`: under which the cards of our categories name their classes there (names.peers) where these differ. `most` objects and `side` [m] of the floor's bounds are what its filters allow; `reach` [m] is half the side of the
    square that its floor masks show.
    """

    name: str
    word: str
    classes: tuple[str, ...]
    label_set: str
    most: int
    side: float
    reach: float
    needs: frozenset[str] = field(default_factory=frozenset)

    def label(self, category: str) -> str | None:
        """Return the class of one of our categories, or None."""
        named = _labels(self.label_set).get(category, category)
        return named if named in self.classes else None

    def categories(self, label: str) -> tuple[str, ...]:
        """Return our categories that have this class."""
        other = tuple(c for c, named in _labels(self.label_set).items() if named == label)
        return other if label in _FOREIGN else (label, *other)


_FOREIGN = frozenset({"sofa", "chair", "table", "console_table"})  # classes that are no category of ours
KINDS: Mapping[str, Kind] = {
    kind.name: kind
    for kind in (
        Kind("bedroom", "bed", BED_CLASSES, "bedroom", 13, 6.0, 3.1, BEDS),
        Kind("livingroom", "living", LIVING_CLASSES, "living", 21, 12.0, 6.2),
        Kind("diningroom", "dining", LIVING_CLASSES, "living", 21, 12.0, 6.2),
        Kind("library", "library", LIBRARY_CLASSES, "living", 10_000, 6.0, 3.1),
    )
}


def kind_of(classes: tuple[str, ...]) -> Kind | None:
    """Return the data set that has these classes, in this order; a file may lack classes that its rooms do not hold.

    Living and dining rooms share theirs: the first that fits is returned. None where a class is of no set.
    """
    for kind in KINDS.values():
        if classes and set(classes) <= set(kind.classes):
            return replace(kind, classes=classes)
    return None
