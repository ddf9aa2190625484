"""What is said of places and open plans."""

from __future__ import annotations

import itertools

from pipeline.floorplan.language.facts import SOCIAL, Clause
from pipeline.floorplan.language.introductions import heads
from pipeline.floorplan.language.naming import and_follows, name
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


def merge(clause: Clause, k: int, e: Element) -> None:
    """Read "open kitchen/living room" and "combined kitchen and living room"; an open kitchen alone is open to where one lives."""
    listed = list(e.ids)
    written_on = "bare_nouns" in clause.state.heard.lexicon.traits  # "客厅餐厅厨房" needs no comma
    joined = written_on
    for x in clause.sentence[k + 1 :]:
        if x.kind == "np" and joined and x.type in SOCIAL and not x.banned:
            listed += name(clause.state, clause.sentence, clause.sentence.index(x), storey(clause, k))
            joined = written_on
        elif (
            x.kind == "and"
            or (x.kind == "comma" and e.type in SOCIAL and and_follows(clause.sentence, x))
            or (x.kind == "cue" and x.value == "has" and len(listed) == 1)
        ):
            joined = True
        else:
            break
    if len(dict.fromkeys(listed)) < 2 and e.said and k > 1 and clause.sentence[k - 1].kind == "and" and _behind(clause, e):
        listed += [i for i in clause.sentence[k - 2].ids if clause.sentence[k - 2].type in SOCIAL]  # "cocina y salón abiertos"
    if len(dict.fromkeys(listed)) > 1 and e.type in SOCIAL:
        clause.state.say("merge", tuple(listed), (), e)
    elif e.type == "kitchen":
        clause.state.say("open_kitchen", tuple(e.ids), (), e)


def _behind(clause: Clause, e: Element) -> bool:
    """Whether an adjective stands behind its room."""
    return e.mark is not None and e.last > e.mark.last and "adjectives_behind" in clause.state.heard.lexicon.traits


def merge_after(clause: Clause, k: int, e: Element) -> None:
    """Read "open plan: living, dining, kitchen": what is named behind the words."""
    listed = [
        i
        for x in clause.sentence[k:]
        if x.kind == "np" and x.type in SOCIAL
        for i in name(clause.state, clause.sentence, clause.sentence.index(x), None)
    ]
    if len(listed) > 1:
        clause.state.say("merge", tuple(listed), (), e)


def written_as_one(clause: Clause, k: int, e: Element) -> int:
    """Return the place of the room that is written as one with that at k, "kitchen/living", "salón-cocina"; 0 for none."""
    j = next((j for j, x in enumerate(clause.sentence[k + 1 : k + 3], k + 1) if x.kind == "np"), 0)
    if not j or clause.sentence[j].type not in SOCIAL - {e.type}:
        return 0
    tokens = clause.state.heard.tokens
    between = clause.state.heard.prompt[tokens[e.last - 1].end : tokens[clause.sentence[j].first].start]
    return j if between in {"/", "-", "–", "/-"} else 0


def no_door(clause: Clause) -> None:
    """Read "no door between kitchen and bedroom", "keine Tür von der Garage ins Schlafzimmer"; the words are taken out."""
    parting = {"comma", "but", "colon"} if any(e.value == "thoroughfare" for e in clause.sentence) else {"comma", "but"}
    ends = [-1, *(k for k, e in enumerate(clause.sentence) if e.kind in parting), len(clause.sentence)]
    for first, last in itertools.pairwise(ends):
        part = clause.sentence[first + 1 : last]
        none = next((j for j, e in enumerate(part) if e.kind in {"neg", "used"}), None)
        if none is not None and (flag := next((e for e in part if e.kind == "flag" and e.value == "thoroughfare"), None)):
            _no_way(clause, part, flag)
            clause.sentence[first + 1 : last] = []
            return
        if none is not None and (wall := next((e for e in part[none:][1:6] if (e.kind, e.value) == ("flag", "partition")), None)):
            _no_wall(clause, first + 1, last, wall)
            return
        door = next((e for e in part[none:][1:4] if _a_door(e)), None) if none is not None else None
        rooms = [k for k in range(first + 1, last) if clause.sentence[k].kind == "np"]
        if door is None and none is not None and len(rooms) == 2:  # "the bathroom door must not open into the kitchen"
            door = next((e for e in clause.sentence[rooms[0] + 1 : first + 1 + none] if e.kind == "flag" and e.value == "doors"), None)
        if door is None or len(rooms) != 2:
            continue
        a, b = (tuple(name(clause.state, clause.sentence, k, None)) for k in rooms)
        clause.state.say("not_connected", a, b, door)
        clause.sentence[first + 1 : last] = []
        return


def _a_door(e: Element) -> bool:
    """Whether a door is spoken of, by itself or with its "to"."""
    return (e.kind == "flag" and e.value == "doors") or (e.kind == "cue" and e.text.split()[0] in {"tuer", "tuere", "verbindung"})


def _no_wall(clause: Clause, first: int, last: int, wall: Element) -> None:
    """Read "no wall between kitchen and living room" as open; behind a comma it is said of the two in front."""
    here = [k for k in range(first, last) if clause.sentence[k].kind == "np"]
    rooms = here or [k for k in range(first) if clause.sentence[k].kind == "np"][-2:]
    if len(rooms) < 2:
        return
    ids = tuple(i for k in rooms for i in name(clause.state, clause.sentence, k, None))
    clause.state.say("merge", ids, (), wall)
    for k in here:
        clause.state.understood(clause.sentence[k].first, clause.sentence[k].last)
    clause.sentence[first:last] = [] if here else [wall]


def _no_way(clause: Clause, part: list[Element], flag: Element) -> None:
    """Read "no bedroom is a thoroughfare", "no walk-through bedrooms", "the study must not be a through room"."""
    rooms: list[str] = []
    for x in (x for x in part if x.kind == "np"):
        k = next(i for i, y in enumerate(clause.sentence) if y is x)
        rooms += [f"*{x.type}"] if x.banned or not x.definite else name(clause.state, clause.sentence, k, None)
    clause.state.say("no_through", tuple(rooms) or ("*bedroom",), (), flag)


def windows(clause: Clause, k: int, e: Element, negative: bool) -> int:
    """Read "no windows in the bedroom", "the bath needs daylight"; return where to go on."""
    rooms = tuple(i for i in (clause.latest or clause.subject) if not i.startswith("*"))
    j = k + 1
    ahead = clause.sentence[j] if j < len(clause.sentence) else None
    if ahead is not None and ahead.kind == "cue" and ahead.value == "in" and (negative or not clause.run):
        named, end = clause.after(j + 1, "in", ())
        rooms, j = (named, end) if named else (rooms, j)
    if rooms:
        clause.state.say("no_window" if negative else "window", rooms, (), e)
    clause.negative = None
    return j
