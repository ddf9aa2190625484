"""Each of the twelve terms against a value worked out by hand, and what must not change them."""

import numpy as np
import pytest
import shapely

from pipeline.floorplan.program.floor_program import FloorProgram, Style
from pipeline.floorplan.realise import wall_lines
from pipeline.floorplan.search import energy, grid
from pipeline.floorplan.search.anneal import score
from pipeline.floorplan.search.spec import Spec, tree
from pipeline.floorplan.search.storeys import weights_of

UNIT = 0.25
HALF = grid.Halves(0.06, 0.12)


ONES = energy.Terms(*[1.0] * len(energy.TERMS))


def labels(*rows, n):
    """A bordered grid from rows of letters, the lowest row first; '.' is outside."""
    body = np.array([[n if c == "." else ord(c) - ord("a") for c in row] for row in rows], dtype=np.int16)
    return np.pad(body, 1, constant_values=n)


def measured(cells, n):
    out = grid.empty(n, cells.shape[0] - 2, cells.shape[1] - 2)
    grid.measure(cells, n, out)
    return out


TWO = labels("aaabb", "aaabb", "aaabb", n=2)
ELL = labels("aaaa", "aabb", "aabb", n=2)  # a is an L of 8 cells


def test_measures_of_two_rectangles():
    out = measured(TWO, 2)
    assert out.cells[:2].tolist() == [9, 6]
    assert out.box[0].tolist() == [0, 0, 3, 3]
    assert out.run[0, 1] == out.walls[0, 1] == 3
    assert out.walls[0, 2] == 9
    assert out.run[1, 2] == 3
    assert out.corners[0].tolist() == [4, 0]
    assert out.centre[1].tolist() == [4.0, 1.5]
    assert out.middle[0, 1].tolist() == [3.0, 1.5]


def test_measures_of_an_l():
    out = measured(ELL, 2)
    assert out.corners[0].tolist() == [5, 1]
    assert out.run[0, 1] == 2
    assert out.walls[0, 1] == 4
    assert grid.hull_area(ELL, 0, out.box) == 10.0  # 12 less the triangle of 2 x 2 / 2


def test_measures_agree_with_the_plain_form_and_with_shapely():
    rng = np.random.default_rng(0)
    for _ in range(30):
        cells = np.pad(rng.integers(0, 3, (7, 8)).astype(np.int16), 1, constant_values=3)
        out, plain = measured(cells, 3), grid.empty(3, 7, 8)
        grid.measure.py_func(cells, 3, plain)
        for a, b in zip(out, plain, strict=True):
            np.testing.assert_array_equal(a, b)
        for room in range(3):
            shape = shapely.union_all([shapely.box(x, y, x + 1, y + 1) for y, x in np.argwhere(cells[1:-1, 1:-1] == room)])
            assert out.cells[room] == shape.area
            one = isinstance(shape, shapely.Polygon) and not shape.interiors
            if grid.simple(out, room):
                assert one
                assert out.walls[room].sum() == shape.length
                hull = grid.hull_area(cells, room, out.box)
                assert hull == pytest.approx(shape.convex_hull.area)
                assert len(wall_lines.outline(cells, room)) == out.corners[room].sum()


def test_inner_area_is_that_of_the_faces():
    out = measured(TWO, 2)
    corners = wall_lines.outline(TWO, 0)
    sides = [False, True, False, False]  # bottom, right, top, left: only the right side has a room behind
    assert corners == [(0, 0), (3, 0), (3, 3), (0, 3)]
    faces = np.array(corners, float) * UNIT + wall_lines.insets(corners, sides, HALF)
    assert faces.tolist() == pytest.approx(np.array([[0.12, 0.12], [0.69, 0.12], [0.69, 0.63], [0.12, 0.63]]))
    exact = shapely.Polygon(faces).area
    assert grid.inner_area(out, 0, 2, UNIT, HALF) == pytest.approx(exact, abs=0.003)


def test_circulation_counts_detours_only():
    chain = np.array([[0, 1, 0], [1, 0, 1], [0, 1, 0]])
    straight = measured(labels("aabbcc", "aabbcc", n=3), 3)
    assert energy.circulation(straight, tree(chain, 0)) == 0.0
    # c lies above a and is reached through b: right 2, then left 1, and up 1.5
    bent = measured(labels("aabb", "ccbb", n=3), 3)
    travel = energy.circulation(bent, tree(chain, 0))
    # a (1, .5) -> wall (2, .5) -> b (3, 1) -> wall (2, 1.5) -> c (1, 1.5): right 2, left 2, up 1
    assert travel == pytest.approx(4.0 * ((5 / 3 - 1) ** 2 + 0.0) / 2)


def test_area_is_absolute():
    wanted, area_weight = np.array([10.0, 12.0]), np.ones(2)
    assert energy.area(np.array([10.0, 12.0]), wanted, area_weight) == 0.0
    assert energy.area(np.array([5.0, 12.0]), wanted, area_weight) == pytest.approx(4.0 * 1.0 / 2)
    assert energy.area(np.array([20.0, 24.0]), wanted, area_weight) == pytest.approx(4.0)  # shares would say 0
    assert energy.area(np.array([20.0, 24.0]), wanted, np.array([1.0, 0.25])) == pytest.approx(4.0 * 1.25 / 2)


def test_squareness():
    box = np.array([[0, 0, 6, 2], [0, 0, 3, 3]])
    assert energy.squareness(box, np.array([1, 1])) == pytest.approx(4.0 * (2.0 + energy.STEEP * (3.0 - energy.SLIM)) / 2)
    assert energy.squareness(box, np.array([0, 1])) == 0.0


def test_convexity_and_simplicity_of_an_l():
    out = measured(ELL, 2)
    hull = np.array([[grid.hull_area(ELL, i, out.box)] for i in range(2)])
    assert energy.convexity(hull, out.cells) == pytest.approx(4.0 * (10 / 8 - 1) ** 2 / 2)
    assert energy.simplicity(out.corners, 2) == pytest.approx(4.0 * 0.25 / 2)


def test_exterior_and_corner_light():
    out = measured(TWO, 2)  # the outline is 16 long: a owns 9, b owns 7; each has two corners
    assert energy.exterior(out.walls, np.array([1, 0])) == pytest.approx(4.0 * (9 / 16 - 1) ** 2)
    assert energy.exterior(out.walls, np.array([1, 1])) == 0.0
    assert energy.corner_light(out.outline_corners, np.array([1, 0])) == pytest.approx(4.0 * 0.25)


def test_alignment_counts_lines():
    out = measured(TWO, 2)
    assert energy.alignment(out.columns, out.rows) == 5  # x = 0, 3, 5 and y = 0, 3
    bent = measured(ELL, 2)
    assert energy.alignment(bent.columns, bent.rows) == 6


def test_useful_area():
    assert energy.useful_area(np.array([6.0, 2.0]), np.array([1, 0])) == pytest.approx(4.0 * 0.25**2)


def test_min_width_by_opening():
    neck = labels("aaaaaaa", "aaa.aaa".replace(".", "b"), "aaa.aaa".replace(".", "b"), n=2)
    out = measured(neck, 2)
    reached, pieces = grid.opening(neck, 0, out.box, 2)
    assert (reached, pieces) == (18, 2)  # the bridge of one cell is not reached
    assert grid.opening(neck, 0, out.box, 1) == (19, 1)
    assert energy.min_width(np.array([[19.0, 0.5, 1.0, 0.0], [2.0, 0.0, 0.0, 0.0]])) == pytest.approx(0.5 + energy.SPLIT)


def test_stair_terms():
    assert energy.stair_fit(6.0, 8.0) == pytest.approx(0.0625)
    assert energy.stair_snug(6.0, 8.0, 10.0) == pytest.approx((6 / 12 - 1) ** 2)
    assert energy.stair_snug(8.0, 8.0, 8.0) == 0.0
    assert energy.overlap(4, 9, 6, 5) == 24  # 4 of the shorter side, all of the longer
    assert energy.overlap(9, 4, 6, 5) == 24
    assert energy.overlap(8, 6, 6, 5) == 30


def test_a_staircase_is_a_rectangle_and_measured_against_its_flights():
    request = spec(2, flight=np.array([0, 3, 2]))
    assert score(ELL, request, ONES, 0.0)[1] > 0.0
    found = score(TWO, request, ONES, 0.0)
    assert found[1] == 0.0
    assert (found[2].stair_fit, found[2].stair_snug) == pytest.approx((0.0, 2 * (6 / 9 - 1) ** 2))  # 3 x 3 cells for flights of 3 x 2


def spec(n, **changes):
    zeros, ones = np.zeros(n, np.int64), np.ones(n, np.int64)
    base = Spec(
        UNIT, 0, np.full(n, 1.0), np.zeros(n), np.full(n, 99.0), np.array([0.0, 99.0]), ones, ones, ones, ones, ones, ones, zeros,
        np.zeros((n, n), np.int64), np.zeros((n, n), np.int64), np.zeros((n, n), np.int64), zeros, zeros, zeros, np.zeros((n, n)), np.zeros((n, n)),
        -1, np.zeros(4, np.int64), 0, HALF, np.ones(n), np.array([-1, 0, 0]), np.zeros((0, 3), np.int64), np.zeros((0, 3)),
    )  # fmt: skip
    return base._replace(**changes)


def values(cells, request):
    return score(cells, request, ONES, 0.0)[2]


def test_terms_do_not_change_under_rotation_and_reflection():
    cells = labels("aaaaccc", "aabbccc", "aabbbbb", "aabbbbb", n=3)
    link = np.array([[0, 1, 0], [1, 0, 1], [0, 1, 0]])
    request = spec(3, link=link, habitable=np.array([1, 0, 1]), least=np.full(3, 2))
    want = values(cells, request)
    for turn in range(4):
        for turned in (np.rot90(cells, turn), np.fliplr(np.rot90(cells, turn))):
            np.testing.assert_allclose(values(np.ascontiguousarray(turned), request), want, atol=1e-12)


def test_terms_do_not_depend_on_the_order_of_rooms():
    cells = labels("aaabb", "aaabb", "cccbb", n=3)
    link = np.array([[0, 1, 1], [1, 0, 0], [1, 0, 0]])
    order = np.array([2, 0, 1, 3])  # old -> new
    renamed = order[cells].astype(np.int16)
    moved = np.zeros_like(link)
    moved[np.ix_(order[:3], order[:3])] = link
    a = values(cells, spec(3, link=link, root=0))
    b = values(renamed, spec(3, link=moved, root=2))
    np.testing.assert_allclose(a, b, atol=1e-12)


@pytest.mark.parametrize(
    ("changes", "broken"),
    [
        ({}, False),
        ({"need": np.array([[0, 3], [3, 0]])}, False),
        ({"need": np.array([[0, 4], [4, 0]])}, True),
        ({"ban": np.array([[0, 1], [1, 0]])}, True),
        ({"outside": np.array([0, 4])}, True),
        ({"corner": np.array([1, 1])}, False),
        ({"low": np.array([0.5, 0.0])}, True),
        ({"high": np.array([0.1, 9.0])}, True),
        ({"order": np.array([[0.0, 1.2], [0.0, 0.0]])}, False),
        ({"order": np.array([[0.0, 2.5], [0.0, 0.0]])}, True),
        ({"apart": np.array([[0.0, 0.9], [0.9, 0.0]])}, True),
        ({"apart": np.array([[0.0, 0.3], [0.3, 0.0]])}, False),
        ({"strict": np.array([1, 3])}, True),
        ({"nonrect": 1}, True),
        ({"total": np.array([0.0, 0.2])}, True),
    ],
)
def test_each_hard_condition_is_noticed(changes, broken):
    hard = score(TWO, spec(2, **changes), ONES, 0.0)[1]
    assert (hard > 0) == broken


def test_a_room_between_two_others_has_no_corner():
    row = labels("abc", "abc", "abc", n=3)
    hard = [score(row, spec(3, corner=np.eye(3, dtype=np.int64)[i]), ONES, 0.0)[1] for i in range(3)]
    assert hard == [0.0, 1.0, 0.0]


def test_between_is_what_lies_on_the_way():
    row = labels("aabbcc", "aabbcc", n=3)
    bend = labels("aabb", "aabb", "cccc", n=3)  # from a, b and c lie to the right and above: at a right angle or less
    for cells, one, broken in ((row, (1, 0, 2), False), (row, (0, 1, 2), True), (bend, (0, 1, 2), True)):
        assert (score(cells, spec(3, between=np.array([one])), ONES, 0.0)[1] > 0) == broken


def test_a_room_in_two_pieces_or_with_a_hole_is_no_room():
    assert score(labels("aba", "aba", n=2), spec(2), ONES, 0.0)[1] == np.inf
    assert score(labels("aaa", "aba", "aaa", n=2), spec(2), ONES, 0.0)[1] == np.inf
    assert score(labels("ab", "ba", n=2), spec(2), ONES, 0.0)[1] == np.inf


def test_knobs_double_and_halve_weights():
    plain, turned = weights_of(FloorProgram()), weights_of(FloorProgram(style=Style(area=2, alignment=-1)))
    ratio = dict(zip(energy.TERMS, np.divide(turned, plain), strict=True))
    assert ratio["area"] == 4.0
    assert ratio["alignment"] == 0.5
    assert ratio["exterior"] == 1.0
    assert list(Style.model_fields) == list(energy.TERMS)


def test_an_ell_is_opened_without_its_cells():
    rng = np.random.default_rng(2)
    for _ in range(60):
        w, h = rng.integers(2, 12, 2)
        a, b = int(rng.integers(1, w)), int(rng.integers(1, h))
        body = np.zeros((h, w), np.int16)
        body[h - b :, w - a :] = 1
        body = [body, body[::-1], body[:, ::-1], body[::-1, ::-1]][int(rng.integers(4))]
        cells = np.pad(body, 1, constant_values=2)
        out = measured(np.ascontiguousarray(cells), 2)
        assert grid.notch_width(cells, 0, out.box) == a
        for side in range(1, 9):
            assert grid.ell_opening(w, h, a, b, side) == grid.opening(cells, 0, out.box, side)
        assert out.cells[0] + 0.5 * a * b == grid.hull_area(cells, 0, out.box)


@pytest.mark.parametrize(("width", "broken"), [(1, True), (3, True), (4, False)])
def test_no_part_of_a_room_is_a_sliver(width, broken):
    rows = ["a" * 8 + "b" * 8] * 6 + ["a" * width + "b" * (16 - width)] * 5
    request = spec(2, strict=np.full(2, 4), high=np.full(2, 99.0))
    assert (score(labels(*rows, n=2), request, ONES, 0.0)[1] > 0) == broken
