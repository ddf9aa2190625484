"""Which rooms of a house are furnished as 3D-FRONT's are: their number in the observed shares, their types likewise."""

import functools
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pipeline.corpus import front_statistics
from pipeline.corpus.houses import rates
from pipeline.corpus.houses.room_list import PRIVATE
from pipeline.corpus.houses.stratified_draws import Deal
from pipeline.seeds import generator

BLOCK = 32
"""Houses over which decisions are dealt evenly."""
MOST_PRIVATE = 5
"""Rooms that a plan can hold beside the living rooms."""
CORRIDORS = ("Hallway", "Aisle", "Corridor")
KINDS: Mapping[str, str] = {name: room["chances"] for name, room in rates.load()["rooms"].items()}  # whose chances furnish a type of room


@dataclass(frozen=True, slots=True)
class Agenda:
    """The types of the furnished rooms, and per recipe the first ordinal of this house and the total of its block."""

    block: int
    rooms: tuple[str, ...]
    ordinals: Mapping[str, tuple[int, int]]

    def deal(self, seed: int, room_type: str, number: int, place: int) -> Deal:
        """Return the hand of the `number`-th furnished room of its recipe; `place` is the house's in its block."""
        kind = KINDS[room_type]
        first, total = self.ordinals.get(kind, (0, 0))
        if not total:  # rooms that every house has: one stratum per house
            return Deal(seed, f"{kind}.{number}", self.block, place, BLOCK)
        return Deal(seed, kind, self.block, first + number, total)


def agenda(seed: int, index: int) -> Agenda:
    """Return what is furnished in house `index`."""
    return _block(seed, index // BLOCK)[index % BLOCK]


@functools.lru_cache(maxsize=64)
def _block(seed: int, block: int) -> tuple[Agenda, ...]:
    rng = generator(seed, "agenda", block)
    weights: Mapping[str, float] = rates.load()["agenda"]
    names, shares = list(weights), np.array(list(weights.values()))
    drawn = [_rooms(rng, names, shares, n) for n in _numbers(rng)]
    typed = _living(rng, drawn)
    totals = Counter(KINDS[t] for rooms in typed for t in rooms)
    counts: Counter[str] = Counter()
    agendas = []
    for rooms in typed:
        agendas.append(Agenda(block, rooms, {kind: (counts[kind], total) for kind, total in totals.items()}))
        counts.update(KINDS[t] for t in rooms)
    return tuple(agendas)


def _numbers(rng: np.random.Generator) -> list[int]:
    """Return how many rooms each house of a block furnishes: the observed shares, evenly."""
    houses = np.array(front_statistics.load().furnished_rooms, float)
    edges = np.cumsum(houses) / houses.sum()
    marks = (np.arange(BLOCK) + rng.random()) / BLOCK
    return [int(n) + 1 for n in rng.permutation(np.searchsorted(edges, marks))]


def chances(shares: NDArray[np.float64], number: int) -> NDArray[np.float64]:
    """Return the chance of each candidate to be among `number` chosen ones: in proportion to the shares, at most 1."""
    sure = np.zeros(len(shares), bool)
    while True:
        probabilities = np.where(sure, 1.0, shares * (number - sure.sum()) / shares[~sure].sum())
        new = (probabilities >= 1) & ~sure
        if not new.any():
            return np.asarray(probabilities)
        sure |= new


def _rooms(rng: np.random.Generator, names: list[str], shares: NDArray[np.float64], number: int) -> tuple[str, ...]:
    """Choose rooms by systematic sampling in a random order."""
    likely = chances(shares, number)
    while True:
        order = rng.permutation(len(names))
        ends = np.cumsum(likely[order])
        picks = order[np.searchsorted(ends, np.arange(number) + rng.random())]
        rooms = tuple(names[i].removesuffix("_2") for i in sorted(picks))
        if sum(t in PRIVATE for t in rooms) <= MOST_PRIVATE:
            return rooms


def _living(rng: np.random.Generator, drawn: list[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Say which living rooms are dining rooms as well: those of houses without a dining room, in their share."""
    alone = [k for k, rooms in enumerate(drawn) if "living" in rooms and "DiningRoom" not in rooms]
    share = float(rates.load()["living_dining"])  # type: ignore[arg-type]
    marks = (rng.permutation(len(alone)) + rng.random()) / max(1, len(alone))
    both = {k for k, mark in zip(alone, marks, strict=True) if mark < share}
    return [
        tuple(("LivingDiningRoom" if k in both else "LivingRoom") if t == "living" else t for t in rooms) for k, rooms in enumerate(drawn)
    ]
