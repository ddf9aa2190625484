"""How many openings lie between rooms: `hops` relations, and which of them a set of links breaks."""

from collections.abc import Sequence
from typing import NamedTuple

from pipeline.entities.plan import hops
from pipeline.floorplan.program.floor_program import FloorProgram, Link


class Distance(NamedTuple):
    """At least `least` openings are to lie on every way from room `a` to room `b`; `selector` is what the request called `a`."""

    selector: str
    a: str
    b: str
    least: float


class Nearness(NamedTuple):
    """A distance that is not kept: only so many `openings` lie between the rooms."""

    asked: Distance
    openings: int


def distances(program: FloorProgram) -> tuple[Distance, ...]:
    """Return what the `hops` relations ask for, room by room; without `b` the rooms of `a` are meant with each other."""
    return tuple(
        Distance(r.a, a.id, b.id, r.value)
        for r in program.relations
        if r.kind == "hops"
        for a in program.select(r.a)
        for b in program.select(r.b or r.a)
        if a.id != b.id
    )


def nearness(asked: Sequence[Distance], links: Sequence[Link]) -> list[Nearness]:
    """Return the distances that the graph of links breaks. Rooms that nothing joins yet are far apart."""
    pairs = [(link.a, link.b) for link in links if link.opens]
    doors = [(distance, hops(pairs, distance.a).get(distance.b)) for distance in asked]
    return [Nearness(distance, count) for distance, count in doors if count is not None and count < distance.least]
