"""Articulated models as PartNet-Mobility folders with GAPartNet's annotation.

Meshes lie in the mesh frame (x right, y up, z front), centred and scaled to about the unit sphere, without metric size;
the base joint turns that into PartNet's world (z up, front -x): world = (-z, -x, y).
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
from numpy.typing import NDArray

from pipeline import seeds
from pipeline.corpus.furniture import texture, wavefront
from pipeline.corpus.furniture.assembly import shape_of
from pipeline.corpus.furniture.catalogue import Model
from pipeline.corpus.furniture.finishes import Finish
from pipeline.corpus.furniture.shape import FRONT, Axis3, Mover, Piece, Pieces, Shape, colliders
from pipeline.corpus.furniture.texture import Atlas
from pipeline.corpus.furniture.wavefront import mesh_frame

TEXTURE = "images/texture_0.png"  # in an object's folder
BASE_RPY = "1.570796326794897 0 -1.570796326794897"
WORLD = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # mesh frame to PartNet's world
# Corners of a part's box in its own axes, in GAPartNet's order.
CORNERS = np.array([(-1, 1, 1), (1, 1, 1), (1, -1, 1), (-1, -1, 1), (-1, 1, -1), (1, 1, -1), (1, -1, -1), (-1, -1, -1)], float) / 2
FURNITURE = frozenset({"StorageFurniture", "Table"})  # PartNet's word for their doors is "rotation_door"
JOINT_WORDS = {"revolute": "hinge", "prismatic": "slider"}


@dataclass(frozen=True, slots=True)
class Component:
    """A mesh file: pieces of one finish on one link, or one handle; `number` counts the object's files."""

    number: int
    name: str
    part: str
    pieces: Pieces

    @property
    def files(self) -> tuple[str, str]:
        """OBJ files in the object's folder: what is seen and what collides, the same where no piece of it belongs to a group."""
        kind = "convex" if any(piece.group for piece in self.pieces) else "original"
        return f"textured_objs/original-{self.number}.obj", f"textured_objs/{kind}-{self.number}.obj"


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
    body = {links[-1].name: f"link_{len(kept) - 1}"}
    names = [(body.get(link.name, link.name), body.get(link.parent, link.parent)) for link in kept]
    own = [link.components + extra.get(link.name, ()) for link in kept]
    return [replace(link, name=n, parent=p, components=c) for link, (n, p), c in zip(kept, names, own, strict=True)]


def write_partnet(models: Sequence[Model], folder: Path) -> None:
    """Write one folder per model under `folder`."""
    for model in models:
        write_model(model, folder / model.model_id)


def write_model(model: Model, folder: Path) -> None:
    """Write one object's folder."""
    shape = shape_of(model)
    frame = normalisation(model, shape)
    links = link_records(shape, frame)
    (folder / "textured_objs").mkdir(parents=True, exist_ok=True)
    sheet = texture.atlas(shape.pieces())
    for component in (c for link in links for c in link.components):
        _write_component(component, frame, folder, sheet)
    (folder / TEXTURE).parent.mkdir(exist_ok=True)
    (folder / TEXTURE).write_bytes(texture.paint(seeds.generator(model.seed, "corpus.furniture.texture"), sheet))
    merged = without_handles(links)
    name = f"partnet_{seeds.key(model.seed, 'corpus.furniture.shapenet'):032x}"
    (folder / "mobility.urdf").write_bytes(urdf(name, merged, frame))
    (folder / "mobility_annotation_gapartnet.urdf").write_bytes(urdf(name, links, frame))
    words = _words(model, merged, classes=False)
    for file, lines in (("semantics.txt", words), ("semantics_gapartnet.txt", _words(model, links, classes=True))):
        (folder / file).write_bytes("".join(f"{link} {joint} {word}\n" for link, joint, word in lines).encode())
    corners, shapenet = frame.point(shape.bounds()), name.removeprefix("partnet_")
    about = {"user_id": "embedded", "model_cat": model.partnet_category, "category": model.category, "model_id": shapenet}
    records: dict[str, Any] = {
        "mobility_v2": mobility(merged, words, frame),
        "link_annotation_gapartnet": annotation(links, frame),
        "bounding_box": {"min": _numbers(corners.min(axis=0)), "max": _numbers(corners.max(axis=0))},
        "meta": about | {"version": "1", "anno_id": model.model_id, "time_in_sec": "0"},
        "result": [{"id": 0, "name": model.partnet_category.lower(), "children": []}],
    }
    for stem, record in records.items():
        (folder / f"{stem}.json").write_bytes((json.dumps(record) + "\n").encode())


def normalisation(model: Model, shape: Shape) -> Frame:
    """Return the frame that centres the box at rest and gives it a diagonal of about 2."""
    low, high = mesh_frame(shape.bounds()).min(axis=0), mesh_frame(shape.bounds()).max(axis=0)
    spread = seeds.generator(model.seed, "corpus.furniture.normalise").uniform(0.95, 1.15)
    return Frame((low + high) / 2, 2.0 * float(spread) / float(np.linalg.norm(high - low)))


def urdf(name: str, links: Sequence[LinkRecord], frame: Frame) -> bytes:
    """Return the URDF: an empty base, the body fixed to it, movers and handles; no inertials, limits without effort."""
    robot = ET.Element("robot", name=name)
    ET.SubElement(robot, "link", name="base")
    origins = {link.name: link.origin for link in links} | {"base": np.zeros(3)}
    for number, link in enumerate(links):
        element = ET.SubElement(robot, "link", name=link.name)
        for k, kind in enumerate(("visual", "collision")):
            for component in link.components:
                attributes = {"name": f"{component.name}-{component.number}"} if kind == "visual" else {}
                shape = ET.SubElement(element, kind, attributes)
                ET.SubElement(shape, "origin", xyz=_xyz(-link.origin))
                ET.SubElement(ET.SubElement(shape, "geometry"), "mesh", filename=component.files[k])
        mover = link.mover
        joint = ET.SubElement(robot, "joint", name=f"joint_{number}", type=mover.type if mover else "fixed")
        if link.parent == "base":
            ET.SubElement(joint, "origin", rpy=BASE_RPY, xyz="0 0 0")
        else:
            ET.SubElement(joint, "origin", xyz=_xyz(link.origin - origins[link.parent]))
        if mover:
            ET.SubElement(joint, "axis", xyz=_xyz(mesh_frame(np.array(mover.axis))))
        ET.SubElement(joint, "child", link=link.name)
        ET.SubElement(joint, "parent", link=link.parent)
        if mover:
            ET.SubElement(joint, "limit", lower="0", upper=_number(_travel(mover, frame)))
    ET.indent(robot, "\t")
    return f'<?xml version="1.0" ?>\n{ET.tostring(robot, encoding="unicode")}\n'.encode()


def _travel(mover: Mover, frame: Frame) -> float:
    """Return how far a joint opens [rad or normalised units]."""
    return mover.upper * (frame.scale if mover.type == "prismatic" else 1.0)


def mobility(links: Sequence[LinkRecord], words: Sequence[tuple[str, str, str]], frame: Frame) -> list[dict[str, Any]]:
    """Return mobility_v2.json: the tree of parts, hinges in degrees, sliders in length units.

    Every second joint is written against its direction with limit b < a, as about half of the real ones are.
    """
    number = {link.name: k for k, link in enumerate(links)}
    entries = []
    for k, (link, (_, joint, word)) in enumerate(zip(links, words, strict=True)):
        mover = link.mover
        data: dict[str, Any] = {}
        if mover:
            travel = _travel(mover, frame)
            sign = -1.0 if k % 2 else 1.0
            limit = {"a": sign * 0.0, "b": float(sign * (np.degrees(travel) if mover.type == "revolute" else travel)), "noLimit": False}
            if mover.type == "prismatic":
                limit |= {"rotates": False, "noRotationLimit": False, "rotationLimit": 0}
            direction = sign * mesh_frame(np.array(mover.axis))
            data = {"axis": {"origin": _numbers(link.origin), "direction": _numbers(direction)}, "limit": limit}
        parts = [{"id": c.number, "name": c.name, "children": []} for c in link.components]
        parent = -1 if link.parent == "base" else number[link.parent]
        entries.append({"id": k, "parent": parent, "joint": joint, "name": word, "parts": parts, "jointData": data})
    return entries


def _words(model: Model, links: Sequence[LinkRecord], *, classes: bool) -> list[tuple[str, str, str]]:
    """Return (link, joint, word) of semantics.txt, or with part `classes` for semantics, and handles fixed, of semantics_gapartnet.txt."""
    furniture = model.partnet_category in FURNITURE
    body = "furniture_body" if furniture else f"{model.partnet_category.lower()}_body"
    words = []
    for link in links:
        word = link.mover.semantic if link.mover and not classes else link.part
        joint = JOINT_WORDS[link.mover.type] if link.mover else "fixed" if link.part else "heavy"
        words.append((link.name, joint, "rotation_door" if word == "door" and furniture else word or body))
    return words


def annotation(links: Sequence[LinkRecord], frame: Frame) -> list[dict[str, Any]]:
    """Return link_annotation_gapartnet.json: per link its class and, of a part, its box (8, 3) in the world at rest."""
    entries: list[dict[str, Any]] = [{"link_name": "base", "is_gapart": False, "category": "", "bbox": []}]
    for link in links:
        box = part_box(link, frame).tolist() if link.part else []
        entries.append({"link_name": link.name, "is_gapart": bool(link.part), "category": link.part, "bbox": box})
    return entries


def part_box(link: LinkRecord, frame: Frame) -> NDArray[np.float64]:
    """Return the corners (8, 3) of a part's box in PartNet's world, ordered in the part's own axes.

    z looks outwards; x is a hinge's axis in the opening sense or a handle's long axis, else the horizontal; y = z x x.
    """
    points = np.concatenate([frame.point(p.solid.vertices) for c in link.components for p in c.pieces])
    low, high = points.min(axis=0), points.max(axis=0)
    extent = high - low
    z = mesh_frame(np.array(link.outward))
    if link.mover is not None and link.part in {"hinge_door", "hinge_lid"}:
        x = mesh_frame(np.array(link.mover.axis))
    elif link.part == "line_fixed_handle":
        across = extent * (np.abs(z) < 0.5)
        x = np.eye(3)[int(np.argmax(across))]
    else:
        x = np.array([1.0, 0.0, 0.0]) if abs(z[0]) < 0.5 else np.array([0.0, 0.0, 1.0])
    axes = np.stack([x, np.cross(z, x), z])
    lengths = np.abs(axes) @ extent
    corners = (CORNERS * lengths) @ axes + (low + high) / 2
    return np.asarray(np.round(corners @ WORLD.T, 8))


def _write_component(component: Component, frame: Frame, folder: Path, sheet: Atlas) -> None:
    """Write the OBJ and MTL of one component, a group per material; all components of an object share one texture."""
    seen, collides = (folder / file for file in component.files)
    groups = wavefront.group_by_finish(component.pieces, seen.stem)
    seen.write_bytes(wavefront.text(groups, f"{seen.stem}.mtl", sheet).obj(frame.scale, -frame.centre))
    seen.with_suffix(".mtl").write_bytes(wavefront.mtl(groups, f"../{TEXTURE}"))
    if collides != seen:
        collides.write_bytes(wavefront.bare(collides.stem, colliders(component.pieces)).obj(frame.scale, -frame.centre))


def _xyz(vector: NDArray[np.float64]) -> str:
    return " ".join(_number(v) for v in vector)


def _number(value: float) -> str:
    return f"{round(float(value), 9) + 0.0:.10g}"


def _numbers(vector: NDArray[np.float64]) -> list[float]:
    return [round(float(v), 9) + 0.0 for v in vector]
