"""Which rooms a pronoun, a list or an object of a sentence stands for."""

from __future__ import annotations

from pipeline.floorplan.language import items as kinds
from pipeline.floorplan.language import lexicon
from pipeline.floorplan.language.amounts import attach
from pipeline.floorplan.language.facts import Reading, heard, named
from pipeline.floorplan.language.items import Item

OPEN_ROOMS = {"kitchen", "dining_room", "living_room", "family_room"}


def point(  # noqa: PLR0911 - one answer per pronoun
    state: Reading, sentence: list[Item], k: int, subject: tuple[str, ...], near: tuple[str, ...]
) -> tuple[str, ...]:
    """Return the rooms that item k points at."""
    item = sentence[k]
    if item.kind == kinds.ROOM or item.ids:
        return tuple(item.ids)
    if item.kind == kinds.EVERY:
        return ("*" + item.type,)
    recent = heard(state, sentence, k)
    if item.role == "it":
        return near or subject or (recent[-1] if recent else ())
    if item.role == "both":
        if near and len(near) == 2:
            return near
        return tuple(dict.fromkeys(i for g in recent[-2:] for i in g))
    if item.role in {"one", "rest"} and recent:
        plural = next((g for g in reversed(recent) if len(g) > 1), recent[-1])
        kind = state.inventory.get(plural[0]).type
        free = [r for r in state.inventory.of(kind) if r.open_slot]
        if item.role == "one":
            taken = free[:1]
            for room in taken:
                room.open_slot = False
            item.ids = [r.id for r in taken]
            return tuple(item.ids)
        return tuple(r.id for r in free)
    if item.role == "group":
        plural = next((g for g in reversed(recent) if len(g) > 1), ())
        return plural or near or subject
    return near


def object_group(  # noqa: C901, PLR0912 - one branch per kind of item: a grammar
    state: Reading, sentence: list[Item], start: int, wide: bool, subject: tuple[str, ...] = (), only: set[str] | None = None
) -> tuple[tuple[str, ...], int]:
    """Return the rooms named after a cue, and where reading goes on. `wide`: the whole list, commas included."""
    group: list[str] = []
    index = end = start
    comma = False
    while index < len(sentence):
        item = sentence[index]
        if item.kind == kinds.ROOM and item.ids:
            if group and not wide and comma:
                break
            if group and _starts_clause(sentence, index):
                break
            if only is not None and state.inventory.get(item.ids[0]).type not in only and not set(item.ids) <= set(subject):
                break
            if group and only is not None and comma and not (set(item.mods) & {"own", "its", "their", "a", "an", "private"}):
                break
            group += [i for i in item.ids if i not in group and i not in subject]
            comma = False
            end = index + 1
        elif item.kind == kinds.PRONOUN and not group:
            if item.role == "each other":
                return ("<each other>",), index + 1
            # an object "it" points past the subject
            others = [g for g in heard(state, sentence, index) if not set(g) & set(subject)]
            if item.role == "both":
                here = [tuple(i.ids) for i in sentence[:index] if i.kind == kinds.ROOM and not set(i.ids) & set(subject)]
                flat = list(dict.fromkeys(i for g in (here if len(here) > 1 else others) for i in g))
                group = _last_two(state, flat, subject)
            elif item.role == "it" and others:
                group = list(others[-1])
            end = index + 1
            break
        elif item.kind == kinds.EVERY and not group:
            return ("*" + item.type,), index + 1
        elif item.kind == kinds.COMMA:
            if item.words in {":", ")"} or (item.words == "(" and group):
                break
            comma = True
        elif item.kind == kinds.AND:
            comma = comma and wide
        elif item.kind == kinds.CUE or item.kind in {kinds.ENTER, kinds.HOME, kinds.LEVEL}:
            if group or item.cue not in {lexicon.BETWEEN, lexicon.HAS}:
                break
        elif item.kind == kinds.AMOUNT:
            if only is None and (group or item.unit in {"area", "length"}):
                break
            attach(state, sentence, index, subject, subject)
        elif item.kind == kinds.MUTE and group and comma:
            break
        index += 1
    return tuple(group), end


def _last_two(state: Reading, flat: list[str], subject: tuple[str, ...]) -> list[str]:
    kinds_seen = {state.inventory.get(i).type for i in named(subject)}
    rest = [i for i in flat if state.inventory.get(i).type not in kinds_seen]
    return rest[-2:]


def _starts_clause(sentence: list[Item], k: int) -> bool:
    """Whether the room at k, after a comma, is the subject of a cue of its own."""
    back = k - 1
    while back >= 0 and sentence[back].kind in {kinds.WORD, kinds.AND}:
        back -= 1
    if back < 0 or sentence[back].kind != kinds.COMMA:
        strong = k > 0 and any(i.kind == kinds.AND for i in sentence[max(0, k - 3) : k])
        if not strong:
            return False
    for item in sentence[k + 1 :]:
        if item.kind in {kinds.WORD, kinds.MUTE}:
            continue
        verb = item.kind == kinds.CUE and item.cue != lexicon.HAS and item.words not in {"on", "around", "along", "by", "near"}
        return verb and back >= 0 and sentence[back].kind == kinds.COMMA
    return False


def conjuncts(state: Reading, sentence: list[Item], k: int) -> tuple[str, ...]:
    """Return the rooms of the list that ends just before item k."""
    group: list[str] = []
    for item in reversed(sentence[:k]):
        if item.kind == kinds.ROOM:
            group = [*item.ids, *group]
        elif item.kind in {kinds.CUE, kinds.HOME, kinds.ENTER, kinds.LEVEL} or (item.kind == kinds.COMMA and item.words in {":", "("}):
            if item.kind == kinds.CUE and item.cue == lexicon.HAS and group:
                break
            if group or item.kind != kinds.CUE:
                break
        elif item.kind == kinds.PRONOUN and item.role in {"both", "rest", "one"}:
            return tuple(group) or point(state, sentence, sentence.index(item), (), ())
    return tuple(dict.fromkeys(group))


def open_plan(state: Reading, sentence: list[Item], k: int) -> None:
    """Read "Open-plan kitchen/living/dining" joins the rooms of the list; "open-plan kitchen" is open to where one lives."""
    listed: list[str] = []
    for item in sentence[k + 1 :]:
        if item.kind == kinds.ROOM and item.type in OPEN_ROOMS:
            listed += item.ids
        elif item.kind not in {kinds.COMMA, kinds.AND, kinds.WORD} or item.words in {":", "with"}:
            break
    if len(listed) > 1:
        state.say("merge", tuple(dict.fromkeys(listed)), (), sentence[k])
    elif listed and state.inventory.get(listed[0]).type == "kitchen":
        state.say("open_kitchen", tuple(listed), (), sentence[k])
