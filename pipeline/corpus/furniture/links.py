"""Links of an articulated model as PartNet-Mobility and GAPartNet cut it, in the normalised mesh frame."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus.furniture.finishes import Finish
from pipeline.corpus.furniture.shape import FRONT, Axis3, Mover, Piece, Pieces, Shape
from pipeline.corpus.furniture.wavefront import mesh_frame


@dataclass(frozen=True, slots=True)
class Component:
    """A mesh file: pieces of one finish on one link, or one handle; `number` counts the object's files."""

    number: int
    name: str
    part: str
    pieces: Pieces

    @property
    def file(self) -> str:
        """Path of its OBJ file in the object's folder."""
        return f"textured_objs/original-{self.number}.obj"

    @property
    def collides_as_seen(self) -> bool:
        """Whether its own mesh serves collisions: no piece of it belongs to a group."""
        return not any(piece.group for piece in self.pieces)

    @property
    def collision_file(self) -> str:
        """Path of the OBJ file that it collides by."""
        return self.file if self.collides_as_seen else f"textured_objs/convex-{self.number}.obj"


@dataclass(frozen=True, slots=True)
class LinkRecord:
    """A link of the URDF. `mover` is None for the body and for handles, which are fixed to `parent`.

    `origin` (3,) of its frame in the mesh frame, normalised; `part` the GAPartNet class or "".
    """

    name: str
    parent: str
    mover: Mover | None
    origin: NDArray[np.float64]
    components: tuple[Component, ...]
    part: str
    outward: Axis3


@dataclass(frozen=True, slots=True)
class Frame:
    """The normalisation: mesh = (mesh_frame(point) - centre) * scale."""

    centre: NDArray[np.float64]
    scale: float

    def point(self, p: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
        """Return a point (..., 3) of our object frame in normalised mesh coordinates."""
        return (mesh_frame(np.asarray(p, float)) - self.centre) * self.scale


def link_records(shape: Shape, frame: Frame) -> list[LinkRecord]:
    """Return the links of GAPartNet's cut: movers, then handles, then the body."""
    movers: list[LinkRecord] = []
    handles: list[LinkRecord] = []
    grips = sum(len({p.name for p in mover.pieces if p.part}) for mover in shape.movers)
    body = f"link_{len(shape.movers) + grips}"
    names = {"base": body} | {mover.name: f"link_{k}" for k, mover in enumerate(shape.movers)}
    number = 0
    for mover in shape.movers:
        components = _components(mover.pieces, number)
        number += len(components)
        name, origin = names[mover.name], frame.point(mover.origin)
        own = tuple(c for c in components if not c.part)
        movers.append(LinkRecord(name, names[mover.parent], mover, origin, own, mover.part_class, mover.outward))
        for grip in (c for c in components if c.part):
            handles.append(LinkRecord(f"link_{len(shape.movers) + len(handles)}", name, None, origin, (grip,), grip.part, mover.outward))
    return [*movers, *handles, LinkRecord(body, "base", None, np.zeros(3), _components(shape.base, number), "", FRONT)]


def _components(parts: Pieces, first: int) -> tuple[Component, ...]:
    """Group pieces into mesh files: each handle by itself, the rest by what it is made of."""
    finishes: dict[str, Finish] = {}
    for piece in parts:  # what collides as one lies in one file, named by the finish that it shows most of
        finishes.setdefault(piece.group, piece.finish)
    groups: dict[tuple[str, Finish | str], list[Piece]] = {}
    for piece in parts:
        key = piece.name if piece.part else finishes[piece.group] if piece.group else piece.finish
        groups.setdefault((piece.part, key), []).append(piece)
    return tuple(Component(first + k, members[0].name, part, tuple(members)) for k, ((part, _), members) in enumerate(groups.items()))


def without_handles(links: Sequence[LinkRecord]) -> list[LinkRecord]:
    """Return the links of PartNet-Mobility's own cut: handles belong to their doors and drawers. Numbers close up."""
    extra: dict[str, tuple[Component, ...]] = {}
    for link in links:
        if link.mover is None and link.part:
            extra[link.parent] = extra.get(link.parent, ()) + link.components
    kept = [link for link in links if link.mover is not None or not link.part]
    old, body = links[-1].name, f"link_{len(kept) - 1}"
    return [
        replace(
            link,
            name=body if link.name == old else link.name,
            parent=body if link.parent == old else link.parent,
            components=link.components + extra.get(link.name, ()),
        )
        for link in kept
    ]
