"""A home as coloured triangles by finish, posed and without its ceilings: what a renderer needs."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from pipeline.entities.asset import Asset, Material
from pipeline.entities.home import Home
from pipeline.geometry.stairs import Step, visible_steps
from pipeline.geometry.walls import Panel, Shell, floor_pieces, outer_panels, reveals, room_panels, shell
from pipeline.preview.building import fans, is_hanging, pattern, scale_colour
from pipeline.rendering import fittings, palette
from pipeline.rendering.pose import asset_triangles, open_joint_values, placement_transform
from pipeline.rendering.surface_colour import face_colours

CUT = 2.15  # walls are cut here; doors stay whole [m]
LOW_CUT = 0.9  # outer walls between the eye and the rooms are cut here, so that one sees in [m]
GRAIN = 0.10  # how much planks and tiles differ; light evens it out
WALL_TOP = Material("wall_cut", (0.05, 0.055, 0.065), 0.9)

Finish = tuple[float, float]  # roughness, metallic
ByFinish = dict[Finish, list[tuple[NDArray[np.float64], NDArray[np.float32]]]]
CutHeight = Callable[[NDArray[np.float64]], float]


@dataclass(frozen=True, slots=True)
class Batch:
    """All triangles of one finish: `faces` (T, 3, 3) [m, world], `colours` (T, 3) linear."""

    roughness: float
    metallic: float
    faces: NDArray[np.float64]
    colours: NDArray[np.float32]


def home_batches(
    home: Home, assets: Mapping[str, Asset], level: int, open_fraction: float, towards_eye: NDArray[np.float64] | None = None
) -> list[Batch]:
    """Return one storey of a home: building, doors and windows, furniture with its doors and drawers partly open.

    With `towards_eye` (2,), a direction in plan, the outer walls on that side are cut low. Window panes are left out.
    """
    built = shell(home.plan, level)
    by_finish: ByFinish = {}

    def cut_height(points: NDArray[np.float64]) -> float:
        if towards_eye is None:
            return CUT
        x, y = points[:, :2].mean(axis=0) + 0.3 * towards_eye  # further than half an outer wall's thickness
        return CUT if shapely.contains_xy(built.outline, x, y) else LOW_CUT

    _building(home, level, built, by_finish, cut_height)
    for leaf in built.leaves:
        kind = next(c.opening.kind for c in built.cuts if c.opening.opening_id == leaf.opening_id)
        asset, (x, y), yaw = fittings.door(leaf, entrance=kind == "entrance")
        _add(by_finish, asset, placement_transform(np.array([x, y, 0.0]), yaw), open_fraction)
    for cut in built.cuts:
        if cut.opening.kind == "window" and cut_height(cut.quad) == CUT:
            asset, (x, y), yaw = fittings.window(cut)
            _add(by_finish, asset, placement_transform(np.array([x, y, 0.0]), yaw), 0.0)
    rooms = {room.room_id for room in home.plan.rooms if room.level == level}
    lift = np.array([0.0, 0.0, level * home.plan.storey_height])
    for placement in home.placements:
        if placement.room_id in rooms and placement.asset_id in assets and not is_hanging(placement):
            T = placement_transform(placement.position - lift, placement.yaw, placement.scale)
            _add(by_finish, assets[placement.asset_id], T, open_fraction)
    return [Batch(*finish, *(np.concatenate(column) for column in zip(*parts, strict=True))) for finish, parts in by_finish.items()]


def _building(home: Home, level: int, built: Shell, by_finish: ByFinish, cut_height: CutHeight) -> None:
    for room in home.plan.rooms:
        if room.level == level:
            material = palette.floor(room.type)
            for piece in floor_pieces(room):
                for ring, shade in zip(*pattern(piece, material), strict=True):
                    plank = replace(material, base_color=scale_colour(material.base_color, 1 + GRAIN * float(shade)))
                    _paint(by_finish, plank, _flat(ring, 0.0))
        if level in home.plan.levels_of(room):
            _panels(by_finish, palette.wall(room.type), room_panels(room, built.cuts), cut_height)
    for step in visible_steps(home.plan, level):
        if step.bottom < CUT:
            _paint(by_finish, palette.STEP, _solid(step, min(step.top, CUT)))
    for prism in built.prisms:
        height = cut_height(prism.polygon)
        if prism.bottom < height <= prism.top:  # whole sills show their board instead
            _paint(by_finish, WALL_TOP, _flat(prism.polygon, height))
    _panels(by_finish, palette.FACADE, [p for p in outer_panels(built) if np.ptp(p.corners[:, 2]) > 1e-6], cut_height)
    for cut in built.cuts:
        _panels(by_finish, palette.JAMB, reveals(cut), cut_height)
        if cut.bottom < 1e-3:
            _paint(by_finish, palette.threshold(home.plan, cut.opening), _flat(cut.quad, 0.0))


def _panels(by_finish: ByFinish, material: Material, panels: list[Panel], cut_height: CutHeight) -> None:
    """Add upright and flat faces, cut at their height."""
    for panel in panels:
        height = cut_height(panel.corners)
        if panel.corners[:, 2].min() < height:
            corners = panel.corners.copy()
            corners[:, 2] = np.minimum(corners[:, 2], height)
            _paint(by_finish, material, np.stack([corners[[0, k, k + 1]] for k in range(1, len(corners) - 1)]))


def _flat(ring: NDArray[np.float64], z: float) -> NDArray[np.float64]:
    return fans(ring[None], z)


def _solid(step: Step, top: float) -> NDArray[np.float64]:
    """Return the top and the sides of a step as triangles."""
    low, high = (np.column_stack([step.polygon, np.full(len(step.polygon), z)]) for z in (step.bottom, top))
    sides = np.stack([low, np.roll(low, -1, axis=0), np.roll(high, -1, axis=0), high], axis=1)
    return np.concatenate([_flat(step.polygon, top), sides[:, [0, 1, 2]], sides[:, [0, 2, 3]]])


def _add(by_finish: ByFinish, asset: Asset, T: NDArray[np.float64], open_fraction: float) -> None:
    faces, materials = asset_triangles(asset, open_joint_values(asset, open_fraction) if open_fraction else None)
    world, colours = faces @ T[:3, :3].T + T[:3, 3], face_colours(asset)
    for index in np.unique(materials):
        material = asset.materials[index] if asset.materials else palette.PLASTER
        if material is not palette.GLASS:  # sunlight behind glass is all noise to a path tracer
            mine = materials == index
            by_finish.setdefault((material.roughness, material.metallic), []).append((world[mine], colours[mine]))


def _paint(by_finish: ByFinish, material: Material, faces: NDArray[np.float64]) -> None:
    colours = np.tile(np.array(material.base_color, np.float32), (len(faces), 1))
    by_finish.setdefault((material.roughness, material.metallic), []).append((faces, colours))
