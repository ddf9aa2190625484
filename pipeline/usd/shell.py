"""The building: floors, ceilings, wall solids, visible wall faces, doors that turn, windows with glass."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf
from shapely.geometry import Polygon

from pipeline.entities.asset import Material, Mesh
from pipeline.entities.plan import Plan, Room
from pipeline.geometry.tiling import convex_pieces
from pipeline.geometry.walls import SLAB, Panel, Shell, outer_panels, reveals, room_panels
from pipeline.rendering import fittings, palette
from pipeline.usd.articulation import convert_asset
from pipeline.usd.layer import attribute, label, place, prim
from pipeline.usd.material import Palette, bind
from pipeline.usd.mesh import convert_mesh, convert_polygons
from pipeline.usd.physics import convert_collider, hide


def convert_room(parent: Sdf.PrimSpec, plan: Plan, room: Room, shells: Mapping[int, Shell], materials: Palette) -> Sdf.PrimSpec:
    """Write a room: floor and ceiling slabs in convex pieces that one sees and walks on, and its wall faces.

    A staircase has its floor on its lowest storey, its ceiling on the highest, faces on all; `shells` holds the storeys' walls.
    """
    spec = prim(parent, room.room_id)
    place(spec, (0.0, 0.0, room.level * plan.storey_height))
    label(spec, "class", ["room"])
    label(spec, "room_type", [room.type])
    pieces = convex_pieces(Polygon(room.polygon))
    storeys = plan.levels_of(room)
    under = (len(storeys) - 1) * plan.storey_height + room.height
    floor = _scope(spec, "floor")
    for i, piece in enumerate(pieces):
        _slab(floor, f"piece_{i}", piece, -SLAB, 0.0, palette.floor(room.type), materials)
    ceiling = _scope(spec, "ceiling")
    for i, piece in enumerate(pieces):
        _slab(ceiling, f"piece_{i}", piece, under, under + SLAB, palette.CEILING, materials)
    panels: list[Panel] = []
    for k, level in enumerate(storeys):
        faces = room_panels(room, shells[level].cuts, plan.storey_height if level < storeys[-1] else room.height)
        panels.extend(Panel(face.owner, face.corners + np.array([0.0, 0.0, k * plan.storey_height])) for face in faces)
    if panels:
        _panels(spec, "wall", panels, palette.wall(room.type), materials)
    return spec


def convert_walls(parent: Sdf.PrimSpec, plan: Plan, level: int, shell: Shell, materials: Palette) -> Sdf.PrimSpec:
    """Write a storey's wall solids (colliders, one convex piece each), facade, jambs, thresholds and steps."""
    spec = prim(parent, f"level_{level}")
    place(spec, (0.0, 0.0, level * plan.storey_height))
    label(spec, "class", ["wall"])
    solids = prim(spec, "solids", "Scope")
    for i, solid in enumerate(shell.prisms):
        mesh = prism_mesh(f"{solid.kind}_{i:03d}", solid.polygon, solid.bottom, solid.top)
        made = convert_mesh(solids, mesh.name, mesh, None)
        hide(made)
        convert_collider(made)
        bind(made, materials.path(palette.PLASTER))
    _panels(spec, "facade", outer_panels(shell), palette.FACADE, materials)
    faces = [panel for cut in shell.cuts for panel in reveals(cut)]
    if faces:
        _panels(spec, "jambs", faces, palette.JAMB, materials)
    for cut in shell.cuts:
        if cut.bottom < 1e-3 and cut.opening.kind != "window":
            name = f"threshold_{cut.opening.opening_id}"
            label(_slab(spec, name, cut.quad, -SLAB, 0.0, palette.threshold(plan, cut.opening), materials), "class", ["floor"])
    if shell.stairs:
        stairs = prim(spec, "stairs", "Scope")
        label(stairs, "class", ["stairs"])
        for i, step in enumerate(shell.stairs):
            _slab(stairs, f"{step.kind}_{i:02d}", step.polygon, step.bottom, step.top, palette.STEP, materials)
    return spec


def convert_doors(parent: Sdf.PrimSpec, elevation: float, shell: Shell, materials: Palette) -> list[Sdf.PrimSpec]:
    """Write the doors of a storey, each an articulation of a fixed frame and a leaf on a hinge."""
    kinds = {cut.opening.opening_id: cut.opening.kind for cut in shell.cuts}
    made = []
    for leaf in shell.leaves:
        asset, (x, y), yaw = fittings.door(leaf, entrance=kinds[leaf.opening_id] == "entrance")
        spec = prim(parent, leaf.opening_id)
        place(spec, (x, y, elevation), yaw)
        label(spec, "class", ["door"])
        convert_asset(spec, asset, materials.paths(asset.materials))
        made.append(spec)
    return made


def convert_windows(parent: Sdf.PrimSpec, elevation: float, shell: Shell, materials: Palette) -> list[Sdf.PrimSpec]:
    """Write the windows of a storey: static frames and panes."""
    made = []
    for cut in shell.cuts:
        if cut.opening.kind == "window":
            asset, (x, y), yaw = fittings.window(cut)
            spec = prim(parent, cut.opening.opening_id)
            place(spec, (x, y, elevation), yaw)
            label(spec, "class", ["window"])
            convert_asset(spec, asset, materials.paths(asset.materials))
            made.append(spec)
    return made


def prism_mesh(name: str, polygon: NDArray[np.float64], bottom: float, top: float) -> Mesh:
    """Make the closed triangle mesh of an upright prism over a convex counter-clockwise polygon (n, 2)."""
    n = len(polygon)
    vertices = np.concatenate([np.column_stack([polygon, np.full(n, z)]) for z in (bottom, top)]).astype(np.float32)
    faces = [[0, k + 1, k] for k in range(1, n - 1)] + [[n, n + k, n + k + 1] for k in range(1, n - 1)]
    for k in range(n):
        j = (k + 1) % n
        faces += [[k, j, n + j], [k, n + j, n + k]]
    return Mesh(name, vertices, np.array(faces, np.int32))


def _scope(parent: Sdf.PrimSpec, name: str) -> Sdf.PrimSpec:
    spec = prim(parent, name)
    label(spec, "class", [name])
    return spec


def _slab(
    parent: Sdf.PrimSpec, name: str, polygon: NDArray[np.float64], bottom: float, top: float, material: Material, materials: Palette
) -> Sdf.PrimSpec:
    made = convert_mesh(parent, name, prism_mesh(name, polygon, bottom, top), material.base_color)
    bind(made, materials.path(material))
    convert_collider(made)
    return made


def _panels(parent: Sdf.PrimSpec, name: str, panels: Iterable[Panel], material: Material, materials: Palette) -> Sdf.PrimSpec:
    """Write flat faces as one mesh without a collider; the solids behind them collide."""
    corners = [panel.corners for panel in panels]
    counts = np.array([len(c) for c in corners], np.int32)
    points = np.concatenate(corners)
    made = convert_polygons(parent, name, points, counts, np.arange(len(points), dtype=np.int32), material.base_color)
    attribute(made, "doubleSided", "bool", True, uniform=True)
    label(made, "class", ["wall"])
    bind(made, materials.path(material))
    return made
