"""Convex colliders, mass and inertia of a link from its meshes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.asset import Link, Mesh
from pipeline.sources.densities import MINIMUM
from pipeline.sources.settings import ModelLimits
from pipeline.sources.solids import Part, mass_properties, parts

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Decompose = Callable[[Floats, Ints], list[tuple[Floats, Ints]]]


@dataclass(frozen=True, slots=True)
class Body:
    """What makes a link: visual meshes, and the meshes (vertices (V, 3) [m], faces (F, 3)) that it collides by."""

    name: str
    visuals: tuple[Mesh, ...]
    collisions: tuple[tuple[Floats, Ints], ...]


def link(body: Body, density: float, limits: ModelLimits, decompose: Decompose | None) -> tuple[Link, list[tuple[str, str]]]:
    """Return the link and (reason, detail) of what was simplified.

    A connected part that fills `convex_fill` of its hull is a convex piece. Any other is cut by `decompose`, or, where
    that is None, stands as its hull.
    """
    notes: list[tuple[str, str]] = []
    solids: list[Part] = []
    pieces: list[Part] = []
    hollow = 0
    for vertices, faces in body.collisions:
        found = parts(vertices, faces)
        solids += found
        odd = sum(p.fill < limits.convex_fill for p in found)
        if odd and decompose is not None:
            pieces += [p for cut in decompose(vertices, faces) for p in parts(*cut)]
            continue
        hollow += odd
        pieces += found
    if hollow:
        notes.append(("hull_collider", f"{body.name}: {hollow} of {len(solids)} parts"))
    if len(pieces) > limits.max_pieces:
        notes.append(("colliders_capped", f"{body.name}: {len(pieces)} pieces, the largest {limits.max_pieces} kept"))
        pieces = sorted(pieces, key=lambda p: -p.hull_volume)[: limits.max_pieces]
    colliders = tuple(_piece(k, p) for k, p in enumerate(pieces))
    mass, com, inertia = mass_properties([(p, density) for p in solids])
    if 0 < mass < MINIMUM:
        inertia = inertia * (MINIMUM / mass)
    least = 1e-6 * np.eye(3)  # engines refuse inertias of thin parts that round to zero
    rounded = np.round(inertia, 9) + least
    return Link(body.name, body.visuals, colliders, round(max(mass, MINIMUM), 5), np.round(com, 6), rounded), notes


def _piece(number: int, part: Part) -> Mesh:
    return Mesh(f"piece_{number:03d}", part.hull.astype(np.float32), part.faces.astype(np.int32))
