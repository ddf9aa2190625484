"""Finishes: colours and surfaces of a model, chosen by style. Colours are linear RGB."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

Pattern = Literal["grain", "weave", "plain", "speckle"]
Color = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Finish:
    """A surface: a preview material, its texture pattern, and the density [kg/m3] of what it covers (hollow parts: mean)."""

    name: str
    color: Color
    roughness: float = 0.6
    metallic: float = 0.0
    opacity: float = 1.0
    pattern: Pattern = "plain"
    density: float = 650.0


@dataclass(frozen=True, slots=True)
class Scheme:
    """The finishes of one model: `body` carcass and frames, `front` doors and drawers, `accent` legs and handles, `soft` covers.

    `second` is a darker or lighter cover for throw pillows and seats, `handle` metal parts; `material` is 3D-FUTURE's word, `style` its style.
    """

    body: Finish
    front: Finish
    accent: Finish
    handle: Finish
    soft: Finish
    second: Finish
    material: str
    style: str = "Modern"


WOODS: Mapping[str, Color] = {
    "oak": (0.47, 0.30, 0.16),
    "walnut": (0.19, 0.095, 0.05),
    "beech": (0.58, 0.37, 0.20),
    "ash": (0.62, 0.47, 0.31),
    "cherry": (0.36, 0.14, 0.07),
    "teak": (0.38, 0.20, 0.09),
    "wenge": (0.07, 0.04, 0.03),
    "birch": (0.68, 0.52, 0.35),
    "grey_oak": (0.33, 0.28, 0.23),
    "rosewood": (0.20, 0.06, 0.035),
}
LACQUERS: Mapping[str, Color] = {
    "white": (0.80, 0.80, 0.78),
    "ivory": (0.74, 0.68, 0.56),
    "light_grey": (0.50, 0.50, 0.50),
    "anthracite": (0.055, 0.06, 0.065),
    "sage": (0.27, 0.34, 0.25),
    "navy": (0.03, 0.06, 0.13),
    "dusty_blue": (0.22, 0.33, 0.43),
    "terracotta": (0.46, 0.17, 0.09),
    "mustard": (0.55, 0.35, 0.06),
    "blush": (0.62, 0.36, 0.32),
    "black": (0.02, 0.02, 0.022),
    "mint": (0.38, 0.57, 0.46),
}
FABRICS: Mapping[str, Color] = {
    "linen": (0.56, 0.49, 0.39),
    "grey_cloth": (0.28, 0.28, 0.29),
    "charcoal": (0.07, 0.07, 0.075),
    "cream_cloth": (0.70, 0.64, 0.53),
    "blue_cloth": (0.08, 0.15, 0.28),
    "green_velvet": (0.04, 0.14, 0.09),
    "rust_cloth": (0.42, 0.13, 0.05),
    "pink_cloth": (0.56, 0.29, 0.27),
    "ochre_cloth": (0.50, 0.30, 0.06),
    "teal_cloth": (0.04, 0.22, 0.24),
    "taupe_cloth": (0.33, 0.26, 0.20),
}
LEATHERS: Mapping[str, Color] = {"cognac": (0.30, 0.11, 0.035), "black_leather": (0.02, 0.019, 0.018), "cream_leather": (0.62, 0.54, 0.42)}
METALS: Mapping[str, Color] = {
    "steel": (0.55, 0.55, 0.56),
    "black_metal": (0.025, 0.025, 0.027),
    "brass": (0.62, 0.42, 0.15),
    "bronze": (0.16, 0.10, 0.06),
    "white_metal": (0.76, 0.76, 0.75),
}

# What each style reaches for first: woods, lacquers (often "" for none), fabrics, metals.
TASTES: Mapping[str, tuple[str, str, str, str]] = {
    "Modern": ("oak walnut grey_oak", "white light_grey anthracite", "grey_cloth charcoal linen cognac black_leather", "black_metal steel"),
    "Nordic": ("ash birch oak beech", "white sage dusty_blue", "linen grey_cloth ochre_cloth teal_cloth", "black_metal white_metal"),
    "Minimalist": ("ash grey_oak birch", "white ivory black", "cream_cloth grey_cloth charcoal", "black_metal white_metal"),
    "Light Luxury": ("walnut wenge", "ivory white navy", "green_velvet blue_cloth pink_cloth cream_leather", "brass"),
    "Industrial": ("oak teak grey_oak", "anthracite black", "cognac charcoal black_leather", "black_metal bronze"),
    "Japanese": ("beech ash cherry", "", "linen taupe_cloth cream_cloth", "black_metal bronze"),
    "American Country": ("cherry oak teak", "ivory sage navy", "linen rust_cloth taupe_cloth cognac", "bronze brass"),
    "New Chinese": ("rosewood walnut wenge", "", "linen taupe_cloth teal_cloth", "brass bronze"),
    "Vintage/Retro": ("teak walnut cherry", "mustard terracotta", "ochre_cloth rust_cloth green_velvet", "brass black_metal"),
    "Mediterranean": ("oak beech teak", "white dusty_blue navy", "blue_cloth cream_cloth linen", "bronze steel"),
}

CERAMIC = Finish("ceramic", (0.86, 0.86, 0.85), 0.12, density=2300)
GLASS = Finish("glass", (0.75, 0.83, 0.84), 0.05, 0.0, 0.28, density=2500)
DARK_GLASS = Finish("dark_glass", (0.02, 0.022, 0.025), 0.08, density=2500)
MIRROR = Finish("mirror", (0.85, 0.87, 0.88), 0.03, 1.0, density=2500)
STEEL = Finish("stainless_steel", (0.56, 0.57, 0.58), 0.28, 0.9, density=2400)
ENAMEL = Finish("enamel_white", (0.82, 0.82, 0.81), 0.25, density=900)
GRAPHITE = Finish("enamel_graphite", (0.09, 0.093, 0.10), 0.3, density=900)
PLASTIC = Finish("plastic_dark", (0.04, 0.04, 0.042), 0.45, density=1000)
PLASTIC_WHITE = Finish("plastic_white", (0.72, 0.72, 0.70), 0.4, density=1000)
GLOW = Finish("lamp_glass", (0.92, 0.88, 0.78), 0.5, density=400)
BEDDING = Finish("bedding", (0.80, 0.78, 0.74), 0.9, pattern="weave", density=45)
MATTRESS = Finish("mattress", (0.74, 0.72, 0.67), 0.9, pattern="weave", density=55)
LEAF = Finish("leaf", (0.05, 0.17, 0.035), 0.6, density=300)
SOIL = Finish("soil", (0.045, 0.03, 0.02), 0.95, pattern="speckle", density=1100)
MARBLE = Finish("marble", (0.72, 0.71, 0.69), 0.15, pattern="speckle", density=2600)
STONE = Finish("stone", (0.10, 0.10, 0.105), 0.3, pattern="speckle", density=2500)


def wood(rng: np.random.Generator, name: str) -> Finish:
    """Return a wood of that name in a shade of its own."""
    return Finish(name, shade(rng, WOODS[name]), 0.5, pattern="grain", density=620)


def cover(rng: np.random.Generator, name: str) -> Finish:
    """Return a cloth or leather over foam; the density is that of the upholstery."""
    if name in LEATHERS:
        return Finish(name, shade(rng, LEATHERS[name]), 0.4, pattern="speckle", density=75)
    return Finish(name, shade(rng, FABRICS[name]), 0.92, pattern="weave", density=60)


def metal(name: str) -> Finish:
    """Return a metal; the density is that of tubes and sheet."""
    return Finish(name, METALS[name], 0.35, 0.85, density=2600)


def shade(rng: np.random.Generator, color: Color, spread: float = 0.12) -> Color:
    """Return the colour a little lighter or darker, warmer or cooler."""
    factors = np.exp(rng.normal(0, spread) + rng.normal(0, spread / 4, 3))
    r, g, b = np.clip(np.array(color) * factors, 0.012, 0.9)
    return (round(float(r), 3), round(float(g), 3), round(float(b), 3))


def scheme(rng: np.random.Generator, style: str) -> Scheme:
    """Choose the finishes of a model by its style."""
    woods, lacquers, fabrics, metals = (words.split() for words in TASTES[style])
    timber = wood(rng, str(rng.choice(woods)))
    tube = metal(str(rng.choice(metals)))
    body = front = timber
    material = "Solid Wood"
    if lacquers and rng.random() < 0.55:
        name = str(rng.choice(lacquers))
        painted = Finish(f"lacquer_{name}", shade(rng, LACQUERS[name], 0.05), 0.35, density=680)
        material = "Composite Board"
        front = painted
        body = painted if rng.random() < 0.5 else timber
    soft = cover(rng, str(rng.choice(fabrics)))
    second = cover(rng, str(rng.choice(fabrics)))
    if second.name == soft.name:
        second = replace(second, name=f"{second.name}_2", color=shade(rng, second.color, 0.5))
    accent = tube if rng.random() < 0.45 else timber
    return Scheme(body, front, accent, tube, soft, second, material, style)
