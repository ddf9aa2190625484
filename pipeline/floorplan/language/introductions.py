"""The rooms that are ruled out, and those that numbers and articles introduce."""

from __future__ import annotations

from pipeline.floorplan.language.facts import SOCIAL, Named, Reading
from pipeline.floorplan.language.naming import ALONE, PLURAL_NAMES, ROLES, close, conjoined, is_landing, listed, repeated
from pipeline.floorplan.language.phrases import Element
from pipeline.floorplan.language.text import spread
from pipeline.floorplan.program.consistency import ImpossibleError
from pipeline.floorplan.program.floor_program import MAX_ROOMS, Evidence

REMOVES = {"quitar", "quita", "eliminar", "elimina", "suprimir", "leave out", "get rid of", "drop", "scrap", "skip", "omit"}
BEFORE_CUE = {"near", "door", "open", "wall", "away", "apart", "leads", "between"}


def ban(sentence: list[Element]) -> None:  # noqa: C901, PLR0912 - one branch per case: a grammar
    """Mark the noun phrases that are ruled out, and turn bounds that a negation turns."""
    for k, e in enumerate(sentence):
        if e.kind == "neg":
            j = _target(sentence, k + 1)
            if j is not None and _placed(sentence, j):
                e.kind, sentence[j].kind, sentence[j + 1].kind = "used", "flag", "no_bath"
                continue
            if j is None:
                _any(sentence, k)
                if k + 1 == len(sentence) or sentence[k + 1].kind in {"comma", "close", "but"}:
                    _behind(sentence, k)
                continue
            phrase = sentence[j]
            if [x.kind for x in sentence[j + 1 : j + 3]] == ["neg", "flag"] and sentence[j + 2].value == "daylight":
                e.kind = sentence[j + 1].kind = "used"  # "no bathroom without a window": all have one
                phrase.det.add("all")
                continue
            if any(m.bound in {"least", "most"} for m in phrase.amounts):
                for m in phrase.amounts:
                    m.bound = {"least": "most", "most": "least"}.get(m.bound, m.bound)
                e.kind = "used"
            elif _related(sentence, j):
                _any(sentence, k)
            elif phrase.adjectives & {"open", "combined"} and phrase.type in SOCIAL:
                e.kind = "used"  # "no open kitchen" is a closed one
                phrase.adjectives = (phrase.adjectives - {"open", "combined"}) | {"closed"}
            elif phrase.type == "bathroom" and "own" in phrase.det:
                e.kind, phrase.kind = "used", "no_own"
            elif phrase.type == "hallway" and (phrase.said or phrase.size != 1.0):
                e.kind = phrase.kind = "used"  # "no narrow corridors" allows others
            elif not phrase.definite or e.text in REMOVES:
                e.kind = "used"
                _list(sentence, j)
        elif e.kind == "needless" and (j := _target(sentence, k + 1)) is not None and not _told(sentence, k):
            e.kind = "used"  # "no es necesario un balcón"
            _list(sentence, j)
        elif e.kind == "needless":
            start = next((j + 1 for j in range(k - 1, -1, -1) if sentence[j].kind in {"comma", "and", "but"}), 0)
            ahead = _target(sentence, k + 1)
            if ahead is not None and not any(x.kind == "np" for x in sentence[start:k]):  # "y nos sobra el salón"
                _list(sentence, ahead)
                continue
            for j in range(k - 1, -1, -1):
                if sentence[j].kind == "np":
                    sentence[j].banned = True
                    if not (j and sentence[j - 1].kind in {"and", "or"}):
                        break
                elif sentence[j].kind not in {"and", "or", "verb", "neg", "det"}:
                    break


def _target(sentence: list[Element], k: int) -> int | None:
    """Return the noun phrase that a negation in front of k rules out; None where it turns a cue or says nothing of rooms."""
    for j in range(k, len(sentence)):
        e = sentence[j]
        if e.kind == "np":
            return None if e.number is not None and any(x.kind == "colon" for x in sentence[k:j]) else j
        if e.kind == "colon" and all(x.kind in {"verb", "word"} for x in sentence[k:j]):
            continue  # "not needed: balcony, garage"
        if e.kind == "cue" and e.value == "has":
            continue
        if e.kind == "word" and e.value == "from":
            return None  # "is not to be seen from the living room"
        if e.kind not in {"verb", "adj", "det", "owner", "size", "word", "relative"}:
            return None
    return None


def _any(sentence: list[Element], k: int) -> None:
    """Let "a bedroom" behind a negated cue mean any bedroom, not a new one: "must not be reached through a bedroom"."""
    cue = False
    for e in sentence[k + 1 :]:
        if e.kind in {"comma", "but"}:
            return
        cue = cue or (e.kind == "cue" and e.value in BEFORE_CUE)
        if cue and e.kind == "np" and "indefinite" in e.det and e.number is None:
            e.det = {"all"}


def _behind(sentence: list[Element], k: int) -> None:
    """Mark what a negation behind it rules out: "Kinderzimmer gibt es keine", "balcony: no"; not what it says of a room that is counted."""
    for j in range(k - 1, -1, -1):
        e = sentence[j]
        if e.kind == "np":
            e.banned = e.number is None and not e.definite and not e.amounts
            sentence[k].kind = "used" if e.banned else "neg"
            return
        if e.kind not in {"verb", "colon", "det", "word"}:
            return


def _told(sentence: list[Element], k: int) -> bool:
    """Whether a room stands in front of k in its clause."""
    return any(x.kind == "np" for x in sentence[max((i for i in range(k) if sentence[i].kind in {"comma", "but"}), default=0) : k])


def _placed(sentence: list[Element], j: int) -> bool:
    """Whether what is ruled out is a bathroom of one bedroom: "no bath in the master"."""
    rest = sentence[j + 1 : j + 3]
    bath = sentence[j].type == "bathroom" and not sentence[j].definite
    return bath and len(rest) == 2 and rest[0].value in {"in", "has"} and rest[0].kind == "cue" and rest[1].type == "bedroom"


def _related(sentence: list[Element], j: int) -> bool:
    """Whether a relation follows at once, which is what is negated: "no kitchen next to the bedroom"."""
    for e in sentence[j + 1 :]:
        if e.kind == "verb":
            continue
        return e.kind == "cue" and e.value in BEFORE_CUE and e.text not in {"inside", "within", "on"}
    return False


def _list(sentence: list[Element], j: int) -> None:
    """Mark a list under one negation: "no balcony, garage or cellar"."""
    sentence[j].banned = True
    joined = ""
    titled = next((x.kind for x in reversed(sentence[:j]) if x.kind in {"colon", "neg", "used"}), "") == "colon"
    for i in range(j + 1, len(sentence)):
        e = sentence[i]
        if e.kind in {"comma", "and", "or"}:
            joined = e.kind if joined != "or" else joined
        elif e.kind == "np" and joined:
            bare = e.number is None and not e.amounts and not e.definite and not e.det & {"own", "another"}
            free = bare and (joined in {"or", "comma"} or not e.det & {"indefinite"}) and not e.adjectives & {"open", "combined"}
            if joined == "comma" and not titled:
                free = free and _closes(sentence, i + 1)
            own = (
                i + 1 < len(sentence)
                and sentence[i + 1].kind in {"cue", "verb", "neg"}
                and joined != "or"
                and not _of_home(sentence, i + 1)
            )
            if not free or own:
                return
            e.banned = True
            joined = ""
        elif e.kind != "det":
            return


def _of_home(sentence: list[Element], i: int) -> bool:
    """Whether the home has what follows: "a house without garage and cellar, with two bedrooms"."""
    thing = next((x for x in sentence[i + 1 :] if x.kind == "np"), None)
    return sentence[i].value == "has" and thing is not None and thing.type in {"bedroom", "living_room", "kitchen"}


def _closes(sentence: list[Element], i: int) -> bool:
    """Whether the list goes on to an "or"."""
    for e in sentence[i:]:
        if e.kind == "or":
            return True
        if e.kind not in {"np", "comma", "det"}:
            return False
    return False


def heads(sentence: list[Element], k: int) -> bool:
    """Whether the level at k opens a new part of a sentence: "living room, kitchen, and upstairs two bedrooms"."""
    before, after = sentence[k - 1].kind if k else "", next((x for x in sentence[k + 1 :] if x.kind not in {"det", "flag"}), None)
    return before in {"comma", "and"} and after is not None and after.kind in {"np", "colon"}


def introduce(state: Reading, sentences: list[list[Element]]) -> None:
    """Make the rooms that numbers and indefinite articles introduce: whole counts first, so that later words may tell them apart."""
    for whole in (True, False):
        for sentence in sentences:
            level = _first_level(sentence)
            suites = False  # "a suite: ... a bedroom": the suite's own
            for k, e in enumerate(sentence):
                if e.kind == "level":
                    level = int(e.value) if not (level is None and k) or heads(sentence, k) else level
                if e.suite and e.kind == "np":
                    suites = True
                if (
                    e.kind == "np"
                    and e.introduces
                    and not e.ids
                    and not e.suite
                    and not (suites and e.type == "bedroom" and e.number is None)
                    and _whole(sentence, k) == whole
                ):
                    _few(state, e)
                    made = _count_all(state, e) if whole else _introduced(state, sentence, k, backward(sentence, k, level))
                    e.ids = [r.id for r in made]


def _few(state: Reading, e: Element) -> None:
    """Refuse more rooms than a program holds, with the words."""
    if (e.number or 0) > MAX_ROOMS:
        start, end = spread(state.heard.tokens[max(e.first - 1, 0) : e.last])
        words = [Evidence(start=start, end=end, text=state.heard.prompt[start:end], field="rooms")]
        raise ImpossibleError(f"{e.number:g} {e.type.replace('_', ' ')}s are asked for", f"ask for {MAX_ROOMS} rooms at most", words)


def _first_level(sentence: list[Element]) -> int | None:
    first = next((e for e in sentence if e.kind in {"np", "level", "zone", "every"}), None)
    return int(first.value) if first is not None and first.kind == "level" else None


def backward(sentence: list[Element], k: int, level: int | None) -> int | None:
    """Return the storey of a phrase: of the level named before it, or behind it where sentences name levels behind."""
    if level is not None:
        return level
    parted = False
    for j, e in enumerate(sentence[k + 1 :], k + 1):
        if e.kind == "level":
            return None if heads(sentence, j) else int(e.value)
        parted = parted or e.kind == "comma"
        if e.kind in {"np", "and", "comma"}:
            continue
        if e.kind == "verb" and parted:  # "four bedrooms, the guest room is downstairs"
            break
        if e.kind in {"cue", "colon"}:
            break
    return None


def _whole(sentence: list[Element], k: int) -> bool:
    """Whether the number of a phrase is the count of all such rooms: "a two-bedroom flat", "three baths in total"."""
    e = sentence[k]
    if e.compound and not e.role:
        return True
    near = [*sentence[k + 1 : k + 2], *(sentence[max(0, k - 1) : k] if e.type == "bedroom" and not e.role else [])]
    return any(x.kind == "flag" and x.value == "total" for x in near) and e.number is not None and not e.amounts


def _count_all(state: Reading, e: Element) -> list[Named]:
    stock = state.inventory
    while len(stock.of(e.type)) < int(e.number or 1):
        room = stock.add(e.type, "", e.text, None, open_slot=True)
        room.whole, room.span = True, (e.first, e.last)
    return stock.of(e.type)[: int(e.number or 1)]


def _introduced(state: Reading, sentence: list[Element], k: int, level: int | None) -> list[Named]:  # noqa: C901, PLR0911, PLR0912 - one branch per case: a grammar
    """Return the rooms of a phrase with a number or an indefinite article."""
    e, stock = sentence[k], state.inventory
    count = int(e.number or (2 if e.plural and e.type not in PLURAL_NAMES else 1))
    same = stock.of(e.type)
    slots = [r for r in same if r.open_slot and (level is None or r.level in {None, level}) and not r.role]
    role = e.role if e.role in ROLES else ""
    if e.number is not None and not role and "another" not in e.det and count > len(same) and any(r.whole for r in same):
        state.say("beyond", tuple(r.id for r in same), (), e, float(count))
        return same
    if slots and e.type == "bathroom" and count == 1 and _had(sentence, k) and not any(r.id in x.ids for r in slots for x in sentence[:k]):
        return []  # "three baths. Two of the bedrooms have an en suite": of those that were counted
    if slots and _predicative(sentence, k):
        return [close(slots[0], role, e.text)]
    if "another" in e.det and role and e.type == "bedroom":  # "三间卧室：大儿子一间，小女儿一间": the second of theirs
        told = [r for r in slots if listed(sentence, k, r) or (r.whole and "bare_nouns" in state.heard.lexicon.traits)]
        if len(told) >= count:
            return [close(r, role, e.text) for r in told[:count]]
    if "another" not in e.det:
        if role and role != "ensuite":
            here = [r for r in same if r.role == role]
            if here and len(here) == count:
                return here
            wide = [r for r in slots if r.whole or listed(sentence, k, r)]
            if len(wide) >= count and e.type != "bathroom":
                return [close(r, role, e.text) for r in wide[:count]]
        elif not role and slots and not _contrasted(sentence, k):
            if len(slots) == count == len(same) and count > 1:
                return slots
            known = all(r.whole for r in slots) or (e.number is not None and count < len(slots) and len(slots) > 1)
            if known and count <= len(slots) and not conjoined(sentence, k):
                return [close(r, "", e.text, level) for r in slots[:count]]
        apart = e.role == "landing" and not any(is_landing(r) for r in same)
        if count == 1 and e.number is None and not role and e.type in ALONE and same and not repeated(sentence, k) and not apart:
            return same[:1]
    made = [stock.add(e.type, role, e.text, level, open_slot=count > 1) for _ in range(count)]
    for room in made:
        room.extra, room.span = "another" in e.det, (e.first, e.last)
    return made


def _had(sentence: list[Element], k: int) -> bool:
    """Whether a bedroom has the room of the phrase at k."""
    before = [e for e in sentence[:k] if e.kind in {"np", "cue", "comma", "and", "pron"}][-2:]
    return (
        len(before) > 1
        and before[1].value == "has"
        and before[1].kind == "cue"
        and (before[0].type == "bedroom" or before[0].kind == "pron")
    )


def _contrasted(sentence: list[Element], k: int) -> bool:
    """Whether a count is told apart from the one in front by an adjective: "3 hab dobles, 1 hab individual"."""
    before = next((e for e in reversed(sentence[:k]) if e.kind == "np" and e.type == sentence[k].type), None)
    return before is not None and bool(before.said) and bool(sentence[k].said) and not before.said & sentence[k].said


def _predicative(sentence: list[Element], k: int) -> bool:
    """Whether a phrase says what one of several is: "four bedrooms, one of which is a guest room"."""
    return k > 1 and sentence[k - 1].kind == "verb" and sentence[k - 2].kind == "pron" and sentence[k - 2].value == "one"
