"""One table for all layout models: the same rooms, the same figures, whoever furnished them.

Figures are of drafts, as boxes: nothing is retrieved, moved or repaired. What counts as articulated is a class that can
come from PartNet, for made and real rooms alike, and its extended state is the paper's box.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import shapely

from pipeline import seeds
from pipeline.baselines.rooms import BaselineSettings
from pipeline.diffusion.codec import proposals_of
from pipeline.diffusion.context import Proposal, RoomContext
from pipeline.diffusion.rooms import Example
from pipeline.experiments.settings import spread
from pipeline.metrics import collision, relations
from pipeline.metrics.intervals import bootstrap, rate
from pipeline.metrics.layout_features import features
from pipeline.metrics.rows import Row
from pipeline.metrics.two_samples import ckl, forest_accuracy
from pipeline.relations.arrangement import Arrangement, RoomOpening, make_arrangement
from pipeline.relations.model import Relations

Furnish = Callable[[Sequence[RoomContext]], list[list[Proposal]]]
Json = dict[str, Any]
COUNTING = ("scenefoundry", "ours")  # the models that a number can be asked of
FLOOR = 1.2  # [m2] that a thing takes: rooms below this times N are not asked for N things


class Case(NamedTuple):
    """A room of the split: its context, what stands there in truth, its name."""

    context: RoomContext
    real: list[Proposal]
    name: str


def cases_of(examples: Sequence[Example], classes: Sequence[str]) -> list[Case]:
    """Return the furnished rooms of a split as the layout models are trained on them."""
    return [Case(e.context, proposals_of(e.continuous, [classes[k] for k in e.classes], e.context), e.key) for e in examples]


def holds(case: Case, count: int) -> bool:
    """Tell whether a room is large enough to be asked for so many things."""
    return bool(shapely.Polygon(case.context.polygon).area >= FLOOR * count)


def compare_models(
    makers: Mapping[str, Furnish],
    cases: Sequence[Case],
    opens: Mapping[str, bool],
    settings: BaselineSettings,
    seed: int,
    known: Relations,
) -> Json:
    """Furnish rooms with every model, and return their figures beside those of the real rooms; `opens` says which classes count as articulated."""
    shown = spread(cases, settings.rooms)
    made, seconds = {"real": [case.real for case in shown]}, {}
    for name, furnish in makers.items():
        start = time.process_time()
        made[name] = furnish([case.context for case in shown])
        seconds[name] = {"cpu_seconds_per_room": round((time.process_time() - start) / len(shown), 4)}
    quantity = {
        name: {str(n): success(makers[name](rooms_with_target(cases, n, settings.count_rooms)), n) for n in settings.counts}
        for name in COUNTING
    }
    rng = seeds.generator(seed, "baselines-bootstrap")
    lived = liveable(rng, seed, shown, made, known)
    models = {
        name: figures(rng, shown, rooms, made["real"], opens, settings.counts) | lived[name] | seconds.get(name, {})
        for name, rooms in made.items()
    }
    return {"models": models, "quantity": quantity}


def figures(
    rng: np.random.Generator,
    cases: Sequence[Case],
    drafts: Sequence[Sequence[Proposal]],
    real: Sequence[Sequence[Proposal]],
    opens: Mapping[str, bool],
    counts: Sequence[int],
) -> Json:
    """Return objects a room, how far their number is from the real one, R_acoll, collisions, CKL, and how often the number is N by chance."""
    rows, true = object_rows(drafts, opens), object_rows(real, opens)
    return {
        "rooms": len(drafts),
        "objects": bootstrap(rng, [float(len(d)) for d in drafts]),
        "r_acoll": collision.acoll(rng, rows, "heuristic"),
        "collision": collision.rates(rows)["bbox"],
        "ckl": ckl(true, rows, sorted(opens)),
        "chance": {str(n): success([d for case, d in zip(cases, drafts, strict=True) if holds(case, n)], n) for n in counts},
    }


def liveable(
    rng: np.random.Generator, seed: int, cases: Sequence[Case], drafts: Mapping[str, Sequence[Sequence[Proposal]]], known: Relations
) -> dict[str, Json]:
    """Return, by model, the relation rates, and how well a forest tells its rooms from the real ones (.5 is best); `drafts` holds "real"."""
    sets = {
        name: [relations.furniture(arrangement(case, draft)) for case, draft in zip(cases, room_drafts, strict=True)]
        for name, room_drafts in drafts.items()
    }
    rates = relations.compare(rng, sets, known)["rates"]
    names = [case.name for case in cases]
    real = features(sets["real"])
    accuracies = {name: forest_accuracy(seed, real, features(rooms), names, names) for name, rooms in sets.items() if name != "real"}
    told = {name: {"relations": {rule: of[name] for rule, of in rates.items()}} for name in sets}
    return {name: own | ({"sca": accuracies[name]} if name in accuracies else {}) for name, own in told.items()}


def arrangement(case: Case, draft: Sequence[Proposal]) -> Arrangement:
    """Return a draft as the room metrics read it."""
    context = case.context
    things = [(p.category, p.position, p.yaw, p.size) for p in draft]
    openings = [RoomOpening(opening.kind, opening.segment) for opening in context.openings]
    return make_arrangement(case.name, context.layout_type, context.polygon, things, openings)


def rooms_with_target(cases: Sequence[Case], count: int, rooms: int) -> list[RoomContext]:
    """Return rooms that are asked for `count` things: `rooms` of those that can hold so many."""
    return [replace(case.context, n_target=count) for case in spread([c for c in cases if holds(c, count)] or cases, rooms)]


def success(drafts: Sequence[Sequence[Proposal]], count: int) -> Json:
    """Return the share of rooms with exactly `count` things."""
    return dict(rate(sum(len(d) == count for d in drafts), len(drafts)))


def object_rows(drafts: Sequence[Sequence[Proposal]], opens: Mapping[str, bool]) -> list[Row]:
    """Return rows of an objects table, as far as the metrics read them; `opens` says which categories count as articulated."""
    return [
        {
            "scene_id": str(number), "room_id": "", "category": p.category, "position": p.position.tolist(), "yaw": p.yaw,
            "size": p.size.tolist(), "openable": opens[p.category],
        }
        for number, draft in enumerate(drafts)
        for p in draft
    ]  # fmt: skip
