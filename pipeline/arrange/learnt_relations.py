"""What the training tables say of categories and pairs of them, in the form that the arranger asks for."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from pipeline import taxonomy
from pipeline.arrays import Floats
from pipeline.relations.frames import REFERENCES, SIDES
from pipeline.relations.model import Mode, PairRelation, Relations, Span

MUST, WANT = 0.85, 0.4  # share of a category's training examples with their backs at walls from which it must, or would rather, be so
UNKNOWN = 0.6  # the share that is taken of a category that the training tables do not know: to the wall where it is drafted near one
GAP = (0.004, 0.012, 0.035)  # and its gap to the wall [m]
CORNERED = 0.25  # share of the training examples with a side at a wall, and
SNUG = 0.1  # usual gap there [m], from which on a category belongs into corners when it is drafted near one
STRENGTH = 0.5  # relations that are weaker bind nobody
RARE = 0.1  # modes in which fewer stand, as a share of those in the commonest, bind nobody: a desk's chair on the other side of the room

Mount = Literal["floor", "wall", "ceiling"]


@dataclass(frozen=True, slots=True)
class Habit:
    """What is known of a category by itself.

    `backed`: the share of the training examples whose back is at a wall, `gap` then least, usual and most to it [m].
    `corner` is least, usual and most of its side's gap to the wall of a corner [m], None for what has no place there.
    `access` is where people come to it: before its front, or at both its sides. `kind` is its super-category.
    """

    mount: Mount
    backed: float
    gap: tuple[float, float, float]
    access: Literal["", "front", "sides"]
    kind: str
    corner: tuple[float, float, float] | None = None

    @property
    def must(self) -> bool:
        """Whether it belongs to a wall."""
        return self.backed >= MUST

    @property
    def wants(self) -> bool:
        """Whether it belongs to a wall or would rather be at one."""
        return self.backed >= WANT


@dataclass(frozen=True, slots=True, eq=False)
class LearntRelations:
    """The relations, answers kept."""

    known: Relations
    _habits: dict[str, Habit] = field(default_factory=dict)
    _modes: dict[tuple[str, str], tuple[Floats, float] | None] = field(default_factory=dict)

    def habit(self, category: str) -> Habit:
        """Return what is known of a category."""
        if category not in self._habits:
            self._habits[category] = _habit(category, self.known)
        return self._habits[category]

    def modes(self, anchor: str, member: str) -> tuple[Floats, float] | None:
        """Return the modes of a relation as rows (M, 13), see `_row`, and its strength; None where there is none that binds."""
        key = (anchor, member)
        if key not in self._modes:
            pair = self.known.pair(anchor, member)
            self._modes[key] = _rows(pair) if pair is not None and pair.strength >= STRENGTH and pair.modes else None
        return self._modes[key]

    def distances(self, categories: Sequence[str]) -> Floats:
        """Return how far things of N categories keep from each other (N, N) [m], 0 where it does not matter."""
        known = self.known.distances
        apart = [known.get((min(one, other), max(one, other)), 0.0) for one in categories for other in categories]
        return np.array(apart).reshape(len(categories), len(categories))


def _habit(category: str, known: Relations) -> Habit:
    entry = taxonomy.load().categories.get(category)
    mount: Mount = entry.mount if entry is not None else "floor"
    kind = entry.super if entry is not None else ""
    if mount == "ceiling":
        return Habit(mount, 0.0, GAP, "", kind)
    back = next((w for w in known.walls.get(category, ()) if w.side == "back"), None)
    learnt = category in known.walls or any(member == category for _, member in known.pairs)
    share = back.share if back is not None else 0.0 if learnt else UNKNOWN
    gap = GAP
    if back is not None:  # some of them stand away from the wall; whoever goes to it goes as near as most do
        usual = min(max(GAP[0], back.gap.middle), GAP[2])
        gap = (GAP[0], usual, max(usual, min(back.gap.high, 2 * GAP[2])))
    if mount == "wall":
        return Habit(mount, 1.0, gap, "", kind)
    access: Literal["front", "sides", ""] = "sides" if kind == "bed" else "front" if share >= WANT and kind != "other" else ""
    sides = [w.gap for w in known.walls.get(category, ()) if w.side in {"left", "right"} and w.share >= CORNERED]
    snug = min(sides, key=lambda span: span.middle, default=None)
    corner = None
    if snug is not None and snug.middle <= SNUG:
        corner = max(GAP[0], snug.low), max(GAP[0], snug.middle), max(GAP[0], snug.high)
    return Habit(mount, share, gap, access, kind, corner)


def _rows(pair: PairRelation) -> tuple[Floats, float]:
    least = RARE * max(mode.weight for mode in pair.modes)
    return np.array([_row(mode) for mode in pair.modes if mode.weight >= least]), pair.strength


def _row(mode: Mode) -> list[float]:
    """Return a mode as numbers: side; reference, low, middle, high outwards and along; whether it faces, low, middle, high of the turn."""
    turn = mode.turn
    bounds = turn.low - turn.middle, turn.middle, turn.high - turn.middle
    return [float(SIDES.index(mode.side)), *_span(mode.outwards), *_span(mode.along), float(turn.reference == "facing"), *bounds]


def _span(span: Span) -> tuple[float, float, float, float]:
    return float(REFERENCES.index(span.reference)), span.low, span.middle, span.high
