"""Plants and waste bins."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.finishes import CERAMIC, LEAF, SOIL, Finish, Scheme, shade
from pipeline.corpus.furniture.shape import Piece, Shape, pieces
from pipeline.corpus.furniture.solids import Solid, hull, revolve, ring, rod, slab
from pipeline.corpus.furniture.solids import circle as circle_outline
from pipeline.corpus.furniture.storage import Size


def leaf(root: NDArray[np.float64], tip: NDArray[np.float64], width: float, sag: float) -> Solid:
    """Return a leaf as a thin convex blade from `root` to `tip` [m], its middle `width` wide and lowered by `sag`."""
    axis = tip - root
    side = np.cross(axis, (0.0, 0.0, 1.0))
    side = side / np.linalg.norm(side) if np.linalg.norm(side) > 1e-6 else np.array([1.0, 0, 0])
    up = np.cross(side, axis / np.linalg.norm(axis))
    middle = root + 0.45 * axis + up * sag
    belt = [middle + side * width / 2, middle + up * 0.004, middle - side * width / 2, middle - up * 0.004]
    return hull(np.array([root, tip, *belt]))


def plant(rng: np.random.Generator, form: str, size: Size, scheme: Scheme) -> Shape:
    """Build a pot with a bush, a palm, or upright leaves."""
    w, d, h = size
    pot_r, pot_h = min(0.34 * w, 0.2), min(0.32 * h, 0.36)
    pot = ring((0.75 * pot_r, pot_r), (0.75 * pot_r - 0.012, pot_r - 0.012), (0.012, pot_h), 20)
    clay = Finish("clay", (0.42, 0.17, 0.09), 0.8, density=1800)
    finish = (CERAMIC, clay, scheme.front)[int(rng.integers(3))]
    base: tuple[Piece, ...] = pieces("pot", [*pot, slab(circle_outline(0.75 * pot_r, 20), (0.0, 0.012))], finish)
    base += pieces("soil", revolve([(0.72 * pot_r, 0.012), (0.92 * pot_r - 0.012, 0.9 * pot_h)], 20), SOIL)
    green = Finish("leaf", shade(rng, LEAF.color, 0.25), 0.6, density=300)
    crown, top = 0.9 * pot_h, h
    leaves: list[Solid] = []
    stems: list[Solid] = []
    golden = math.pi * (3 - math.sqrt(5))
    if form == "tall":  # upright sword-like leaves
        for k in range(18):
            a, share = k * golden, (k + 0.5) / 18
            reach = 0.5 * w * share
            root = np.array([0.3 * pot_r * math.cos(a), 0.3 * pot_r * math.sin(a), crown])
            tip = np.array([reach * math.cos(a), reach * math.sin(a), top - (top - crown) * 0.55 * share**1.5])
            leaves.append(leaf(root, tip, 0.055 + 0.02 * (1 - share), -0.05 * share))
    elif form == "palm":
        trunk = crown + 0.45 * (top - crown)
        stems = [rod((0, 0, crown - 0.02), (0.01, 0.0, trunk), 0.02, 0.014, 8)]
        for k in range(22):
            a, share = k * golden, (k + 0.5) / 22
            reach = 0.5 * w * (0.5 + 0.5 * share)
            root = np.array([0.01 + 0.012 * math.cos(a), 0.012 * math.sin(a), trunk - 0.02 + 0.02 * share])
            tip = np.array([reach * math.cos(a), reach * math.sin(a), trunk + (top - trunk) * (1 - 1.3 * share**2)])
            leaves.append(leaf(root, tip, 0.06, 0.10 * share * (top - trunk) + 0.02))
    else:
        count = 56
        for k in range(count):
            share = (k + 0.5) / count
            a, polar = k * golden, math.acos(1 - 1.75 * share)
            middle = crown + 0.55 * (top - crown)
            direction = np.array([math.sin(polar) * math.cos(a), math.sin(polar) * math.sin(a), math.cos(polar)])
            radius = np.array([0.5 * w, 0.5 * d, 0.45 * (top - crown)])
            tip = np.array([0, 0, middle]) + radius * direction * float(rng.uniform(0.9, 1.0))
            root = np.array([0, 0, middle]) + radius * direction * 0.45
            leaves.append(leaf(root, tip, 0.13 * w + 0.03, 0.02))
            if k % 4 == 0:
                stems.append(rod((0, 0, crown - 0.01), tuple(0.8 * root + 0.2 * tip), 0.006, 0.004, 5))
    bark = Finish("bark", (0.12, 0.07, 0.035), 0.9, density=500)
    return Shape(base + pieces("stems", stems, bark) + pieces("leaves", leaves, green))
