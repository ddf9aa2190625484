"""Sweeps: all that moves is in them, and a little room about it, but for its height."""

import numpy as np
import pytest
import shapely

from pipeline.geometry.kinematics import joint_motion
from pipeline.geometry.prisms import MARGIN, solid
from tests.geometry.furniture import chest, cupboard


@pytest.mark.parametrize("asset", [chest(), cupboard()])
def test_a_sweep_has_room_about_what_moves(asset):
    joint, prisms = asset.joints[0], solid(asset).sweeps[0].prisms
    swept = shapely.union_all([shapely.Polygon(prisms.polygon(k)) for k in range(len(prisms))])
    pieces = [mesh.vertices.astype(float) for mesh in asset.links[1].colliders]
    for q in np.linspace(0.0, joint.upper, 30):
        T = joint_motion(joint, float(q))
        for points in pieces:
            outline = shapely.MultiPoint((points @ T[:3, :3].T + T[:3, 3])[:, :2]).convex_hull
            assert swept.buffer(1e-6).contains(outline.buffer(MARGIN, join_style="mitre" if joint.type == "prismatic" else "round"))
    heights = np.concatenate(pieces)[:, 2]
    assert (prisms.z.min(), prisms.z.max()) == pytest.approx((heights.min(), heights.max()))
