"""Small things stand: whatever lies about must rest on what bears it, in any engine."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull, QhullError

from pipeline.card import cards
from pipeline.corpus.furniture.assembly import shape_of
from pipeline.corpus.furniture.catalogue import catalogue
from pipeline.corpus.furniture.finishes import Finish
from pipeline.corpus.furniture.shape import Shape, pieces
from pipeline.corpus.furniture.solids import box

SOLE = 2e-3  # what is so near to the lowest point bears [m]: a telephone lies on its camera and an edge
LEAST = 4.0  # [degrees] by which a thing may be tilted before it tips


def steadiness(shape):
    """Return by how much [degrees] a shape can be tilted before its centre of mass is past what it stands on."""
    points = np.concatenate([p.solid.vertices for p in shape.pieces()])
    hulls = [ConvexHull(p.solid.vertices) for p in shape.pieces()]
    mass = np.array([h.volume * p.finish.density for h, p in zip(hulls, shape.pieces(), strict=True)])
    middle = np.array([p.solid.vertices.mean(axis=0) for p in shape.pieces()])
    centre = (mass[:, None] * middle).sum(axis=0) / mass.sum()
    floor = points[:, 2].min()
    try:
        sole = ConvexHull(points[points[:, 2] < floor + SOLE, :2])
    except (QhullError, ValueError):
        return 0.0
    inside = -(sole.equations[:, :2] @ centre[:2] + sole.equations[:, 2]).max()
    return np.degrees(np.arctan2(inside, centre[2] - floor))


def lying():
    """One model of every form of what lies about; what is soft lies flat anyway."""
    found = {}
    made = catalogue(0)
    for model in (*made.future, *made.partnet):
        card = cards().get(model.category)
        if card is not None and card.loose and card.felt != "soft":
            found.setdefault((model.category, model.form), model)
    return found


def test_what_lies_about_does_not_tip():
    tipping = {key: round(float(s), 1) for key, model in lying().items() if (s := steadiness(shape_of(model))) < LEAST}
    assert not tipping


def test_two_feet_on_a_line_are_not_enough():
    wood = Finish("wood", (0.5, 0.4, 0.3))
    top = pieces("top", box((-0.1, 0.1), (-0.1, 0.1), (0.05, 0.1)), wood)
    feet = [box((x, x + 0.01), (-0.005, 0.005), (0.0, 0.05)) for x in (-0.1, 0.09)]
    assert steadiness(Shape(top + pieces("feet", feet, wood))) == pytest.approx(np.degrees(np.arctan2(0.005, 0.075)), abs=0.5)
