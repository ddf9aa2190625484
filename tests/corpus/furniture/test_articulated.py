"""Every form of the articulated library at three seeds: nothing enters anything, hinges on edges, drawers inside, part classes."""

import math
from collections import Counter
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from pipeline.corpus.furniture.assembly import shape_of
from pipeline.corpus.furniture.catalogue import catalogue
from pipeline.corpus.furniture.finishes import Finish
from pipeline.corpus.furniture.fronts import FrontStyle, Rect, door
from pipeline.corpus.furniture.lines import LINES
from pipeline.corpus.furniture.shape import Mover, Shape, colliders, pieces
from pipeline.corpus.furniture.solids import box
from pipeline.entities.asset import PART_CLASSES

TOUCH = 5e-4  # how much two pieces may overlap [m]
STEPS = 13
# GAPartNet's categories, of PartNet-Mobility and of AKB-48.
GAPARTNET = {
    *("StorageFurniture", "Table", "Toilet", "TrashCan", "Remote", "Laptop", "CoffeeMachine", "Dishwasher", "Refrigerator"),
    *("Camera", "Bucket", "Keyboard", "Safe", "Printer", "Box", "Oven", "KitchenPot", "Toaster", "WashingMachine"),
    *("Microwave", "Phone", "Door", "Suitcase", "Drawer"),
}
WOOD = Finish("wood", (0.5, 0.4, 0.3))


@cache
def samples():
    """One model of every form at each of three seeds."""
    found = []
    for seed in (0, 1, 2):
        by_form = {}
        for model in catalogue(seed).partnet:
            by_form.setdefault((model.category, model.form), model)
        found += [(model, shape_of(model)) for model in by_form.values()]
    return found


def transform(mover: Mover, q):
    T = np.eye(4)
    if mover.type == "prismatic":
        T[:3, 3] = q * np.array(mover.axis)
        return T
    x, y, z = mover.axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    T[:3, :3] = np.eye(3) + np.sin(q) * K + (1 - np.cos(q)) * K @ K
    T[:3, 3] = np.array(mover.origin) - T[:3, :3] @ np.array(mover.origin)
    return T


def poses(shape: Shape, positions):
    """Transforms of all bodies, the base first, with movers at `positions` {name: q}."""
    T = {"base": np.eye(4)}
    for mover in shape.movers:
        T[mover.name] = T[mover.parent] @ transform(mover, positions.get(mover.name, 0.0))
    return T


def unique_directions(vectors):
    length = np.linalg.norm(vectors, axis=1)
    a = vectors[length > 1e-9] / length[length > 1e-9, None]
    sign = np.sign(a[np.arange(len(a)), np.argmax(np.abs(a) > 1e-6, axis=1)])
    return np.unique(np.round(a * sign[:, None], 4), axis=0)


def directions(solid):
    """Distinct face normals and edge directions of a convex solid."""
    tri = solid.vertices[solid.triangles()]
    normals = np.cross(tri[:, 1] - tri[:, 0], tri[:, 2] - tri[:, 0])
    edges = np.concatenate([np.roll(solid.vertices[list(f)], -1, axis=0) - solid.vertices[list(f)] for f in solid.faces])
    return unique_directions(normals), unique_directions(edges)


def apart(a, b, axes, limit):
    """Whether convex point sets enter each other by no more than `limit` along one of the axes."""
    pa, pb = a @ axes.T, b @ axes.T
    return bool((np.minimum(pa.max(0), pb.max(0)) - np.maximum(pa.min(0), pb.min(0))).min() <= limit)


def collisions(shape: Shape, steps=STEPS):
    """Move each joint through its range, those it waits for open, the others closed; yield (mover, other) that meet."""
    bodies = [("base", s) for s in colliders(shape.base)] + [(m.name, s) for m in shape.movers for s in colliders(m.pieces)]
    owner = np.array([name for name, _ in bodies])
    axes_of = cache(lambda k: directions(bodies[k][1]))
    upper = {m.name: m.upper for m in shape.movers}
    hangs = {m.name: {m.name} for m in shape.movers}
    for m in reversed(shape.movers):
        if m.parent != "base":
            hangs[m.parent] |= hangs[m.name]
    for mover in shape.movers:
        moving = np.isin(owner, sorted(hangs[mover.name]))
        for q in np.linspace(mover.lower, mover.upper, steps):
            T = poses(shape, {name: upper[name] for name in mover.after} | {mover.name: q})
            points = [s.vertices @ T[name][:3, :3].T + T[name][:3, 3] for name, s in bodies]
            low, high = np.array([p.min(0) for p in points]) + TOUCH, np.array([p.max(0) for p in points])
            for i in np.flatnonzero(moving):
                for k in np.flatnonzero(~moving & (low < high[i]).all(1) & (high > low[i]).all(1)):
                    (normals_i, edges_i), (normals_k, edges_k) = axes_of(i), axes_of(k)
                    turn_i, turn_k = T[owner[i]][:3, :3].T, T[owner[k]][:3, :3].T
                    faces = np.concatenate([normals_i @ turn_i, normals_k @ turn_k])
                    if apart(points[i], points[k], faces, TOUCH):
                        continue
                    crossed = np.cross((edges_i @ turn_i)[:, None], (edges_k @ turn_k)[None]).reshape(-1, 3)
                    length = np.linalg.norm(crossed, axis=1)
                    crossed = crossed[length > 1e-6] / length[length > 1e-6, None]
                    if not len(crossed) or not apart(points[i], points[k], crossed, TOUCH):
                        yield mover.name, str(owner[k]), round(float(q), 3)


def test_nothing_enters_anything_at_any_joint_position():
    for model, shape in samples():
        met = next(collisions(shape), None)
        assert met is None, (model.category, model.form, model.style, model.seed, met)


def test_the_sweep_finds_what_is_wrong():
    leaf = door("door", Rect((0.0, 0.5), (0.0, 1.0), 0.0), FrontStyle("slab", "none", WOOD, WOOD), "left", 1.8)
    clear = Shape(pieces("side", box((-0.02, 0.5), (0.025, 0.3), (0, 1)), WOOD), (leaf,))
    blocked = Shape(pieces("side", box((-0.02, 0.05), (-0.3, -0.01), (0, 1)), WOOD), (leaf,))
    behind = replace(
        leaf,
        name="rack",
        type="prismatic",
        axis=(0, -1, 0),
        upper=0.2,
        pieces=pieces("rack", box((0.1, 0.4), (0.03, 0.1), (0.2, 0.4)), WOOD),
    )
    assert not list(collisions(clear))
    assert list(collisions(blocked))
    assert list(collisions(Shape((), (leaf, behind))))
    assert not list(collisions(Shape((), (leaf, replace(behind, after=("door",))))))


def test_what_waits_waits_for_something():
    for _, shape in samples():
        names = {m.name for m in shape.movers}
        assert all(set(m.after) <= names - {m.name} for m in shape.movers)


def test_hinges_lie_on_an_edge_and_open_outwards():
    for model, shape in samples():
        for mover in shape.movers:
            if mover.part_class not in {"hinge_door", "hinge_lid"}:
                continue
            points = np.concatenate([p.solid.vertices for p in mover.pieces if not p.part])
            low, high = points.min(axis=0), points.max(axis=0)
            across = [k for k in range(3) if abs(mover.axis[k]) < 0.5]
            gaps = [min(abs(mover.origin[k] - low[k]), abs(mover.origin[k] - high[k])) for k in across]
            assert max(gaps) < 0.012, (model, mover.name, gaps)
            middle = (low + high) / 2
            T = transform(mover, min(mover.upper, math.pi / 2))
            moved = T[:3, :3] @ middle + T[:3, 3] - middle
            assert np.dot(moved, mover.outward) > 0.2 * np.linalg.norm(moved), (model, mover.name)
            assert 0.6 < mover.upper < 2.6


def test_drawers_are_open_boxes_that_stay_in_their_carcass():
    seen = 0
    for model, shape in samples():
        base = np.stack([p.solid.bounds() for p in shape.base])
        low, high = base[:, 0].min(axis=0), base[:, 1].max(axis=0)
        for mover in shape.movers:
            walls = [p for p in mover.pieces if p.name.endswith("drawer_box")]
            if mover.part_class != "slider_drawer" or not walls:
                continue
            seen += 1
            assert len(walls) == 4, (model, mover.name)
            bounds = np.stack([p.solid.bounds() for p in walls])
            inner_low, inner_high = bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)
            assert (inner_low[[0, 2]] > low[[0, 2]]).all(), (model, mover.name)
            assert (inner_high[[0, 2]] < high[[0, 2]]).all(), (model, mover.name)
            length = inner_high[1] - inner_low[1]
            assert 0.4 * length < mover.upper < 0.95 * length, (model, mover.name)
            assert sum(np.prod(b[1] - b[0]) for b in bounds) < 0.75 * np.prod(inner_high - inner_low), (model, mover.name)
    assert seen > 100


def test_part_classes():
    classes = Counter()
    for model, shape in samples():
        for mover in shape.movers:
            assert mover.part_class in PART_CLASSES[:9], (model, mover.name)
            classes[mover.part_class] += 1
            classes.update({p.name: p.part for p in mover.pieces if p.part}.values())
    assert set(classes) == set(PART_CLASSES[:9])


def test_every_form_is_sampled():
    want = {(c, f.name) for c, line in LINES.items() if line.moving for f in line.forms if not f.still}
    missing = want - {(m.category, m.form) for m, _ in samples()}
    assert not missing


def test_gravity_keeps_level_hinges_shut():
    """A door on its lower edge leans against its carcass, a lid lies: they need no drive or friction at rest.

    What hangs from its upper edge would come to rest a degree open; the joint's drive holds that.
    """
    for model, shape in samples():
        for mover in shape.movers:
            if mover.part_class in {"hinge_door", "hinge_lid"} and abs(mover.axis[2]) < 0.5:
                mass, moment = 0.0, np.zeros(3)
                for piece in mover.pieces:
                    weight = piece.solid.volume() * piece.finish.density
                    mass, moment = mass + weight, moment + weight * piece.solid.vertices.mean(axis=0)
                arm = moment / mass - np.array(mover.origin)
                torque = np.cross(arm, [0, 0, -9.81 * mass]) @ np.array(mover.axis)
                hangs = arm[2] < -0.4 * np.ptp(np.concatenate([p.solid.vertices[:, 2] for p in mover.pieces]))
                assert torque < 0 or hangs, (model, mover.name, torque)


def test_the_library_is_large_enough():
    made = catalogue(0)
    assert len(made.partnet) >= 350
    assert {m.partnet_category for m in made.partnet} >= GAPARTNET


def test_few_colliders():
    counts = [len(colliders(s.base)) + sum(len(colliders(m.pieces)) for m in s.movers) for _, s in samples()]
    assert np.median(counts) <= 20
    assert max(counts) <= 96


def test_triangle_budget():
    counts = [sum(len(p.solid.triangles()) for p in s.pieces()) for _, s in samples()]
    assert np.median(counts) <= 3000


@pytest.mark.parametrize("form", ["drawers", "doors"])
def test_boards_are_thick_enough_to_collide(form):
    for model, shape in samples():
        if model.category in {"cabinet", "nightstand", "wardrobe", "sideboard"} and form in model.form:
            for solid in colliders(p for p in shape.base if "foot" not in p.name):
                assert np.ptp(solid.vertices, axis=0).min() > 0.0065, model
