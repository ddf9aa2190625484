"""A small picture of one asset, from its front left, with its doors and drawers a little open."""

import math

import numpy as np
from PIL import Image

from pipeline.entities.asset import Asset
from pipeline.rendering.palette import display
from pipeline.rendering.pose import asset_triangles, open_joint_values
from pipeline.rendering.raster import darken_edges, oblique, render, shrink
from pipeline.rendering.surface_colour import face_colours

BACKGROUND = (0.96, 0.96, 0.95)


def thumbnail(asset: Asset, size: int = 256, open_fraction: float = 0.35) -> Image.Image:
    """Draw the asset, `size` x `size` pixels."""
    faces, _ = asset_triangles(asset, open_joint_values(asset, open_fraction))
    if not len(faces):
        return Image.new("RGB", (size, size), tuple(int(255 * c) for c in BACKGROUND))
    view = oblique(faces.reshape(-1, 3), math.radians(-32), math.radians(24), 2 * size)
    frame = render(view, faces, display(face_colours(asset)), background=BACKGROUND)
    frame = darken_edges(shrink(frame, 2), max(2, size // 64), 0.35, reach=0.25 * float(np.linalg.norm(asset.size)))
    return Image.fromarray(frame.colour)
