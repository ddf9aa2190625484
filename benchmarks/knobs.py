"""The knob experiment: each of the twelve style knobs is turned from -3 to 3, and its own energy term is measured on the plans.

python -m benchmarks.knobs [seeds] [first seed]; a table over 100 seeds and more is drawn into docs/images/knobs.png
"""

import sys
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

from pipeline.execution import cores, single_thread
from pipeline.floorplan import FloorProgram, complete, warm
from pipeline.floorplan.program.floor_program import Link, RoomReq, Style
from pipeline.floorplan.search.energy import TERMS
from pipeline.floorplan.solver import search

PICTURE = Path(__file__).resolve().parents[1] / "docs" / "images" / "knobs.png"
LEAST = 100  # seeds of a table that is drawn
VALUES = (-3, -2, -1, 0, 1, 2, 3)
FLAT = "living_room kitchen bedroom bedroom bathroom hallway wc balcony"
WAYS = (("entry", "living_room"), ("living_room", "dining_room"), ("dining_room", "kitchen"), ("living_room", "hallway"))
DEEP = "entry living_room dining_room kitchen hallway bedroom bedroom bathroom office"
GROUND, UPPER = "entry living_room kitchen wc", "bedroom bedroom bathroom"


def main(seeds: int = 12, first: int = 0) -> None:
    """Print the means of each term over its knob's values; those over LEAST seeds and more are drawn."""
    table = knob_table(seeds, cores(), first=first)
    head = "".join(f"{f'2^{v}':>9s}" for v in VALUES)
    print(f"means over {seeds} seeds of each knob's own term\n{'knob':14s}{head}    ends / error  monotone")
    for name, term in table.items():
        row = "".join(f"{m:9.4f}" for m in term["mean"])
        print(f"{name:14s}{row} {term['ends'][0] / max(term['ends'][1], 1e-12):15.1f}  {'yes' if monotone(term) else 'NO'}")
    if seeds >= LEAST:
        draw(table, seeds)


@cache
def subjects() -> dict[str, FloorProgram]:
    """Return the program on which each knob is measured: one in which what it weighs is in tension with the rest.

    A flat of eight rooms; for `circulation` rooms in a row, where ways can double back; for `convexity` the flat with `simplicity` -3, for
    bends that are not there have no depth; for the stairs a house of two storeys.
    """
    flat = complete(FloorProgram(rooms=rooms_of(FLAT), only=True))
    deep = complete(FloorProgram(rooms=rooms_of(DEEP), links=tuple(Link(a=a, b=b) for a, b in WAYS), only=True))
    house = complete(FloorProgram(rooms=rooms_of(GROUND, 0) + rooms_of(UPPER, 1), storeys=2))
    bent = flat.model_copy(update={"style": Style(simplicity=-3)})
    return {name: house if name.startswith("stair") else {"circulation": deep, "convexity": bent}.get(name, flat) for name in TERMS}


def rooms_of(types: str, level: int | None = None) -> tuple[RoomReq, ...]:
    """Return rooms of these types, in a row of words, on a level."""
    return tuple(RoomReq.model_validate({"id": f"r{level or 0}_{i}", "type": k, "level": level}) for i, k in enumerate(types.split()))


def knob_table(seeds: int, jobs: int = 1, names: Collection[str] = TERMS, first: int = 0) -> dict[str, Any]:
    """Return by knob what its own term does over VALUES, on seeds from `first` on; `jobs` processes share the work.

    `mean` and its standard `error` (7,) of the term, unweighted, over plans as they are returned; `step` (6, 2) differences of
    neighbouring values, seed by seed, with their standard errors; `ends` (2,) the same from the first value to the last. A seed draws the same
    random numbers whatever the knob's value.
    """
    work = [(name, value, seed) for name in names for value in VALUES for seed in range(first, first + seeds)]
    measured = np.array(list(in_processes(_measure, work, jobs))).reshape(-1, len(VALUES), seeds)
    table = {}
    for name, energies in zip(names, measured, strict=True):
        steps = np.vstack([np.diff(energies, axis=0), energies[-1] - energies[0]])
        table[name] = {
            "mean": energies.mean(axis=1).tolist(),
            "error": _error(energies).tolist(),
            "step": np.stack([steps[:-1].mean(axis=1), _error(steps[:-1])], 1).tolist(),
            "ends": [float(steps[-1].mean()), float(_error(steps[-1]))],
        }
    return table


def in_processes(measure: Callable[[Any], Any], work: Sequence[Any], jobs: int) -> Iterator[Any]:
    """Yield what is measured of each piece of work, in their order, by `jobs` processes that have compiled the planner."""
    if jobs <= 1:
        yield from map(measure, work)
        return
    # spawned, not forked: a child must not inherit the threads of libraries that are already at work
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn"), initializer=_warm) as pool:
        yield from pool.map(measure, work, chunksize=5)


def _warm() -> None:
    single_thread()
    warm()


def _measure(one: tuple[str, int, int]) -> float:
    """Return the knob's own term of one plan: of the knob `name`, turned to `value`, from `seed`."""
    name, value, seed = one
    program = subjects()[name]
    turned = program.model_copy(update={"style": program.style.model_copy(update={name: value})})
    return float(search(turned, seed).terms[TERMS.index(name)])


def _error(samples: np.ndarray) -> np.ndarray:
    """Return standard errors of means over the last axis."""
    return np.asarray(samples.std(axis=-1, ddof=1) / np.sqrt(samples.shape[-1]))


def monotone(term: Mapping[str, Any]) -> bool:
    """Whether a term falls as its knob rises: no step rises by more than its standard error, and the ends differ by more than three."""
    return all(step <= error for step, error in term["step"]) and term["ends"][0] < -3 * term["ends"][1]


def draw(table: Mapping[str, Any], seeds: int, path: Path = PICTURE, columns: int = 4) -> None:
    """Draw a panel per knob: means, from zero, with their standard errors as a band."""
    from matplotlib.figure import Figure

    rows = -(-len(table) // columns)
    figure = Figure(figsize=(2.4 * columns, 1.7 * rows), dpi=110, layout="constrained")
    figure.suptitle(f"each knob against its own term, means over {seeds} seeds", fontsize=10)
    for axes, (name, term) in zip(figure.subplots(rows, columns).flat, table.items(), strict=False):
        mean, error = np.array(term["mean"]), np.array(term["error"])
        axes.plot(VALUES, mean, "-o", color="#2f7f86", markersize=3, linewidth=1.4)
        axes.fill_between(VALUES, mean - error, mean + error, color="#2f7f86", alpha=0.18, linewidth=0)
        axes.set_title(name.replace("_", " "), fontsize=9)
        axes.set_ylim(0, 1.08 * max(*(mean + error), 1e-6))
        axes.tick_params(labelsize=7)
        axes.grid(color="#e6eaef")
        axes.spines[["top", "right"]].set_visible(False)
        axes.set_xlabel("knob k: weight times 2^k", fontsize=7)
    figure.savefig(path, metadata={"Software": None})


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
