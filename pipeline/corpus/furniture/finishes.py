"""Finishes: colours and surfaces of a model, chosen by style. Colours are linear RGB."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal, TypeVar

import numpy as np
import yaml

from pipeline import params, style
from pipeline.style import Color, StyleSpec

Thing = TypeVar("Thing")
Pattern = Literal[
    "plain", "grain", "weave", "speckle", "leather", "boucle", "velvet", "brushed", "concrete", "marble", "terrazzo", "stripe", "check", "floral",
    "cane", "knit", "leaf", "rug_border", "rug_diamonds", "rug_stripes", "art_blocks", "art_hills", "art_circles", "art_lines", "dial",
]  # fmt: skip
FILE = "manifests/furniture.yaml"
PATH = Path(__file__).resolve().parents[3] / FILE
STYLES: Mapping[str, StyleSpec] = {name: known.spec for name, known in style.load().styles.items()}
COLORS: Mapping[str, Color] = {name: color for kind in style.load().colours.values() for name, color in kind.items()}
LEATHERS = style.load().colours["leathers"]
CLOTH_GROUNDS: Color = (0.72, 0.68, 0.60)  # the light thread of striped, checked and flowered cloth
_KNOWN: dict[str, Any] = yaml.safe_load(PATH.read_text(encoding="utf-8"))
PALETTES: Mapping[str, tuple[Color, ...]] = params.convert(Mapping[str, tuple[Color, ...]], _KNOWN["palettes"], "palettes", FILE)
Profile = tuple[tuple[float, ...], ...]
PROFILES: Mapping[str, Profile] = params.convert(Mapping[str, Profile], _KNOWN["profiles"], "profiles", FILE)
SUPER_CATEGORIES: Mapping[str, str] = _KNOWN["super_categories"]


@dataclass(frozen=True, slots=True)
class Finish:
    """A surface: a preview material, its texture pattern, and the density [kg/m3] of what it covers (hollow parts: mean).

    A pattern goes from `color` to `second` where there is one, else it is lighter and darker than `color`.
    """

    name: str
    color: Color
    roughness: float = 0.6
    metallic: float = 0.0
    opacity: float = 1.0
    pattern: Pattern = "plain"
    density: float = 650.0
    second: Color | None = None


@dataclass(frozen=True, slots=True)
class Finishes:
    """The finishes of one model: `body` carcass and frames, `front` doors and drawers, `accent` legs and handles, `soft` covers.

    `second` is a darker or lighter cover for throw pillows and seats, `handle` metal parts, `timber` bare wood, `stone` what a
    table's top is made of where it is not wood; `material` and `style_name` are 3D-FUTURE's words.
    """

    body: Finish
    front: Finish
    accent: Finish
    handle: Finish
    soft: Finish
    second: Finish
    material: str
    style_name: str
    style: StyleSpec
    timber: Finish
    stone: Finish

    @property
    def tradition(self) -> str:
        """The group of styles.yaml that the style is of: "classic", "oriental" or none ("")."""
        return next((name for name in ("classic", "oriental") if self.style_name in style.load().groups[name]), "")


Material = Finish | str
"""A finish, or the name of one in manifests/furniture.yaml."""
FINISHES = {key: params.build(Finish, {"name": key} | entry, f"finishes.{key}", FILE) for key, entry in _KNOWN["finishes"].items()}


def pick(rng: np.random.Generator, words: str) -> str:
    """Draw one of the words."""
    return str(rng.choice(words.split()))


def one_of(rng: np.random.Generator, things: Sequence[Thing]) -> Thing:
    """Draw one of the things."""
    return things[int(rng.integers(len(things)))]


def draw_material(rng: np.random.Generator, *materials: Material) -> Material:
    """Draw one of some materials."""
    return one_of(rng, materials)


def lacquer(rng: np.random.Generator, name: str, roughness: float = 0.35) -> Finish:
    """Return a lacquer of that name in a shade of its own."""
    return Finish(f"lacquer_{name}", tint(rng, COLORS[name], 0.05), roughness, density=680)


def cover(rng: np.random.Generator, name: str, pattern: Pattern = "weave") -> Finish:
    """Return a cloth or leather over foam; the density is that of the upholstery."""
    if name in LEATHERS:
        return Finish(name, tint(rng, COLORS[name]), 0.4, pattern="leather", density=75)
    if pattern == "leather":
        pattern = "weave"
    second = CLOTH_GROUNDS if pattern in ("stripe", "check", "floral") else None
    if second is not None and max(COLORS[name]) > 0.5:  # a light cloth's pattern is darker than its ground
        second = (0.16, 0.18, 0.22)
    return Finish(name, tint(rng, COLORS[name]), 0.75 if pattern == "velvet" else 0.92, pattern=pattern, density=60, second=second)


def cane(rng: np.random.Generator) -> Finish:
    """Return a woven panel of rattan."""
    return Finish("cane", tint(rng, (0.56, 0.38, 0.19), 0.08), 0.8, pattern="cane", density=250, second=(0.20, 0.12, 0.055))


def tint(rng: np.random.Generator, color: Color, spread: float = 0.12) -> Color:
    """Return the colour a little lighter or darker, warmer or cooler."""
    factors = np.exp(rng.normal(0, spread) + rng.normal(0, spread / 4, 3))
    r, g, b = np.clip(np.array(color) * factors, 0.012, 0.9)
    return (round(float(r), 3), round(float(g), 3), round(float(b), 3))


def draw_finishes(rng: np.random.Generator, style_name: str) -> Finishes:
    """Choose the finishes of a model by its style."""
    style = STYLES[style_name]
    wood = pick(rng, style.woods)
    timber = Finish(wood, tint(rng, COLORS[wood]), 0.5, pattern="grain", density=620)
    metal = pick(rng, style.metals)
    tube = Finish(metal, COLORS[metal], 0.35, 0.85, density=2600)  # as dense as tubes and sheet are
    body = front = timber
    material = "Bamboo Rattan" if wood in ("bamboo", "rattan") else "Solid Wood"
    if style.lacquers and rng.random() < style.paint:
        painted = lacquer(rng, pick(rng, style.lacquers))
        material = "Composite Board"
        front = painted
        body = painted if rng.random() < 0.5 else timber
    patterns: list[Pattern] = style.cloths.split()  # type: ignore[assignment]
    name = pick(rng, style.fabrics)
    soft = cover(rng, name, one_of(rng, patterns))
    second = cover(rng, pick(rng, style.fabrics), one_of(rng, patterns))
    if second.name == soft.name:
        second = replace(second, name=f"{second.name}_2", color=tint(rng, second.color, 0.5))
    accent = tube if rng.random() < style.tube else timber
    stone = FINISHES[pick(rng, style.stones)]
    return Finishes(body, front, accent, tube, soft, second, material, style_name, style, timber, stone)
