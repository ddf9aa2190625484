"""What is kept of an asset for plans is all that is seen of it from above."""

from __future__ import annotations

import numpy as np
import pytest

from pipeline.entities.asset import Asset, Material
from pipeline.rendering.above import draw_from_above, visible_top
from pipeline.rendering.boxes import box, solid_link
from pipeline.rendering.palette import display
from pipeline.rendering.pose import asset_triangles, placement_transform
from pipeline.rendering.raster import render, top_down
from pipeline.rendering.surface_colour import face_colours

NOWHERE = np.zeros((0, 3, 3)), np.zeros((0, 3), np.float32)


def table() -> Asset:
    """A top on four legs, a bowl on it, and a box below that nobody sees."""
    legs = [box(f"leg_{x}_{y}", (x - 0.03, y - 0.03, 0), (x + 0.03, y + 0.03, 0.7), 1) for x in (-0.5, 0.5) for y in (-0.3, 0.3)]
    parts = (
        box("top", (-0.6, -0.4, 0.7), (0.6, 0.4, 0.74)),
        box("bowl", (0.1, 0.0, 0.74), (0.3, 0.2, 0.8), 2),
        box("under", (-0.2, -0.2, 0.1), (0.2, 0.2, 0.5), 2),
    )
    materials = (Material("oak", (0.5, 0.3, 0.1)), Material("steel", (0.6, 0.6, 0.6)), Material("red", (0.7, 0.05, 0.05)))
    return Asset(
        "table",
        "dining_table",
        np.array([1.2, 0.8, 0.8]),
        (solid_link("base", (*parts, *legs), parts, 20.0),),
        (),
        materials,
        "t",
        "1",
        "x",
    )


def test_only_what_is_seen_is_kept():
    kept = visible_top(table())
    assert len(kept.faces) == 4  # two triangles of the top, two of the bowl
    assert kept.faces[..., 2].min() == pytest.approx(0.74, abs=1e-6)


@pytest.mark.parametrize("yaw", [0.0, 0.6, -2.5])
@pytest.mark.parametrize("scale", [(1.0, 1.0, 1.0), (0.8, 1.3, 1.1)])
def test_a_roof_is_drawn_as_the_whole_asset_is(yaw, scale):
    asset, position, size = table(), np.array([0.3, -0.2, 0.1]), np.array(scale)
    view = top_down(np.array([-1.5, -1.5]), np.array([1.5, 1.5]), 240, 240)
    faces, _ = asset_triangles(asset)
    T = placement_transform(position, yaw, size)
    whole = render(view, faces @ T[:3, :3].T + T[:3, 3], display(face_colours(asset)), np.full(len(faces), 7, np.int32))
    frame = render(view, *NOWHERE, np.zeros(0, np.int32))
    draw_from_above(frame, view, asset, position, yaw, size, 7)
    assert (frame.item == 7).mean() > 0.08
    assert (frame.item != whole.item).mean() < 2e-3  # along edges, where a pixel's centre lies on one
    both = (frame.item == 7) & (whole.item == 7)
    assert np.abs(frame.colour[both].astype(int) - whole.colour[both]).max(axis=-1).mean() < 0.5
