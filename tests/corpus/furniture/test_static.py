"""Every form of the static library, three models each: solid convex pieces, no piece deep in another, budget, styles."""

import itertools
from collections import Counter
from functools import cache

import numpy as np
import pytest

from pipeline.corpus.furniture import bent, texture
from pipeline.corpus.furniture.assembly import finishes_of, shape_of
from pipeline.corpus.furniture.catalogue import catalogue, corpus_cards, styles_of
from pipeline.corpus.furniture.finishes import STYLES, Finish
from pipeline.corpus.furniture.shape import freeze, pieces
from pipeline.corpus.furniture.solids import Solid, box, cushion, merge_solids, normals, pillow, topology
from pipeline.corpus.furniture.wavefront import sides_of
from pipeline.seeds import generator

SMALL = {
    "rug", "curtain", "pillow", "table_lamp", "cup", "plate", "bowl", "vase", "book", "book_stack", "basket", "picture", "mirror",
    "clock", "television", "bath_mat", "blind", "towel", "folded_towels", "throw", "paper_holder", "coat_hooks", "photo_frame", "candle",
    "tray", "potted_herb", "bottle", "canister", "kettle", "cutting_board", "fruit_bowl", "toy", "pen_cup", "alarm_clock", "tissue_box",
}  # fmt: skip
WOODEN = 0.035  # how deep one hard piece may sit in another: a tenon, a screwed joint [m]
SOFT = 0.06  # the same where one of them is upholstery, which gives [m]
FOAM = 200.0  # density below which a piece is soft [kg/m3]


def volume(solid: Solid) -> float:
    a, b, c = (solid.vertices[solid.triangles()[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def distinct(vectors):
    length = np.linalg.norm(vectors, axis=1)
    a = vectors[length > 1e-12] / length[length > 1e-12, None]
    sign = np.sign(a[np.arange(len(a)), np.argmax(np.abs(a) > 1e-6, axis=1)])
    return np.unique(np.round(a * sign[:, None], 3), axis=0)


def directions(solid: Solid):
    """Distinct face normals and edge directions, up to sign."""
    edges = [solid.vertices[list(f)] - solid.vertices[[*f[1:], f[0]]] for f in solid.faces]
    return distinct(normals(solid.vertices, topology(solid.faces))), distinct(np.concatenate(edges))


def depth(a, axes_a, b, axes_b):
    """How deep two convex point sets enter each other [m], by the separating axis theorem; nought or less: apart."""
    crossed = np.cross(axes_a[1][:, None], axes_b[1][None]).reshape(-1, 3)
    axes = np.concatenate([axes_a[0], axes_b[0], crossed])
    length = np.linalg.norm(axes, axis=1)
    axes = axes[length > 1e-6] / length[length > 1e-6, None]
    pa, pb = a @ axes.T, b @ axes.T
    return float(-np.maximum(pa.min(axis=0) - pb.max(axis=0), pb.min(axis=0) - pa.max(axis=0)).max())


@cache
def chosen():
    """Three models of each form of each category with static models, from as many seeds as that takes."""
    count: Counter[tuple[str, str]] = Counter()
    made = []
    for seed in (0, 1, 2):
        for model in catalogue(seed).future:
            if count[model.category, model.form] < 3 and model.category in HERE:
                count[model.category, model.form] += 1
                made.append(model)
    return tuple(made)


HERE = {c for c, card in corpus_cards().items() if not card.moving}


def test_there_are_enough_models_of_every_category():
    library = catalogue(0)
    assert len(library.future) >= 650
    assert min(Counter(m.category for m in (*library.future, *library.partnet)).values()) >= 6
    assert {m.super_category for m in catalogue(0).future} == {
        "Bed", "Cabinet/Shelf/Desk", "Table", "Chair", "Pier/Stool", "Sofa", "Lighting", "Others",
    }  # fmt: skip


def test_forms_and_styles_suit_each_other():
    assert {s for card in corpus_cards().values() for form in card.forms.values() for s in styles_of(form)} == set(STYLES)
    for model in catalogue(1).future:
        forms = corpus_cards()[model.category].forms
        assert model.style in styles_of(forms[model.form]) or model.form == next(iter(forms))
    assert {m.style for m in catalogue(0).future} == set(STYLES)
    assert len(STYLES) == 19
    assert sum(m.share for m in STYLES.values()) == pytest.approx(1)


def test_styles_differ_in_what_they_are_made_of():
    """Two styles share few of their finishes: the palette alone tells most of them apart."""
    seen: dict[str, set[str]] = {}
    for seed in (0, 1):
        for model in catalogue(seed).future:
            finishes = finishes_of(model)
            seen.setdefault(model.style, set()).update(f.name for f in (finishes.body, finishes.soft, finishes.handle, finishes.timber))
    for a, b in (
        ("Nordic", "Industrial"),
        ("Japanese", "European Classic"),
        ("Light Luxury", "Southeast Asia"),
        ("Ming Qing", "Minimalist"),
    ):
        assert len(seen[a] & seen[b]) <= 0.2 * min(len(seen[a]), len(seen[b])), (a, b, seen[a] & seen[b])


def test_pieces_are_solid():
    for model in chosen():
        for piece in shape_of(model).pieces():
            assert volume(piece.solid) > 0, (model, piece.name)


def test_triangles_of_static_models():
    counts = {m: sum(len(p.solid.triangles()) for p in shape_of(m).pieces()) for m in chosen()}
    assert np.median(list(counts.values())) <= 3000
    assert max(counts.values()) <= 12000
    assert max(n for m, n in counts.items() if m.category in SMALL) <= 1500


def test_no_piece_is_deep_in_another():
    for model in chosen():
        parts = list(freeze(shape_of(model)).pieces())
        solids = [p.solid for p in parts]
        low = np.array([s.vertices.min(axis=0) for s in solids]) + WOODEN
        high = np.array([s.vertices.max(axis=0) for s in solids]) - WOODEN
        axes = cache(lambda k, solids=solids: directions(solids[k]))
        for i in range(len(solids)):
            for j in np.flatnonzero((low < high[i]).all(axis=1) & (high > low[i]).all(axis=1)):
                if j > i:
                    limit = SOFT if min(parts[i].finish.density, parts[j].finish.density) < FOAM else WOODEN
                    how_deep = depth(solids[i].vertices, axes(i), solids[j].vertices, axes(j))
                    assert how_deep <= limit, (model, parts[i].name, parts[j].name, how_deep)


BENT = {
    "tube": bent.tube(bent.curve([(0, 0, 0), (0.1, 0, 0.3), (0, 0.2, 0.5)]), [0.02] * 8 + [0.01]),
    "right angle": bent.tube([(0, 0, 0), (0, 0.3, 0), (0, 0.3, 0.4), (0.3, 0.3, 0.4)], 0.012),
    "hoop": bent.tube(np.column_stack([bent.arc((0, 0), 0.5, 0, 2 * np.pi, 16)[:-1], np.zeros(16)]), 0.01, closed=True),
    "band": bent.wall(bent.arc((0, 0), 0.4, 0, 3, 8), 0.03, 0, 0.4),
    "wall": bent.wall(bent.arc((0, 0), 0.4, 0, 3, 8), 0.06, 0.1, np.linspace(0.4, 0.7, 9), 0.03),
    "sheet": bent.sheet(bent.curve([(-0.2, 0.4), (0.1, 0.38), (0.2, 0.5), (0.25, 0.8)]), 0.012, 0.4),
    "leaf": bent.blades(np.zeros((3, 3)), np.array([(0, 0, 1.0), (1, 0, 0.2), (0, 0.3, -0.1)]), 0.1),
    "kite": bent.blades(np.zeros((2, 3)), np.array([(0, 0, 1.0), (1, 0, 0.2)]), 0.1, n=4),
    "board": [bent.prism(np.array([(0, 0), (1, 0), (0.8, 0.6), (0.2, 0.6)]), "x", (0, 0.03), 0.01)],
    "prism": [bent.prism(np.array([(0, 0), (1, 0), (0, 1.0)]), axis, (0, 0.1)) for axis in "xyz"],
    "pillow": [pillow((0, 0.5), (0, 0.5), (0, 0.15))],
    "crowned": [cushion((0, 0.5), (0, 0.6), (0, 0.15), 0.05, 3, 0.03), cushion((0, 0.1), (0, 0.6), (0, 0.15), 0.045, 3, 0.05)],
}


@pytest.mark.parametrize("name", BENT)
def test_bent_pieces_are_convex_and_turned_outwards(name):
    for solid in BENT[name]:
        tri = solid.triangles()
        a, b, c = (solid.vertices[tri[:, k]] for k in range(3))
        n = np.cross(b - a, c - a)
        n /= np.linalg.norm(n, axis=1, keepdims=True)
        assert volume(solid) > 0
        assert (solid.vertices @ n.T - np.einsum("ij,ij->i", a, n)).max() < 3e-4


def test_neighbours_of_a_tube_touch_and_do_not_enter_each_other():
    path = [(0, 0, 0), (0, 0, 0.3), (0, 0.25, 0.5), (0.2, 0.4, 0.5)]
    made = bent.tube(path, 0.02, 10)
    for a, b in itertools.pairwise(made):
        assert depth(a.vertices, directions(a), b.vertices, directions(b)) < 1e-5  # directions are rounded


def test_texture_coordinates_keep_real_sizes_and_stay_in_their_field():
    oak, cloth = Finish("oak", (0.4, 0.3, 0.2), pattern="grain"), Finish("cloth", (0.2, 0.2, 0.3), pattern="weave")
    parts = pieces("a", [box((0, 1.2), (0, 0.4), (0, 0.03)), box((0, 0.05), (0, 0.05), (0, 0.5))], oak) + pieces(
        "b", box((0, 0.5), (0, 0.5), (0, 0.1)), cloth
    )
    sheet = texture.atlas(parts)
    vertices, shared = merge_solids([p.solid for p in parts])
    pixels = sheet.uv(parts, vertices, shared, sides_of(normals(vertices, shared), shared)) * [sheet.width, sheet.height]
    owner = np.repeat(np.arange(len(parts)), [len(p.solid.vertices) for p in parts])[shared.corners]
    for number, part in enumerate(parts):
        (left, width, height), mine = sheet.fields[part.finish], pixels[owner == number]
        assert (mine >= [left, 0]).all()
        assert (mine <= [left + width, height]).all()
    around = np.linalg.norm(pixels[shared.following] - pixels, axis=1)
    edges = vertices[shared.corners]
    assert np.allclose(around, sheet.scale * np.linalg.norm(edges[shared.following] - edges, axis=1))


def test_grain_runs_along_the_part():
    tone = texture.tones(generator(0, "test"), "grain", (200, 200), texture.SCALE)
    along, across = np.abs(np.diff(tone, axis=0)).mean(), np.abs(np.diff(tone, axis=1)).mean()
    assert along < 0.5 * across


@pytest.mark.parametrize("pattern", sorted(texture.CONTRAST) + sorted(texture.WHOLE))
def test_tones_lie_between_nought_and_one(pattern):
    tone = texture.tones(generator(0, "test", pattern), pattern, (90, 130), 160.0)
    assert tone.shape == (90, 130)
    assert tone.min() >= 0
    assert tone.max() <= 1
    assert pattern == "plain" or tone.std() > 0.01
