"""A prior over programs for mass production: studios to six bedrooms on one or two storeys, of the plan types of several cultures.

The types stand in `apartment_types.py` (one storey) and `house_types.py` (two); section `prior` of params.yaml weighs them.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from pipeline.errors import ContentError
from pipeline.floorplan.program import apartment_types, house_types
from pipeline.floorplan.program.completion import complete
from pipeline.floorplan.program.floor_program import FloorProgram
from pipeline.floorplan.program.program_sketch import Sketch


@dataclass(frozen=True, slots=True)
class PlanType:
    """How a type is drawn, and the numbers of bedrooms that it has."""

    draw: Callable[[Sketch, int], FloorProgram]
    least: int
    most: int


TYPES: Mapping[str, PlanType] = {
    "studio": PlanType(apartment_types.studio, 0, 0),
    "flat": PlanType(apartment_types.flat, 1, 5),
    "corridor": PlanType(apartment_types.corridor, 1, 5),
    "open_plan": PlanType(apartment_types.open_plan, 2, 6),
    "ldk": PlanType(apartment_types.ldk, 1, 4),
    "two_halls": PlanType(apartment_types.two_halls, 2, 4),
    "hall_less": PlanType(apartment_types.hall_less, 1, 4),
    "shared": PlanType(apartment_types.shared_flat, 3, 5),
    "terrace": PlanType(house_types.terrace, 2, 4),
    "detached": PlanType(house_types.detached_house, 3, 6),
}


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
            if name not in TYPES:
                raise ContentError(f"params.yaml: prior.types.{name} is no type of plan", f"types are {', '.join(TYPES)}")
        if len(self.bedrooms) != 6:
            raise ContentError(f"params.yaml: prior.bedrooms has {len(self.bedrooms)} weights", "give six, for one to six bedrooms")
        for name, weights in (("types", [*self.types.values()]), ("bedrooms", [*self.bedrooms])):
            if not weights or min(weights) < 0 or sum(weights) <= 0:
                raise ContentError(f"params.yaml: weights of prior.{name} must be 0 or more, and not all 0", "mend section prior")


def prior(rng: np.random.Generator, settings: PriorSettings | None = None) -> FloorProgram:
    """Draw a completed program."""
    settings = settings or PriorSettings()
    names = [n for n in TYPES if settings.types.get(n, 0.0) > 0]
    weights = np.array([settings.types[n] for n in names])
    kind = TYPES[names[int(rng.choice(len(names), p=weights / weights.sum()))]]
    beds = 0
    if kind.most > 0:
        counts = np.arange(kind.least, kind.most + 1)
        share = np.array(settings.bedrooms)[counts - 1] + 1e-12
        beds = int(rng.choice(counts, p=share / share.sum()))
    return complete(kind.draw(Sketch(rng), beds))
