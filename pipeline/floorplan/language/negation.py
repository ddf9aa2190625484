"""What is ruled out: the scope of "no", "without" and their like over a list of rooms."""

from __future__ import annotations

from pipeline.floorplan.language.facts import SOCIAL
from pipeline.floorplan.language.phrases import Element

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
