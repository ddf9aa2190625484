"""Convex colliders, mass and inertia of a link from its meshes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
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
class Solids:
    """What a link weighs and collides by: all connected parts, the convex pieces, (reason, detail) of simplifications."""

    parts: tuple[Part, ...]
    pieces: tuple[Part, ...]
    notes: tuple[tuple[str, str], ...] = ()

    def scaled(self, shift: Floats, factor: float) -> Solids:
        """Return the same moved by -`shift` (3,), then scaled by `factor`."""
        return Solids(tuple(p.scaled(shift, factor) for p in self.parts), tuple(p.scaled(shift, factor) for p in self.pieces), self.notes)


def solids(name: str, meshes: Iterable[tuple[Floats, Ints]], limits: ModelLimits, decompose: Decompose | None) -> Solids:
    """Take meshes (vertices (V, 3), faces (F, 3)) apart.

    A connected part that fills `convex_fill` of its hull is a convex piece. A mesh with any other is cut by
    `decompose`, or, where that is None, each part stands as its hull. Beyond `max_pieces` the smallest are left out.
    """
    notes: list[tuple[str, str]] = []
    every: list[Part] = []
    pieces: list[Part] = []
    hollow = 0
    for vertices, faces in meshes:
        found = parts(vertices, faces)
        every += found
        odd = sum(p.fill < limits.convex_fill for p in found)
        if odd and decompose is not None:
            pieces += [p for cut in decompose(vertices, faces) for p in parts(*cut)]
            continue
        hollow += odd
        pieces += found
    if hollow:
        notes.append(("hull_collider", f"{name}: {hollow} of {len(every)} parts"))
    if len(pieces) > limits.max_pieces:
        notes.append(("colliders_capped", f"{name}: {len(pieces)} pieces, the largest {limits.max_pieces} kept"))
        pieces = sorted(pieces, key=lambda p: -p.hull_volume)[: limits.max_pieces]
    return Solids(tuple(every), tuple(pieces), tuple(notes))


def link(name: str, visuals: Iterable[Mesh], matter: Solids, density: float) -> Link:
    """Return the link [m, kg] of visual meshes and solids of one `density` [kg/m3]."""
    mass, com, inertia = mass_properties([(p, density) for p in matter.parts])
    if 0 < mass < MINIMUM:
        inertia = inertia * (MINIMUM / mass)
    least = 1e-6 * np.eye(3)  # engines refuse inertias of thin parts that round to zero
    colliders = tuple(_piece(k, p) for k, p in enumerate(matter.pieces))
    return Link(name, tuple(visuals), colliders, round(max(mass, MINIMUM), 5), np.round(com, 6), np.round(inertia, 9) + least)


def _piece(number: int, part: Part) -> Mesh:
    return Mesh(f"piece_{number:03d}", part.hull.astype(np.float32), part.faces.astype(np.int32))
