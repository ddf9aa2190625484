"""What a negation rules out: rooms, and bounds that it turns round. What it says of relations is read with them."""

from __future__ import annotations

from pipeline.floorplan.language.facts import SOCIAL
from pipeline.floorplan.language.phrases import Element

RELATIONS = {"near", "door", "open", "wall", "away", "apart", "leads", "between"}
TURNED = {"least": "most", "most": "least"}
NAMES = {"bedroom", "living_room", "kitchen"}  # what a home has, not a room that is ruled out


def ban(sentence: list[Element]) -> None:
    """Mark the noun phrases that are ruled out, and turn bounds that a negation turns."""
    for k, e in enumerate(sentence):
        if e.kind == "neg":
            j = _target(sentence, k + 1)
            if j is not None:
                _negate(sentence, k, j)
                continue
            _any(sentence, k)
            if k + 1 == len(sentence) or sentence[k + 1].kind in {"comma", "close", "but"}:
                _behind(sentence, k)
        elif e.kind == "needless":
            start = max((i + 1 for i in range(k) if sentence[i].kind in {"comma", "but"}), default=0)
            j = None if any(x.kind == "np" for x in sentence[start:k]) else _target(sentence, k + 1)
            if j is not None:  # "no es necesario un balcón"
                e.kind = "used"
                _list(sentence, j)
            for i in range(k - 1, -1, -1) if j is None else ():
                if sentence[i].kind == "np":
                    sentence[i].banned, e.kind = True, "used"
                    if not (i and sentence[i - 1].kind in {"and", "or"}):
                        break
                elif sentence[i].kind not in {"and", "or", "verb", "neg", "det"}:
                    break


def _negate(sentence: list[Element], k: int, j: int) -> None:
    """Apply the negation at k to the phrase at j."""
    e, phrase, rest = sentence[k], sentence[j], sentence[j + 1 : j + 3]
    if [x.kind for x in rest] == ["neg", "flag"] and rest[1].value == "daylight":
        e.kind = rest[0].kind = "used"  # "no bathroom without a window": all have one
        phrase.det.add("all")
    elif any(m.bound in TURNED for m in phrase.amounts):
        e.kind = "used"
        for m in phrase.amounts:
            m.bound = TURNED.get(m.bound, m.bound)
    elif _related(sentence, j):
        _any(sentence, k)  # "no kitchen next to the bedroom"
    elif phrase.adjectives & {"open", "combined"} and phrase.type in SOCIAL:
        e.kind = "used"  # "no open kitchen" is a closed one
        phrase.adjectives = (phrase.adjectives - {"open", "combined"}) | {"closed"}
    elif not phrase.definite or e.removes:
        e.kind = "used"
        _list(sentence, j)


def _target(sentence: list[Element], k: int) -> int | None:
    """Return the noun phrase that a negation in front of k rules out; None where it turns a relation or says nothing of rooms."""
    for j, e in enumerate(sentence[k:], k):
        if e.kind == "np":
            return None if e.number is not None and any(x.kind == "colon" for x in sentence[k:j]) else j
        colon = e.kind == "colon" and all(x.kind in {"verb", "word"} for x in sentence[k:j])  # "not needed: balcony, garage"
        if e.kind not in {"verb", "adj", "det", "owner", "size", "word", "relative"} and not colon and (e.kind, e.value) != ("cue", "has"):
            return None
    return None


def _any(sentence: list[Element], k: int) -> None:
    """Let "a bedroom" behind a negated relation mean any bedroom, not a new one: "must not be reached through a bedroom"."""
    cue = False
    for e in sentence[k + 1 :]:
        if e.kind in {"comma", "but"}:
            return
        cue = cue or (e.kind == "cue" and e.value in RELATIONS)
        if cue and e.kind == "np" and "indefinite" in e.det and e.number is None:
            e.det = {"all"}


def _behind(sentence: list[Element], k: int) -> None:
    """Mark what a negation behind it rules out: "Kinderzimmer gibt es keine", "balcony: no"; not what it says of a room that is counted."""
    e = next((x for x in reversed(sentence[:k]) if x.kind not in {"verb", "colon", "det", "word"}), None)
    if e is not None and e.kind == "np":
        e.banned = e.number is None and not e.definite and not e.amounts
        sentence[k].kind = "used" if e.banned else "neg"


def _related(sentence: list[Element], j: int) -> bool:
    """Whether a relation follows at once, which is what is negated."""
    e = next((x for x in sentence[j + 1 :] if x.kind != "verb"), None)
    return e is not None and e.kind == "cue" and e.value in RELATIONS


def _list(sentence: list[Element], j: int) -> None:
    """Mark a list under one negation: "no balcony, garage or cellar"."""
    sentence[j].banned = True
    joined = ""
    titled = next((x.kind for x in reversed(sentence[:j]) if x.kind in {"colon", "neg", "used"}), "") == "colon"
    for i in range(j + 1, len(sentence)):
        e = sentence[i]
        if e.kind in {"comma", "and", "or"}:
            joined = e.kind if joined != "or" else joined
            continue
        if e.kind != "np" or not joined or e.number is not None or e.amounts or e.definite or e.det & {"own", "another"}:
            return
        rest = next((x for x in sentence[i + 1 :] if x.kind not in {"np", "comma", "det"}), None)
        if joined == "comma" and not titled and (rest is None or rest.kind != "or"):
            return
        told = sentence[i + 1] if i + 1 < len(sentence) and sentence[i + 1].kind in {"cue", "verb", "neg"} and joined != "or" else None
        had = next((x for x in sentence[i + 1 :] if x.kind == "np"), None)
        if told is not None and not (told.value == "has" and had is not None and had.type in NAMES):
            return  # it has a statement of its own, unless it is the home that has what follows
        e.banned, joined = True, ""
