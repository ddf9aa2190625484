"""What is known of relations: pairs of categories, walls, and the questions that are put to them."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from pipeline.relations.arrangement import Thing
from pipeline.relations.frames import relate
from pipeline.relations.modes import Mode, Nearest, Pose, Span, boxes, nearest


class Tendency:
    """What holds in a `share` of its cases, and by `chance` alone in another."""

    __slots__ = ()
    share: float
    chance: float

    @property
    def strength(self) -> float:
        """How much more often than by chance it holds."""
        return self.share - self.chance


@dataclass(frozen=True, slots=True)
class PairRelation(Tendency):
    """How members of one category stand to anchors of another. `cases`: members that share a room with an anchor.

    `share` of them are in a mode, `chance` is that of mirrored members.
    """

    anchor: str
    member: str
    modes: tuple[Mode, ...]
    cases: int
    share: float
    chance: float


@dataclass(frozen=True, slots=True)
class WallRelation(Tendency):
    """How things of one category stand to a wall with one of their sides: the gap to it [m], and the turn against it [rad].

    `share` of the cases are so, `chance` is the mean share of the other sides.
    """

    category: str
    side: str
    gap: Span
    turn: Span
    cases: int
    share: float
    chance: float


@dataclass(frozen=True)
class Relations:
    """All relations; `pairs` by (anchor, member), `walls` by category, strongest side first.

    `distances` [m], by two names in order, is the gap that such things keep in all but a few rooms, where it is one to walk through.
    """

    pairs: Mapping[tuple[str, str], PairRelation]
    walls: Mapping[str, tuple[WallRelation, ...]]
    distances: Mapping[tuple[str, str], float] = field(default_factory=dict)
    _anchors: dict[str, tuple[PairRelation, ...]] = field(default_factory=dict, repr=False, compare=False)

    def pair(self, anchor: str, member: str) -> PairRelation | None:
        """Return the relation of a member to an anchor, if it has one."""
        return self.pairs.get((anchor, member))

    def anchors(self, member: str) -> tuple[PairRelation, ...]:
        """Return the relations of a member, strongest first."""
        if member not in self._anchors:
            own = [pair for (_, name), pair in self.pairs.items() if name == member]
            self._anchors[member] = tuple(sorted(own, key=lambda p: (-p.strength, p.anchor)))
        return self._anchors[member]

    def strongest(self, least: float = 0.0) -> list[PairRelation]:
        """Return the relations of at least this strength, strongest first."""
        pairs = [pair for pair in self.pairs.values() if pair.strength >= least]
        return sorted(pairs, key=lambda p: (-p.strength, p.anchor, p.member))

    def nearest(self, anchor: Thing, member: Thing) -> Nearest | None:
        """Return how far a member is from the nearest mode at this anchor, and the pose that would be in it; None without a relation."""
        pair = self.pair(anchor.category, member.category)
        if pair is None:
            return None
        index, metres, radians = nearest(pair.modes, relate(boxes([anchor]), boxes([member])))
        mode = int(index[0])
        return Nearest(mode, float(metres[0]), float(radians[0]), pair.modes[mode].pose(anchor, member, member.size))

    def poses(self, anchor: Thing, member: str, size: tuple[float, float, float]) -> list[Pose]:
        """Return where a member of this size would stand at the anchor, one pose for each mode, likeliest first."""
        pair = self.pair(anchor.category, member)
        if pair is None:
            return []
        return sorted((mode.pose(anchor, None, size) for mode in pair.modes), key=lambda pose: -pose.weight)

    def best(self, member: Thing, anchors: Sequence[Thing]) -> tuple[int, Nearest] | None:
        """Return the anchor (its index) at whose modes the member is nearest, and that nearest mode; None where none relates."""
        candidates = [(k, near) for k, anchor in enumerate(anchors) if (near := self.nearest(anchor, member)) is not None]
        return min(candidates, key=lambda f: f[1].metres + 0.5 * f[1].radians) if candidates else None


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
