"""Every form of the articulated library at three seeds: nothing enters anything, hinges on edges, drawers inside, part classes."""

import math
import sys
from collections import Counter
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent))
from sweep import collisions, transform

from pipeline.corpus.furniture.assembly import shape_of
from pipeline.corpus.furniture.catalogue import catalogue, corpus_cards
from pipeline.corpus.furniture.finishes import Finish
from pipeline.corpus.furniture.fronts import FrontStyle, Rect, door
from pipeline.corpus.furniture.shape import Shape, colliders, pieces
from pipeline.corpus.furniture.solids import box
from pipeline.entities.asset import PART_CLASSES

# GAPartNet's categories, of PartNet-Mobility and of AKB-48, without those that no home holds (suitcases, safes, buckets, chests of drawers for a desk).
GAPARTNET = {
    *("StorageFurniture", "Table", "Toilet", "TrashCan", "Remote", "Laptop", "CoffeeMachine", "Dishwasher", "Refrigerator"),
    *("Camera", "Keyboard", "Printer", "Box", "Oven", "KitchenPot", "Toaster", "WashingMachine"),
    *("Microwave", "Phone", "Door"),
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
    want = {(c, name) for c, card in corpus_cards().items() if card.moving for name, form in card.forms.items() if not form.still}
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
    assert np.median(counts) <= 21
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
