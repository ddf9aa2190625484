"""Styles: 3D-FUTURE's nineteen names, and what each reaches for in timber, colour, cloth, metal, legs, edges and ornament."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Manner:
    """What a style reaches for; words are drawn from with equal chances, a repeated word more often.

    `share`: how often it comes. `woods`, `lacquers` ("" for none), `fabrics`, `metals`: names of finishes.py. `legs`: leg forms of
    legs.py. `cloths`: patterns of covers. `stones`: table tops other than wood. `shades`: forms of lamp shades. Chances in [0, 1]:
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


MANNERS: Mapping[str, Manner] = {
    "Modern": Manner(0.15, "oak walnut grey_oak smoked_oak", "white light_grey anthracite", "grey_cloth charcoal linen cognac black_leather",
        "black_metal steel", "square block sled plank blade", "weave weave boucle leather", "marble sintered glass smoked_glass", "drum cone dome globe",
        paint=0.5, tube=0.5, stone=0.3, slim=0.95),
    "Nordic": Manner(0.12, "ash birch oak beech beech", "white sage dusty_blue blush", "linen grey_cloth ochre_cloth teal_cloth snow_cloth", "black_metal white_metal brass",
        "splayed splayed dowel tapered hairpin", "weave weave boucle knit", "terrazzo marble", "cone dome drum paper",
        paint=0.35, tube=0.2, stone=0.06, cane=0.15, soft=0.05, edge=0.008, slim=0.85),
    "Minimalist": Manner(0.09, "ash grey_oak birch", "white ivory black greige", "cream_cloth grey_cloth charcoal snow_cloth", "black_metal white_metal",
        "plank square sled blade", "weave boucle", "sintered concrete", "globe drum cylinder", paint=0.6, tube=0.35, stone=0.25, soft=0.03, edge=0.002, slim=0.75),
    "Light Luxury": Manner(0.09, "walnut wenge smoked_oak", "ivory white navy emerald", "green_velvet blue_cloth pink_cloth cream_leather grey_velvet", "brass brass copper",
        "blade tapered sled dowel", "velvet velvet leather", "marble dark_marble green_marble", "globe cylinder crystal drum", paint=0.6, tube=0.9, stone=0.5, piping=0.35,
        tufts=0.4, soft=0.05),
    "Industrial": Manner(0.06, "oak teak reclaimed", "anthracite black rust", "cognac charcoal black_leather cognac", "black_metal gunmetal bronze", "hairpin cross pipe sled",
        "leather leather weave", "concrete", "cage dome cone", paint=0.12, tube=1.0, stone=0.15, tufts=0.2, edge=0.002, slim=1.1),
    "Japanese": Manner(0.06, "beech ash cherry hinoki", "", "linen taupe_cloth cream_cloth indigo_cloth", "black_metal bronze", "square plank block", "weave weave stripe", "sintered",
        "paper paper drum", paint=0.0, tube=0.05, stone=0.03, soft=0.03, edge=0.003, slim=0.8),
    "American Country": Manner(0.06, "cherry oak teak walnut", "ivory sage navy barn_red", "linen rust_cloth taupe_cloth cognac plum_cloth", "bronze brass", "turned turned square bun",
        "weave check floral leather", "travertine", "bell drum pleated", paint=0.35, tube=0.0, stone=0.05, piping=0.5, tufts=0.25, ornament=0.7, soft=0.06, edge=0.01, slim=1.25),
    "New Chinese": Manner(0.05, "rosewood walnut wenge", "", "linen taupe_cloth teal_cloth cream_cloth", "brass bronze", "horse square ming", "weave weave velvet", "marble dark_marble",
        "drum paper lantern", paint=0.0, tube=0.15, stone=0.2, piping=0.2, soft=0.035, ornament=0.35, edge=0.004),
    "Vintage/Retro": Manner(0.05, "teak walnut cherry", "mustard terracotta mint", "ochre_cloth rust_cloth green_velvet cognac", "brass black_metal copper", "splayed dowel hairpin tapered",
        "weave velvet leather check", "terrazzo travertine", "dome cone mushroom", paint=0.3, tube=0.3, stone=0.1, piping=0.4, tufts=0.45, cane=0.2, soft=0.045, edge=0.008),
    "Mediterranean": Manner(0.04, "oak beech teak whitewashed", "white dusty_blue navy aqua", "blue_cloth cream_cloth linen snow_cloth", "bronze steel", "turned square tapered",
        "stripe stripe weave floral", "travertine terrazzo", "drum bell rattan", paint=0.6, tube=0.1, stone=0.15, piping=0.3, ornament=0.35, cane=0.15, edge=0.01, slim=1.1),
    "European": Manner(0.04, "walnut cherry", "ivory white greige", "cream_cloth taupe_cloth blue_cloth cream_leather", "brass bronze", "cabriole turned cabriole", "weave floral velvet leather",
        "marble", "bell pleated crystal", paint=0.6, tube=0.1, stone=0.3, piping=0.5, tufts=0.5, ornament=0.9, soft=0.06, edge=0.012, slim=1.15),
    "European Classic": Manner(0.03, "mahogany walnut rosewood", "ivory gold_leaf", "wine_velvet green_velvet cream_leather plum_cloth", "brass gold", "cabriole cabriole turned",
        "velvet floral leather", "marble green_marble dark_marble", "crystal bell pleated", paint=0.25, tube=0.05, stone=0.4, piping=0.6, tufts=0.8, ornament=1.0, soft=0.065, edge=0.014,
        slim=1.3),
    "Neoclassical": Manner(0.03, "mahogany walnut", "ivory white greige", "cream_cloth grey_velvet blue_cloth", "brass gold", "fluted fluted tapered", "velvet weave stripe", "marble dark_marble",
        "bell crystal pleated", paint=0.65, tube=0.1, stone=0.4, piping=0.5, tufts=0.4, ornament=0.8, soft=0.05, edge=0.01, slim=1.1),
    "Chinoiserie": Manner(0.03, "rosewood ebony", "lacquer_red black jade", "jade_cloth wine_velvet cream_cloth", "brass gold", "ming horse cabriole", "floral velvet weave", "dark_marble",
        "lantern drum paper", paint=0.55, tube=0.05, stone=0.15, piping=0.3, ornament=0.7, soft=0.035, edge=0.005),
    "Ming Qing": Manner(0.02, "rosewood huanghuali ebony", "", "wine_velvet linen jade_cloth", "brass bronze", "ming horse ming", "weave velvet floral", "marble", "lantern paper", paint=0.0,
        tube=0.0, stone=0.1, ornament=0.7, soft=0.02, edge=0.006, slim=0.95),
    "Southeast Asia": Manner(0.02, "teak bamboo rattan", "", "linen jade_cloth ochre_cloth cream_cloth", "bronze", "bamboo square bamboo", "weave floral", "travertine", "rattan rattan paper",
        paint=0.0, tube=0.0, stone=0.05, cane=0.8, soft=0.05, edge=0.008, slim=1.1),
    "Korean": Manner(0.02, "birch ash whitewashed", "white blush ivory", "pink_cloth snow_cloth cream_cloth lilac_cloth", "white_metal brass", "tapered cabriole turned", "weave floral check",
        "marble", "pleated drum bell", paint=0.8, tube=0.15, stone=0.1, piping=0.35, ornament=0.45, soft=0.055, edge=0.01, slim=0.95),
    "Kids": Manner(0.02, "birch beech", "white mint blush sky lemon coral", "blue_cloth ochre_cloth pink_cloth mint_cloth coral_cloth", "white_metal", "dowel splayed block",
        "weave check stripe knit", "terrazzo", "dome globe cone", paint=0.85, tube=0.05, stone=0.0, piping=0.3, soft=0.07, edge=0.014, slim=1.15),
    "Others": Manner(0.02, "oak walnut birch", "white light_grey anthracite", "linen grey_cloth taupe_cloth", "black_metal steel", "square tapered plank", "weave", "marble", "drum dome",
        paint=0.4, tube=0.3),
}  # fmt: skip

ORIENTAL = ("New Chinese", "Chinoiserie", "Ming Qing")
CLASSIC = ("European", "European Classic", "Neoclassical", "American Country")
PLAIN = ("Modern", "Nordic", "Minimalist", "Japanese", "Others", "Korean")

GROUPS: Mapping[str, tuple[str, ...]] = {"oriental": ORIENTAL, "classic": CLASSIC}


def suited(styles: Sequence[str]) -> tuple[str, ...]:
    """Return the styles that a form comes in, with the words for several spelt out; all where its card names none."""
    return tuple(s for name in styles for s in GROUPS.get(name, (name,))) or tuple(MANNERS)
