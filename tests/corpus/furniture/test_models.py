"""Every model of the catalogue: closed convex pieces, exact size, hollow carcasses, joints where they belong."""

from collections import Counter
from functools import cache

import numpy as np
import pytest

from pipeline.corpus.furniture.assembly import build, mass_properties, shape_of
from pipeline.corpus.furniture.catalogue import catalogue
from pipeline.corpus.furniture.finishes import Finish
from pipeline.corpus.furniture.lines import LINES
from pipeline.corpus.furniture.shape import Mover, pieces
from pipeline.corpus.furniture.solids import box
from pipeline.entities.asset import PART_CLASSES

TOUCH = 5e-4  # how much two pieces may overlap [m]
DOORS = {"hinge_door", "hinge_lid"}


def models():
    made = catalogue(0)
    return (*made.future, *made.partnet)


@cache
def shapes():
    return [(m, shape_of(m)) for m in models()]


def moving():
    return [(m, s) for m, s in shapes() if m.partnet_category]


def rotation(axis, angle):
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def posed(mover: Mover, vertices, q):
    if mover.type == "prismatic":
        return vertices + q * np.array(mover.axis)
    origin = np.array(mover.origin)
    return (vertices - origin) @ rotation(mover.axis, q).T + origin


def distinct(vectors):
    a = np.array(vectors)
    length = np.linalg.norm(a, axis=1)
    a = a[length > 1e-12] / length[length > 1e-12, None]
    sign = np.sign(a[np.arange(len(a)), np.argmax(np.abs(a) > 1e-6, axis=1)])
    return np.unique(np.round(a * sign[:, None], 4), axis=0)


def directions(solid):
    """Distinct face normals and edge directions."""
    v, normals, edges = solid.vertices, [], []
    for face in solid.faces:
        p = v[list(face)]
        normals.append(np.cross(p, np.roll(p, -1, axis=0)).sum(axis=0))
        edges += list(np.roll(p, -1, axis=0) - p)
    return distinct(normals), distinct(edges)


def depth(a, axes_a, b, axes_b):
    """Penetration [m] of two convex point sets by the separating axis theorem; zero or less: apart."""
    crossed = np.cross(axes_a[1][:, None], axes_b[1][None]).reshape(-1, 3)
    axes = np.concatenate([axes_a[0], axes_b[0], crossed])
    length = np.linalg.norm(axes, axis=1)
    axes = axes[length > 1e-6] / length[length > 1e-6, None]
    pa, pb = a @ axes.T, b @ axes.T
    return float(-np.maximum(pa.min(0) - pb.max(0), pb.min(0) - pa.max(0)).max())


def penetrations(shape, steps=7):
    """Move each joint through its range, the others at rest; yield (mover, other, depth) where they enter each other."""
    solids = [("base", p.name, p.solid) for p in shape.base]
    solids += [(m.name, p.name, p.solid) for m in shape.movers for p in m.pieces]
    low = np.array([s.vertices.min(0) for *_, s in solids]) + TOUCH
    high = np.array([s.vertices.max(0) for *_, s in solids]) - TOUCH
    axes_of = cache(lambda k: directions(solids[k][2]))
    for mover in shape.movers:
        others = np.array([owner != mover.name for owner, *_ in solids])
        for i in np.flatnonzero(~others):
            for q in np.linspace(mover.lower, mover.upper, steps):
                v = posed(mover, solids[i][2].vertices, q)
                for k in np.flatnonzero(others & (low < v.max(0)).all(1) & (high > v.min(0)).all(1)):
                    turn = np.eye(3) if mover.type == "prismatic" else rotation(mover.axis, q)
                    axes = tuple(a @ turn.T for a in axes_of(i))
                    d = depth(v, axes, solids[k][2].vertices, axes_of(k))
                    if d > TOUCH:
                        yield mover.name, f"{solids[k][0]}:{solids[k][1]}", d


def test_pieces_are_closed_convex_and_turned_outwards():
    for model, shape in shapes():
        for piece in shape.pieces():
            v, tri = piece.solid.vertices, piece.solid.triangles()
            start, end = tri.ravel().astype(np.int64), np.roll(tri, -1, axis=1).ravel().astype(np.int64)
            forth, back = np.sort(start * len(v) + end), np.sort(end * len(v) + start)
            assert np.array_equal(forth, back), (model, piece.name)
            assert (np.diff(forth) > 0).all(), (model, piece.name)
            a, b, c = (v[tri[:, k]] for k in range(3))
            n = np.cross(b - a, c - a)
            length = np.linalg.norm(n, axis=1, keepdims=True)
            assert (length > 1e-12).all(), (model, piece.name)
            assert (v @ (n / length).T - np.einsum("ij,ij->i", a, n / length)).max() < 3e-4, (model, piece.name)


def test_boxes_are_the_catalogues_sizes():
    for model, shape in shapes():
        low, high = shape.bounds()
        assert np.allclose(high - low, model.size, atol=1e-9), model
        assert np.allclose([low[0] + high[0], low[1] + high[1], low[2]], 0, atol=1e-9), model


def test_triangle_budget():
    counts = [sum(len(p.solid.triangles()) for p in s.pieces()) for _, s in shapes()]
    assert np.median(counts) <= 3000
    assert max(counts) <= 12000


def test_nothing_enters_anything_at_any_joint_position():
    """A seat under a closed lid is lifted with it: the one case in which a mover meets another mover."""
    for model, shape in moving():
        for mover, other, how_deep in penetrations(shape):
            assert (mover, other) == ("seat", "lid:lid"), (model, mover, other, how_deep)


def test_the_sweep_finds_what_is_wrong():
    wood = Finish("wood", (0.5, 0.4, 0.3))
    from pipeline.corpus.furniture.fronts import FrontStyle, Rect, door
    from pipeline.corpus.furniture.shape import Shape

    leaf = door("door", Rect((0.0, 0.5), (0.0, 1.0), 0.0), FrontStyle("slab", "none", wood, wood), "left", 1.8)
    clear = Shape(pieces("side", box((-0.02, 0.5), (0.025, 0.3), (0, 1)), wood), (leaf,))
    blocked = Shape(pieces("side", box((-0.02, 0.05), (-0.3, -0.01), (0, 1)), wood), (leaf,))
    assert not list(penetrations(clear))
    assert list(penetrations(blocked))


def test_hinges_lie_on_an_edge_and_open_outwards():
    for model, shape in moving():
        for mover in shape.movers:
            if mover.part_class not in DOORS:
                continue
            points = np.concatenate([p.solid.vertices for p in mover.pieces if not p.part])
            low, high = points.min(axis=0), points.max(axis=0)
            across = [k for k in range(3) if abs(mover.axis[k]) < 0.5]
            gaps = [min(abs(mover.origin[k] - low[k]), abs(mover.origin[k] - high[k])) for k in across]
            assert max(gaps) < 0.009, (model, mover.name, gaps)
            middle = (low + high) / 2
            moved = posed(mover, middle[None], mover.upper)[0] - middle
            assert np.dot(moved, mover.outward) > 0.2 * np.linalg.norm(moved), (model, mover.name)
            assert 0.8 < mover.upper < 1.9


def test_drawers_are_boxes_that_stay_in_their_carcass():
    seen = 0
    for model, shape in moving():
        base = np.stack([p.solid.bounds() for p in shape.base])
        low, high = base[:, 0].min(axis=0), base[:, 1].max(axis=0)
        for mover in shape.movers:
            if mover.part_class != "slider_drawer":
                continue
            seen += 1
            walls = [p for p in mover.pieces if p.name.endswith("drawer_box")]
            assert len(walls) == 5, (model, mover.name)
            bounds = np.stack([p.solid.bounds() for p in walls])
            inner_low, inner_high = bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)
            assert (inner_low[[0, 2]] > low[[0, 2]]).all(), (model, mover.name)
            assert (inner_high[[0, 2]] < high[[0, 2]]).all(), (model, mover.name)
            length = inner_high[1] - inner_low[1]
            assert 0.4 * length < mover.upper < 0.95 * length, (model, mover.name)
            volume = np.prod(inner_high - inner_low)
            assert sum(np.prod(b[1] - b[0]) for b in bounds) < 0.7 * volume, (model, mover.name)
    assert seen > 100


def test_carcasses_are_hollow():
    for model, shape in moving():
        if model.partnet_category == "StorageFurniture":
            solid = sum(np.prod(p.solid.bounds()[1] - p.solid.bounds()[0]) for p in shape.base if not p.name.startswith("book"))
            assert solid < 0.6 * np.prod(model.size), model


def test_part_classes():
    classes = Counter(m.part_class for _, s in moving() for m in s.movers)
    classes += Counter({(m.name, p.name): p.part for _, s in moving() for m in s.movers for p in m.pieces if p.part}.values())
    assert set(classes) == set(PART_CLASSES) - {"other"}


def test_every_form_is_built():
    assert {(m.category, m.form) for m in models()} == {(c, f.name) for c, line in LINES.items() for f in line.forms}


def test_static_models_do_not_move():
    assert all(not s.movers for m, s in shapes() if not m.partnet_category)
    assert all(s.movers for _, s in moving())


def test_assets():
    for model in models()[::9]:
        asset = model.build()
        assert np.allclose(asset.size, model.size)
        points = np.concatenate([m.vertices for m in asset.meshes()])
        assert np.allclose(np.ptp(points, axis=0), model.size, atol=1e-5)
        assert asset.articulated == model.articulated
        for link in asset.links:
            assert link.mass > 0
            assert (np.linalg.eigvalsh(link.inertia) > 0).all()
        total = sum(link.mass for link in asset.links)
        assert 0.3 < total < 700, (model, total)


def test_mass_of_a_block():
    block = pieces("block", box((1, 3), (0, 1), (0, 1)), Finish("x", (0, 0, 0), density=500))
    mass, com, inertia = mass_properties(block)
    assert mass == pytest.approx(1000)
    assert np.allclose(com, (2, 0.5, 0.5))
    assert np.allclose(inertia, np.diag([1000 / 12 * 2, 1000 / 12 * 5, 1000 / 12 * 5]))


def test_building_twice_gives_the_same():
    for model in models()[::25]:
        shape_of.cache_clear()
        first = build(model)
        shape_of.cache_clear()
        second = build(model)
        assert all(np.array_equal(a.vertices, b.vertices) for a, b in zip(first.meshes(), second.meshes(), strict=True))
        assert first.materials == second.materials
