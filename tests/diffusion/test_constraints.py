import math

import numpy as np
import pytest
import torch
from shapely import Polygon
from shapely.affinity import rotate, translate

from pipeline import seeds
from pipeline.diffusion.batch import room_batch
from pipeline.diffusion.codec import Codec
from pipeline.diffusion.context import floor_tokens
from pipeline.diffusion.guidance import (
    DEEP,
    Prisms,
    articulated_collision,
    articulation_descent,
    bodies,
    doorways,
    heuristic_sweeps,
    outside,
    overlap,
    size_shift,
    swept,
)
from pipeline.diffusion.relations import Boxes, boxes_of
from pipeline.diffusion.settings import SampleSettings
from pipeline.geometry.kinematics import beyond_body
from tests.diffusion.small_world import make_context

FIELDS = ("centre", "half", "bottom", "height", "axis")


def prism(x, y, w, d, yaw=0.0, low=0.0, high=1.0):
    t = lambda *v: torch.tensor(v, dtype=torch.float64)  # noqa: E731
    return Prisms(t(x, y), t(w / 2, d / 2), t(math.cos(yaw), math.sin(yaw)), torch.tensor(low), torch.tensor(high))


def drawn(p):
    w, d = (2 * p.half).tolist()
    box = Polygon([(-w / 2, -d / 2), (w / 2, -d / 2), (w / 2, d / 2), (-w / 2, d / 2)])
    return translate(rotate(box, math.atan2(*p.axis.flip(0).tolist()), origin=(0, 0), use_radians=True), *p.centre.tolist())


def test_overlap_has_the_zeros_of_the_true_intersection():
    rng = seeds.generator(0, "boxes")
    hits = 0
    for _ in range(300):
        a, b = (prism(*rng.uniform(-1, 1, 2), *rng.uniform(0.3, 1.5, 2), rng.uniform(-3, 3)) for _ in range(2))
        area = drawn(a).intersection(drawn(b)).area
        depth = float(overlap(a, b))
        assert (depth > 1e-9) == (area > 1e-9)
        assert depth == pytest.approx(float(overlap(b, a)), abs=1e-9)
        hits += area > 0
    assert 50 < hits < 290


def test_the_depth_is_the_push_that_parts_them():
    a, b = prism(0, 0, 1, 1), prism(0.7, 0.1, 1, 1)
    assert float(overlap(a, b)) == pytest.approx(0.3)
    assert float(overlap(a, prism(1.0001, 0.1, 1, 1))) == 0


def test_things_above_each_other_do_not_overlap():
    assert float(overlap(prism(0, 0, 1, 1, high=0.8), prism(0, 0, 1, 1, low=0.8, high=2.0))) == 0


def room(n_target=None):
    context = make_context(0, n_target=n_target)
    return context, room_batch([floor_tokens(context)], [0], [2.7])


def body(rows):
    """Boxes of one room from rows (x, y, w, d, yaw)."""
    t = torch.tensor(rows, dtype=torch.float32)[None]
    return Boxes(
        t[..., :2],
        t[..., 2:4] / 2,
        torch.zeros_like(t[..., 0]),
        torch.ones_like(t[..., 0]),
        torch.stack([t[..., 4].cos(), t[..., 4].sin()], -1),
    )


def beyond_walls(row, rooms):
    return outside(Prisms(*(part[0] for part in bodies(body([row])))), rooms, torch.zeros(1, dtype=torch.long))


def test_outside_is_zero_inside_and_grows_beyond_the_wall():
    context, rooms = room()
    half = (context.polygon.max(0) - context.polygon.min(0)) / 2
    reach = [float(beyond_walls([half[0] - 0.5 + beyond, 0.0, 1.0, 1.0, 0.0], rooms)) for beyond in (-0.1, 0.1, 0.3)]
    assert reach[0] == 0
    assert 0 < reach[1] < reach[2]


def test_outside_knows_the_notch_of_an_l_shaped_room():
    from pipeline.diffusion.context import RoomContext

    polygon = np.array([[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]], float)
    rooms = room_batch([floor_tokens(RoomContext("bedroom", polygon))], [0], [2.7])
    assert float(beyond_walls([-1, -1, 1.0, 1.0, 0.3], rooms)) == 0
    assert float(beyond_walls([1, 1, 1.0, 1.0, 0.3], rooms)) > 0


def test_a_leaf_keeps_its_quarter_disc_free():
    _, rooms = room()
    prisms, there = doorways(rooms)
    assert int(there.sum()) == 1
    box = 2 * prisms.half[there][0]
    assert box.tolist() == pytest.approx([0.85, 0.85], abs=1e-5)


def test_the_heuristic_grows_a_third_of_the_depth_to_the_front():
    box = heuristic_sweeps(torch.tensor([[[1.2, 0.6, 0.8]] * 2]), torch.tensor([[True, False]]))
    assert box[0, 0, 0].flatten().tolist() == pytest.approx([-0.6, -0.5, 0, 0.6, 0.3, 0.8])
    assert torch.isnan(box[0, 1]).all()


def cost(depth):
    """Half the square of a depth, whose slope ends at DEEP."""
    return depth**2 / 2 if depth < DEEP else DEEP * (depth - DEEP / 2)


def test_a_joint_s_sweep_counts_although_the_bodies_are_apart():
    _, rooms = room()
    boxes, both = body([[0, 0.4, 1.0, 0.5, 0.0], [0, -0.5, 0.8, 0.5, 0.0]]), torch.ones(1, 2, dtype=torch.bool)
    sweeps = torch.full((1, 2, 1, 2, 3), torch.nan)
    assert float(articulated_collision(boxes, both, sweeps, rooms)) == 0
    sweeps[0, 0, 0] = torch.tensor([[-0.5, -0.7, 0.1], [0.5, -0.25, 0.9]])  # a drawer that comes out at the front, -y
    blocked = float(articulated_collision(boxes, both, sweeps, rooms))
    assert blocked == pytest.approx(cost(0.05), rel=1e-3)
    turned = body([[0, 0.4, 1.0, 0.5, math.pi], [0, -0.5, 0.8, 0.5, 0.0]])
    assert float(articulated_collision(turned, both, sweeps, rooms)) == 0
    assert float(articulated_collision(boxes, torch.tensor([[True, False]]), sweeps, rooms)) == 0


def test_the_penalty_is_the_sum_over_pairs():
    """Every pair counts once, whatever the order and the emptiness of slots, and rooms of a batch do not see each other."""
    rng = seeds.generator(3, "pairs")
    context, single = room()
    rooms = room_batch([floor_tokens(context)] * 3, [0] * 3, [2.7] * 3)
    rows = rng.uniform([-2, -2, 0.3, 0.3, -3], [2, 2, 1.2, 1.2, 3], (3, 6, 5))
    occupied = torch.from_numpy(rng.random((3, 6)) < 0.7)
    sweeps = torch.full((3, 6, 2, 2, 3), torch.nan)
    sweeps[:, ::2, 1] = torch.tensor([[-0.3, -0.9, 0.1], [0.3, -0.2, 0.9]])
    boxes = [body(r.tolist()) for r in rows]
    together = articulated_collision(Boxes(*(torch.cat([getattr(b, k) for b in boxes]) for k in FIELDS)), occupied, sweeps, rooms)
    doors = [Prisms(*(part[0, k] for part in doorways(single)[0])) for k in torch.nonzero(doorways(single)[1][0])[:, 0]]
    for n, box in enumerate(boxes):
        made = bodies(box)
        moving, real = swept(made, sweeps[n : n + 1])
        held = torch.nonzero(occupied[n])[:, 0].tolist()
        things = {i: Prisms(*(part[0, i] for part in made)) for i in held}
        arms = {(i, k): Prisms(*(part[0, i, k] for part in moving)) for i in held for k in range(2) if real[0, i, k]}
        depths = [overlap(things[i], things[j]) for i in held for j in held if i < j]
        depths += [overlap(arm, things[j]) for (i, _), arm in arms.items() for j in held if i != j]
        depths += [overlap(p, door) for p in (*things.values(), *arms.values()) for door in doors]
        beyond = [0.5 * _beyond(p, single) for p in things.values()] + [0.25 * _beyond(p, single) for p in arms.values()]
        assert float(together[n]) == pytest.approx(sum(cost(float(d)) for d in depths) + sum(beyond), rel=1e-5, abs=1e-6)
    assert together.min() > 0


def _beyond(prism, rooms):
    return float(outside(Prisms(*(part[None] for part in prism)), rooms, torch.zeros(1, dtype=torch.long)))


def test_descending_lowers_the_penalty_where_the_printed_sign_climbs(norm):
    codec, (_, rooms) = Codec(norm), room()
    settings = SampleSettings()
    rng = seeds.generator(4, "clutter")
    fell = 0
    for _ in range(20):
        metric = torch.zeros(1, 5, 40)
        metric[..., :2] = torch.from_numpy(rng.uniform(-1.2, 1.2, (1, 5, 2)))
        metric[..., 3:6] = torch.from_numpy(rng.uniform(0.4, 1.0, (1, 5, 3)))
        yaw = torch.from_numpy(rng.uniform(-3, 3, (1, 5)))
        metric[..., 6], metric[..., 7] = yaw.cos(), yaw.sin()
        occupied, classes = torch.ones(1, 5, dtype=torch.bool), torch.tensor([[0, 1, 2, 3, 4]])
        sweeps = torch.full((1, 5, 1, 2, 3), torch.nan)
        sweeps[0, 0, 0] = torch.tensor([[-0.3, -0.8, 0.1], [0.3, -0.2, 0.5]])

        def phi(x, occupied=occupied, classes=classes, sweeps=sweeps):
            return float(articulated_collision(boxes_of(codec.metric(x, classes)), occupied, sweeps, rooms))

        x = codec.normalise(metric, classes)
        start = phi(x)
        step = articulation_descent(codec, x, classes, sweeps, rooms, settings)
        climbed = x.clone()
        climbed[..., :8] -= 0.1 * step
        assert phi(climbed) >= start
        for _ in range(24):  # a push is DEEP long at most, so clutter takes its time
            x = x.clone()
            x[..., :8] += articulation_descent(codec, x, classes, sweeps, rooms, settings)
        assert torch.equal(x[..., 2:6], codec.normalise(metric, classes)[..., 2:6])  # heights and sizes stay
        fell += phi(x) < 0.35 * start + 1e-9
    assert fell >= 18


def test_a_step_is_never_longer_than_its_clip(norm):
    codec, (_, rooms) = Codec(norm), room()
    metric = torch.zeros(1, 3, 40)
    metric[..., :2] = 30.0  # far outside
    metric[..., 3:7] = 1.0
    classes = torch.zeros(1, 3, dtype=torch.long)
    step = articulation_descent(codec, codec.normalise(metric, classes), classes, None, rooms, SampleSettings(clip=0.15))
    assert float((step[..., :2] * codec.reach).norm(dim=-1).max()) <= 0.15 + 1e-5


def test_a_new_size_keeps_the_back_where_it_is(norm):
    codec = Codec(norm)
    metric = torch.zeros(1, 1, 40)
    metric[..., 3:6] = torch.tensor([1.0, 0.6, 0.8])
    yaw = 0.7
    metric[..., 6], metric[..., 7] = math.cos(yaw), math.sin(yaw)
    classes = torch.tensor([[1]])
    x = codec.normalise(metric, classes)
    moved = x.clone()
    moved[..., :6] += size_shift(codec, x, classes, torch.tensor([[[1.2, 0.5, 0.9]]]))
    after = codec.metric(moved, classes)
    front = torch.tensor([math.sin(yaw), -math.cos(yaw)])
    torch.testing.assert_close(after[0, 0, 3:6], torch.tensor([1.2, 0.5, 0.9]), atol=1e-5, rtol=0)
    torch.testing.assert_close(after[0, 0, :2] - front * 0.25, -front * 0.3, atol=1e-5, rtol=0)


def test_units_of_a_run_are_in_nobodys_way():
    # Two units side by side; the left one's door, once open, has its handle 3 cm beyond its side, before its neighbour's front.
    _, rooms = room()
    there = torch.ones(1, 2, dtype=torch.bool)
    boxes = body([(-0.3, 0.0, 0.6, 0.6, 0.0), (0.3, 0.0, 0.6, 0.6, 0.0)])
    whole = np.array([[[-0.33, -0.9, 0.0], [0.33, -0.28, 0.9]]])
    for box, free in ((whole, False), (beyond_body(whole, np.array([0.6, 0.6, 0.9])), True)):
        sweeps = torch.full((1, 2, 1, 2, 3), torch.nan)
        sweeps[0, 0] = torch.from_numpy(box)
        assert (float(articulated_collision(boxes, there, sweeps, rooms)) < 1e-12) == free


def descended(norm, rows, tucked=None, steps=40):
    """Where bodies (x, y, w, d, yaw) of one room stand after some descents."""
    codec, (_, rooms) = Codec(norm), room()
    metric = torch.zeros(1, len(rows), 40)
    metric[0, :, :2] = torch.tensor(rows)[:, :2]
    metric[0, :, 3:5] = torch.tensor(rows)[:, 2:4]
    metric[..., 5] = metric[..., 6] = 1.0
    classes = torch.zeros(1, len(rows), dtype=torch.long)
    x = codec.normalise(metric, classes)
    for _ in range(steps):
        x[..., :8] += articulation_descent(codec, x, classes, None, rooms, SampleSettings(), tucked)
    return codec.metric(x, classes)[0, :, :2]


def test_an_overlap_is_not_shared_out_along_a_row(norm):
    # Three units side by side, the right ones 20 cm into each other: those part, and the left pair stays as it is but for a hair.
    place = descended(norm, [(-0.6, 0.0, 0.6, 0.6), (0.0, 0.0, 0.6, 0.6), (0.4, 0.0, 0.6, 0.6)])
    assert float(place[2, 0] - place[1, 0]) == pytest.approx(0.6, abs=0.01)
    assert float(place[1, 0] - place[0, 0]) == pytest.approx(0.6, abs=0.01)
    in_one_step = descended(norm, [(0.0, 0.0, 0.6, 0.6), (0.4, 0.0, 0.6, 0.6)], steps=1)
    assert float(in_one_step[1, 0] - in_one_step[0, 0]) == pytest.approx(0.4 + 2 * 0.5 * DEEP, abs=1e-4)


def test_chairs_may_stand_under_tables(norm):
    rows = [(0.0, 0.0, 1.4, 0.8), (0.0, 0.5, 0.45, 0.5)]
    tucked = torch.ones(1, 2, 2, dtype=torch.bool)
    assert torch.allclose(descended(norm, rows, tucked), torch.tensor(rows)[:, :2], atol=1e-5)
    table, chair = descended(norm, rows)[:, 1].tolist()
    assert chair - table == pytest.approx(0.65, abs=0.01)
