"""Relation rates: how often things stand to each other as they do in furnished rooms, real beside made.

Rates are shares of cases with 95 % Wilson intervals: the rules of `pipeline.metrics.rules`, and the strongest relations that
the training tables show. Counts are means per room with bootstrap intervals.
"""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from pipeline import taxonomy
from pipeline.metrics.intervals import Rate, bootstrap, rate
from pipeline.metrics.rules import CHAIRS, RULES, TABLES, Rule, backs, frames_of, of
from pipeline.relations.arrangement import Arrangement, make_arrangement
from pipeline.relations.model import PairRelation, Relations, in_any_mode

Json = dict[str, Any]
Sets = Mapping[str, Sequence[Arrangement]]

WANTS_A_WALL = 0.85  # share of training things with their backs at a wall from which on a category wants one
STRONG = 0.5  # least strength of a learnt relation that is reported, and
MOST = 24  # how many are


def furniture(room: Arrangement) -> Arrangement:
    """Return a room with the things that the layout model learns, and no others."""
    names = set(taxonomy.load().names)
    kept = [k for k, name in enumerate(room.categories) if name in names]
    things = [(room.categories[k], room.position[k], room.yaw[k], room.size[k]) for k in kept]
    return make_arrangement(room.name, room.layout_type, room.polygon, things, room.openings)


def compare(rng: np.random.Generator, sets: Sets, known: Relations) -> Json:
    """Return every rate and count for each set of rooms, by name of the figure, then of the set; the first set is the real one.

    A category wants a wall at its back where most of its training things have one.
    """
    sets = {key: [furniture(room) for room in rooms] for key, rooms in sets.items()}
    at_walls = [wall for sides in known.walls.values() for wall in sides if wall.side == "back" and wall.gap.high < 0.2]
    rules = {**RULES, "back at the wall": backs(frozenset(wall.category for wall in at_walls if wall.share >= WANTS_A_WALL))}
    learnt = {f"{pair.member} at {pair.anchor}": holding(pair) for pair in notable(known)}
    types = ["all", *sorted({room.layout_type for room in next(iter(sets.values()))})]
    counts = {
        kind: {key: [len(r.categories) for r in rooms if kind in {"all", r.layout_type}] for key, rooms in sets.items()} for kind in types
    }
    chairs = {key: [len(of(room, CHAIRS)) for room in rooms if len(of(room, TABLES))] for key, rooms in sets.items()}
    return {
        "rates": {name: {key: rule_rate(rooms, rule) for key, rooms in sets.items()} for name, rule in sorted(rules.items())},
        "learnt": {name: {key: rule_rate(rooms, rule) for key, rooms in sets.items()} for name, rule in learnt.items()},
        "objects": {kind: {key: bootstrap(rng, own) for key, own in by_set.items()} for kind, by_set in counts.items()},
        "chairs": {key: bootstrap(rng, own) for key, own in chairs.items()},
    }


def rule_rate(rooms: Sequence[Arrangement], rule: Rule) -> Rate:
    """Return how often a rule holds over all its cases."""
    verdicts = [verdict for room in rooms for verdict in rule(room)]
    return rate(sum(verdicts), len(verdicts))


def notable(known: Relations) -> list[PairRelation]:
    """Return the strongest relations among what the layout model learns, one for each pair of categories and three for each member."""
    names = set(taxonomy.load().names)
    by_pair: dict[frozenset[str], PairRelation] = {}
    taken: Counter[str] = Counter()
    for pair in sorted(known.pairs.values(), key=lambda p: (-p.strength, p.anchor, p.member)):
        both = frozenset((pair.anchor, pair.member))
        if pair.strength >= STRONG and both <= names and both not in by_pair and taken[pair.member] < 3:
            by_pair[both] = pair
            taken[pair.member] += 1
    return list(by_pair.values())[:MOST]


def holding(pair: PairRelation) -> Rule:
    """Return the rule for members of a relation in rooms that have an anchor: one of its modes holds at the nearest."""

    def rule(room: Arrangement) -> Iterator[bool]:
        anchors, members = of(room, (pair.anchor,)), of(room, (pair.member,))
        for k in members:
            others = anchors[anchors != k]
            if len(others):
                frames = frames_of(room, others, np.array([k]))
                yield bool(in_any_mode(pair.modes, frames[np.array([frames.distance().argmin()])])[0])

    return rule
