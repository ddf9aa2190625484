"""Convex colliders, mass and inertia of a link from its meshes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.asset import Link, Mesh
from pipeline.sources.densities import BOARD, BOXES, HOLLOW, MINIMUM
from pipeline.sources.inertials import Inertial
from pipeline.sources.merging import merged
from pipeline.sources.settings import ModelLimits
from pipeline.sources.solids import Part, dissected, mass_properties, parts

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Decompose = Callable[[Floats, Ints], list[tuple[Floats, Ints]] | None]
WORTH = 1e-3  # share of the largest hull below which cutting a part into pieces changes nothing that a robot feels


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

    A connected part that fills `convex_fill` of its hull is a convex piece. Any other is cut by `decompose`, or, where
    that is None or fails, stands as its hull. Neighbouring pieces are merged where that fills next to nothing. Beyond
    `max_pieces` the smallest are left out.
    """
    notes: list[tuple[str, str]] = []
    found = [entry for vertices, faces in meshes for entry in dissected(vertices, faces)]
    largest = max((part.hull_volume for part, _, _ in found), default=0.0)
    pieces: list[Part] = []
    hollow = 0
    for part, points, triangles in found:
        if part.fill >= limits.convex_fill:
            pieces.append(part)
            continue
        cut = decompose(points, triangles) if decompose is not None and part.hull_volume >= WORTH * largest else None
        if cut is None:
            hollow += 1
            pieces.append(part)
        else:
            pieces += [p for piece in cut for p in parts(*piece)]
    if hollow:
        notes.append(("hull_collider", f"{name}: {hollow} of {len(found)} parts"))
    pieces = list(merged(pieces))
    if len(pieces) > limits.max_pieces:
        notes.append(("colliders_capped", f"{name}: {len(pieces)} pieces, the largest {limits.max_pieces} kept"))
        pieces = sorted(pieces, key=lambda p: -p.hull_volume)[: limits.max_pieces]
    return Solids(tuple(part for part, _, _ in found), tuple(pieces), tuple(notes))


def link(name: str, visuals: Iterable[Mesh], matter: Solids, density: float, kind: str = "", stated: Inertial | None = None) -> Link:
    """Return the link [m, kg] of visual meshes and solids; `kind` is the super-category.

    It weighs what is `stated`, else what its matter does at one `density` [kg/m3].
    """
    if stated is not None:
        mass, com, inertia = stated.mass, stated.centre, stated.inertia
    else:
        mass, com, inertia = mass_properties([(_hollowed(p, kind), density) for p in matter.parts])
    if 0 < mass < MINIMUM:
        inertia = inertia * (MINIMUM / mass)
    least = 1e-6 * np.eye(3)  # engines refuse inertias of thin parts that round to zero
    colliders = tuple(_piece(k, p) for k, p in enumerate(matter.pieces))
    return Link(name, tuple(visuals), colliders, round(max(mass, MINIMUM), 5), np.round(com, 6), np.round(inertia, 9) + least)


def matter_volume(matter: Solids, kind: str) -> float:
    """Return the volume of matter [m3] of a link of that super-category."""
    return float(sum(_hollowed(p, kind).volume for p in matter.parts))


def _hollowed(part: Part, kind: str) -> Part:
    """Return the part as it weighs: of case furniture a block too thick for a board is a box of boards."""
    if kind not in BOXES or np.ptp(part.hull, axis=0).min() <= HOLLOW:
        return part
    return replace(part, volume=min(part.volume, part.area * BOARD))


def _piece(number: int, part: Part) -> Mesh:
    return Mesh(f"piece_{number:03d}", part.hull.astype(np.float32), part.faces.astype(np.int32))
