import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from pipeline.corpus.furniture.solids import rounded_rectangle
from pipeline.sources.densities import MINIMUM
from pipeline.sources.meshes import colliders, merging
from pipeline.sources.meshes.colliders import build_link, solids
from pipeline.sources.meshes.cutting import cut
from pipeline.sources.meshes.merging import merge_pieces
from pipeline.sources.meshes.mesh_solids import MAX_HULL, components, convex_part, extremes, hull, mass_properties, parts, signed_volume
from pipeline.sources.settings import ModelLimits
from tests.sources import mobility


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
    made = build_link("b", (), solids("b", [box((0.001, 0.001, 0.2))], ModelLimits(), None), 1.0)
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


def bowl():
    mesh = trimesh.creation.icosphere(3)
    mesh.update_faces(mesh.triangles_center[:, 2] < 0.3)
    return np.asarray(mesh.vertices, float), np.asarray(mesh.faces)


def test_cut_pieces_replace_the_mesh():
    """A U of three boards as one closed solid: pieces that cover it and leave its inside free."""
    from shapely.geometry import Polygon

    u = trimesh.creation.extrude_polygon(Polygon([(0, 0), (1, 0), (1, 1), (0.9, 1), (0.9, 0.1), (0.1, 0.1), (0.1, 1), (0, 1)]), 0.4)
    made = solids("u", [(np.asarray(u.vertices), np.asarray(u.faces))], ModelLimits(), 0.015)
    assert 3 <= len(made.pieces) <= 6
    assert made.notes == ()
    assert sum(p.hull_volume for p in made.pieces) == pytest.approx(u.volume, rel=0.1)
    air = np.random.default_rng(0).uniform((0.17, 0.17, 0), (0.83, 1, 0.4), (1000, 3))
    assert not inside(air, made.pieces).any()


def test_a_surface_is_covered_and_no_pocket_filled():
    v, f = bowl()
    made = cut(v, f, 0.05, 24)
    pieces = [p for points in made.pieces if (p := convex_part(points, 1.0))]
    assert len(pieces) <= 24
    assert made.depth < 0.15
    middles = v[f].mean(axis=1)
    reach = np.min([_outside(middles, p) for p in pieces], axis=0)
    assert reach.max() < 0.05  # of a bowl of radius 1
    air = np.random.default_rng(0).normal(size=(500, 3)) * 0.1
    assert not inside(air, pieces).any()


def _outside(points, part):
    """Return by how much points (N, 3) lie outside of a convex part, 0 within."""
    a = part.hull[part.faces[:, 0]]
    normals = np.cross(part.hull[part.faces[:, 1]] - a, part.hull[part.faces[:, 2]] - a)
    lengths = np.maximum(np.linalg.norm(normals, axis=1), 1e-12)
    return np.maximum(((normals @ points.T - (normals * a).sum(1)[:, None]) / lengths[:, None]).max(axis=0), 0.0)


@pytest.mark.parametrize("broken", ["open", "doubled", "turned"])
def test_what_is_nearly_convex_stays_one_piece(broken):
    v, f = box((1, 0.4, 0.2))
    faces = {"open": f[1:], "doubled": np.concatenate([f, f[:, ::-1]]), "turned": np.where(np.arange(12)[:, None] % 2, f, f[:, ::-1])}[
        broken
    ]
    assert len(solids("b", [(v, faces)], ModelLimits(), 0.25).pieces) == 1


def test_a_bound_on_the_work_of_an_object(monkeypatch):
    """However many bowls an object has, they are cut into so many pieces, and what comes after stands as its hull."""
    v, f = bowl()
    many = [(v * 0.1 + (k, 0, 0), f) for k in range(6)]
    monkeypatch.setattr(colliders, "CUTS", 20)
    monkeypatch.setattr(colliders, "LOOKS", 4)
    made = solids("b", many, ModelLimits(), 0.005)
    assert [reason for reason, _ in made.notes] == ["hull_collider"]
    assert len(made.pieces) <= 20 + 6


def test_merging_is_the_same_in_any_company():
    """Boards far away change nothing, though bounds are taken for many pairs at once."""
    boards = [p for k in range(4) for p in parts(*box((0.3, 0.4, 0.02), (0.3 * k, 0, 0)))]
    far = [p for k in range(3) for p in parts(*box((0.1, 0.1, 0.1), (0.2 * k, 0.9, 0)))]
    assert len(merge_pieces(boards + far)) == 1 + 3


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
    made = merge_pieces(apart)
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
    assert build_link("b", (), block, 600.0, "sofa").mass == pytest.approx(600)
    assert build_link("b", (), block, 600.0, "cabinet").mass == pytest.approx(600 * 7 * 0.018)
    board = solids("b", [box((1, 0.5, 0.02))], ModelLimits(), None)
    assert build_link("b", (), board, 600.0, "cabinet").mass == pytest.approx(6)


@pytest.mark.parametrize("seed", range(3))
def test_a_board_with_holes_drawn_from_both_sides_is_one_part(seed):
    """At a hole a face and its own back share an edge with nobody else: the two are no closed part."""
    mesh = mobility.dirty(mobility.board((0, 0, 0), (1, 0.4, 0.6), 12, 0.01), np.random.default_rng(seed))
    assert len(components(*mesh)) == 1


def test_a_bound_on_the_hulls_that_are_tried_where_everything_touches(monkeypatch):
    """Of pieces that all touch each other there are pairs without end; each is offered to the likeliest few, and what fits best still becomes one."""
    rng = np.random.default_rng(0)
    crowd = [p for _ in range(24) for p in parts(*box(rng.uniform(0.2, 0.5, 3), rng.uniform(-0.1, 0.1, 3)))]
    boards = [p for k in range(6) for p in parts(*box((0.1, 0.8, 0.01), (0.1 * k - 0.25, 0, 0.9)))]
    tried = []
    hulls = merging._hull
    monkeypatch.setattr(merging, "_hull", lambda pieces: tried.append(len(pieces)) or hulls(pieces))
    monkeypatch.setattr(merging, "HULLS", 150)  # five for each of the thirty
    made = merge_pieces(crowd + boards)
    assert sum(count == 2 for count in tried) <= 2 * 5 * 30
    assert sum(p.hull.min(axis=0)[2] > 0.8 for p in made) == 1


def test_a_hull_of_few_corners_leaves_little_of_a_rounded_plate_out():
    outline = rounded_rectangle((-0.32, 0.32), (-0.28, 0.28), 0.03, 14)
    plate = np.concatenate([np.column_stack([outline, np.full(len(outline), z)]) for z in (0.0, 0.04)])
    kept = ConvexHull(extremes(plate))
    assert len(kept.vertices) <= MAX_HULL < len(plate)
    assert (plate @ kept.equations[:, :3].T + kept.equations[:, 3]).max() < 0.001
