"""The knob experiment: each of the twelve style knobs is turned from -3 to 3, and its own energy term is measured on the plans."""

import multiprocessing
from collections.abc import Collection, Mapping
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pipeline.execution import single_thread
from pipeline.floorplan import FloorProgram, complete
from pipeline.floorplan.program.floor_program import Link, RoomReq, Style
from pipeline.floorplan.search.energy import TERMS
from pipeline.floorplan.solver import search
from pipeline.report.plots import Curve, panels

VALUES = (-3, -2, -1, 0, 1, 2, 3)
FLAT = ("living_room", "kitchen", "bedroom", "bedroom", "bathroom", "hallway", "wc", "balcony")
WAYS = (("entry", "living_room"), ("living_room", "dining_room"), ("dining_room", "kitchen"), ("living_room", "hallway"))
DEEP = ("entry", "living_room", "dining_room", "kitchen", "hallway", "bedroom", "bedroom", "bathroom", "office")
GROUND, UPPER = ("entry", "living_room", "kitchen", "wc"), ("bedroom", "bedroom", "bathroom")


@cache
def subjects() -> dict[str, FloorProgram]:
    """Return the program on which each knob is measured: one in which what it weighs is in tension with the rest.

    A flat of eight rooms; for `circulation` rooms in a row, where ways can double back; for `convexity` the flat with `simplicity` -3, for
    bends that are not there have no depth; for the stairs a house of two storeys.
    """
    flat = complete(FloorProgram(rooms=_rooms(FLAT), only=True))
    deep = complete(FloorProgram(rooms=_rooms(DEEP), links=tuple(Link(a=a, b=b) for a, b in WAYS), only=True))
    house = complete(FloorProgram(rooms=_rooms(GROUND, 0) + _rooms(UPPER, 1), storeys=2))
    bent = flat.model_copy(update={"style": Style(simplicity=-3)})
    return {name: house if name.startswith("stair") else {"circulation": deep, "convexity": bent}.get(name, flat) for name in TERMS}


def _rooms(types: tuple[str, ...], level: int | None = None) -> tuple[RoomReq, ...]:
    return tuple(RoomReq.model_validate({"id": f"r{level or 0}_{i}", "type": k, "level": level}) for i, k in enumerate(types))


def knob_table(seeds: int, jobs: int = 1, names: Collection[str] = TERMS, first: int = 0) -> dict[str, Any]:
    """Return {values, seeds, terms: {knob: {mean, error, step, ends}}} of the knobs `names` on seeds from `first` on; `jobs` processes share the work.

    `mean` and its standard `error` (7,) of the knob's own term, unweighted, over plans as they are returned; `step` (6, 2) differences of
    neighbouring values, seed by seed, with their standard errors; `ends` (2,) the same from the first value to the last. A seed draws the same
    random numbers whatever the knob's value.
    """
    work = [(name, value, seed) for name in TERMS if name in names for value in VALUES for seed in range(first, first + seeds)]
    if jobs > 1:
        # spawned, not forked: a child must not inherit the threads of libraries that are already at work
        with ProcessPoolExecutor(jobs, mp_context=multiprocessing.get_context("spawn"), initializer=single_thread) as pool:
            measured = list(pool.map(_measure, work, chunksize=16))
    else:
        measured = [_measure(one) for one in work]
    terms: dict[str, Any] = {}
    for k, name in enumerate(n for n in TERMS if n in names):
        energies = np.array(measured).reshape(-1, len(VALUES), seeds)[k]
        mean, error = _mean(energies.T)
        steps = [_mean((after - before)[:, None]) for before, after in pairwise(energies)]
        ends = _mean((energies[-1] - energies[0])[:, None])
        terms[name] = {
            "mean": mean.round(5).tolist(),
            "error": error.round(5).tolist(),
            "step": [[round(float(m[0]), 5), round(float(e[0]), 5)] for m, e in steps],
            "ends": [round(float(ends[0][0]), 5), round(float(ends[1][0]), 5)],
        }
    return {"values": list(VALUES), "seeds": seeds, "terms": terms}


def _measure(one: tuple[str, int, int]) -> float:
    """Return the knob's own term of one plan: of the knob `name`, turned to `value`, from `seed`."""
    name, value, seed = one
    program = subjects()[name]
    turned = program.model_copy(update={"style": program.style.model_copy(update={name: value})})
    return float(search(turned, seed).terms[TERMS.index(name)])


def _mean(samples: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return means over the first axis and their standard errors."""
    return samples.mean(axis=0), samples.std(axis=0, ddof=1) / np.sqrt(len(samples))


def monotone(term: Mapping[str, Any]) -> bool:
    """Whether a term falls as its knob rises: no step rises by more than its standard error, and the ends differ by more than three."""
    return all(step <= error for step, error in term["step"]) and term["ends"][0] < -3 * term["ends"][1]


def knob_picture(table: Mapping[str, Any]) -> bytes:
    """Return a PNG with a panel per knob: means with their standard errors."""
    curves = [
        Curve(
            name.replace("_", " "),
            table["values"],
            term["mean"],
            [m - e for m, e in zip(term["mean"], term["error"], strict=True)],
            [m + e for m, e in zip(term["mean"], term["error"], strict=True)],
        )
        for name, term in table["terms"].items()
    ]
    return panels(curves, title=f"each knob against its own term, means over {table['seeds']} seeds", x="knob k: weight times 2^k")
