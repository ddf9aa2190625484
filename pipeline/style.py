"""Styles of furniture, from manifests/styles.yaml: what they are called, and what each reaches for in timber, colour, cloth, metal, legs and ornament."""

import functools
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from pipeline import params, yaml_text

PATH = Path(__file__).resolve().parent.parent / "manifests" / "styles.yaml"
Color = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class StyleSpec:
    """What a style reaches for; words are drawn from with equal chances, a repeated word more often.

    `share`: how often it comes. `woods`, `lacquers` ("" for none), `fabrics`, `metals`: names of colours. `legs`: leg forms of
    legs.py. `cloths`: patterns of covers. `stones`: table tops other than wood. `shades`: forms of lamp shades. `fronts` and
    `handles`: those of doors and drawers (fronts.py). Chances in [0, 1]:
    `paint` lacquer instead of wood, `tube` metal legs, `stone` tops, `piping` and `tufts` of cushions, `ornament` mouldings, turnings
    and carved aprons, `cane` woven panels. `soft` [m]: radius of cushions, `edge` [m]: of boards; `slim`: factor on thicknesses.
    """

    share: float
    woods: str
    lacquers: str
    fabrics: str
    metals: str
    legs: str
    cloths: str = "weave"
    stones: str = "marble"
    shades: str = "drum"
    fronts: str = "slab slab shaker"
    handles: str = "bar flat knob edge"
    paint: float = 0.4
    tube: float = 0.4
    stone: float = 0.15
    piping: float = 0.1
    tufts: float = 0.0
    ornament: float = 0.0
    cane: float = 0.0
    soft: float = 0.045
    edge: float = 0.004
    slim: float = 1.0


@dataclass(frozen=True, slots=True)
class Style:
    """A style of 3D-FUTURE: the words for it in prompts, of all languages, and what the corpus makes of it."""

    spec: StyleSpec
    words: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Styles:
    """The manifest: styles by name, words that stand for several, and the colours [linear RGB] of what they name, by kind."""

    styles: Mapping[str, Style]
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    colours: Mapping[str, Mapping[str, Color]] = field(default_factory=dict)


@functools.cache
def load() -> Styles:
    """Read the manifest."""
    return params.build(Styles, yaml_text.parse(PATH.read_text(encoding="utf-8")), "styles", "manifests/styles.yaml")
