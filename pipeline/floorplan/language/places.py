"""Where rooms lie: storeys, wings and zones."""

from __future__ import annotations

from pipeline.floorplan.language.clause import Clause, ids_of, known
from pipeline.floorplan.language.phrases import Element, heads


def level(c: Clause, k: int, e: Element) -> int:
    """Put rooms on a storey: those named before it, or, where it comes first, those that follow."""
    c.state.levels.append(e)
    ahead = c.near(k + 1)
    if c.forward or heads(c.sentence, k) or ("*" in c.latest and ahead is not None and ahead.kind == "colon"):
        c.state.heights |= {"*": int(e.value)} if "*" in c.latest and not c.forward else {}
        c.forward, c.level, c.run = True, int(e.value), []
        return k + 1
    owners = c.subject if c.objects and c.latest == c.objects else ()  # "a guest room with bath, downstairs"
    for room in (c.stock.get(i) for i in known((*c.latest, *owners))):
        room.level = int(e.value)
    c.state.heights |= {i.removeprefix("*zone_"): int(e.value) for i in c.latest if i.startswith("*")}
    return k + 1


def wing(c: Clause, k: int, e: Element) -> int:
    """Read "the bedrooms in one wing": they are a zone."""
    c.state.understood(e.first, e.last)
    _settle(c, e, ids_of(c.run))
    c.run = []
    return k + 1


def _settle(c: Clause, e: Element, ids: tuple[str, ...]) -> None:
    if not ids or all(i.startswith("*") for i in ids):
        c.state.wings += tuple(i.removeprefix("*zone_") for i in ids if i != "*")
        return
    made = next((n for n, (members, _) in c.state.zones.items() if members and set(members) == set(ids)), None)
    made = made or ("bedroom" if c.types(ids) == {"bedroom"} else f"wing_{len(c.state.wings) + 1}")
    c.state.zones.setdefault(made, (ids, e))
    c.state.wings += (made,)


def zone(c: Clause, k: int, e: Element) -> int:
    """Take the rooms of a zone into the list."""
    c.zone(k, e)
    return k + 1
