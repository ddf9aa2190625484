from __future__ import annotations

import numpy as np
import pytest

from pipeline.entities.plan import Opening, Plan, Room, Swing
from pipeline.geometry.kinematics import joint_motion
from pipeline.geometry.walls import shell
from pipeline.rendering.boxes import box, join_meshes, solid_link, triangles
from pipeline.rendering.fittings import door, window
from pipeline.rendering.pose import asset_triangles, open_joint_values, placement_transform

A = Room("a", "bedroom", np.array([[0, 0], [4, 0], [4, 3], [0, 3]], float))
B = Room("b", "hallway", np.array([[4.12, 0], [6, 0], [6, 3], [4.12, 3]], float))


def leaf(room, hinge, *, flipped=False):
    ends = np.array([[4.06, 1.0], [4.06, 1.9]])
    opening = Opening("d", "door", ("a", "b"), ends[::-1] if flipped else ends, 2.05, 0.0, Swing(room, hinge, 1.5))
    return shell(Plan((A, B), (opening,), "b"), 0).leaves[0]


def volume(mesh):
    t = triangles(mesh)
    return np.einsum("ij,ij->", t[:, 0], np.cross(t[:, 1], t[:, 2])) / 6


def test_boxes_face_outwards():
    mesh = box("b", (-1, 0, 2), (1, 3, 2.5))
    assert volume(mesh) == pytest.approx(3.0, rel=1e-6)
    assert volume(join_meshes("two", (mesh, box("c", (5, 5, 5), (6, 6, 6))))) == pytest.approx(4.0, rel=1e-6)


def test_inertia_of_a_split_box_is_that_of_the_whole():
    whole = box("w", (0, 0, 0), (1, 2, 3))
    halves = (box("l", (0, 0, 0), (1, 2, 1)), box("u", (0, 0, 1), (1, 2, 3)))
    one, two = solid_link("l", (), (whole,), 6.0), solid_link("l", (), halves, 6.0)
    assert np.allclose(one.com, two.com)
    assert np.allclose(one.inertia, two.inertia)
    assert np.allclose(np.diag(one.inertia), 6 / 12 * np.array([4 + 9, 1 + 9, 1 + 4]))


@pytest.mark.parametrize("flipped", [False, True])
@pytest.mark.parametrize("hinge", [0, 1])
@pytest.mark.parametrize("room", ["a", "b"])
def test_doors_open_into_their_room(room, hinge, flipped):
    made = leaf(room, hinge, flipped=flipped)
    asset, position, yaw = door(made, entrance=False)
    T = placement_transform(np.array([*position, 0.0]), yaw) @ joint_motion(asset.joints[0], 1.5)
    handle = next(m for m in asset.links[1].visuals if m.part)
    x = float((T[:3, :3] @ handle.vertices.mean(axis=0) + T[:3, 3])[0])
    assert (x > 4.5) if room == "b" else (x < 3.6)


@pytest.mark.parametrize("room", ["a", "b"])
def test_the_closed_leaf_is_the_outline_of_the_plan(room):
    made = leaf(room, 1)
    asset, position, yaw = door(made, entrance=True)
    T = placement_transform(np.array([*position, 0.0]), yaw)
    points = asset.links[1].visuals[0].vertices @ T[:3, :3].T + T[:3, 3]
    outline = made.outline()
    assert np.allclose(points.min(axis=0)[:2], outline.min(axis=0), atol=1e-6)
    assert np.allclose(points.max(axis=0)[:2], outline.max(axis=0), atol=1e-6)


def test_frames_stay_out_of_the_leafs_way():
    asset, _, _ = door(leaf("b", 0), entrance=False)
    panel = asset.links[1].colliders[0].vertices
    low, high = panel.min(axis=0), panel.max(axis=0)
    for piece in asset.links[0].colliders:
        apart = np.maximum(piece.vertices.min(axis=0) - high, low - piece.vertices.max(axis=0)).max()
        assert apart > 0.001


def test_windows_fill_their_hole():
    opening = Opening("w", "window", ("a",), np.array([[-0.12, 1.0], [-0.12, 2.6]]), 1.4, 0.9)
    cut = shell(Plan((A, B), (opening,), "b"), 0).cuts[0]
    asset, position, yaw = window(cut)
    points = np.concatenate([m.vertices for m in asset.meshes()]) @ placement_transform(np.array([*position, 0.0]), yaw)[:3, :3].T
    points[:, :2] += position
    assert np.allclose(points.min(axis=0), [-0.155, 1.0, 0.9], atol=1e-6)
    assert np.allclose(points.max(axis=0), [-0.085, 2.6, 2.3], atol=1e-6)


def test_posed_triangles_move_with_their_joint():
    asset, _, _ = door(leaf("b", 0), entrance=False)
    rest, materials = asset_triangles(asset)
    moved, _ = asset_triangles(asset, open_joint_values(asset, 1.0))
    still = sum(len(m.faces) for m in asset.links[0].visuals)
    assert len(rest) == len(materials) == len(moved)
    assert np.allclose(rest[:still], moved[:still])
    assert np.abs(rest[still:] - moved[still:]).max() > 0.5
