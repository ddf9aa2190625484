"""Assembly: a catalogue model becomes a shape of its exact size, and the shape an asset with masses and colliders."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from pipeline import seeds
from pipeline.corpus.furniture import finishes
from pipeline.corpus.furniture.builders import BUILDERS
from pipeline.corpus.furniture.catalogue import Model
from pipeline.corpus.furniture.finishes import Finish, Scheme
from pipeline.corpus.furniture.shape import Mover, Piece, Shape, colliders, fitted, frozen
from pipeline.corpus.furniture.solids import Solid
from pipeline.entities.asset import Asset, Joint, Link, Material, Mesh

LICENCE = "CC0-1.0"


def scheme_of(model: Model) -> Scheme:
    """Return the finishes of a model."""
    return finishes.scheme(seeds.generator(model.seed, "corpus.furniture.finish"), model.style)


def main_material(model: Model) -> str:
    """Return 3D-FUTURE's word for the main material."""
    from pipeline.corpus.furniture.builders import MATERIALS

    word = MATERIALS.get(model.category, "")
    scheme = scheme_of(model)
    if word == "soft":
        return "Leather" if scheme.soft.name.removesuffix("_2") in finishes.LEATHERS else "Cloth"
    return word or scheme.material


@functools.lru_cache(maxsize=16)
def shape_of(model: Model) -> Shape:
    """Return the shape of a model, its box exactly `model.size`; static models have their movers fixed."""
    rng = seeds.generator(model.seed, "corpus.furniture.shape")
    shape = fitted(BUILDERS[model.category](rng, model.form, model.size, scheme_of(model)), model.size)
    return shape if model.articulated else frozen(shape)


def build(model: Model) -> Asset:
    """Make the asset of a model in the object frame."""
    shape = shape_of(model)
    palette = list(dict.fromkeys(piece.finish for piece in shape.pieces()))
    index = {"base": 0} | {mover.name: i + 1 for i, mover in enumerate(shape.movers)}
    links = [_link("base", shape.base, palette)] + [_link(m.name, m.pieces, palette) for m in shape.movers]
    return Asset(
        asset_id=f"embedded_{model.model_id.replace('-', '_')}",
        category=model.category,
        size=np.array(model.size, float),
        links=tuple(links),
        joints=tuple(_joint(mover, index) for mover in shape.movers),
        materials=tuple(Material(f.name, f.color, f.roughness, f.metallic, f.opacity) for f in palette),
        source="embedded",
        source_id=model.model_id,
        licence=LICENCE,
        style=model.style,
        super_category=model.super_category,
    )


def _joint(mover: Mover, index: dict[str, int]) -> Joint:
    return Joint(
        name=_joint_name(mover.name),
        type=mover.type,
        parent=index[mover.parent],
        child=index[mover.name],
        axis=np.array(mover.axis, float),
        origin=np.array(mover.origin, float),
        lower=mover.lower,
        upper=mover.upper,
        part_class=mover.part_class,
        after=tuple(_joint_name(name) for name in mover.after),
    )


def _joint_name(mover: str) -> str:
    return f"{mover}_joint"


def _link(name: str, parts: tuple[Piece, ...], palette: list[Finish]) -> Link:
    meshes = tuple(_mesh(piece, palette) for piece in parts)
    mass, com, inertia = mass_properties(parts)
    hulls = tuple(_collider(k, solid) for k, solid in enumerate(colliders(p for p in parts if p.group)))
    return Link(name, meshes, tuple(m for m, p in zip(meshes, parts, strict=True) if not p.group) + hulls, mass, com, inertia)


def _collider(number: int, solid: Solid) -> Mesh:
    return Mesh(f"collider_{number}", solid.vertices.astype(np.float32), solid.triangles())


def _mesh(piece: Piece, palette: list[Finish]) -> Mesh:
    return Mesh(piece.name, piece.solid.vertices.astype(np.float32), piece.solid.triangles(), palette.index(piece.finish), None, piece.part)


def mass_properties(parts: tuple[Piece, ...]) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
    """Return mass [kg], centre (3,) [m] and inertia (3, 3) [kg m2] about it, by summing signed tetrahedra of all pieces."""
    mass, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for piece in parts:
        a, b, c = (piece.solid.vertices[piece.solid.triangles()[:, k]] for k in range(3))
        volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6 * piece.finish.density
        total = a + b + c
        mass += float(volumes.sum())
        first += volumes @ total / 4
        # Second moments of a tetrahedron with one corner at the origin: V/20 (sum of x x^T over corners + (sum x)(sum x)^T).
        for corner in (a, b, c, total):
            second += np.einsum("i,ij,ik->jk", volumes / 20, corner, corner)
    com = first / mass
    central = second - mass * np.outer(com, com)
    return mass, com, np.trace(central) * np.eye(3) - central
