"""Every model of the catalogue: closed convex pieces, exact size, hollow carcasses, joints where they belong."""

from functools import cache

import numpy as np

from pipeline.corpus.furniture.assembly import shape_of
from pipeline.corpus.furniture.catalogue import catalogue, corpus_cards


def models():
    made = catalogue(0)
    return (*made.future, *made.partnet)


@cache
def shapes():
    return [(m, shape_of(m)) for m in models()]


def moving():
    return [(m, s) for m, s in shapes() if m.partnet_category]


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


def test_carcasses_are_hollow():
    for model, shape in moving():
        if model.partnet_category == "StorageFurniture":
            solid = sum(np.prod(p.solid.bounds()[1] - p.solid.bounds()[0]) for p in shape.base if not p.name.startswith("book"))
            assert solid < 0.6 * np.prod(model.size), model


def test_every_form_is_built():
    assert {(m.category, m.form) for m in models()} == {(c, name) for c, card in corpus_cards().items() for name in card.forms}


def test_static_models_do_not_move():
    assert all(not s.movers for m, s in shapes() if not m.partnet_category)
    assert all(s.movers for _, s in moving())


def test_building_twice_gives_the_same():
    for model in models()[::25]:
        shape_of.cache_clear()
        first = list(shape_of(model).pieces())
        shape_of.cache_clear()
        second = list(shape_of(model).pieces())
        assert all(np.array_equal(a.solid.vertices, b.solid.vertices) for a, b in zip(first, second, strict=True))
        assert [p.finish for p in first] == [p.finish for p in second]
