"""Densities [kg/m3] by which masses are estimated: of the material that a model names, else typical of its kind."""

from pipeline import taxonomy
from pipeline.card import cards

MATERIALS = {name.lower(): density for name, density in taxonomy.load().densities.items() if density is not None}
KINDS: dict[str, float] = {
    "bed": 110.0,
    "sofa": 90.0,
    "chair": 400.0,
    "stool": 250.0,
    "table": 600.0,
    "cabinet": 600.0,
    "kitchen": 600.0,
    "appliance": 450.0,
    "bath": 900.0,
    "lighting": 500.0,
    "textile": 120.0,
    "other": 300.0,
}
DEFAULT = 500.0
UPHOLSTERED = 220.0  # least of chairs and stools: what is soft has a frame in it
SOFT = frozenset({"bed", "sofa"})  # mostly filling, whatever the frame's material
MINIMUM = 0.002  # [kg] of a link: a key of a keyboard
SEATS = frozenset({"chair", "stool"})
BOXES = frozenset({"cabinet", "kitchen", "table"})  # kinds whose blocks are hollow: modelled as one solid, built of boards
HOLLOW = 0.12  # [m] thickness above which a block of those is no board
BOARD = 0.018  # [m] thickness of the boards of such a block


def density(super_category: str, material: str, category: str = "") -> float:
    """Return the density for a model of our category and super-category whose source names `material` ("" when it does not)."""
    own = cards()[category].density if category in cards() else None
    if own is not None:
        return own
    if super_category in SOFT:
        return min(MATERIALS.get(material.lower(), 1e9), KINDS[super_category])
    material_density = MATERIALS.get(material.lower(), KINDS.get(super_category, DEFAULT))
    return max(material_density, UPHOLSTERED) if super_category in SEATS else material_density
