"""Convex colliders, mass and inertia of a link from its meshes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pipeline.arrays import Floats, Ints
from pipeline.entities.asset import Link, Mesh
from pipeline.sources.densities import BOARD, BOXES, HOLLOW, MINIMUM
from pipeline.sources.meshes.cutting import cut
from pipeline.sources.meshes.inertials import Inertial
from pipeline.sources.meshes.merging import merge_pieces
from pipeline.sources.meshes.mesh_solids import Part, convex_part, mass_properties, parts_with_meshes
from pipeline.sources.meshes.near_boxes import simplify_to_box, with_few_sides
from pipeline.sources.meshes.recesses import stand_midway
from pipeline.sources.meshes.touching import TOUCHED, TouchTolerances, simplify_pieces
from pipeline.sources.settings import ModelLimits

Dissected = tuple[Part, Floats, Ints]
# The work that an object may cost, in counts: the same object gives the same colliders however busy the machine is.
WORTH = 1e-3  # share of the largest hull below which cutting a part into pieces changes nothing that a robot feels
PIECES = 24  # of one part
CUTS = 120  # pieces of all parts of an object that are cut
LOOKS = 80  # parts of an object that are looked at for pockets
POCKET = 0.01  # share of an object's diagonal: the depth of a pocket that may be filled


@dataclass(frozen=True, slots=True)
class Solids:
    """What a link weighs and collides by: all connected parts, the convex pieces, (reason, detail) of simplifications."""

    parts: tuple[Part, ...]
    pieces: tuple[Part, ...]
    notes: tuple[tuple[str, str], ...] = ()

    def scaled(self, shift: Floats, factor: float) -> Solids:
        """Return the same moved by -`shift` (3,), then scaled by `factor`."""
        return Solids(tuple(p.scaled(shift, factor) for p in self.parts), tuple(p.scaled(shift, factor) for p in self.pieces), self.notes)


def solids(name: str, meshes: Iterable[tuple[Floats, Ints]], limits: ModelLimits, tolerance: float | None) -> Solids:
    """Take the meshes (vertices (V, 3), faces (F, 3)) of one link apart; see `bodies_solids`."""
    return bodies_solids([(name, meshes)], limits, tolerance)[0]


def bodies_solids(
    bodies: Iterable[tuple[str, Iterable[tuple[Floats, Ints]]]], limits: ModelLimits, tolerance: float | None
) -> list[Solids]:
    """Take (name, meshes) of each link of an object apart.

    A connected part that fills `convex_fill` of its hull is a convex piece. Any other is one as well where its hull holds
    no pocket deeper than `tolerance` [the meshes' unit], and is cut otherwise, the largest first, as long as the object has
    CUTS pieces left; what comes after stands as its hull, and so do all of them where `tolerance` is None. Neighbouring
    pieces are merged where that fills next to nothing. Beyond `max_pieces` of a link the smallest are left out.
    """
    by_body = [(name, [entry for vertices, faces in meshes for entry in parts_with_meshes(vertices, faces)]) for name, meshes in bodies]
    cuts = {} if tolerance is None else _cuts([parts for _, parts in by_body], limits, tolerance)
    return [
        _solids(name, parts, {k: c for (owner, k), c in cuts.items() if owner == body}, limits)
        for body, (name, parts) in enumerate(by_body)
    ]


def _cuts(bodies: Sequence[Sequence[Dissected]], limits: ModelLimits, tolerance: float) -> dict[tuple[int, int], list[Part]]:
    """Return the convex pieces of the parts (body, part) that were looked at: the largest that are not convex."""
    hollow = []
    for body, parts in enumerate(bodies):
        largest = max((part.hull_volume for part, _, _ in parts), default=0.0)
        hollow += [
            (-round(part.hull_volume, 12), body, k)
            for k, (part, _, _) in enumerate(parts)
            if part.fill < limits.convex_fill and part.hull_volume >= WORTH * largest
        ]
    cuts: dict[tuple[int, int], list[Part]] = {}
    left = CUTS
    for _, body, k in sorted(hollow)[:LOOKS]:
        part, points, triangles = bodies[body][k]
        if np.ptp(points, axis=0).max() < 2 * tolerance:
            cuts[body, k] = [part]
            continue
        pieces = cut(points, triangles, tolerance, min(PIECES, left)).pieces
        cuts[body, k] = [part] if len(pieces) == 1 else [p for piece in pieces if (p := convex_part(piece, part.volume / len(pieces)))]
        left = max(left - len(pieces), 1)
    return cuts


def _solids(name: str, dissection: Sequence[Dissected], cuts: Mapping[int, list[Part]], limits: ModelLimits) -> Solids:
    notes: list[tuple[str, str]] = []
    pieces = [p for k, (part, _, _) in enumerate(dissection) for p in cuts.get(k, [part])]
    hulls = sum(part.fill < limits.convex_fill and k not in cuts for k, (part, _, _) in enumerate(dissection))
    if hulls:
        notes.append(("hull_collider", f"{name}: {hulls} of {len(dissection)} parts"))
    pieces = list(merge_pieces(pieces))
    if len(pieces) > limits.max_pieces:
        notes.append(("colliders_capped", f"{name}: {len(pieces)} pieces, the largest {limits.max_pieces} kept"))
        pieces = sorted(pieces, key=lambda p: -p.hull_volume)[: limits.max_pieces]
    return Solids(tuple(part for part, _, _ in dissection), tuple(pieces), tuple(notes))


def build_link(
    name: str,
    visuals: Iterable[Mesh],
    matter: Solids,
    density: float,
    kind: str = "",
    stated: Inertial | float | None = None,
    how: TouchTolerances | None = None,
) -> Link:
    """Return the link [m, kg] of visual meshes and solids; `kind` is the super-category, `how` truly it is felt.

    It weighs what is `stated`, a mass alone or with its inertia, else what its matter does at one `density` [kg/m3].
    """
    if isinstance(stated, Inertial):
        mass, com, inertia = stated.mass, stated.centre, stated.inertia
    else:
        mass, com, inertia = mass_properties([(_hollow_out(p, kind), density) for p in matter.parts])
        if stated is not None and mass > 0:
            mass, inertia = stated, inertia * (stated / mass)
    if 0 < mass < MINIMUM:
        inertia = inertia * (MINIMUM / mass)
    least = 1e-6 * np.eye(3)  # engines refuse inertias of thin parts that round to zero
    how, visuals = how or TouchTolerances(), tuple(visuals)
    pieces = simplify_pieces(matter.pieces, how)
    floor = min((float(p.hull[:, 2].min()) for p in pieces), default=0.0)
    boxes = [simplify_to_box(p.hull, p.faces, how.box, floor) for p in pieces]
    if how.sides <= TOUCHED:
        seen = [m.vertices[m.faces].astype(np.float64) for m in visuals if not m.part]
        boxes = [(stand_midway(hull, np.concatenate(seen)), faces) for hull, faces in boxes] if seen else boxes
    hulls = enumerate(with_few_sides(*box, how.sides) for box in boxes)
    colliders = tuple(Mesh(f"piece_{k:03d}", hull.astype(np.float32), faces.astype(np.int32)) for k, (hull, faces) in hulls)
    return Link(name, visuals, colliders, round(max(mass, MINIMUM), 5), np.round(com, 6), np.round(inertia, 9) + least)


def matter_volume(matter: Solids, kind: str) -> float:
    """Return the volume of matter [m3] of a link of that super-category."""
    return float(sum(_hollow_out(p, kind).volume for p in matter.parts))


def _hollow_out(part: Part, kind: str) -> Part:
    """Return the part as it weighs: of case furniture a block too thick for a board is a box of boards."""
    if kind not in BOXES or np.ptp(part.hull, axis=0).min() <= HOLLOW:
        return part
    return replace(part, volume=min(part.volume, part.area * BOARD))
