import functools

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.sources.colliders import link, solids
from pipeline.sources.densities import MINIMUM
from pipeline.sources.merging import merged
from pipeline.sources.settings import ModelLimits
from pipeline.sources.solids import MAX_HULL, components, hull, mass_properties, parts, signed_volume


def box(size, at=(0, 0, 0)):
    mesh = trimesh.creation.box(size)
    return np.asarray(mesh.vertices) + at, np.asarray(mesh.faces)


def joined(*meshes):
    vertices, faces, n = [], [], 0
    for v, f in meshes:
        vertices.append(v)
        faces.append(f + n)
        n += len(v)
    return np.concatenate(vertices), np.concatenate(faces)


def test_unshared_vertices_are_welded():
    v, f = box((1, 1, 1))
    assert len(components(v[f].reshape(-1, 3), np.arange(36).reshape(-1, 3))) == 1


def test_parts_of_a_table_are_convex():
    legs = [box((0.05, 0.05, 0.7), (x, y, 0.35)) for x in (-0.5, 0.5) for y in (-0.3, 0.3)]
    found = parts(*joined(box((1.2, 0.8, 0.04), (0, 0, 0.73)), *legs))
    assert len(found) == 5
    assert all(p.fill > 0.999 for p in found)
    assert found[0].hull_volume == pytest.approx(1.2 * 0.8 * 0.04)


def test_a_bowl_is_not_convex():
    ring = trimesh.creation.annulus(0.3, 0.5, 0.2)
    (part,) = parts(np.asarray(ring.vertices), np.asarray(ring.faces))
    assert part.fill == pytest.approx(1 - 0.36, abs=0.02)
    matter = solids("b", [(np.asarray(ring.vertices), np.asarray(ring.faces))], ModelLimits(), None)
    assert matter.notes[0][0] == "hull_collider"
    assert len(matter.pieces) == 1


def test_flat_sheet_gets_a_thickness():
    v = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    points, faces, volume = hull(v)
    assert volume == pytest.approx(0.002, rel=0.01)
    assert signed_volume(points, faces) == pytest.approx(volume)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10_000))
def test_hulls_are_outward_and_bounded(seed):
    points = np.random.default_rng(seed).normal(size=(300, 3))
    corners, faces, volume = hull(points)
    assert len(corners) <= MAX_HULL
    assert signed_volume(corners, faces) == pytest.approx(volume)
    assert volume <= trimesh.convex.convex_hull(points).volume + 1e-9


@settings(max_examples=20, deadline=None)
@given(st.lists(st.floats(0.1, 2), min_size=3, max_size=3), st.lists(st.floats(-3, 3), min_size=3, max_size=3))
def test_mass_and_inertia_of_boxes(size, at):
    """Against the closed form of one box, and the parallel-axis sum of two."""
    (part,) = parts(*box(size, at))
    mass, com, inertia = mass_properties([(part, 100.0)])
    a, b, c = size
    assert mass == pytest.approx(100 * a * b * c)
    assert np.allclose(com, at)
    assert np.allclose(inertia, mass / 12 * np.diag([b * b + c * c, a * a + c * c, a * a + b * b]), rtol=1e-6, atol=1e-9)
    (other,) = parts(*box(size, np.add(at, (5, 0, 0))))
    double = mass_properties([(part, 100.0), (other, 100.0)])
    assert double[1][0] == pytest.approx(at[0] + 2.5)
    assert double[2][2, 2] == pytest.approx(2 * inertia[2, 2] + 2 * mass * 2.5**2)


def test_inertia_of_a_link_is_physical():
    made = link("b", (), solids("b", [box((0.001, 0.001, 0.2))], ModelLimits(), None), 1.0)
    values = np.linalg.eigvalsh(made.inertia)
    assert values.min() > 0
    assert values[2] <= values[0] + values[1] + 1e-12
    assert made.mass >= MINIMUM


def test_scaling_a_part_is_taking_the_scaled_mesh_apart():
    v, f = joined(box((1, 0.4, 0.2), (3, 1, 2)), box((0.2, 0.3, 0.9), (0, 0, 1)))
    shift, factor = np.array([1.0, -2, 0.5]), 0.6
    for a, b in zip(parts((v - shift) * factor, f), [p.scaled(shift, factor) for p in parts(v, f)], strict=True):
        assert np.allclose(a.centre, b.centre)
        assert np.allclose(a.inertia, b.inertia)
        assert np.allclose([a.hull_volume, a.volume, a.fill], [b.hull_volume, b.volume, b.fill])


def test_cut_pieces_replace_the_mesh_and_are_cached(tmp_path):
    """CoACD's answer for a U of three boards as one closed solid: convex pieces that cover it, read back from the cache."""
    from shapely.geometry import Polygon

    from pipeline.sources.decomposition import decompose

    u = trimesh.creation.extrude_polygon(Polygon([(0, 0), (1, 0), (1, 1), (0.9, 1), (0.9, 0.1), (0.1, 0.1), (0.1, 1), (0, 1)]), 0.4)
    mesh = (np.asarray(u.vertices), np.asarray(u.faces))
    made = solids("u", [mesh], ModelLimits(), lambda v, f: decompose(v, f, tmp_path))
    assert len(made.pieces) >= 3
    assert made.notes == ()
    assert sum(p.hull_volume for p in made.pieces) == pytest.approx(u.volume, rel=0.1)
    assert len(list(tmp_path.iterdir())) == 1
    assert len(solids("u", [mesh], ModelLimits(), lambda v, f: decompose(v, f, tmp_path)).pieces) == len(made.pieces)


def test_a_failed_cut_leaves_the_hull_and_is_not_tried_again(tmp_path, monkeypatch):
    """Native code that dies, or is not there, costs the pieces, never the model."""
    from pipeline.sources import decomposition

    ring = trimesh.creation.annulus(0.3, 0.5, 0.2)
    mesh = (np.asarray(ring.vertices), np.asarray(ring.faces))
    cut = functools.partial(decomposition.decompose, cache=tmp_path)
    with monkeypatch.context() as patch:
        patch.setattr(decomposition, "available", lambda: False)
        assert [r for r, _ in solids("b", [mesh], ModelLimits(), cut).notes] == ["hull_collider"]
        assert not list(tmp_path.iterdir())
    with monkeypatch.context() as patch:
        patch.setattr(decomposition, "_PROGRAM", "import os; os.abort()")
        assert [r for r, _ in solids("b", [mesh], ModelLimits(), cut).notes] == ["hull_collider"]
        patch.setattr(decomposition, "_PROGRAM", "raise AssertionError")
        assert len(solids("b", [mesh], ModelLimits(), cut).pieces) == 1
    assert len(list(tmp_path.iterdir())) == 1


def drawer(w=0.5, d=0.45, h=0.15, t=0.012):
    """Bottom, four sides and a front: a drawer's box."""
    return [
        box((w, d, t), (0, 0, t / 2)),
        *(box((t, d - 2 * t, h), (s * (w - t) / 2, 0, t + h / 2)) for s in (-1, 1)),
        *(box((w, t, h), (0, s * (d - t) / 2, t + h / 2)) for s in (-1, 1)),
        box((w + 0.04, 0.019, h + 0.04), (0, -d / 2 - 0.0095, h / 2)),
    ]


def inside(points, pieces):
    found = np.zeros(len(points), bool)
    for p in pieces:
        a = p.hull[p.faces[:, 0]]
        normals = np.cross(p.hull[p.faces[:, 1]] - a, p.hull[p.faces[:, 2]] - a)
        found |= ((normals @ points.T - (normals * a).sum(1)[:, None]) < 0).all(0)
    return found


def test_the_inside_of_a_drawer_stays_free():
    made = solids("d", [joined(*drawer())], ModelLimits(), None)
    rng = np.random.default_rng(1)
    air = rng.uniform((-0.23, -0.20, 0.02), (0.23, 0.20, 0.16), (2000, 3))
    assert not inside(air, made.pieces).any()


def test_boards_in_line_and_a_framed_door_are_one_piece():
    boards = [box((0.3, 0.4, 0.02), (0.3 * k, 0, 0)) for k in range(4)]
    assert len(solids("b", [joined(*boards)], ModelLimits(), None).pieces) == 1
    rails = [box((0.05, 0.02, 0.9), (s * 0.225, 0, 0)) for s in (-1, 1)] + [box((0.4, 0.02, 0.05), (0, 0, s * 0.425)) for s in (-1, 1)]
    panel = box((0.4, 0.008, 0.8), (0, 0.002, 0))
    assert len(solids("d", [joined(*rails, panel)], ModelLimits(), None).pieces) == 1
    assert len(solids("d", [joined(*rails)], ModelLimits(), None).pieces) == 4  # an open frame is no board


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10_000))
def test_merging_covers_all_and_fills_little(seed):
    """Of random boards: every corner stays covered, and the pieces hold no more than GAIN and shallow pockets beyond the boards."""
    rng = np.random.default_rng(seed)
    grid = rng.integers(0, 4, (8, 3)) * 0.25
    boards = [box(rng.choice([0.02, 0.25, 0.5], 3), at) for at in grid]
    apart = [p for v, f in boards for p in parts(v, f)]
    made = merged(apart)
    assert len(made) <= len(apart)
    points = rng.uniform(-0.3, 1.1, (4000, 3))
    before, after = inside(points, apart), inside(points, made)
    assert (after | ~before).all()
    assert (after & ~before).mean() <= 0.02


def test_whichever_way_round_and_twice_the_faces_are_drawn():
    v, f = box((1, 0.4, 0.2))
    odd = f.copy()
    odd[::2] = odd[::2, ::-1]
    for faces in (odd, np.concatenate([f, f[:, ::-1]]), np.concatenate([f, f])):
        (part,) = parts(v, faces)
        assert part.fill == pytest.approx(1)
        assert part.volume == pytest.approx(0.08)
    (lidless,) = parts(v, f[2:])
    assert lidless.fill < 0.5


def test_boards_that_share_corners_stay_two():
    """Two boxes along one edge, vertices shared as an exporter that welds writes them."""
    v, f = joined(box((1, 0.4, 0.2)), box((1, 0.4, 0.2), (1, 0.4, 0)))
    _, first, index = np.unique(v.round(6), axis=0, return_index=True, return_inverse=True)
    found = parts(v[first], index.ravel()[f])
    assert [p.fill for p in found] == pytest.approx([1, 1])
    assert sum(p.volume for p in found) == pytest.approx(0.16)


def test_a_block_of_a_cabinet_weighs_as_a_box_of_boards():
    block = solids("b", [box((1, 0.5, 2))], ModelLimits(), None)
    assert link("b", (), block, 600.0, "sofa").mass == pytest.approx(600)
    assert link("b", (), block, 600.0, "cabinet").mass == pytest.approx(600 * 7 * 0.018)
    board = solids("b", [box((1, 0.5, 0.02))], ModelLimits(), None)
    assert link("b", (), board, 600.0, "cabinet").mass == pytest.approx(6)
