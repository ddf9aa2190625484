"""What an articulated shape tells of its category beside its proportions: its doors and drawers, and how large they would be."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from pipeline.arrays import Floats
from pipeline.card import cards
from pipeline.entities.asset import PartBox
from pipeline.sources.articulated.shape import ArticulatedShape
from pipeline.sources.meshes.mesh_solids import Part

CLEAR = 0.9  # opacity below which a door is glazed
LEAF = 0.05  # share of the front from which on what slides along it is a door
FLAT = 5.0  # a piece this much wider than thick, both ways, is a board
# Sizes that furniture has whatever its category, our estimates: median [m] and standard deviation of the logarithm.
KNOWN: Mapping[str, tuple[float, float]] = {
    "leaf_width": (0.42, 0.35),  # of a hinged door
    "drawer_height": (0.19, 0.45),  # of a drawer's front
    "handle_length": (0.15, 0.50),  # of a bar handle
    "board": (0.018, 0.30),  # thickness of the carcass's boards
}


@dataclass(frozen=True, slots=True)
class Signs:
    """Of a shape in its own units: `sizes` of things whose real size is known, counts, and shares."""

    sizes: Mapping[str, tuple[float, ...]]
    doors: int
    drawers: int
    glass: bool
    covered: float
    grip: float | None


def signs(shape: ArticulatedShape, base: Sequence[Part]) -> Signs:
    """Return the signs of a shape; `base` are the convex pieces of its body."""
    doors = [p for p in shape.parts if p.part_class == "hinge_door"]
    drawers = [p for p in shape.parts if p.part_class == "slider_drawer"]
    whole = max(float(shape.extent[0] * shape.extent[2]), 1e-12)
    # What slides along the front is a door that has no class of its own; areas as seen from the front.
    moved = [np.ptp(shape.bodies[j.child].points(), axis=0) for j in shape.joints if j.type == "prismatic" and abs(j.axis[0]) > 0.8]
    sliding = [area for e in moved if (area := float(e[0] * e[2])) > LEAF * whole]
    front = (sum(_reach(p)[0] * _reach(p)[2] for p in doors + drawers) + sum(sliding)) / whole
    extents = [np.sort(np.ptp(p.hull, axis=0)) for p in base]
    sizes = {
        "leaf_width": tuple(float(p.size[1]) for p in doors),
        "drawer_height": tuple(float(_reach(p)[2]) for p in drawers),
        "handle_length": tuple(float(p.size.max()) for p in shape.parts if p.part_class == "line_fixed_handle"),
        "board": tuple(float(e[0]) for e in extents if e[1] > FLAT * e[0]),
    }
    leaves = {p.link for p in doors}
    clear = any(shape.palette.materials[m.material].opacity < CLEAR for k in leaves for m in shape.bodies[k].visuals)
    return Signs(sizes, len(doors) + len(sliding), len(drawers), clear, min(front, 1.0), _grip(shape.parts, doors))


def log_likelihood(observed: Signs, category: str, scale: float) -> float:
    """Return how well the signs suit a category at `scale` [m per unit], up to a constant that all categories share."""
    entry = cards()[category].signs
    total = 0.0
    for name, (median, spread) in KNOWN.items():
        values = [v for v in observed.sizes[name] if v > 0]
        if values:
            total -= 0.5 * ((math.log(float(np.median(values)) * scale) - math.log(median)) / spread) ** 2
    total += math.log(entry.doors if observed.doors else 1 - entry.doors)
    total += math.log(entry.drawers if observed.drawers else 1 - entry.drawers)
    total += _normal(observed.covered, *entry.covered)
    if observed.doors:
        total += math.log(entry.glass if observed.glass else 1 - entry.glass)
    if observed.grip is not None:
        total += _normal(observed.grip, *entry.grip)
    return total


def _normal(value: float, mean: float, spread: float) -> float:
    return -0.5 * ((value - mean) / spread) ** 2 - math.log(spread)


def _reach(part: PartBox) -> Floats:
    """Return the extent (3,) of a part's box along our axes."""
    return np.asarray(part.size @ np.abs(part.axes))


def _grip(parts: Sequence[PartBox], doors: Sequence[PartBox]) -> float | None:
    """Return the mean height of handles on upright doors, in shares of the door's height from its middle."""
    heights = []
    for door in doors:
        height = float(_reach(door)[2])
        if abs(float(door.axes[0, 2])) < 0.8 or height <= 0:
            continue
        heights += [(p.centre[2] - door.centre[2]) / height for p in parts if p.link == door.link and p.part_class.endswith("fixed_handle")]
    return float(np.clip(np.mean(heights), -0.5, 0.5)) if heights else None
