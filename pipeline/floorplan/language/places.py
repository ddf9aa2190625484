"""Where rooms lie: storeys, wings, zones."""

from __future__ import annotations

from pipeline.floorplan.language.clause import Clause
from pipeline.floorplan.language.introductions import heads
from pipeline.floorplan.language.phrases import Element


def storey(clause: Clause, k: int) -> int | None:
    """Return the storey that is said of the phrase at k."""
    if clause.sentence[k].role == "landing":
        return 1
    if clause.forward:
        return clause.level
    for j, e in enumerate(clause.sentence[k + 1 :], k + 1):
        if e.kind == "level":
            return None if heads(clause.sentence, j) else int(e.value)
        if e.kind not in {"np", "and", "comma", "or", "det"}:
            return None
    return None


def level(clause: Clause, k: int, e: Element) -> int:
    """Put rooms on a storey: those named before it, or, where it comes first, those that follow."""
    clause.state.understood(e.first, e.last)
    clause.state.levels.append(e)
    if clause.forward:
        clause.level = int(e.value)
        clause.run = []
    elif heads(clause.sentence, k) or ("*" in clause.latest and any(x.kind == "colon" for x in clause.sentence[k + 1 : k + 2])):
        clause.state.heights |= dict.fromkeys((i for i in clause.latest if i == "*"), int(e.value))
        clause.forward, clause.level, clause.run = True, int(e.value), []
    else:
        owners = clause.subject if clause.objects and clause.latest == clause.objects else ()  # "a guest room with bath, downstairs"
        for room in (clause.stock.get(i) for i in (*clause.latest, *owners) if not i.startswith("*")):
            room.level = int(e.value)
        clause.state.heights |= {i.removeprefix("*zone_"): int(e.value) for i in clause.latest if i.startswith("*")}
        if k + 1 < len(clause.sentence) and clause.sentence[k + 1].kind == "comma":
            clause.run = []
    return k + 1


def wing(clause: Clause, k: int, e: Element) -> int:
    """Read "the bedrooms in one wing": they are a zone."""
    clause.state.understood(e.first, e.last)
    before = clause.sentence[k - 1].kind if k else "comma"
    ahead = next((x.kind for x in clause.sentence[k + 1 :] if x.kind not in {"det", "colon", "verb", "pron"}), "")
    if before in {"comma", "colon", "and"} and ahead == "np":  # "on one side the bedrooms, on the other kitchen and living room"
        close(clause)
        clause.wing, clause.run = (e, []), []
        return k + 1
    _settle(clause, e, tuple(i for x in clause.run for i in x.ids))
    clause.run = []
    return k + 1


def close(clause: Clause) -> None:
    """Make a zone of the rooms that were named behind the words for a wing."""
    if clause.wing is not None:
        e, ids = clause.wing
        clause.wing = None
        _settle(clause, e, tuple(dict.fromkeys(ids)))


def _settle(clause: Clause, e: Element, ids: tuple[str, ...]) -> None:
    if not ids or all(i.startswith("*zone_") for i in ids) or "*" in ids:
        clause.state.wings += tuple(i.removeprefix("*zone_") for i in ids if i != "*")
    else:
        made = next((n for n, (members, _) in clause.state.zones.items() if members and set(members) == set(ids)), None)
        kinds = {clause.stock.get(i).type for i in ids if not i.startswith("*")}
        made = made or ("bedroom" if kinds == {"bedroom"} else f"wing_{len(clause.state.wings) + 1}")
        clause.state.zones.setdefault(made, (ids, e))
        clause.state.wings += (made,)


def zone(clause: Clause, k: int, e: Element) -> int:
    """Take the rooms of a zone into the list."""
    clause.state.understood(e.first, e.last)
    kinds = {"bedroom": ("bedroom",), "living": ("living_room", "dining_room", "family_room"), "work": ("office", "meeting_room")}
    members = tuple(r.id for r in clause.stock.rooms if r.type in kinds.get(e.value, ()) or (r.type == "bedroom" and r.role == e.value))
    e.ids = list(members) if members else [f"*zone_{e.value}"]
    clause.state.zones.setdefault(e.value, (members, e))
    clause.push(k, e, tuple(e.ids))
    return k + 1
