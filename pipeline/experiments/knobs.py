"""The knob experiment: each of the twelve style knobs is turned from -3 to 3, and its own energy term is measured on the plans."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from pipeline.floorplan import FloorProgram, complete
from pipeline.floorplan.energy import TERMS
from pipeline.floorplan.program import RoomReq, Style
from pipeline.floorplan.solver import search
from pipeline.report.plots import Curve, panels

VALUES = (-3, -2, -1, 0, 1, 2, 3)


def subjects() -> tuple[FloorProgram, FloorProgram]:
    """Return the two programs whose plans are measured: a flat of eight rooms, and a house of two storeys for the stair terms."""
    flat = ("living_room", "kitchen", "bedroom", "bedroom", "bathroom", "hallway", "wc", "balcony")
    ground, upper = ("entry", "living_room", "kitchen", "wc"), ("bedroom", "bedroom", "bathroom")
    rooms = [RoomReq.model_validate({"id": f"g{i}", "type": k, "level": 0}) for i, k in enumerate(ground)]
    rooms += [RoomReq.model_validate({"id": f"u{i}", "type": k, "level": 1}) for i, k in enumerate(upper)]
    return (
        complete(FloorProgram(rooms=tuple(RoomReq.model_validate({"id": f"r{i}", "type": k}) for i, k in enumerate(flat)), only=True)),
        complete(FloorProgram(rooms=tuple(rooms), storeys=2)),
    )


def knob_table(seeds: int) -> dict[str, Any]:
    """Return {values, seeds, terms: {knob: means of its own term over seeds}}; the same seeds for every value of a knob."""
    flat, house = subjects()
    means: dict[str, list[float]] = {}
    for knob, name in enumerate(TERMS):
        program = house if name.startswith("stair") else flat
        means[name] = []
        for value in VALUES:
            turned = program.model_copy(update={"style": Style.model_validate({name: value})})
            made = [search(turned, seed).terms[knob] for seed in range(seeds)]
            means[name].append(round(float(np.mean(made)), 5))
    return {"values": list(VALUES), "seeds": seeds, "terms": means}


def monotone(means: Sequence[float]) -> bool:
    """Whether a term never rises with its knob and falls from end to end."""
    return all(b <= a + 1e-9 for a, b in pairwise(means)) and means[-1] < means[0]


def knob_picture(table: Mapping[str, Any]) -> bytes:
    """Return a PNG with a panel per knob."""
    curves = [Curve(name.replace("_", " "), table["values"], means) for name, means in table["terms"].items()]
    return panels(curves, title=f"each knob against its own term, means over {table['seeds']} seeds", x="knob: weight x 2^k")
