import math

import numpy as np
import pytest

from pipeline.entities.asset import Joint
from pipeline.geometry import kinematics
from pipeline.geometry.prisms import CORNERS, prism, solid
from tests.geometry.furniture import asset, box, chest, cupboard, link, table


def test_a_drawer_slides_out_of_its_front():
    made = chest()
    T = kinematics.link_transforms(made, np.array([0.3]))
    assert np.allclose(T[0], np.eye(4))
    assert np.allclose(T[1, :3, 3], [0, -0.3, 0])
    assert np.allclose(kinematics.sweep_box(made, 0), [[-0.4, -0.25 - 0.03 - 0.4, 0.1], [0.4, -0.23, 0.8]], atol=1e-6)


def test_a_door_turns_about_its_edge():
    made = cupboard()
    T = kinematics.link_transforms(made, np.array([math.pi / 2]))[1]
    free_edge = T @ np.array([0.3, -0.25, 1.0, 1.0])
    assert np.allclose(free_edge[:3], [-0.3, -0.25 - 0.6, 1.0])  # straight ahead of the hinge
    low, high = kinematics.sweep_box(made, 0)
    assert low[1] == pytest.approx(-0.25 - 0.6, abs=0.01)
    assert high[0] == pytest.approx(0.3, abs=0.01)


def test_links_hang_on_their_parents():
    base, door, knob = (link(n, box((0, 0, 0), (1, 1, 1))) for n in ("base", "door", "knob"))
    joints = [
        Joint("door", "revolute", 0, 1, np.array([0, 0, 1.0]), np.zeros(3), 0, 2, "hinge_door"),
        Joint("knob", "prismatic", 1, 2, np.array([1.0, 0, 0]), np.zeros(3), 0, 1, "slider_button"),
    ]
    made = asset("a", "cabinet", (1, 1, 1), [base, door, knob], joints)
    T = kinematics.link_transforms(made, np.array([math.pi / 2, 0.5]))
    assert np.allclose(T[2] @ [0, 0, 0, 1], [0, 0.5, 0, 1])
    assert kinematics.moved_links(made, 0) == [1, 2]
    assert kinematics.moved_links(made, 1) == [2]


@pytest.mark.parametrize("made", [chest(), cupboard()])
def test_the_sweep_box_holds_every_position(made):
    low, high = kinematics.sweep_box(made, 0, steps=4)
    points = np.concatenate([m.vertices for m in made.links[1].colliders])
    for q in np.linspace(0, made.joints[0].upper, 40):
        moved = (
            points @ kinematics.link_transforms(made, np.array([q]))[1][:3, :3].T
            + kinematics.link_transforms(made, np.array([q]))[1][:3, 3]
        )
        assert np.all(moved >= low - 1e-6)
        assert np.all(moved <= high + 1e-6)


def test_handles_and_where_they_set_off():
    assert np.allclose(kinematics.handle_point(chest(), 0), [0, -0.265, 0.46], atol=1e-6)
    assert np.allclose(kinematics.opening_direction(chest(), 0), [0, -1, 0])
    far = kinematics.handle_point(cupboard(), 0)
    assert far[0] == pytest.approx(0.3)
    direction = kinematics.opening_direction(cupboard(), 0)
    assert direction[1] < -0.99


def test_rest_prisms_of_boxes_are_exact():
    made = solid(table())
    assert len(made.rest) == 5
    assert np.array_equal(np.unique(made.rest.count), [4])
    assert made.rest.z[0] == pytest.approx([0.71, 0.75], abs=1e-6)


def test_round_things_are_covered():
    angles = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    ring = np.stack([np.cos(angles), np.sin(angles)], 1)
    made = prism(np.concatenate([np.column_stack([ring, np.full(40, z)]) for z in (0, 1)]))
    assert made.count[0] == CORNERS
    polygon = made.polygon(0)
    edges = np.roll(polygon, -1, 0) - polygon
    inward = (ring[:, None] - polygon)[..., 1] * edges[:, 0] - (ring[:, None] - polygon)[..., 0] * edges[:, 1]
    assert inward.min() > -1e-6
    assert np.linalg.norm(polygon, axis=1).max() < 1.1


@pytest.mark.parametrize("made", [chest(), cupboard()])
def test_sweep_prisms_hold_the_moving_part_between_the_steps(made):
    sweep = solid(made).sweeps[0]
    points = np.concatenate([m.vertices for m in made.links[1].colliders]).astype(float)
    for q in np.linspace(0.001, made.joints[0].upper, 57):
        step = int(np.searchsorted(sweep.reached, q - 1e-12))
        T = kinematics.link_transforms(made, np.array([q]))[1]
        moved = (points @ T[:3, :3].T + T[:3, 3])[:, :2]
        own = [sweep.prisms.polygon(int(i)) for i in np.flatnonzero(sweep.prisms.part == step)]
        excess = [min(_beyond(p, polygon) for polygon in own) for p in moved]
        assert max(excess) < 0.0025  # what the arc bulges


def _beyond(point, polygon):
    edges = np.roll(polygon, -1, 0) - polygon
    normal = np.stack([edges[:, 1], -edges[:, 0]], 1) / np.linalg.norm(edges, axis=1)[:, None]
    return float(((point - polygon) * normal).sum(1).max())
