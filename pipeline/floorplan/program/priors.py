"""A prior over programs for mass production: studios to six bedrooms on one or two storeys, of the plan types of several cultures.

The types stand in manifests/plan_types.yaml, step by step as they are drawn; section `prior` of params.yaml weighs them.
"""

import functools
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field, TypeAdapter, ValidationError

from pipeline import yaml_text
from pipeline.errors import ContentError
from pipeline.floorplan.program.completion import complete
from pipeline.floorplan.program.defaults import OUTSIDE
from pipeline.floorplan.program.floor_program import (
    Accessibility,
    Entrance,
    FloorProgram,
    Footprint,
    Forbid,
    Link,
    LinkKind,
    Model,
    Range,
    RoomReq,
    RoomType,
    Slug,
    Style,
)

PATH = Path(__file__).resolve().parents[3] / "manifests" / "plan_types.yaml"
MOST_STRETCH = 1.4  # how far rooms of a smaller storey may grow
PerBedroom = Annotated[tuple[float, ...], Field(min_length=1, max_length=2)]  # a, or a and b: a + b per bedroom
Place = Slug | tuple[Slug, ...] | Mapping[Slug, float]  # a room, the first of several that is there, or one of them by their shares


class Step(Model):
    """What is drawn if all of `needs` (rooms, or outcomes of tosses) are there and none of `unless`, for numbers of bedrooms, with some odds."""

    needs: tuple[Slug, ...] = Field(default=(), alias="if")
    unless: tuple[Slug, ...] = ()
    beds: tuple[int, int] | None = None
    odds: PerBedroom | None = None


class RoomStep(Step):
    """A room with a log-normal area [m2], with a door to the room `door`; without an area it follows from the other rooms."""

    room: Slug
    type: RoomType
    area: PerBedroom | None = None
    spread: float = 0.16
    door: Place = ()
    level: int = 0
    functions: tuple[str, ...] = ()


class LinkStep(Step):
    """Two rooms are joined by one of the kinds."""

    link: tuple[Place, Place]
    kinds: tuple[LinkKind, ...] = ()


class BedroomsStep(Step):
    """All bedrooms, with doors to one room: the first of several is the primary one, unless they are alike. Mean areas [m2]."""

    bedrooms: Place
    primary: float = 16.5
    other: float = 13.0
    each: float | None = None
    spread: float = 0.13
    level: int = 0


class TossStep(Step):
    """One of some outcomes, by cumulative chances; none where the last is below 1."""

    toss: Mapping[Slug, float]


class ForbidStep(Step):
    """Two rooms that share no wall."""

    forbid: tuple[Slug, Slug]


class Children(Model):
    """Bedrooms of children: the share of `homes` of two, three, ... bedrooms that have one (the last: of more, too), and the share of `further` bedrooms that are theirs, too.

    None is the first bedroom of a home, and none has more than `size` of the largest one's floor.
    """

    homes: Annotated[tuple[float, ...], Field(min_length=1)]
    further: float
    size: float


class PlanType(Model):
    """A type: its usual weight, its numbers of bedrooms, the room that one enters, and the outline: L-shaped with probability `corner`, a least aspect of `aspects`."""

    weight: float
    least: int
    most: int
    steps: tuple[RoomStep | LinkStep | BedroomsStep | TossStep | ForbidStep, ...]
    storeys: int = 1
    into: Place | None = None
    children: Children | None = None
    corner: float = 0.15
    aspects: tuple[float, ...] = (1.0, 1.0, 1.3)
    span: float = 0.5


@functools.cache
def plan_types() -> Mapping[str, PlanType]:
    """Return the types by name. Raises ContentError naming what is wrong in the manifest."""
    try:
        return TypeAdapter(dict[str, PlanType]).validate_python(yaml_text.parse(PATH.read_text(encoding="utf-8")))
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"]))
        raise ContentError(f"manifests/plan_types.yaml: {where}: {first['msg']}", "compare it with the types beside it") from error


@dataclass(frozen=True, slots=True)
class PriorSettings:
    """Section `prior` of params.yaml: weights of the types, and of one to six bedrooms where a type leaves the choice."""

    types: Mapping[str, float] = field(default_factory=lambda: {name: kind.weight for name, kind in plan_types().items()})
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


def prior(rng: np.random.Generator, settings: PriorSettings | None = None, family: np.random.Generator | None = None) -> FloorProgram:
    """Draw a completed program. `family` draws which bedrooms are children's; without it none is, and all else is the same."""
    settings = settings or PriorSettings()
    names = [n for n in plan_types() if settings.types.get(n, 0.0) > 0]
    weights = np.array([settings.types[n] for n in names])
    kind = plan_types()[names[int(rng.choice(len(names), p=weights / weights.sum()))]]
    beds = 0
    if kind.most > 0:
        counts = np.arange(kind.least, kind.most + 1)
        share = np.array(settings.bedrooms)[counts - 1] + 1e-12
        beds = int(rng.choice(counts, p=share / share.sum()))
    program = complete(draw(kind, beds, rng))
    return _with_children(program, kind.children, family) if kind.children and family is not None else program


def _with_children(program: FloorProgram, children: Children, rng: np.random.Generator) -> FloorProgram:
    """Give some of the smaller bedrooms to children."""
    beds = [r for r in program.rooms if r.type == "bedroom"]
    largest = max((r.area.target or 0.0 for r in beds), default=0.0)
    free = [r.id for r in beds[1:] if (r.area.target or 0.0) <= children.size * largest]
    if not free or rng.random() >= children.homes[min(len(beds) - 2, len(children.homes) - 1)]:
        return program
    first = free[int(rng.integers(len(free)))]
    theirs = {first, *(i for i in free if rng.random() < children.further)}
    rooms = tuple(r.model_copy(update={"role": "child"}) if r.id in theirs else r for r in program.rooms)
    return program.model_copy(update={"rooms": rooms})


def draw(kind: PlanType, beds: int, rng: np.random.Generator) -> FloorProgram:
    """Draw a program of a type with that many bedrooms; its gaps are open."""
    draft = _Draft(rng, beds, kind.storeys)
    for step in kind.steps:
        draft.take(step)
    if kind.storeys > 1:
        draft.balance()
    return draft.program(kind)


class _Draft:
    """A program in the making: its rooms, links, and what the tosses came to."""

    def __init__(self, rng: np.random.Generator, beds: int, storeys: int) -> None:
        self.rng, self.beds, self.storeys = rng, beds, storeys
        self.rooms: list[RoomReq] = []
        self.links: list[Link] = []
        self.forbids: list[Forbid] = []
        self.there: set[str] = set()  # ids of rooms, and outcomes of tosses

    def take(self, step: Step) -> None:
        """Draw what a step says, where it is to be taken."""
        fits = step.beds is None or step.beds[0] <= self.beds <= step.beds[1]
        if not fits or not self.there.issuperset(step.needs) or not self.there.isdisjoint(step.unless):
            return
        if step.odds and self.rng.random() >= self._linear(step.odds):
            return
        match step:
            case RoomStep():
                door = self._place(step.door) if step.door else ""
                area = None if step.area is None else self._linear(step.area)
                self._room(step.room, step.type, area, step.spread, step.level, door, functions=step.functions)
            case LinkStep():
                one, other = (self._place(place) for place in step.link)
                kind = step.kinds[int(self.rng.integers(len(step.kinds)))] if step.kinds else "door"
                self.links.append(Link(a=one, b=other, kind=kind))
            case BedroomsStep():
                door = self._place(step.bedrooms)
                for k in range(self.beds):
                    primary = k == 0 and self.beds > 1 and step.each is None
                    area = step.primary if primary else step.each or step.other
                    self._room(f"bed_{k + 1}", "bedroom", area, step.spread, step.level, door, role="primary" if primary else "")
            case TossStep():
                share = self.rng.random()
                self.there.update([outcome for outcome, most in step.toss.items() if share < most][:1])
            case ForbidStep():
                self.forbids.append(Forbid(what="adjacent", a=step.forbid[0], b=step.forbid[1], stated=False))

    def _linear(self, terms: tuple[float, ...]) -> float:
        return terms[0] if len(terms) == 1 else terms[0] + terms[1] * self.beds

    def _place(self, place: Place) -> str:
        """Return the id of the room that is meant."""
        if isinstance(place, Mapping):
            first, second = place
            return first if self.rng.random() < place[first] else second
        return place if isinstance(place, str) else next(name for name in place if name in self.there)

    def _room(self, name: str, kind: str, mean: float | None, spread: float, level: int, door: str, **fields: object) -> None:
        """Add a room, with a door to the room `door` if one is named."""
        area = Range() if mean is None else Range(target=round(float(mean * np.exp(self.rng.normal(0.0, spread))), 2))
        fields |= {"id": name, "type": kind, "stated": False, "area": area, "level": level if self.storeys > 1 else None}
        self.rooms.append(RoomReq.model_validate(fields))
        self.there.add(name)
        if door:
            self.links.append(Link(a=door, b=name))

    def balance(self) -> None:
        """Stretch the rooms of the smaller of two storeys, so that walls stand above walls."""
        sizes = [sum(r.area.target or 0.0 for r in self.rooms if r.level == v and r.type not in OUTSIDE) for v in (0, 1)]
        stairs = sum(r.area.target or 0.0 for r in self.rooms if r.type == "staircase")
        sizes[1] += stairs
        small = int(sizes[1] < sizes[0])
        factor = min((max(sizes) - stairs) / (min(sizes) - stairs), MOST_STRETCH)
        for k, r in enumerate(self.rooms):
            if r.level == small and r.area.target and r.type not in {*OUTSIDE, "staircase"}:
                self.rooms[k] = r.model_copy(update={"area": Range(target=round(r.area.target * factor, 2))})

    def program(self, kind: PlanType) -> FloorProgram:
        """Return the program; at most three knobs of its style are turned."""
        low = float(self.rng.choice(kind.aspects))
        ell = len(self.rooms) >= 6 and self.rng.random() < kind.corner
        access = Accessibility(min_door=0.9, min_corridor=1.2) if self.rng.random() < 0.06 else Accessibility()
        knobs = [n for n in Style.model_fields if not n.startswith("stair")]
        chosen = self.rng.choice(len(knobs), size=int(self.rng.integers(0, 4)), replace=False)
        return FloorProgram(
            rooms=tuple(self.rooms),
            links=tuple(self.links),
            forbids=tuple(self.forbids),
            entrance=Entrance(into=None if kind.into is None else self._place(kind.into)),
            only=True,
            storeys=kind.storeys,
            style=Style.model_validate({knobs[i]: int(self.rng.choice([-2, -1, 1, 2])) for i in sorted(chosen.tolist())}),
            accessibility=access,
            footprint=Footprint(shape="L" if ell else "rectangle", min_aspect=low, max_aspect=low + kind.span),
        )
