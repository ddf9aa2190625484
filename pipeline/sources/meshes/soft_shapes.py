"""Soft things as they lie, and cushions with level tops: what lies on a swell rolls, where a real one gives way."""

import numpy as np

from pipeline.arrays import Floats
from pipeline.sources.meshes.mesh_solids import MAX_HULL, Part, convex_part, extremes

CORNERS = 8  # of the outline on which a soft thing lies, and of a level top, at most
SOLE = 0.8  # share of its outline that a soft thing lies on
RISE = 0.12  # share of its height below which it has no other corners: PhysX tilts what all but lies on a rounded edge


def level_top(part: Part, lift: float) -> Part:
    """Return a cushion with a level top: what lies on a swell rolls, where a real one gives way."""
    top = float(part.hull[:, 2].max())
    upper = _outline(part.hull[part.hull[:, 2] > top - lift])
    level = np.column_stack([upper[:, :2], np.full(len(upper), top)])  # all of its corners stay, however many the sides have
    return convex_part(np.concatenate([extremes(part.hull, MAX_HULL - len(level)), level]), part.volume) or part


def _outline(points: Floats) -> Floats:
    """Return those of points (N, 3) that are farthest out, seen from above, at most CORNERS."""
    turns = 2 * np.pi * np.arange(CORNERS) / CORNERS
    return np.asarray(points[np.unique(np.argmax(points[:, :2] @ [np.cos(turns), np.sin(turns)], axis=0))])


def lie_flat(part: Part) -> Part:
    """Return a soft thing as it lies: its outline, drawn in a little, on what bears it."""
    around = _outline(part.hull)
    middle = (part.hull.min(axis=0) + part.hull.max(axis=0)) / 2
    low, high = part.hull[:, 2].min(), part.hull[:, 2].max()
    sole = np.column_stack([middle[:2] + SOLE * (around[:, :2] - middle[:2]), np.full(len(around), low)])
    above = part.hull[part.hull[:, 2] > low + RISE * (high - low)]
    return convex_part(np.concatenate([extremes(above, MAX_HULL - len(sole)), sole]), part.volume) or part
