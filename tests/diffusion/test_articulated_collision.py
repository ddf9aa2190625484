import math

import numpy as np
import pytest
from shapely import Polygon
from shapely.affinity import rotate, translate

from pipeline import seeds
from pipeline.diffusion.articulated_collision import BODY, CLEARANCE, DEEP, SWEEP, Furniture, Obstacles, articulated_collision, descend
from pipeline.diffusion.batch import room_batch
from pipeline.diffusion.context import RoomContext, floor_tokens
from pipeline.diffusion.guidance import heuristic_sweeps, resized
from pipeline.geometry.kinematics import beyond_body
from tests.diffusion.small_world import make_context

HALL = np.array([[0, 0], [40, 0], [40, 40], [0, 40]], float)  # so large that nothing reaches its walls


def floor(*polygons):
    contexts = [RoomContext("bedroom", polygon) for polygon in polygons]
    return Obstacles.of(room_batch([floor_tokens(c) for c in contexts], [0] * len(contexts), [2.7] * len(contexts)))


def room(count=1):
    """The small world's room, with its door."""
    context = make_context(0)
    return context, Obstacles.of(room_batch([floor_tokens(context)] * count, [0] * count, [2.7] * count))


def bodies(rows, low=0.0, high=1.0):
    """Boxes (1, N, 8) of one room from rows (x, y, w, d, yaw)."""
    x, y, w, d, yaw = np.array(rows, float).T
    z, h = np.full_like(x, low), np.full_like(x, high - low)
    return np.stack([x, y, z, w, d, h, np.cos(yaw), np.sin(yaw)], -1)[None]


def all_of(boxes):
    return np.ones(boxes.shape[:2], bool)


def cost(depth):
    """Half the square of a depth, whose slope ends at DEEP."""
    return depth**2 / 2 if depth < DEEP else DEEP * (depth - DEEP / 2)


def depth_of(*rows, obstacles=None):
    """How deep two bodies are in each other, and what it costs, in a room without end."""
    boxes = bodies(rows)
    phi, _, deepest = articulated_collision(boxes, Furniture.of(all_of(boxes)), obstacles or floor(HALL))
    return float(deepest[0]), float(phi[0])


def drawn(x, y, w, d, yaw):
    box = Polygon([(-w / 2, -d / 2), (w / 2, -d / 2), (w / 2, d / 2), (-w / 2, d / 2)])
    return translate(rotate(box, yaw, origin=(0, 0), use_radians=True), x, y)


def test_an_overlap_has_the_zeros_of_the_true_intersection():
    rng = seeds.generator(0, "boxes")
    hits = 0
    for _ in range(300):
        a, b = ([*rng.uniform(-1, 1, 2), *rng.uniform(0.3, 1.5, 2), rng.uniform(-3, 3)] for _ in range(2))
        area = drawn(*a).intersection(drawn(*b)).area
        depth, phi = depth_of(a, b)
        assert (depth > 1e-9) == (area > 1e-9)
        assert phi == pytest.approx(cost(depth))
        assert depth == pytest.approx(depth_of(b, a)[0], abs=1e-9)
        hits += area > 0
    assert 50 < hits < 290


def test_the_depth_is_the_push_that_parts_them():
    assert depth_of((0, 0, 1, 1, 0), (0.7, 0.1, 1, 1, 0))[0] == pytest.approx(0.3)
    assert depth_of((0, 0, 1, 1, 0), (1.0001, 0.1, 1, 1, 0))[0] == 0


def test_things_above_each_other_do_not_overlap():
    low, high = bodies([(0, 0, 1, 1, 0)], high=0.8), bodies([(0, 0, 1, 1, 0)], low=0.8, high=2.0)
    boxes = np.concatenate([low, high], 1)
    assert articulated_collision(boxes, Furniture.of(all_of(boxes)), floor(HALL))[0] == 0


@pytest.mark.parametrize("seed", range(4))
def test_the_gradient_is_the_slope(seed):
    """Against differences, in rooms with doors, sweeps, empty slots and things that stick out of the walls."""
    rng = seeds.generator(seed, "slopes")
    _, obstacles = room(3)
    boxes = np.concatenate([bodies(rng.uniform([-2, -2, 0.3, 0.3, -3], [2, 2, 1.2, 1.2, 3], (6, 5))) for _ in range(3)])
    boxes[..., 6:] *= rng.uniform(0.5, 1.5, (3, 6, 1))  # yaws need not be unit
    sweeps = np.full((3, 6, 2, 2, 3), np.nan)
    sweeps[:, ::2, 1] = [[-0.3, -0.9, 0.1], [0.3, -0.2, 0.9]]
    furniture = Furniture.of(rng.random((3, 6)) < 0.8, sweeps, np.zeros((3, 6, 6), bool))
    _, gradient, _ = articulated_collision(boxes, furniture, obstacles)
    step, channels = 1e-6, [0, 1, 3, 4, 6, 7]
    for slot in range(6):
        for channel in channels:
            ahead, behind = boxes.copy(), boxes.copy()
            ahead[:, slot, channel] += step
            behind[:, slot, channel] -= step
            slope = (
                (articulated_collision(ahead, furniture, obstacles)[0] - articulated_collision(behind, furniture, obstacles)[0]) / 2 / step
            )
            if channel in {3, 4}:  # a sweep is its joint's: it keeps its size, and stands where the body does
                slope = np.where(furniture.occupied[:, slot], slope, 0.0)
            np.testing.assert_allclose(gradient[:, slot, channel], slope, atol=2e-5)
    assert np.abs(gradient[..., channels]).max() > 0.01
    assert np.abs(gradient[~furniture.occupied]).max() == 0


def test_outside_is_zero_inside_and_grows_beyond_the_wall():
    context, obstacles = room()
    half = (context.polygon.max(0) - context.polygon.min(0)) / 2
    beyond = [depth_of([half[0] - 0.5 + by, 0.0, 1.0, 1.0, 0.0], obstacles=obstacles) for by in (-0.1, 0.1, 0.3)]
    assert [depth for depth, _ in beyond] == pytest.approx([0, 0.1, 0.3], abs=1e-6)
    assert [phi for _, phi in beyond] == pytest.approx([0, *(BODY * 3 * by**2 / 2 for by in (0.1, 0.3))], abs=1e-6)


def test_outside_knows_the_notch_of_an_l_shaped_room():
    notched = floor(np.array([[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]], float))
    assert depth_of([-1, -1, 1.0, 1.0, 0.3], obstacles=notched)[0] == 0
    assert depth_of([1, 1, 1.0, 1.0, 0.3], obstacles=notched)[0] > 0


def test_a_leaf_keeps_its_quarter_disc_free_and_a_passage_a_strip():
    _, obstacles = room()
    assert obstacles.exist.sum() == 1
    box = 2 * obstacles.doorways[obstacles.exist][0, 2:4]
    assert box.tolist() == pytest.approx([0.85, 0.85], abs=1e-5)
    batch = room_batch([floor_tokens(make_context(0))], [0], [2.7])
    batch.hinge[:] = -1
    open_way = Obstacles.of(batch)
    assert 2 * open_way.doorways[open_way.exist][0, 3] == pytest.approx(CLEARANCE)


def test_the_heuristic_grows_a_third_of_the_depth_to_the_front():
    box = heuristic_sweeps(np.array([[[1.2, 0.6, 0.8]] * 2]), np.array([[True, False]]))
    assert box[0, 0, 0].ravel().tolist() == pytest.approx([-0.6, -0.5, 0, 0.6, 0.3, 0.8])
    assert np.isnan(box[0, 1]).all()


def test_a_joint_s_sweep_counts_although_the_bodies_are_apart():
    _, obstacles = room()
    boxes = bodies([[0, 0.4, 1.0, 0.5, 0.0], [0, -0.5, 0.8, 0.5, 0.0]])
    sweeps = np.full((1, 2, 1, 2, 3), np.nan)
    assert articulated_collision(boxes, Furniture.of(all_of(boxes), sweeps), obstacles)[0] == 0
    sweeps[0, 0, 0] = [[-0.5, -0.7, 0.1], [0.5, -0.25, 0.9]]  # a drawer that comes out at the front, -y
    assert articulated_collision(boxes, Furniture.of(all_of(boxes), sweeps), obstacles)[0] == pytest.approx(cost(0.05), rel=1e-3)
    turned = bodies([[0, 0.4, 1.0, 0.5, math.pi], [0, -0.5, 0.8, 0.5, 0.0]])
    assert articulated_collision(turned, Furniture.of(all_of(boxes), sweeps), obstacles)[0] == 0
    assert articulated_collision(boxes, Furniture.of(np.array([[True, False]]), sweeps), obstacles)[0] == 0


def test_the_penalty_is_the_sum_over_pairs():
    """Every pair counts once, whatever the order and the emptiness of slots, and rooms of a batch do not see each other."""
    rng = seeds.generator(3, "pairs")
    _, single = room()
    boxes = np.concatenate([bodies(r) for r in rng.uniform([-2, -2, 0.3, 0.3, -3], [2, 2, 1.2, 1.2, 3], (3, 6, 5))])
    occupied = rng.random((3, 6)) < 0.7
    sweep = np.array([[-0.3, -0.9, 0.1], [0.3, -0.2, 0.9]])
    sweeps = np.full((3, 6, 2, 2, 3), np.nan)
    sweeps[:, ::2, 1] = sweep
    together = articulated_collision(boxes, Furniture.of(occupied, sweeps), room(3)[1])[0]
    door = single.doorways[single.exist][0]
    doorway = (*door[:2], *(2 * door[2:4]), math.atan2(door[5], door[4]), *door[6:])
    for n in range(3):
        held = np.flatnonzero(occupied[n]).tolist()
        things = {i: (*boxes[n, i, [0, 1, 3, 4]], math.atan2(*boxes[n, i, [7, 6]]), 0.0, 1.0) for i in held}
        arms = {i: swept(things[i], sweep) for i in held if i % 2 == 0}
        pairs = [(things[i], things[j]) for i in held for j in held if i < j]
        pairs += [(arm, things[j]) for i, arm in arms.items() for j in held if i != j]
        pairs += [(p, doorway) for p in (*things.values(), *arms.values())]
        beyond = [(BODY, p) for p in things.values()] + [(SWEEP, p) for p in arms.values()]
        parted = sum(cost(alone(a, b)) for a, b in pairs) + sum(weight / BODY * lost(p, single) for weight, p in beyond)
        assert float(together[n]) == pytest.approx(parted, rel=1e-6, abs=1e-9)
    assert together.min() > 0


def swept(thing, sweep):
    """What a sweep's box is in the room of a thing (x, y, w, d, yaw, low, high)."""
    x, y, _, _, yaw, low, _ = thing
    (across, along, _), (w, d, _) = sweep.mean(0), sweep[1] - sweep[0]
    c, s = math.cos(yaw), math.sin(yaw)
    return x + c * across - s * along, y + s * across + c * along, w, d, yaw, low + sweep[0, 2], low + sweep[1, 2]


def alone(*things):
    """How deep two things are in each other, heights and all."""
    boxes = np.concatenate([bodies([t[:5]], *t[5:]) for t in things], 1)
    return float(articulated_collision(boxes, Furniture.of(all_of(boxes)), floor(HALL))[2][0])


def lost(thing, obstacles):
    """What it costs that a thing sticks out of its room, doors aside."""
    boxes = bodies([thing[:5]], *thing[5:])
    bare = Obstacles(obstacles.doorways, np.zeros_like(obstacles.exist), obstacles.walls, obstacles.bound)
    return float(articulated_collision(boxes, Furniture.of(all_of(boxes)), bare)[0][0])


def test_descending_lowers_the_penalty_where_the_printed_sign_climbs():
    _, obstacles = room()
    rng = seeds.generator(4, "clutter")
    fell = 0
    for _ in range(20):
        boxes = bodies(rng.uniform([-1.2, -1.2, 0.4, 0.4, -3], [1.2, 1.2, 1.0, 1.0, 3], (5, 5)))
        sweeps = np.full((1, 5, 1, 2, 3), np.nan)
        sweeps[0, 0, 0] = [[-0.3, -0.8, 0.1], [0.3, -0.2, 0.5]]
        furniture = Furniture.of(all_of(boxes), sweeps)
        start = articulated_collision(boxes, furniture, obstacles)[0]
        climbed = 1.1 * boxes - 0.1 * descend(boxes, furniture, obstacles, 1, 0.5, 0.1, 0.15)
        assert articulated_collision(climbed, furniture, obstacles)[0] >= start
        after = descend(boxes, furniture, obstacles, 24, 0.5, 0.1, 0.15)  # a push is DEEP long at most, so clutter takes its time
        assert np.array_equal(after[..., 2:6], boxes[..., 2:6])  # heights and sizes stay
        fell += articulated_collision(after, furniture, obstacles)[0] < 0.35 * start + 1e-9
    assert fell >= 18


def test_a_step_is_never_longer_than_its_clip():
    _, obstacles = room()
    boxes = bodies([(30.0, 30.0, 1.0, 1.0, 0.0)] * 3)  # far outside
    moved = descend(boxes, Furniture.of(all_of(boxes)), obstacles, 1, 0.5, 0.1, 0.15)
    assert np.hypot(*(moved - boxes)[0, :, :2].T).max() <= 0.15 + 1e-9


def test_a_new_size_keeps_the_back_where_it_is():
    yaw = 0.7
    boxes = np.array([[[0, 0, 0, 1.0, 0.6, 0.8, math.cos(yaw), math.sin(yaw)]]])
    after = resized(boxes, np.array([[[1.2, 0.5, 0.9]]]), np.ones((1, 1), bool))[0, 0]
    front = np.array([math.sin(yaw), -math.cos(yaw)])
    assert after[3:6].tolist() == [1.2, 0.5, 0.9]
    np.testing.assert_allclose(after[:2] - front * 0.25, -front * 0.3, atol=1e-12)


def test_units_of_a_run_are_in_nobodys_way():
    # Two units side by side; the left one's door, once open, has its handle 3 cm beyond its side, before its neighbour's front.
    _, obstacles = room()
    boxes = bodies([(-0.3, 0.0, 0.6, 0.6, 0.0), (0.3, 0.0, 0.6, 0.6, 0.0)])
    whole = np.array([[[-0.33, -0.9, 0.0], [0.33, -0.28, 0.9]]])
    for box, free in ((whole, False), (beyond_body(whole, np.array([0.6, 0.6, 0.9])), True)):
        sweeps = np.full((1, 2, 1, 2, 3), np.nan)
        sweeps[0, 0] = box
        assert (float(articulated_collision(boxes, Furniture.of(all_of(boxes), sweeps), obstacles)[0][0]) < 1e-12) == free


def descended(rows, tucked=None, steps=40):
    """Where bodies (x, y, w, d) of one room stand after some descents."""
    boxes = bodies([(*row, 0.0) for row in rows])
    return descend(boxes, Furniture.of(all_of(boxes), None, tucked), room()[1], steps, 0.5, 0.1, 0.15)[0, :, :2]


def test_an_overlap_is_not_shared_out_along_a_row():
    # Three units side by side, the right ones 20 cm into each other: those part, and the left pair stays as it is but for a hair.
    place = descended([(-0.6, 0.0, 0.6, 0.6), (0.0, 0.0, 0.6, 0.6), (0.4, 0.0, 0.6, 0.6)])
    assert place[2, 0] - place[1, 0] == pytest.approx(0.6, abs=0.01)
    assert place[1, 0] - place[0, 0] == pytest.approx(0.6, abs=0.01)
    in_one_step = descended([(0.0, 0.0, 0.6, 0.6), (0.4, 0.0, 0.6, 0.6)], steps=1)
    assert in_one_step[1, 0] - in_one_step[0, 0] == pytest.approx(0.4 + 2 * 0.5 * DEEP, abs=1e-4)


def test_chairs_may_stand_under_tables():
    rows = [(0.0, 0.0, 1.4, 0.8), (0.0, 0.5, 0.45, 0.5)]
    np.testing.assert_allclose(descended(rows, np.ones((1, 2, 2), bool)), np.array(rows)[:, :2], atol=1e-5)
    table, chair = descended(rows)[:, 1].tolist()
    assert chair - table == pytest.approx(0.65, abs=0.01)
