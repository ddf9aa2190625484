"""Simulated annealing of a plan on the grid: wall shifts, jogs and swaps, geometric cooling, the best state kept."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pipeline.floorplan.energy import Spec, terms, tree
from pipeline.floorplan.grid import Labels, Measures, empty, measure
from pipeline.geometry.compiled import compiled

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

DRAWS = 8  # uniform numbers that one proposal takes
LINE, PAIR, SIDE, PART, SWAP = 0.35, 0.60, 0.78, 0.97, 1.0  # cumulative shares of the moves


@compiled
def propose(grid: Labels, n: int, fixed: Ints, draws: Floats) -> bool:  # noqa: C901, PLR0912 - compiled: calls would cost more
    """Change `grid` in place by one random move; False when the draw gives none.

    A wall cell is drawn; then the whole wall line moves by a cell (LINE), or the stretch between the same two rooms (PAIR),
    one room's whole side (SIDE), or a part of it, which makes a jog (PART); or two neighbours swap places (SWAP).
    """
    height, width = grid.shape[0] - 2, grid.shape[1] - 2
    y = 1 + int(draws[0] * height)
    x = 1 + int(draws[1] * width)
    turn = int(draws[2] * 4.0)
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
    kind = draws[3]
    if kind >= PART:
        for i in range(1, height + 1):
            for j in range(1, width + 1):
                if grid[i, j] == a:
                    grid[i, j] = b
                elif grid[i, j] == b:
                    grid[i, j] = a
        return True
    sy, sx = (0, 1) if dx == 0 else (1, 0)  # along the wall
    first, last = 0, 0
    for way in range(2):
        step = 1 if way == 0 else -1
        k = 0
        while True:
            near = grid[y + (k + step) * sy, x + (k + step) * sx]
            far = grid[y + dy + (k + step) * sy, x + dx + (k + step) * sx]
            if near == far or max(near, far) == n or fixed[near] > 0 or fixed[far] > 0:
                break
            if kind >= LINE and near != a:
                break
            if (LINE <= kind < PAIR or kind >= SIDE) and far != b:
                break
            k += step
        if way == 0:
            last = k
        else:
            first = k
    if kind >= SIDE and last > first:
        cut = first + 1 + int(draws[4] * (last - first))
        if draws[5] < 0.5:
            last = cut - 1
        else:
            first = cut
    depth = 1 if draws[6] < 0.75 else 2
    for k in range(first, last + 1):
        near = grid[y + k * sy, x + k * sx]
        far = grid[y + dy + k * sy, x + dx + k * sx]
        for d in range(1, depth + 1):
            cy, cx = y + d * dy + k * sy, x + d * dx + k * sx
            if grid[cy, cx] != far:
                break
            grid[cy, cx] = near
    return True


def score(grid: Labels, spec: Spec, weights: Floats, penalty: float) -> tuple[float, float, Floats]:
    """Return (energy with the penalty, hard violation, the twelve terms) of a grid."""
    fixed = np.zeros(spec.target.size + 1, np.int64)
    _, soft, hard, values, _ = run(grid, spec, weights, fixed, np.zeros((0, DRAWS)), 1.0, 1.0, penalty)
    return soft + (penalty * hard if penalty else 0.0), hard, values


def run(
    start: Labels, spec: Spec, weights: Floats, fixed: Ints, draws: Floats, hot: float, cold: float, penalty: float
) -> tuple[Labels, float, float, Floats, int]:
    """Anneal from `start` with one proposal per row of `draws`; see `anneal`. Scratch space is made here."""
    out = empty(spec.target.size, start.shape[0] - 2, start.shape[1] - 2)
    return anneal(start, spec, tree(spec.link, spec.root), out, weights, fixed, draws, hot, cold, penalty)


@compiled
def _copy(source: Labels, target: Labels) -> None:
    """Copy a grid (a loop compiles faster than a slice)."""
    for y in range(source.shape[0]):
        for x in range(source.shape[1]):
            target[y, x] = source[y, x]


@compiled
def _weighted(values: Floats, weights: Floats) -> float:
    total = 0.0
    for k in range(values.size):
        total += values[k] * weights[k]
    return total


@compiled
def anneal(
    start: Labels,
    spec: Spec,
    edges: Ints,
    out: Measures,
    weights: Floats,
    fixed: Ints,
    draws: Floats,
    hot: float,
    cold: float,
    penalty: float,
) -> tuple[Labels, float, float, Floats, int]:
    """Anneal from `start`; return the best plan: grid, energy, hard violation (0: all conditions hold), terms, moves accepted.

    The violation's weight grows from a quarter of `penalty` to all of it; the best state is the one of least (violation, energy).
    """
    n = spec.target.size
    grid = start.copy()
    trial = start.copy()
    values = np.zeros(12)
    areas = np.zeros(n)
    measure(grid, n, out)
    hard = terms(grid, out, spec, edges, values, areas)
    soft = _weighted(values, weights)
    best = grid.copy()
    best_soft, best_hard = soft, hard
    best_values = values.copy()
    accepted = 0
    steps = draws.shape[0]
    for k in range(steps):
        done = k / steps
        heat = hot * (cold / hot) ** done
        weight = penalty * (0.25 + 0.75 * done)
        if not propose(trial, n, fixed, draws[k]):
            continue
        measure(trial, n, out)
        new_hard = terms(trial, out, spec, edges, values, areas)
        new_soft = _weighted(values, weights)
        change = new_soft - soft + weight * (new_hard - hard)
        if new_hard < np.inf and (hard == np.inf or change <= 0.0 or draws[k, 7] < np.exp(-change / heat)):
            _copy(trial, grid)
            soft, hard = new_soft, new_hard
            accepted += 1
            if hard < best_hard - 1e-12 or (hard <= best_hard and soft < best_soft):
                _copy(grid, best)
                best_soft, best_hard = soft, hard
                for i in range(12):
                    best_values[i] = values[i]
        else:
            _copy(grid, trial)
    return best, best_soft, best_hard, best_values, accepted
