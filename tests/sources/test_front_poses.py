import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pipeline.entities.home import Placement
from pipeline.sources.threed_front.poses import Box, place, to_ours, wrap, yaw_and_tilt

angles = st.floats(-math.pi + 1e-3, math.pi)


def quaternion(yaw):
    return np.array([0, round(math.sin(yaw / 2), 5), 0, round(math.cos(yaw / 2), 5)])


@given(angles)
def test_yaw_of_a_turn_about_the_vertical(yaw):
    found, tilt = yaw_and_tilt(quaternion(yaw))
    assert abs(math.remainder(found - yaw, 2 * math.pi)) < 5e-5
    assert tilt < 1e-3


def test_tilt_is_the_angle_of_the_vertical():
    assert yaw_and_tilt(np.array([math.sin(0.1), 0, 0, math.cos(0.1)]))[1] == pytest.approx(0.2, abs=1e-6)


def test_half_turn_is_in_the_half_open_range():
    assert wrap(yaw_and_tilt(np.array([0.0, 1, 0, 0]))[0]) == pytest.approx(math.pi, abs=1e-5)
    assert wrap(-math.pi) > 0


def test_front_of_the_file_is_our_front():
    """A model's +z in the file is -y with us, at any yaw: the point ahead of the model stays ahead of it."""
    for yaw in (0.0, 0.3, math.pi / 2, -2.0, math.pi):
        ahead = np.array([math.sin(yaw), 0, math.cos(yaw)])  # R_y(yaw) (0, 0, 1)
        c, s = math.cos(yaw), math.sin(yaw)
        ours = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ [0, -1, 0]
        assert np.allclose(to_ours(ahead), ours)


def transformed(box, unit, position, yaw, scale):
    """The box's corners by the format's own words: v' = R(rot) (scale v) + pos, then our frame."""
    c, s = math.cos(yaw), math.sin(yaw)
    R = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    corners = np.array([[x, y, z] for x in (box.low[0], box.high[0]) for y in (box.low[1], box.high[1]) for z in (box.low[2], box.high[2])])
    return to_ours((corners * unit * scale) @ R.T + position)


@given(
    angles,
    st.lists(st.floats(0.2, 2), min_size=3, max_size=3),
    st.sampled_from([(1, 1, 1), (-1, 1, 1), (1, 1, -1), (-1, 1, -1)]),
    st.lists(st.floats(-5, 5), min_size=3, max_size=3),
)
def test_placed_box_is_the_transformed_box(yaw, magnitude, signs, position):
    """Off-centre models, stretched and mirrored: footprint and heights equal those of the transformed corners."""
    box = Box((-0.3, -0.1, -0.7), (0.9, 1.2, 0.4))
    scale = np.array(magnitude) * signs
    pose = place(box, np.array(position), yaw, scale)
    corners = transformed(box, 1.0, np.array(position), yaw, scale)
    footprint = Placement("", "", "", "", pose.position, pose.yaw, pose.size).footprint()
    want = {tuple(np.round(p, 3)) for p in corners[:, :2]}
    for point in footprint:
        assert min(np.hypot(*(point - w)) for w in map(np.array, want)) < 2e-3
    assert pose.position[2] == pytest.approx(corners[:, 2].min())
    assert pose.position[2] + pose.size[2] == pytest.approx(corners[:, 2].max())
    assert pose.mirrored == (signs[0] * signs[2] < 0)


@given(angles, st.sampled_from([(1, 1, 1), (-1, 1, 1), (1, 1, -1), (-1, 1, -1)]))
def test_front_follows_mirroring(yaw, signs):
    pose = place(Box((-1, 0, -1), (1, 1, 1)), np.zeros(3), yaw, np.array(signs, float))
    c, s = math.cos(yaw), math.sin(yaw)
    ahead = to_ours(np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ (np.array([0, 0, 1]) * signs))
    assert np.allclose([math.sin(pose.yaw), -math.cos(pose.yaw)], ahead[:2], atol=2e-5)
