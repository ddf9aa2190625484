"""What is known of relations: ways of standing at an anchor, pairs of categories, walls, distances; and as JSON: small, stable, readable."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from pipeline.arrays import Bools, Floats
from pipeline.errors import ContentError
from pipeline.manifest import write_bytes
from pipeline.relations.frames import ALONG, NORMAL, SIDES, Frames, offset_along, wrap_angle

VERSION = 2
METRES, RADIANS = 0.05, 0.09  # a member this near to a mode holds it [m], [rad]: 5 cm, 5 degrees


class Span(NamedTuple):
    """Where the cases lie: 5 %, 50 % and 95 % of them are below; measured from a reference, see `frames.offset_along`."""

    reference: str
    low: float
    middle: float
    high: float

    def excess(self, value: Floats) -> Floats:
        """Return how far values lie outside: negative below, positive above, 0 within."""
        return np.asarray(np.minimum(value - self.low, 0) + np.maximum(value - self.high, 0))


class Mode(NamedTuple):
    """A side of the anchor, the share of members that stand so, their place outwards of it and along it, their turn.

    `turn` is measured from the anchor's yaw (`anchor`), or from the yaw at which the member's front points at the anchor's centre (`facing`).
    """

    side: str
    weight: float
    outwards: Span
    along: Span
    turn: Span

    def distances(self, frames: Frames) -> tuple[Floats, Floats]:
        """Return how far members are off (P,) [m] and (P,) [rad]: 0 within the spans."""
        k = SIDES.index(self.side)
        off = []
        for span, direction in ((self.outwards, NORMAL[k]), (self.along, ALONG[k])):
            beyond = span.excess(offset_along(frames, direction, span.reference))
            off.append(beyond * (frames.anchor @ np.abs(direction)) if span.reference == "share" else beyond)
        turn = self.turn
        angle = wrap_angle((frames.facing if turn.reference == "facing" else frames.turn) - turn.middle)
        beyond = turn._replace(low=turn.low - turn.middle, high=turn.high - turn.middle).excess(angle)
        return np.hypot(*off), np.abs(beyond)


def in_any_mode(modes: tuple[Mode, ...], frames: Frames) -> Bools:
    """Return which members are in a mode (P,)."""
    inside = np.zeros(len(frames.turn), bool)
    for mode in modes:
        metres, radians = mode.distances(frames)
        inside |= (metres <= METRES) & (radians <= RADIANS)
    return inside


class PairRelation(NamedTuple):
    """How members of one category stand to anchors of another. `cases`: members that share a room with an anchor.

    `share` of them are in a mode, `chance` is that of mirrored members.
    """

    anchor: str
    member: str
    cases: int
    share: float
    chance: float
    modes: tuple[Mode, ...]

    @property
    def strength(self) -> float:
        """How much more often than by chance it holds."""
        return self.share - self.chance


class WallRelation(NamedTuple):
    """How things of one category stand to a wall with one of their sides: the gap to it [m], and the turn against it [rad].

    `share` of the cases are so, `chance` is the mean share of the other sides.
    """

    category: str
    side: str
    cases: int
    share: float
    chance: float
    gap: Span
    turn: Span

    @property
    def strength(self) -> float:
        """How much more often than by chance it holds."""
        return self.share - self.chance


@dataclass(frozen=True)
class Relations:
    """All relations; `pairs` by (anchor, member), `walls` by category, strongest side first.

    `distances` [m], by two names in order, is the gap that such things keep in all but a few rooms, where it is one to walk through.
    """

    pairs: Mapping[tuple[str, str], PairRelation]
    walls: Mapping[str, tuple[WallRelation, ...]]
    distances: Mapping[tuple[str, str], float] = field(default_factory=dict)

    def pair(self, anchor: str, member: str) -> PairRelation | None:
        """Return the relation of a member to an anchor, if it has one."""
        return self.pairs.get((anchor, member))

    def save(self, path: Path) -> None:
        """Write relations, a line for each pair, wall and distance."""
        walls = (wall for sides in self.walls.values() for wall in sides)
        listed: dict[str, Iterable[Any]] = {"pairs": self.pairs.values(), "walls": walls}
        listed["distances"] = ((*names, distance) for names, distance in self.distances.items())
        lines = {key: ",\n".join(f"  {json.dumps(row)}" for row in rows) for key, rows in listed.items()}
        parts = [f'"version": {VERSION}', *(f'"{key}": [\n{text}\n]' for key, text in lines.items())]
        write_bytes(path, ("{" + ",\n".join(parts) + "}\n").encode())

    @classmethod
    def load(cls, path: Path) -> "Relations":
        """Read relations. Raises ContentError when the file is missing or holds something else."""
        try:
            tree = json.loads(path.read_text(encoding="utf-8"))
            if tree["version"] != VERSION:
                raise ContentError(f"relations of version {tree['version']}, not {VERSION}", "run `dvc repro preprocess`")
            pairs = [
                PairRelation(a, m, n, share, chance, tuple(_mode(*mode) for mode in modes))
                for a, m, n, share, chance, modes in tree["pairs"]
            ]
            walls = [WallRelation(c, s, n, share, chance, Span(*gap), Span(*turn)) for c, s, n, share, chance, gap, turn in tree["walls"]]
            return relations(pairs, walls, {(str(a), str(b)): float(distance) for a, b, distance in tree["distances"]})
        except FileNotFoundError as error:
            raise ContentError(f"{path} is missing", "run `dvc repro preprocess`, which learns it from the tables") from error
        except (KeyError, TypeError, ValueError) as error:
            raise ContentError(
                f"{path} holds no relations ({type(error).__name__}: {error})", "delete it and run `dvc repro preprocess`"
            ) from error


def relations(
    pairs: Iterable[PairRelation], walls: Iterable[WallRelation], distances: Mapping[tuple[str, str], float] | None = None
) -> Relations:
    """Return relations by their names, the walls' strongest side first."""
    by_category: dict[str, list[WallRelation]] = {}
    for wall in sorted(walls, key=lambda w: (w.category, -w.strength, w.side)):
        by_category.setdefault(wall.category, []).append(wall)
    named = {(p.anchor, p.member): p for p in pairs}
    return Relations(
        dict(sorted(named.items())), {name: tuple(sides) for name, sides in by_category.items()}, dict(sorted((distances or {}).items()))
    )


def _mode(side: str, weight: float, *spans: Any) -> Mode:
    return Mode(side, weight, *(Span(*span) for span in spans))
