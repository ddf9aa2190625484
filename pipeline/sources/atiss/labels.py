"""The four data sets that ATISS and DiffuScene cut 3D-FRONT into (manifests/peers.yaml): their classes, our categories for them, their filters."""

import functools
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from pipeline import params, yaml_text
from pipeline.card import cards

PATH = Path(__file__).resolve().parents[3] / "manifests" / "peers.yaml"
LEAST, HIGHEST, LOWEST = 3, 4.0, -0.005  # objects; [m] their top and bottom
FOREIGN = frozenset({"sofa", "chair", "table", "console_table"})  # classes that are no category of ours


@functools.cache
def _labels(label_set: str) -> Mapping[str, str]:
    return {name: card.names.peers[label_set] for name, card in cards().items() if label_set in card.names.peers}


@dataclass(frozen=True, slots=True)
class Kind:
    """One data set; the fields are explained in manifests/peers.yaml."""

    word: str
    classes: tuple[str, ...]
    label_set: str
    most: int
    side: float
    reach: float
    needs: tuple[str, ...] = ()
    name: str = ""

    def label(self, category: str) -> str | None:
        """Return the class of one of our categories, or None."""
        named = _labels(self.label_set).get(category, category)
        return named if named in self.classes else None

    def categories(self, label: str) -> tuple[str, ...]:
        """Return our categories that have this class."""
        other = tuple(c for c, named in _labels(self.label_set).items() if named == label)
        return other if label in FOREIGN else (label, *other)


KINDS: Mapping[str, Kind] = {
    name: params.build(Kind, row | {"name": name}, name, "manifests/peers.yaml")
    for name, row in yaml_text.parse(PATH.read_text(encoding="utf-8")).items()
}


def kind_of(classes: tuple[str, ...]) -> Kind | None:
    """Return the data set that has these classes, in this order; a file may lack classes that its rooms do not hold.

    Living and dining rooms share theirs: the first that fits is returned. None where a class is of no set.
    """
    fitting = (replace(kind, classes=classes) for kind in KINDS.values() if classes and set(classes) <= set(kind.classes))
    return next(fitting, None)
