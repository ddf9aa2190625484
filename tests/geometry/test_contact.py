import numpy as np
import shapely

from pipeline.geometry.contact import first_hits, group_boxes, pair_depths, wall_excesses
from pipeline.geometry.prisms import join_prisms, prism


def random_prisms(seed, n=60):
    rng = np.random.default_rng(seed)
    made = []
    for _ in range(n):
        points = rng.normal(size=(int(rng.integers(4, 20)), 3)) * [0.3, 0.3, 0.2] + rng.uniform(-0.8, 0.8, 3)
        made.append(prism(points))
    return join_prisms(made)


def truth(a, b):
    """Which prisms of two sets share volume, by shapely."""
    pa = [shapely.Polygon(a.polygon(i)) for i in range(len(a))]
    pb = [shapely.Polygon(b.polygon(i)) for i in range(len(b))]
    flat = np.array([[shapely.area(shapely.intersection(p, q)) > 0 for q in pb] for p in pa])
    high = np.minimum(a.z[:, None, 1], b.z[None, :, 1]) > np.maximum(a.z[:, None, 0], b.z[None, :, 0])
    return flat & high


def test_depths_are_positive_just_where_prisms_share_volume():
    prisms = random_prisms(0)
    start = np.arange(len(prisms) + 1)
    depths = pair_depths(prisms.corners, prisms.count, prisms.z, prisms.boxes(), start, group_boxes(prisms, start), 0.0)
    wanted = truth(prisms, prisms)
    np.fill_diagonal(wanted, val=False)
    assert np.array_equal(depths > 0, wanted)
    assert np.array_equal(depths, depths.T)


def test_groups_touch_when_any_of_their_prisms_do():
    prisms = random_prisms(1)
    start = np.array([0, 10, 10, 35, 60])  # the second group is empty
    depths = pair_depths(prisms.corners, prisms.count, prisms.z, prisms.boxes(), start, group_boxes(prisms, start), 0.0)
    wanted = truth(prisms, prisms)
    for g in range(4):
        for h in range(4):
            if g != h:
                assert (depths[g, h] > 0) == wanted[start[g] : start[g + 1], start[h] : start[h + 1]].any()


def test_first_hits_are_hits_and_leave_the_owner_out():
    moving, others = random_prisms(2, 30), random_prisms(3)
    start = np.arange(0, 61, 5)
    boxes = group_boxes(others, start)
    wanted = truth(moving, others).reshape(30, 12, 5).any(2)
    for owner in (-1, 4):
        owners = np.full(30, owner)
        hits = first_hits(
            moving.corners,
            moving.count,
            moving.z,
            moving.boxes(),
            owners,
            others.corners,
            others.count,
            others.z,
            others.boxes(),
            start,
            boxes,
            0.0,
        )
        expected = wanted.copy()
        if owner >= 0:
            expected[:, owner] = False
        assert np.array_equal(hits >= 0, expected.any(1))
        assert all(expected[i, h] for i, h in enumerate(hits) if h >= 0)


def test_a_tolerance_forgives_shallow_contact():
    a = prism(np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float))
    for shift, touching in ((0.997, False), (0.99, True)):
        both = join_prisms([a, a.placed(np.array([shift, 0.0, 0.0]), 0.0, np.ones(3))])
        start = np.arange(3)
        depths = pair_depths(both.corners, both.count, both.z, both.boxes(), start, group_boxes(both, start), 0.005)
        assert (depths[0, 1] > 0) == touching


def test_walls():
    room = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    a = prism(np.array([[x, y, z] for x in (1.5, 2.25) for y in (1, 1.5) for z in (0, 1)]))
    assert np.allclose(wall_excesses(a.corners, a.count, room), 0.25)
