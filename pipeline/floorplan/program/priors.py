"""A prior over programs for mass production: studios to six bedrooms on one or two storeys, of the plan types of several cultures.

The types stand in manifests/plan_types.yaml; section `prior` of params.yaml weighs them.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from pipeline.errors import ContentError
from pipeline.floorplan.program.completion import complete
from pipeline.floorplan.program.floor_program import FloorProgram
from pipeline.floorplan.program.plan_types import draw, plan_types


def _even() -> dict[str, float]:
    return {"studio": 12.0, "flat": 26.0, "corridor": 12.0, "open_plan": 12.0, "ldk": 10.0, "two_halls": 9.0, "hall_less": 7.0, "shared": 4.0,
            "terrace": 4.0, "detached": 4.0}  # fmt: skip


@dataclass(frozen=True, slots=True)
class PriorSettings:
    """Section `prior` of params.yaml: weights of the types, and of one to six bedrooms where a type leaves the choice."""

    types: Mapping[str, float] = field(default_factory=_even)
    bedrooms: tuple[float, ...] = (27.0, 32.0, 23.0, 11.0, 5.0, 2.0)

    def __post_init__(self) -> None:
        """Raise ContentError for a type that is unknown, and for weights that are negative or all zero."""
        for name in self.types:
            if name not in plan_types():
                raise ContentError(f"params.yaml: prior.types.{name} is no type of plan", f"types are {', '.join(plan_types())}")
        if len(self.bedrooms) != 6:
            raise ContentError(f"params.yaml: prior.bedrooms has {len(self.bedrooms)} weights", "give six, for one to six bedrooms")
        for name, weights in (("types", [*self.types.values()]), ("bedrooms", [*self.bedrooms])):
            if not weights or min(weights) < 0 or sum(weights) <= 0:
                raise ContentError(f"params.yaml: weights of prior.{name} must be 0 or more, and not all 0", "mend section prior")


def prior(rng: np.random.Generator, settings: PriorSettings | None = None) -> FloorProgram:
    """Draw a completed program."""
    settings = settings or PriorSettings()
    names = [n for n in plan_types() if settings.types.get(n, 0.0) > 0]
    weights = np.array([settings.types[n] for n in names])
    kind = plan_types()[names[int(rng.choice(len(names), p=weights / weights.sum()))]]
    beds = 0
    if kind.most > 0:
        counts = np.arange(kind.least, kind.most + 1)
        share = np.array(settings.bedrooms)[counts - 1] + 1e-12
        beds = int(rng.choice(counts, p=share / share.sum()))
    return complete(draw(kind, beds, rng))
