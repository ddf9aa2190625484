"""Simulated annealing of a plan on the grid: wall shifts, jogs and swaps, geometric cooling, the best state kept."""

from typing import NamedTuple

import numpy as np

from pipeline.arrays import Floats, Ints
from pipeline.floorplan.search.energy import Terms, terms, weighted_sum, zone_spread
from pipeline.floorplan.search.grid import Labels, Measures, empty, measure
from pipeline.floorplan.search.spec import Spec, tree
from pipeline.geometry.compiled import borrowing

Schedule = tuple[float, float, float, int]  # as `anneal` takes it
DRAWS = 8  # uniform numbers that one proposal takes
LINE, PAIR, SIDE, PART, SWAP = 0.35, 0.60, 0.78, 0.97, 1.0  # cumulative shares of the moves


class Scratch(NamedTuple):
    """What annealing a plan of n rooms works on."""

    grid: Labels  # the plan as it is now, and
    trial: Labels  # as proposed
    areas: Floats  # (n,) of the proposal, as `terms` writes them
    shape: Floats  # (n, 4) likewise, and
    kept: Floats  # (n, 4) of the plan as it is now
    touched: Ints  # (n+1,) rooms that differ between the two


@borrowing
def propose(grid: Labels, n: int, fixed: Ints, draws: Floats, k: int, touched: Ints) -> bool:
    """Change `grid` in place by one random move, row k of `draws`; False when the draw gives none.

    Rooms whose cells changed are marked in `touched` (n+1,).

    A wall cell is drawn; then the whole wall line moves by a cell (LINE), or the stretch between the same two rooms (PAIR),
    one room's whole side (SIDE), or a part of it, which makes a jog (PART); or two neighbours swap places (SWAP).
    """
    height, width = grid.shape[0] - 2, grid.shape[1] - 2
    y = 1 + int(draws[k, 0] * height)
    x = 1 + int(draws[k, 1] * width)
    turn = int(draws[k, 2] * 4.0)
    dy = 1 if turn == 0 else (-1 if turn == 1 else 0)
    dx = 1 if turn == 2 else (-1 if turn == 3 else 0)
    # walk to the next wall in that direction
    while grid[y, x] != n and grid[y + dy, x + dx] == grid[y, x]:
        y += dy
        x += dx
    a = grid[y, x]
    b = grid[y + dy, x + dx]
    if max(a, b) == n or fixed[a] > 0 or fixed[b] > 0:
        return False
    kind = draws[k, 3]
    if kind >= PART:
        _swap(grid, a, b, touched)
        return True
    sy, sx = (0, 1) if dx == 0 else (1, 0)  # along the wall
    last = _reach(grid, n, fixed, kind, (y, x, dy, dx), 1)
    first = _reach(grid, n, fixed, kind, (y, x, dy, dx), -1)
    if kind >= SIDE and last > first:
        cut = first + 1 + int(draws[k, 4] * (last - first))
        if draws[k, 5] < 0.5:
            last = cut - 1
        else:
            first = cut
    depth = 1 if draws[k, 6] < 0.75 else 2
    for i in range(first, last + 1):
        near = grid[y + i * sy, x + i * sx]
        far = grid[y + dy + i * sy, x + dx + i * sx]
        touched[near] = 1
        touched[far] = 1
        for d in range(1, depth + 1):
            cy, cx = y + d * dy + i * sy, x + d * dx + i * sx
            if grid[cy, cx] != far:
                break
            grid[cy, cx] = near
    return True


@borrowing
def _swap(grid: Labels, a: int, b: int, touched: Ints) -> None:
    """Let two rooms change places."""
    touched[a] = 1
    touched[b] = 1
    for i in range(1, grid.shape[0] - 1):
        for j in range(1, grid.shape[1] - 1):
            if grid[i, j] == a:
                grid[i, j] = b
            elif grid[i, j] == b:
                grid[i, j] = a


@borrowing
def _reach(grid: Labels, n: int, fixed: Ints, kind: float, wall: tuple[int, int, int, int], step: int) -> int:
    """Return how many cells of a wall move with its cell (y, x), whose other side is at (dy, dx) from it, in the direction of `step`."""
    y, x, dy, dx = wall
    sy, sx = (0, 1) if dx == 0 else (1, 0)  # along the wall
    a, b = grid[y, x], grid[y + dy, x + dx]
    reach = 0
    while True:
        near = grid[y + (reach + step) * sy, x + (reach + step) * sx]
        far = grid[y + dy + (reach + step) * sy, x + dx + (reach + step) * sx]
        if near == far or max(near, far) == n or fixed[near] > 0 or fixed[far] > 0:
            return reach
        if kind >= LINE and near != a:
            return reach
        if (LINE <= kind < PAIR or kind >= SIDE) and far != b:
            return reach
        reach += step


def score(grid: Labels, spec: Spec, weights: Terms, penalty: float) -> tuple[float, float, Terms]:
    """Return (energy with the penalty, hard violation, the twelve terms) of a grid."""
    fixed = np.zeros(spec.target.size + 1, np.int64)
    _, soft, hard, values, _, _ = run(grid, spec, weights, fixed, np.zeros((0, DRAWS)), 1.0, 1.0, penalty, 1)
    return soft + (penalty * hard if penalty else 0.0), hard, values


def run(
    start: Labels, spec: Spec, weights: Terms, fixed: Ints, draws: Floats, hot: float, cold: float, penalty: float, most: int
) -> tuple[Labels, float, float, Terms, int, int]:
    """Anneal from `start` with at most one proposal per row of `draws`; return the best grid and what `anneal` says of it."""
    n = spec.target.size
    out = empty(n, start.shape[0] - 2, start.shape[1] - 2)
    scratch = Scratch(start.copy(), start.copy(), np.zeros(n), np.zeros((n, 4)), np.zeros((n, 4)), np.ones(n + 1, np.int64))
    best = start.copy()
    return best, *anneal(best, spec, tree(spec.link, spec.root), out, scratch, weights, fixed, draws, (hot, cold, penalty, most))


@borrowing
def _copy(source: Labels, target: Labels, out: Measures, touched: Ints) -> None:
    """Copy the boxes of touched rooms, in which all changed cells lie (a loop compiles faster than a slice)."""
    for i in range(touched.size - 1):
        if touched[i] > 0:
            for y in range(out.box[i, 1] + 1, out.box[i, 3] + 1):
                for x in range(out.box[i, 0] + 1, out.box[i, 2] + 1):
                    target[y, x] = source[y, x]


@borrowing
def _copy_all(source: Labels, target: Labels) -> None:
    for y in range(source.shape[0]):
        for x in range(source.shape[1]):
            target[y, x] = source[y, x]


@borrowing
def anneal(
    best: Labels, spec: Spec, edges: Ints, out: Measures, scratch: Scratch, weights: Terms, fixed: Ints, draws: Floats, schedule: Schedule
) -> tuple[float, float, Terms, int, int]:
    """Anneal from `best` and leave the best plan there; return its energy, hard violation (0: all hold), terms, moves accepted and evaluated.

    The schedule is the heat at the start and at the end, the weight of a hard violation at the end, and how many proposals are evaluated
    at most. That weight grows from a quarter to all of it; the best state is the one of least (violation, energy).
    """
    hot, cold, penalty, most = schedule
    n = spec.target.size
    grid, trial, areas, shape, kept, touched = scratch
    measure(grid, n, out)
    exact = n > 0  # a plain True is a type of its own: `terms` would be compiled twice
    values, hard = terms(grid, out, spec, edges, areas, shape, touched, exact)
    soft = weighted_sum(values, weights) + zone_spread(out, spec.near)
    if hard < np.inf:
        _settle(shape, kept, touched)
    best_soft, best_hard = soft, hard
    best_values = values
    accepted, evaluated = 0, 0
    for k in range(draws.shape[0]):
        if evaluated == most:
            break
        if not propose(trial, n, fixed, draws, k, touched):
            continue
        done = evaluated / most
        heat = hot * (cold / hot) ** done
        weight = penalty * (0.25 + 0.75 * done)
        evaluated += 1
        measure(trial, n, out)
        # the draw says how much worse the proposal may be; most fall at the first, cheap look
        bound = np.inf if hard == np.inf else soft + weight * hard - heat * np.log(draws[k, 7] + 1e-300)
        new_hard, new_soft, new_values, united = np.inf, np.inf, values, zone_spread(out, spec.near)
        for look in range(2):
            new_values, new_hard = terms(trial, out, spec, edges, areas, shape, touched, look == 1)
            new_soft = weighted_sum(new_values, weights) + united
            if new_hard == np.inf or new_soft + weight * new_hard > bound:
                new_hard = np.inf
                break
        if new_hard < np.inf:
            _copy(trial, grid, out, touched)
            _settle(shape, kept, touched)
            soft, hard, values = new_soft, new_hard, new_values
            accepted += 1
            if hard < best_hard - 1e-12 or (hard <= best_hard and soft < best_soft):
                _copy_all(grid, best)
                best_soft, best_hard = soft, hard
                best_values = values
        else:
            _copy(grid, trial, out, touched)
            _settle(kept, shape, touched)
            if hard == np.inf:  # nothing is known of the start yet
                for i in range(n):
                    touched[i] = 1
    return best_soft, best_hard, best_values, accepted, evaluated


@borrowing
def _settle(source: Floats, target: Floats, touched: Ints) -> None:
    """Copy the rows of touched rooms, and mark none."""
    for i in range(source.shape[0]):
        if touched[i] > 0:
            for j in range(4):
                target[i, j] = source[i, j]
        touched[i] = 0
