"""What furniture weighs [kg]: the range of each category, to which an estimate by volume and density is held.

An estimate is no better than the mesh: one that is a shell weighs too little, one whose hollows are filled too much. The
ranges on the cards are wide: an empty cabinet, a plant with its pot.
"""

from dataclasses import replace

from pipeline.card import cards
from pipeline.entities.asset import Asset


def mass(asset: Asset) -> float:
    """Return what all links weigh together [kg]."""
    return float(sum(link.mass for link in asset.links))


def factor(category: str, kilograms: float) -> float:
    """Return by what an estimate is to be multiplied to lie in its category's range: 1 within it, or where none is known."""
    low, high = cards()[category].mass if category in cards() else (kilograms, kilograms)
    return min(max(kilograms, low), high) / kilograms


def clamp_mass(asset: Asset) -> tuple[Asset, float]:
    """Return the asset with its mass in the range of its category, and the factor on all masses and inertias."""
    by = factor(asset.category, mass(asset))
    if by == 1.0:
        return asset, by
    links = tuple(replace(link, mass=round(link.mass * by, 5), inertia=link.inertia * by) for link in asset.links)
    return replace(asset, links=links), by
