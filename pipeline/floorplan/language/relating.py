"""What the cues of a sentence say about the rooms around them: joined, open, near, apart, owned, avoided."""

from __future__ import annotations

from pipeline.floorplan.language import items as kinds
from pipeline.floorplan.language import lexicon
from pipeline.floorplan.language.amounts import attach
from pipeline.floorplan.language.facts import HALLS, PERSONAL, Reading, heard, named
from pipeline.floorplan.language.groups import conjuncts, object_group, open_plan, point
from pipeline.floorplan.language.items import Item

ON_HALL = {
    "bedroom",
    "bathroom",
    "wc",
    "office",
    "closet",
    "storage",
    "utility",
    "playroom",
    "library",
    "media_room",
    "gym",
    "meeting_room",
}


def relations(state: Reading, sentence: list[Item]) -> None:  # noqa: C901, PLR0912 - one branch per kind of item: a grammar
    """Read what the cues of a sentence say about the rooms around them."""
    subject: tuple[str, ...] = ()  # of the clause
    near: tuple[str, ...] = ()  # the latest group
    objects: tuple[str, ...] = ()  # of the latest cue
    index = 0
    while index < len(sentence):
        item = sentence[index]
        if item.kind == kinds.ENTER:
            group, index = object_group(state, sentence, index + 1, wide=False)
            if group:
                state.entrance = group[0]
                near = subject = group
            continue
        if item.kind in {kinds.ROOM, kinds.PRONOUN, kinds.EVERY, kinds.HOME}:
            if item.kind == kinds.ROOM and item.role == "ensuite" and not item.ids and near:
                state.say("ensuite", near, (), item)
            if item.kind == kinds.HOME:
                near = ()
                index += 1
                continue
            group = point(state, sentence, index, subject, near)
            if item.kind == kinds.ROOM or item.role in {"both", "one", "rest"} or item.kind == kinds.EVERY or not near:
                near = group
            if item.kind != kinds.PRONOUN or item.role != "it":
                objects = ()
            if not subject or item.role in {"group", "both", "one", "rest"}:
                subject = group
            elif item.words in {"that", "which"}:
                subject = near
            elif item.kind == kinds.PRONOUN and item.role == "it" and group:
                near = subject if not objects else near
        elif item.kind == kinds.AMOUNT:
            attach(state, sentence, index, subject, near)
        elif item.kind == kinds.CUE:
            index, subject, near, objects = _cue(state, sentence, index, subject, near, objects)
            continue
        elif item.kind == kinds.MUTE and item.words in {"window to the outside", "windows to the outside"} and near:
            state.say("window", near, (), item)
        elif item.kind == kinds.WORD:
            _word(state, sentence, index, near)
        index += 1


def _word(state: Reading, sentence: list[Item], k: int, near: tuple[str, ...]) -> None:
    """Single words that say something about rooms: "daylight", "only", "open plan"."""
    word = sentence[k].words
    if word == "plan" and k and sentence[k - 1].words == "open":
        open_plan(state, sentence, k)
    if word in {"daylight", "windows", "window"} and near:
        before = {i.words for i in sentence[max(0, k - 3) : k]}
        what = "no_window" if before & {"no", "without", "windowless"} else "window"
        state.say(what, near, (), sentence[k])
    if word == "only" and state.facts and state.facts[-1].what == lexicon.DOOR and near:
        state.say("only", state.facts[-1].a, (), sentence[k])


def _cue(  # noqa: C901, PLR0911, PLR0912 - one branch per kind of item: a grammar
    state: Reading, sentence: list[Item], k: int, subject: tuple[str, ...], near: tuple[str, ...], objects: tuple[str, ...]
) -> tuple[int, tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
    """Read one cue; return where to go on, and the new subject, latest group and objects."""
    item = sentence[k]
    cue = item.cue
    unchanged = (k + 1, subject, near, objects)
    if k + 1 < len(sentence) and sentence[k + 1].kind == kinds.COMMA and sentence[k + 1].words != ":":
        return unchanged
    if cue == lexicon.HAS or item.words in {"on", "along", "around", "by", "near", "connects", "serves"}:
        ahead = next((i for i in sentence[k + 1 : k + 8] if i.kind != kinds.WORD), None)
        if ahead is None or ahead.kind not in {kinds.ROOM, kinds.PRONOUN} or not (ahead.ids or ahead.kind == kinds.PRONOUN):
            if not (cue == lexicon.HAS and ahead is not None and ahead.kind == kinds.AMOUNT):
                return unchanged
            return unchanged
        if item.words in {"on", "along", "around"} and state.inventory.get(ahead.ids[0]).type not in HALLS if ahead.ids else False:
            return unchanged
    negative = any(i.words in {"not", "n't", "never", "shouldn't", "mustn't", "don't"} for i in sentence[max(0, k - 3) : k])
    chain = item.words in {"on to", "through to"}
    if not near and not subject and objects == ():
        subject = next(reversed(heard(state, sentence, k)), ()) if cue != lexicon.HAS else ()
        near = subject
    source = objects if chain and objects else (subject if objects and not chain else (near or subject))
    if cue == lexicon.HAS:
        return _has(state, sentence, k, source, subject, near)
    wide = cue in {lexicon.LEADS, lexicon.OPEN, lexicon.BETWEEN}
    if cue == lexicon.DOOR and item.words in {
        "connects to",
        "connected to",
        "connected with",
        "with access to",
        "has access to",
        "linked to",
    }:
        wide = True
    if cue == lexicon.THROUGH:
        return _through(state, sentence, k, subject, objects)
    group, end = object_group(state, sentence, k + 1, wide, subject=source)
    if not group:
        if cue == lexicon.OPEN and len(subject) + len(near) > 1:
            return unchanged
        return unchanged
    state.understood(item)
    halls = [i for i in group if not i.startswith(("*", "<")) and state.inventory.get(i).type in HALLS]
    if cue == lexicon.DOOR and halls and not objects and source and not source[0].startswith("*"):
        listed = conjuncts(state, sentence, k)
        source = tuple(i for i in listed if state.inventory.get(i).type in ON_HALL and i not in halls) or source
    if group == ("<each other>",):
        listed = named(near) if len(near) > 1 and cue != lexicon.OPEN else ()
        listed = listed or conjuncts(state, sentence, k) or named(tuple(dict.fromkeys(subject + near)))
        if negative or cue in {lexicon.BAN, lexicon.AWAY}:
            state.say(lexicon.BAN, listed, listed, item)
        else:
            state.say("merge" if cue == lexicon.OPEN else cue, listed, (), item)
        return end, subject, near, ()
    if cue == lexicon.AWAY and source:
        state.say("away", source, group, item, 0.35)
    elif cue in {lexicon.NEAR, lexicon.WALL} and negative:
        state.say(lexicon.BAN, source, group, item)
    elif negative and cue in {lexicon.OPEN, lexicon.DOOR, lexicon.LEADS}:
        state.say("not_open" if cue == lexicon.OPEN else "not_connected", source, group, item)
    else:
        nook = cue == lexicon.DOOR and _before(sentence, k, {"nook", "alcove", "niche"})
        state.say("open" if nook else cue, source, group, item)
    only = "only" in item.words.split() or (end < len(sentence) and sentence[end].words == "only") or _before(sentence, k, {"only"}, 2)
    if only and cue == lexicon.DOOR:
        state.say("only", source, (), item)
    return end, source, source, group


def _before(sentence: list[Item], k: int, words: set[str], reach: int = 5) -> bool:
    return any(i.words in words for i in sentence[max(0, k - reach) : k])


def _has(
    state: Reading, sentence: list[Item], k: int, source: tuple[str, ...], subject: tuple[str, ...], near: tuple[str, ...]
) -> tuple[int, tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
    """Read "X with its own bathroom": rooms that belong to a room hang on it."""
    item = sentence[k]
    before = next((i for i in reversed(sentence[:k]) if i.kind in {kinds.ROOM, kinds.HOME, kinds.PRONOUN}), None)
    if before is not None and before.kind == kinds.HOME:
        return k + 1, subject, near, ()
    source = near or source or subject
    own = named(source)
    owner = [i for i in own if state.inventory.get(i).type == "bedroom"]
    if not owner:
        living = [i for i in own if state.inventory.get(i).type in {"living_room", "kitchen", "dining_room", "studio_room", "office"}]
        if living and item.words in {"with", "has", "having"}:
            extra = {"balcony", "sunroom", "storage"}
            group, end = object_group(state, sentence, k + 1, wide=False, subject=source, only=extra)
            group = named(group)
            if group and len(living) == 1:
                state.understood(item)
                state.say(lexicon.DOOR, group, tuple(living), item)
                return end, subject, tuple(living), ()
        return k + 1, subject, near, ()
    group, end = object_group(state, sentence, k + 1, wide=True, subject=own, only=PERSONAL)
    group = named(group)
    if not group:
        return k + 1, subject, near, ()
    state.understood(item)
    for kind in dict.fromkeys(state.inventory.get(i).type for i in group):
        things = tuple(i for i in group if state.inventory.get(i).type == kind)
        state.say("own", things, tuple(owner), item)
    return end, tuple(owner), group, group


def _through(
    state: Reading, sentence: list[Item], k: int, subject: tuple[str, ...], objects: tuple[str, ...]
) -> tuple[int, tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
    group, end = object_group(state, sentence, k + 1, wide=False)
    group, listed = named(group), named(subject)
    rooms = [i for i in sentence[:k] if i.kind == kinds.ROOM]
    if not objects and rooms:
        listed = conjuncts(state, sentence, k)
        listed = tuple(i for i in listed if i not in group) or listed
    if group and listed:
        state.understood(sentence[k])
        state.say(lexicon.THROUGH, listed, group, sentence[k])
    return end, subject, subject, objects
