"""Assets as they are seen from straight above, and drawing them into a plan: turned and scaled, what is seen of them stays the same."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.entities.asset import Asset
from pipeline.geometry.compiled import borrowing
from pipeline.geometry.memo import cached_on_asset
from pipeline.rendering.palette import display
from pipeline.rendering.pose import asset_triangles
from pipeline.rendering.raster import AMBIENT, LIGHT, Buffers, Frame, View, fill_triangle, render, top_down
from pipeline.rendering.surface_colour import face_colours

FINENESS, MOST = 250.0, 640  # pixels per metre, and pixels a side, at which it is tried what is seen
TO_LIGHT = LIGHT / np.linalg.norm(LIGHT)


@dataclass(frozen=True, slots=True)
class VisibleTop:
    """The triangles (T, 3, 3) [m, object frame] of an asset that are seen from above, and their display colours (T, 3)."""

    faces: NDArray[np.float32]
    colours: NDArray[np.float32]


@cached_on_asset
def visible_top(asset: Asset) -> VisibleTop:
    """Return what is seen of an asset with all joints at 0."""
    faces, _ = asset_triangles(asset)
    visible = np.zeros(len(faces), np.bool_)
    if len(faces):
        low, high = faces[..., :2].min((0, 1)), faces[..., :2].max((0, 1))
        width, height = (int(np.clip(math.ceil(FINENESS * side), 8, MOST)) for side in high - low)
        items = render(top_down(low, high, width, height), faces, np.zeros((len(faces), 3), np.float32)).item
        visible[items[items >= 0]] = True
    return VisibleTop(faces[visible].astype(np.float32), display(face_colours(asset, visible)))


def draw_from_above(
    frame: Frame, view: View, asset: Asset, position: NDArray[np.float64], yaw: float, scale: NDArray[np.float64], item: int
) -> None:
    """Draw an asset into a frame that looks down at `position` (3,) [m], shaded as `render` does; `item` labels its pixels."""
    top = visible_top(asset)
    pose = np.array([*position, math.cos(yaw), math.sin(yaw)])
    offset = np.array([view.width / 2, view.height / 2]) - view.scale * view.centre[:2] * (1.0, -1.0)
    scratch = np.empty((3, 3)), np.empty((3, 3), np.float32), np.empty(3, np.uint8)
    _draw(top.faces, top.colours, pose, scale, view.scale, offset, item, TO_LIGHT, AMBIENT, scratch, frame.buffers)


@borrowing
def _draw(
    faces: NDArray[np.float32],
    colours: NDArray[np.float32],
    pose: NDArray[np.float64],
    size: NDArray[np.float64],
    scale: float,
    offset: NDArray[np.float64],
    item: int,
    light: NDArray[np.float64],
    ambient: float,
    scratch: tuple[NDArray[np.float64], NDArray[np.float32], NDArray[np.uint8]],
    buffers: Buffers,
) -> None:
    """Scale by `size`, turn and move by `pose` (x, y, z, cos, sin), shade and fill triangles.

    A point's pixel is `offset` + `scale` times its (x, -y) [m]. `scratch` has a triangle's corners in the world and
    in the picture, (3, 3) each, and its colour (3,).
    """
    world, corners, paint = scratch
    for t in range(faces.shape[0]):
        for k in range(3):
            x, y = faces[t, k, 0] * size[0], faces[t, k, 1] * size[1]
            world[k, 0] = pose[3] * x - pose[4] * y + pose[0]
            world[k, 1] = pose[4] * x + pose[3] * y + pose[1]
            world[k, 2] = faces[t, k, 2] * size[2] + pose[2]
            corners[k, 0], corners[k, 1] = offset[0] + scale * world[k, 0], offset[1] - scale * world[k, 1]
            corners[k, 2] = world[k, 2]
        ax, ay, az = world[1, 0] - world[0, 0], world[1, 1] - world[0, 1], world[1, 2] - world[0, 2]
        bx, by, bz = world[2, 0] - world[0, 0], world[2, 1] - world[0, 1], world[2, 2] - world[0, 2]
        nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        length = math.sqrt(nx**2 + ny**2 + nz**2)
        lambert = (nx * light[0] + ny * light[1] + nz * light[2]) / max(length, 1e-12)
        lambert = min(max(-lambert if nz < 0 else lambert, 0.0), 1.0)  # the side that is seen
        for k in range(3):
            paint[k] = np.uint8(min(max(colours[t, k] * (ambient + (1.0 - ambient) * lambert) * 255.0 + 0.5, 0.0), 255.0))
        fill_triangle(corners, paint, item, buffers)
