import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.sources.colliders import link, solids
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
    assert made.mass >= 0.05


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
