"""The building: floors, ceilings, wall solids, visible wall faces, doors that turn, windows with glass."""

import functools
from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf

from pipeline.entities.asset import Asset, Material, Mesh
from pipeline.entities.plan import Plan, Room
from pipeline.geometry.walls import SLAB, Panel, Prism, Shell, floor_pieces, outer_panels, reveals, room_panels
from pipeline.rendering import fittings, palette
from pipeline.usd.articulation import convert_asset
from pipeline.usd.layer import attribute, label, prim
from pipeline.usd.material import Palette, bind
from pipeline.usd.mesh import convert_box, convert_mesh, convert_polygons, flat_normals, split_polygons
from pipeline.usd.physics import convert_collider, hide
from pipeline.usd.prim_templates import group, instantiate, mesh_attributes, template_of, transform_ops

MATERIALS = "/World/Materials"  # where a home's own parts find theirs
SHAPE = ("points", "extent", "normals")  # what each prism has of its own
PLACE = ("xformOp:translate", "xformOp:orient", "xformOp:scale", "xformOpOrder")  # what each box has
EXACT = 1e-6  # [m, m2] by which a rectangle's corners may be off


def room_text(parent: str, plan: Plan, room: Room, shells: Mapping[int, Shell], materials: Palette) -> str:
    """Return a room as one sees it: floor and ceiling slabs and its wall faces; what collides is the storey's (`walls_text`).

    A staircase has its floor on its lowest storey, its ceiling on the highest, faces on all; `shells` holds the storeys' walls.
    """
    path = f"{parent}/{room.room_id}"
    pieces = floor_pieces(room)
    storeys = plan.levels_of(room)
    under = (len(storeys) - 1) * plan.storey_height + room.height
    parts = [transform_ops((0.0, 0.0, room.level * plan.storey_height))]
    for name, bottom, material in (("floor", -SLAB, palette.floor(room.type)), ("ceiling", under, palette.CEILING)):
        slabs = (_slab(f"{path}/{name}/piece_{i}", piece, (bottom, bottom + SLAB), material, materials) for i, piece in enumerate(pieces))
        parts.append(instantiate(_labelled(name), f"{path}/{name}", "".join(slabs)))
    panels: list[Panel] = []
    for k, level in enumerate(storeys):
        faces = room_panels(room, shells[level].cuts, plan.storey_height if level < storeys[-1] else room.height)
        panels.extend(Panel(face.owner, face.corners + np.array([0.0, 0.0, k * plan.storey_height])) for face in faces)
    if panels:
        parts.append(_panels(f"{path}/wall", panels, palette.wall(room.type), materials))
    return instantiate(_labelled("room", room_type=room.type), path, "".join(parts))


def walls_text(parent: str, plan: Plan, level: int, shell: Shell, solids: Iterable[Prism], materials: Palette) -> str:
    """Return a storey's `solids` (colliders, one box or convex piece each), facade, jambs, thresholds and steps."""
    path = f"{parent}/level_{level}"
    plaster = materials.path(palette.PLASTER)
    masses = [_solid(f"{path}/solids/{solid.kind}_{i:03d}", solid, plaster) for i, solid in enumerate(solids)]
    parts = [transform_ops((0.0, 0.0, level * plan.storey_height)), instantiate(group(schema="Scope"), f"{path}/solids", "".join(masses))]
    parts.append(_panels(f"{path}/facade", outer_panels(shell), palette.FACADE, materials))
    faces = [panel for cut in shell.cuts for panel in reveals(cut)]
    if faces:
        parts.append(_panels(f"{path}/jambs", faces, palette.JAMB, materials))
    for cut in shell.cuts:
        if cut.bottom < 1e-3 and cut.opening.kind != "window":
            name = f"threshold_{cut.opening.opening_id}"
            parts.append(_slab(f"{path}/{name}", cut.quad, (-SLAB, 0.0), palette.threshold(plan, cut.opening), materials, "floor"))
    if shell.stairs:
        steps = (
            _slab(f"{path}/stairs/{step.kind}_{i:02d}", step.polygon, (step.bottom, step.top), palette.STEP, materials, collides=True)
            for i, step in enumerate(shell.stairs)
        )
        parts.append(instantiate(_labelled("stairs", "Scope"), f"{path}/stairs", "".join(steps)))
    return instantiate(_labelled("wall"), path, "".join(parts))


def door_texts(parent: str, elevation: float, shell: Shell, materials: Palette) -> list[str]:
    """Return the doors of a storey, each an articulation of a fixed frame and a leaf on a hinge."""
    kinds = {cut.opening.opening_id: cut.opening.kind for cut in shell.cuts}
    texts = []
    for leaf in shell.leaves:
        fitting = _door(fittings.door_size(leaf), entrance=kinds[leaf.opening_id] == "entrance")
        materials.paths(fitting.materials)
        where = transform_ops((*leaf.hinge, elevation), float(np.arctan2(leaf.along[1], leaf.along[0])))
        texts.append(instantiate(fitting.template, f"{parent}/{leaf.opening_id}", where))
    return texts


def window_texts(parent: str, elevation: float, shell: Shell, materials: Palette) -> list[str]:
    """Return the windows of a storey: static frames and panes."""
    texts = []
    for cut in shell.cuts:
        if cut.opening.kind == "window":
            fitting, (start, yaw) = _window(fittings.window_size(cut)), fittings.window_pose(cut)
            materials.paths(fitting.materials)
            where = transform_ops((*start, elevation), yaw)
            texts.append(instantiate(fitting.template, f"{parent}/{cut.opening.opening_id}", where))
    return texts


class Fitting(NamedTuple):
    """A door or window of one size: its template and its materials."""

    template: str
    materials: tuple[Material, ...]


@functools.lru_cache(maxsize=256)
def _door(size: fittings.Size, *, entrance: bool) -> Fitting:
    return _fitting(fittings.door_of(size, entrance=entrance), "door")


@functools.lru_cache(maxsize=256)
def _window(size: fittings.Size) -> Fitting:
    return _fitting(fittings.window_of(size), "window")


def _fitting(asset: Asset, name: str) -> Fitting:
    def convert(layer: Sdf.Layer) -> None:
        spec = prim(layer, "Template")
        label(spec, "class", [name])
        convert_asset(spec, asset, Palette(MATERIALS).paths(asset.materials))

    return Fitting(template_of(convert), asset.materials)


def prism_points(polygon: NDArray[np.float64], bottom: float, top: float) -> NDArray[np.float64]:
    """Return the corners (2n, 3) of an upright prism over a polygon (n, 2), the lower ones first."""
    n = len(polygon)
    points = np.empty((2 * n, 3))
    points[:n, :2] = points[n:, :2] = polygon
    points[:n, 2], points[n:, 2] = bottom, top
    return points


@functools.cache
def _prism(n: int) -> Mesh:
    """Return the closed triangle mesh of an upright prism over a convex counter-clockwise polygon of n corners."""
    faces = [[0, k + 1, k] for k in range(1, n - 1)] + [[n, n + k, n + k + 1] for k in range(1, n - 1)]
    for k in range(n):
        j = (k + 1) % n
        faces += [[k, j, n + j], [k, n + j, n + k]]
    turn = 2 * np.pi * np.arange(n) / n  # any such polygon: corners that are one would be written as one
    outline = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return Mesh("prism", prism_points(outline, 0.0, 1.0).astype(np.float32), np.array(faces, np.int32))


def _prism_shape(polygon: NDArray[np.float64], bottom: float, top: float) -> str:
    points, faces = prism_points(polygon, bottom, top), _prism(len(polygon)).faces
    return mesh_attributes(points, flat_normals(points, np.full(len(faces), 3, np.int32), faces.ravel()))


@functools.cache
def _labelled(name: str, schema: str = "Xform", room_type: str = "") -> str:
    """Return the template of a prim that holds others, labelled as a `name` and, where it is a room, with its type."""

    def convert(layer: Sdf.Layer) -> None:
        spec = prim(layer, "Template", schema)
        label(spec, "class", [name])
        if room_type:
            label(spec, "room_type", [room_type])

    return template_of(convert)


def _solid(path: str, solid: Prism, material: str) -> str:
    """Return a solid that collides and is not seen, as a cube where it is a box: engines know nothing better."""
    low, high = solid.bottom, solid.top
    p = solid.polygon
    if len(p) == 4 and float(np.abs(p[0] + p[2] - p[1] - p[3]).max()) < EXACT and abs((p[1] - p[0]) @ (p[3] - p[0])) < EXACT:
        size = (*(float(np.linalg.norm(p[k] - p[0])) for k in (1, 3)), high - low)
        yaw = float(np.arctan2(*(p[1] - p[0])[::-1]))
        return instantiate(_solid_template(0, material), path, transform_ops((*p.mean(axis=0), (low + high) / 2), yaw, size))
    return instantiate(_solid_template(len(p), material), path, _prism_shape(p, low, high))


@functools.lru_cache(maxsize=256)
def _solid_template(corners: int, material: str) -> str:
    """Return the template of a solid over a polygon of so many corners, of a cube for 0."""

    def convert(layer: Sdf.Layer) -> None:
        gprim = (
            convert_mesh(layer, "Template", _prism(corners), None) if corners else convert_box(layer, "Template", np.zeros(3), np.ones(3))
        )
        hide(gprim)
        convert_collider(gprim)
        bind(gprim, material)

    return template_of(convert, SHAPE if corners else PLACE)


def _slab(
    path: str, polygon: NDArray[np.float64], heights: tuple[float, float], material: Material, materials: Palette, name: str = "",
    *, collides: bool = False,
) -> str:  # fmt: skip
    """Return a prism that is seen, labelled as `name`."""
    template = _slab_template(len(polygon), material, materials.path(material), name, collides=collides)
    return instantiate(template, path, _prism_shape(polygon, *heights))


@functools.lru_cache(maxsize=256)
def _slab_template(corners: int, material: Material, path: str, name: str, *, collides: bool) -> str:
    def convert(layer: Sdf.Layer) -> None:
        gprim = convert_mesh(layer, "Template", _prism(corners), material.base_color)
        bind(gprim, path)
        if collides:
            convert_collider(gprim)
        if name:
            label(gprim, "class", [name])

    return template_of(convert, SHAPE)


def _panels(path: str, panels: Iterable[Panel], material: Material, materials: Palette) -> str:
    """Return flat faces as one mesh without a collider; the solids behind them collide."""
    corners = [panel.corners for panel in panels]
    counts = np.array([len(c) for c in corners], np.int32)
    every = np.concatenate(corners).astype(np.float32)
    normals = np.repeat(flat_normals(every, counts, np.arange(len(every), dtype=np.int32)), counts, axis=0)
    rows, index = np.unique(np.concatenate([every, normals.round(5)], axis=1), axis=0, return_inverse=True)  # one corner a plane
    rows, indices = split_polygons(rows, counts, index.reshape(-1).astype(np.int32))  # a door above a wall: its sides meet no edge of that
    topology = f"int[] faceVertexCounts = {counts.tolist()}\nint[] faceVertexIndices = {indices.tolist()}\n"
    shape = mesh_attributes(rows[:, :3], rows[:, 3:], "vertex")
    return instantiate(_panels_template(material, materials.path(material)), path, shape + topology)


@functools.lru_cache(maxsize=256)
def _panels_template(material: Material, path: str) -> str:
    def convert(layer: Sdf.Layer) -> None:
        one = np.arange(3, dtype=np.int32)
        gprim = convert_polygons(layer, "Template", np.eye(3), one[2:] + 1, one, material.base_color)
        attribute(gprim, "doubleSided", "bool", True, uniform=True)
        label(gprim, "class", ["wall"])
        bind(gprim, path)

    return template_of(convert, (*SHAPE, "faceVertexCounts", "faceVertexIndices"))
