"""The two searches: slicing trees tile the outline, annealing keeps rooms whole and gets no worse."""

import numpy as np
import pytest

from pipeline.floorplan.program.completion import complete
from pipeline.floorplan.program.floor_program import FloorProgram, RoomReq
from pipeline.floorplan.search import anneal, grid, layout, slicing, trees
from pipeline.floorplan.search.storeys import storey
from pipeline.floorplan.search.trees import Effort, Outline, Trees


def program():
    kinds = ("living_room", "kitchen", "bedroom", "bedroom", "bathroom", "hallway")
    return complete(FloorProgram(rooms=tuple(RoomReq(id=f"r{i}", type=k) for i, k in enumerate(kinds))))


def test_slicing_trees_tile_the_outline_with_the_wanted_areas():
    rng = np.random.default_rng(0)
    for _ in range(20):
        m = int(rng.integers(2, 9))
        expr = [0]
        for k in range(1, m):
            expr += [k, slicing.V if rng.random() < 0.5 else slicing.H]
        gross = rng.uniform(60.0, 120.0, m)
        width = height = int(np.sqrt(gross.sum()))
        rect = np.zeros((m, 4), np.int64)
        assert slicing.lay_out(np.array(expr), gross, width, height, rect, np.zeros((2 * m - 1, 7), np.int64), np.zeros(2 * m - 1))
        cover = np.zeros((height, width), int)
        for x0, y0, x1, y1 in rect:
            cover[y0:y1, x0:x1] += 1
        assert (cover == 1).all()
        sizes = (rect[:, 2] - rect[:, 0]) * (rect[:, 3] - rect[:, 1])
        assert np.all(np.abs(sizes / sizes.sum() - gross / gross.sum()) < 0.07)


def test_moves_of_trees_keep_expressions_normalised():
    rng = np.random.default_rng(1)
    expr = np.array([0, 1, slicing.V, 2, slicing.H, 3, slicing.V, 4, slicing.H])
    kept = 0
    for draw in rng.random((2000, slicing.DRAWS)):
        trial = expr.copy()
        if slicing._mutate(trial, draw):
            assert sorted(trial[trial >= 0]) == [0, 1, 2, 3, 4]
            assert slicing._valid(trial)
            expr, kept = trial, kept + 1
    assert kept > 500


def test_contact_of_rectangles():
    rect = np.array([[0, 0, 4, 4], [4, 2, 8, 6], [0, 4, 4, 8], [9, 9, 10, 10]])
    assert layout.contact(rect, 0, 1) == 2
    assert layout.contact(rect, 0, 2) == 4
    assert layout.contact(rect, 0, 3) == 0


def start(seed):
    request = storey(program(), 0)
    rng = np.random.default_rng(seed)
    side = int(np.ceil(np.sqrt(request.gross.sum())))
    return request, Trees(request, program(), Outline(side, side, 0)).grow(rng, 1, Effort())[0], rng


def test_annealing_keeps_the_outline_and_whole_rooms_and_is_repeatable():
    for seed in range(3):
        request, cells, rng = start(seed)
        n = len(request.rooms)
        draws = rng.random((2000, anneal.DRAWS))
        fixed = np.zeros(n + 1, np.int64)
        found = [anneal.run(cells, request.spec, request.weights, fixed, draws, 1.2, 0.01, 40.0, 2000) for _ in range(2)]
        np.testing.assert_array_equal(found[0][0], found[1][0])
        best = found[0][0]
        assert ((best == n) == (cells == n)).all()
        out = grid.empty(n, best.shape[0] - 2, best.shape[1] - 2)
        grid.measure(best, n, out)
        assert all(grid.simple(out, i) for i in range(n))
        assert found[0][4] > 5  # proposals were accepted


def test_annealing_never_returns_worse_than_its_start_and_longer_is_better(monkeypatch):
    monkeypatch.setattr(trees, "SLICES", 4)  # a tree that is barely searched leaves something to gain
    gains = []
    for seed in range(4):
        request, cells, rng = start(seed)
        n = len(request.rooms)
        fixed = np.zeros(n + 1, np.int64)
        first, hard0, _ = anneal.score(cells, request.spec, request.weights, 0.0)
        _, soft, hard, _, _, _ = anneal.run(
            cells, request.spec, request.weights, fixed, rng.random((1000, anneal.DRAWS)), 1.2, 0.01, 40.0, 1000
        )
        assert (hard, soft) <= (hard0, first)
        gains.append(first + 40 * hard0 - soft - 40 * hard)
    assert np.mean(gains) > 0


def test_the_proposal_agrees_with_its_plain_form():
    request, cells, rng = start(5)
    n = len(request.rooms)
    fixed = np.zeros(n + 1, np.int64)
    fixed[2] = 1
    draws = rng.random((300, anneal.DRAWS))
    for k in range(len(draws)):
        a, b = cells.copy(), cells.copy()
        touched, marked = np.zeros(n + 1, np.int64), np.zeros(n + 1, np.int64)
        assert anneal.propose(a, n, fixed, draws, k, touched) == anneal.propose.py_func(b, n, fixed, draws, k, marked)
        np.testing.assert_array_equal(a, b)
        np.testing.assert_array_equal(touched, marked)
        assert ((a == 2) == (cells == 2)).all()
        assert set(np.unique(cells[a != cells])) | set(np.unique(a[a != cells])) <= set(np.flatnonzero(touched))


def test_the_kept_state_is_what_its_grid_says():
    for seed in range(4):
        request, cells, rng = start(seed)
        draws = rng.random((800, anneal.DRAWS))
        best, soft, hard, values, _, evaluated = anneal.run(
            cells, request.spec, request.weights, np.zeros(len(request.rooms) + 1, np.int64), draws, 1.2, 0.01, 40.0, 800
        )
        again, violation, terms = anneal.score(best, request.spec, request.weights, 0.0)
        np.testing.assert_allclose(values, terms, atol=1e-9)
        assert (soft, hard) == pytest.approx((again, violation))
        assert 300 < evaluated <= 800


def rectangles(rng, request, side):
    """Return the rectangles of a random slicing tree of the rooms."""
    m = request.gross.size
    while True:
        expr = [0]
        for k in range(1, m):
            expr += [k, slicing.V if rng.random() < 0.5 else slicing.H]
        rect, order = np.zeros((m, 4), np.int64), np.array(expr)
        if slicing.lay_out(order, request.gross, side, side, rect, np.zeros((2 * m - 1, 7), np.int64), np.zeros(2 * m - 1)):
            return rect


def test_a_layout_that_is_given_up_is_as_bad_as_that_and_its_score_agrees_with_the_plain_form():
    request, rng = storey(program(), 0), np.random.default_rng(6)
    n, side = len(request.rooms), int(np.ceil(np.sqrt(request.gross.sum())))
    wishes = Trees(request, program(), Outline(side, side, 0)).wishes
    travel = np.zeros((n, 4))
    for _ in range(40):
        rect = rectangles(rng, request, side)
        whole = layout.cost(rect, side, side, n, request.gross, wishes, np.inf, travel)
        assert whole == pytest.approx(layout.cost.py_func(rect, side, side, n, request.gross, wishes, np.inf, travel))
        for share in (0.2, 0.6, 0.99):
            assert share * whole < layout.cost(rect, side, side, n, request.gross, wishes, share * whole, travel) <= whole + 1e-9
        assert layout.cost(rect, side, side, n, request.gross, wishes, whole, travel) == whole


def test_lines_of_a_layout_are_those_of_its_grid():
    request, rng = storey(program(), 0), np.random.default_rng(7)
    n, side = len(request.rooms), int(np.ceil(np.sqrt(request.gross.sum())))
    for _ in range(20):
        rect = rectangles(rng, request, side)
        cells = np.full((side + 2, side + 2), n, np.int16)
        for i, (x0, y0, x1, y1) in enumerate(rect.tolist()):
            cells[y0 + 1 : y1 + 1, x0 + 1 : x1 + 1] = i
        out = grid.empty(n, side, side)
        grid.measure(cells, n, out)
        assert layout.count_wall_lines(rect) == out.columns.sum() + out.rows.sum()
