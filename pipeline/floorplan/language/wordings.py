"""Ways that say a relation round about: "with doors to ...", "from the hall there is access to ...", "access to X is from Y"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.doorways import phrase
from pipeline.floorplan.language.marks import ENDS, Mark, Words, sentences_of

INTO = {"to", "into", "onto", "leading to", "leading into", "opening to", "opening into", "opening onto"}
ACCESS = {"door", "doors", "access", "doorway", "doorways"}
BY = {"from", "through", "via", "only via", "only from", "only through", "by way of", "exclusively from", "from only"}
REACHED = {
    "reached",
    "accessed",
    "entered",
    "accessible",
    "reachable",
    "open",
    "opens",
    "can be",
    "are",
    "is",
    "lead",
    "be",
    "can",
    "reach",
}


def worded(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks with what is said round about said by a cue."""
    if heard.lexicon.language not in {"en", "es"}:
        return list(marks)
    made: list[Mark] = []
    english = (_each, _doors, _from, _which, _access, _you, _there, _wide, _but, _baths, _per, _whole, _sized)
    rules = english if heard.lexicon.language == "en" else (_doors, _one_goes, _baths, _per, _told, _sized)
    for sentence in sentences_of(marks):
        said = sentence
        for rule in rules:
            said = rule(said)
        made += said
    return made


def _listed(marks: Sequence[Mark], k: int) -> tuple[int, int]:
    """Return (end, number of phrases) of the list that begins at k: "the kitchen, the bath and the hall"."""
    end, count = phrase(marks, k), 0
    j = end
    while j:
        end, count = j, count + 1
        k = j
        while k < len(marks) and (marks[k].kind in {"comma", "join"} or marks[k].text in {"to", "into", "a", "al"}) and k - j < 3:
            k += 1
        j = phrase(marks, k) if k > j else 0
    return end, count


def _leads(at: Mark, last: Mark) -> Mark:
    return Mark("cue", "leads", 0.0, False, at.first, last.last, "leads to")


def _each(marks: list[Mark]) -> list[Mark]:
    """Leave out "each", "all", "both" in front of a way: "are each reached from", "all have a door to"."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        ahead = marks[k + 1 : k + 4]
        way = bool(ahead) and ahead[0].kind == "cue" and ahead[0].value in {"door", "leads"}
        has = bool(ahead) and ahead[0].value == "has" and any(ACCESS & set(m.text.split()) for m in ahead[1:])
        after = k > 0 and marks[k - 1].kind not in {"comma", "open", "dash"}
        if after and mark.text in {"each", "all", "both"} and mark.kind in {"det", "pron", "adverb"} and (way or has):
            continue
        made.append(mark)
    return made


def _doors(marks: list[Mark]) -> list[Mark]:  # noqa: PLR0912 - one branch per case: a grammar
    """Read "with doors to A, B and C", "has three doors: to A, to B and to C", "connects to A, B and C" as leading to all of them."""
    for k, mark in enumerate(marks):
        j = k
        if mark.text in {"with doors", "with a door"} and mark.kind == "ignored":
            j = k + 1
        elif (mark.kind, mark.value) == ("cue", "has") or mark.kind in {"colon", "open"}:
            j = k + 1
            while j < len(marks) and marks[j].kind in {"det", "num", "adj", "size", "adverb"}:
                j += 1
            if j >= len(marks) or (marks[j].kind, marks[j].value) != ("flag", "doors"):
                if not (mark.value == "has" and j < len(marks) and marks[j].text in {"door to", "doors to", "a door to"}):
                    continue
                j -= 1
            j += 1
        elif mark.kind == "cue" and mark.value == "door" and mark.text.split()[-1] in {"to", "a", "al", "con", "la"} and k:
            end, count = _listed(marks, k + 1)
            ended = end >= len(marks) or marks[end].kind in ENDS | {"comma", "close", "but"}
            if count > 2 and ended and any(m.kind == "join" for m in marks[k:end]):
                return [
                    *marks[:k],
                    _leads(mark, mark),
                    *(m for m in marks[k + 1 : end] if m.text not in {"to", "into", "a", "al"} or m.kind == "room"),
                    *marks[end:],
                ]
            continue
        else:
            continue
        while j < len(marks) and (marks[j].kind in {"colon", "comma", "dash", "hyphen"} or marks[j].text in {"each", "one each"}):
            j += 1
        if j >= len(marks) or not (marks[j].text in INTO or (j > k + 1 and marks[j].text in {"door to", "doors to"})):
            continue
        start = j + 1 + (j + 1 < len(marks) and marks[j + 1].text == "both" and phrase(marks, j + 2) > 0 and not marks[j + 2].plural)
        end, count = _listed(marks, start)
        if not count:
            continue
        said = [m for m in marks[start:end] if m.text not in {"to", "into"}]
        close = end < len(marks) and mark.kind == "open" and marks[end].kind == "close"
        cue = _leads(mark, marks[j])
        if mark.kind == "ignored" or mark.text in {"with", "w"}:
            cue = replace(cue, text="with doors to")  # of the room in front of it alone
        return [*marks[:k], cue, *said, *marks[end + close :]]
    return marks


def _from(marks: list[Mark]) -> list[Mark]:
    """Read "from the hall, doors lead to ...", "from A there is access to B" as leading there."""
    for k, mark in enumerate(marks):
        start = phrase(marks, k + 1) if (mark.kind, mark.value) == ("cue", "from") else 0
        j, door = start, False
        while start and j < len(marks) and j - start < 6 and not phrase(marks, j) and marks[j].kind not in ENDS:
            door = door or bool(ACCESS & set(marks[j].text.split()))
            last = marks[j].text.split()[-1:] if marks[j].text else []
            if door and last and last[0] in {"to", "into", "onto"} and phrase(marks, j + 1):
                return [*marks[:start], _leads(marks[start], marks[j]), *marks[j + 1 :]]
            j += 1
    return marks


def _which(marks: list[Mark]) -> list[Mark]:
    """Read "a hall off which are A and B", "from which A and B are reached"."""
    for k in range(1, len(marks) - 2):
        if marks[k].text not in {"from", "off", "through", "via"} or marks[k + 1].text != "which":
            continue
        j = k + 2
        while j < len(marks) and marks[j].kind == "verb":
            j += 1
        end, count = _listed(marks, j)
        if not count:
            continue
        tail = end
        while tail < len(marks) and (
            marks[tail].text in REACHED or marks[tail].kind in {"verb", "adverb"} or marks[tail].value == "reachable"
        ):
            tail += 1
        if tail < len(marks) and marks[tail].kind not in ENDS | {"comma"}:
            continue
        before = marks[: k - (marks[k - 1].kind == "comma")]
        return [*before, _leads(marks[k], marks[k + 1]), *marks[j:end], *marks[tail:]]
    return marks


def _access(marks: list[Mark]) -> list[Mark]:
    """Read "access to A and B is from C", "the only access to A is from B"."""
    for k, mark in enumerate(marks):
        if k > 2 or mark.text not in {"access to", "direct access to"}:
            continue
        end, count = _listed(marks, k + 1)
        j = end
        while j < len(marks) and marks[j].kind in {"verb", "adverb", "flag"}:
            j += 1
        if not count or j >= len(marks) or marks[j].text not in BY or not phrase(marks, j + 1):
            continue
        verb = Mark("verb", "", 0.0, False, mark.last, mark.last, "are")
        cue = Mark("cue", "door", 0.0, False, marks[j].first, marks[j].last, "accessed from", only=marks[j].only)
        return [*marks[:k], *marks[k + 1 : end], verb, *(m for m in marks[end:j] if m.value == "only"), cue, *marks[j + 1 :]]
    return marks


def _you(marks: list[Mark]) -> list[Mark]:
    """Read "you reach A from B", "you enter A through B", "through A into B"."""
    for k, mark in enumerate(marks[:4]):
        going = (mark.kind == "cue" and mark.value == "leads" and mark.text.split()[0] in {"you", "one", "get"}) or (
            mark.kind == "enter" and mark.text.split()[-1] in {"enter", "enters"}
        )
        if going and (end := phrase(marks, k + 1)) and end < len(marks) and marks[end].text in BY:
            last = phrase(marks, end + 1)
            if last and (last >= len(marks) or marks[last].kind in ENDS | {"comma", "join"}):
                cue = Mark("cue", "door", 0.0, False, marks[end].first, marks[end].last, "reached from")
                return [*marks[:k], *marks[k + 1 : end], cue, *marks[end + 1 :]]
    end = phrase(marks, 1) if marks and marks[0].text == "through" else 0
    if end and end < len(marks) and marks[end].text in {"into", "to"} and phrase(marks, end + 1):
        return [*marks[1:end], _leads(marks[end], marks[end]), *marks[end + 1 :]]
    return marks


def _one_goes(marks: list[Mark]) -> list[Mark]:
    """Read "se accede a la cocina y al baño desde el pasillo" as both reached from the hall."""
    for k, mark in enumerate(marks[:2]):
        going = mark.text.startswith("se ") and ((mark.kind, mark.value) == ("cue", "leads") or mark.kind == "enter")
        end, count = _listed(marks, k + 1) if going else (0, 0)
        if count and end < len(marks) and marks[end].text.split()[0] == "desde" and phrase(marks, end + 1):
            verb = Mark("verb", "", 0.0, False, mark.last, mark.last, "estan")
            cue = Mark("cue", "door", 0.0, False, marks[end].first, marks[end].last, "accesible desde")
            return [*marks[:k], *(m for m in marks[k + 1 : end] if m.text not in {"a", "al"}), verb, cue, *marks[end + 1 :]]
    return marks


def _told(marks: list[Mark]) -> list[Mark]:
    """Read "a la cocina, el baño y el salón se accede desde el pasillo" as said of all three."""
    start = int(bool(marks) and marks[0].text in {"a", "al"})
    end, count = _listed(marks, start)
    if count > 2 and end < len(marks) and marks[end - 1].kind == "room":
        j = end + ((marks[end].kind, marks[end].value) == ("cue", "has"))
        way = j < len(marks) and ((marks[j].kind == "cue" and marks[j].value == "door") or marks[j].text.startswith("se entra"))
        if way and phrase(marks, j + 1) and any(m.kind == "join" for m in marks[start:end]):
            verb = Mark("verb", "", 0.0, False, marks[end].first, marks[end].first, "estan")
            cue = replace(marks[j], kind="cue", value="door", text="accesible desde")
            return [*(m for m in marks[start:end] if m.text not in {"a", "al"}), verb, cue, *marks[j + 1 :]]
    return marks


def _there(marks: list[Mark]) -> list[Mark]:
    """Read "..., and from there the kitchen", "and from the hall the kitchen" behind a way."""
    for k in range(2, len(marks) - 1):
        if marks[k].kind != "cue" or marks[k].value != "from" or marks[k - 1].kind not in {"join", "comma"}:
            continue
        said = any(m.kind == "enter" or (m.kind == "cue" and m.value in {"leads", "door"}) for m in marks[:k])
        there = marks[k].text.endswith("there") or marks[k + 1].text == "there"
        end = k + 1 + (marks[k + 1].text == "there") if there else phrase(marks, k + 1)
        if said and end and phrase(marks, end):
            if there:
                cue = Mark("cue", "chain", 0.0, False, marks[k].first, marks[end - 1].last, "and from there to")
                begin = k - (marks[k - 1].kind == "join")
                begin -= marks[begin - 1].kind == "comma"
                return [*marks[:begin], cue, *marks[end:]]
            return [*marks[:end], _leads(marks[end], marks[end]), *marks[end:]]
    return marks


GAPS = {"opening", "connection", "transition", "passage"}


def _wide(marks: list[Mark]) -> list[Mark]:
    """Read "with a wide opening to B", "has an open connection to B" as open to it, an open-plan kitchen as one that is open."""
    made = list(marks)
    for k in range(1, len(marks)):
        plan = (marks[k].kind, marks[k].value) == ("flag", "open_plan") and marks[k].text.replace(" - ", " ") in {"open plan", "openplan"}
        had = marks[k - 1].value == "has" or (marks[k - 1].kind == "slash" and k > 1 and marks[k - 2].value == "has")
        if plan and had and k + 1 < len(marks) and marks[k + 1].value == "kitchen":
            made[k] = replace(marks[k], kind="adj", value="open")
        words = marks[k].text.split()
        if not words or words[0] not in GAPS:
            continue
        j = k if len(words) > 1 else k + 1
        begin = next((i for i in range(k - 1, max(-1, k - 5), -1) if marks[i].value == "has"), None)
        wide = any(m.text in {"wide", "open", "large", "big", "generous"} for m in marks[max(0, k - 3) : k])
        if begin is not None and wide and j < len(marks) and marks[j].text.split()[-1] in {"to", "into", "onto"} and phrase(marks, j + 1):
            cue = Mark("cue", "open", 0.0, False, marks[begin].first, marks[j].last, "opened up to")
            return [*marks[:begin], cue, *marks[j + 1 :]]
    return made


DROPPED = {"minus", "never mind", "forget", "forget about", "don't include", "do not include"}


def _but(marks: list[Mark]) -> list[Mark]:
    """Read "but not next to B" as not next to it, "keep A from touching B", "with C between them"."""
    made = list(marks)
    for k in range(len(marks) - 1):
        ahead = marks[k + 1]
        if (marks[k].kind, marks[k].value) == ("cue", "except") and ahead.kind == "cue" and ahead.value in {"near", "door", "wall", "open"}:
            made[k] = replace(marks[k], kind="neg", value="")
        if (marks[k].kind, marks[k].value) == ("cue", "from") and ahead.kind == "cue" and ahead.value == "wall":
            made[k] = replace(marks[k], kind="neg", value="", text="not")
        if marks[k].kind == "neg" and ahead.text == "separated from":
            made[k] = replace(marks[k], kind="fill", value="")
            made[k + 1] = replace(ahead, value="open", text="opened up to")
        if marks[k].text in DROPPED and (ahead.kind, ahead.value) == ("det", "definite"):
            made[k + 1] = replace(ahead, kind="fill", value="")
        if marks[k].kind == "room" and ahead.kind == "colon" and k + 2 < len(marks) and marks[k + 2].text == "0":
            return [*made[:k], Mark("neg", "", 0.0, False, ahead.first, ahead.first, "no"), marks[k], *marks[k + 3 :]]
        if (marks[k].kind, marks[k].value) == ("cue", "between") and ahead.text in {"them", "the two", "these two"}:
            made[k] = replace(marks[k], text="in between")
            del made[k + 1]
            return made
    return made


def _bath(mark: Mark) -> bool:
    return mark.kind == "room" and mark.value.startswith("bathroom")


def _baths(marks: list[Mark]) -> list[Mark]:
    """Read "..., all en suite", "all bedrooms are en suite", "two with ensuite", "one of which is en suite"."""
    for k in range(1, len(marks)):
        mark, before = marks[k], marks[k - 1]
        if mark.text in {"ensuite to", "en suite to"} and (before.kind in {"comma", "join"} or before.value == "indefinite"):
            room = Mark("room", "bathroom/ensuite", 0.0, False, mark.first, mark.first + 1, "ensuite")
            return [*marks[:k], room, replace(mark, first=mark.first + 1, text="belongs to"), *marks[k + 1 :]]
        if not _bath(mark):
            continue
        ensuite = mark.value == "bathroom/ensuite"
        j = k - 1
        while j > 0 and (marks[j].value in {"has", "own"} or marks[j].kind in {"adj", "verb"} or marks[j].text in {"a", "an"}):
            j -= 1
        beds = any(m.kind == "room" and m.value == "bedroom" and m.plural for m in marks[: j + 1])
        has = Mark("cue", "has", 0.0, False, before.first, before.last, "with")
        own = Mark("det", "own", 0.0, False, before.last, before.last, "own")
        bath = replace(mark, value="bathroom", plural=False)
        every = (
            marks[j].text in {"all", "each", "every one", "all of them", "each one"}
            and j
            and marks[j - 1].kind in {"comma", "open", "dash"}
        )
        if every and beds and (ensuite or before.value in {"has", "own"}) and marks[k].text != "baños":
            return [*marks[:j], replace(marks[j], kind="det", value="each", text="each"), has, own, bath, *marks[k + 1 :]]
        named = marks[j].kind == "room" and marks[j].value == "bedroom" and j and marks[j - 1].value in {"all", "each", "both"}
        if ensuite and named and before.kind == "verb":
            return [*marks[: j + 1], has, own, bath, *marks[k + 1 :]]
        if ensuite and (marks[j].kind, marks[j].value) == ("pron", "one") and before.kind == "verb":
            return [*marks[: j + 1], *marks[k:]]
        counted = marks[j].kind == "num" and j and marks[j - 1].kind in {"comma", "open"}
        if ensuite and beds and counted and before.value == "has":
            return [*marks[:j], replace(marks[j], kind="pron", value="one"), *marks[j + 1 :]]
    return marks


def _per(marks: list[Mark]) -> list[Mark]:
    """Read "three bathrooms, one for each bedroom", "one per bedroom" as each with its own."""
    for k in range(2, len(marks) - 2):
        one = (marks[k].number == 1.0 or marks[k].text == "one") and marks[k - 1].kind in {"comma", "open"}
        one = one or (marks[k].text in {"uno", "una"} and marks[k - 1].kind in {"comma", "open"})
        j = k + 1 + (marks[k + 1].text in {"for", "para"})
        each = j + 1 < len(marks) and (marks[j].value == "each" or marks[j].text == "por") and marks[j + 1].value == "bedroom"
        bath = next((m for m in reversed(marks[:k]) if m.kind == "room"), None)
        if one and each and bath is not None and _bath(bath):
            made = [
                replace(marks[j], text="each"),
                replace(marks[j + 1], plural=False),
                Mark("cue", "has", 0.0, False, marks[j].last, marks[j].last, "has"),
                Mark("det", "own", 0.0, False, marks[j].last, marks[j].last, "own"),
                replace(bath, plural=False, first=marks[j].last, last=marks[j].last),
            ]
            stop = Mark("stop", "", 0.0, False, marks[k].first, marks[k].first, ".")
            return [*marks[: k - 1], stop, *made, *marks[j + 2 :]]
    return marks


def _whole(marks: list[Mark]) -> list[Mark]:
    """Read "everything within 85 m2", "all under 85 m2" as the area of the home, "has a floor area of 14 m2" as that of the room."""
    made = list(marks)
    for k, mark in enumerate(marks):
        if mark.kind != "amount" or mark.value != "area":
            continue
        lead = [m for m in marks[max(0, k - 5) : k] if m.kind not in {"verb", "fill", "word", "adverb", "det"} or m.text == "all"]
        said = bool(lead) and (lead[-1].text in {"all", "everything"} or lead[-1].kind == "every") and mark.bound in {"most", "least", ""}
        after = lead[-2:-1]
        whole = marks[k - 1 - sum(m.kind in {"verb", "adverb"} for m in marks[max(0, k - 3) : k])] if k else mark
        place = next((i for i in range(k - 1, -1, -1) if marks[i] is whole), 0)
        if whole.kind == "home" and place and marks[place - 1].text in {"whole", "entire", "complete", "overall"}:
            made[k] = replace(mark, total=True)
        if said and (not after or after[0].kind in ENDS | {"comma"}):
            made[k] = replace(mark, total=True)
        flag = next((i for i in range(k - 1, max(-1, k - 3), -1) if (marks[i].kind, marks[i].value) == ("flag", "total")), None)
        if flag is not None and marks[flag].text == "floor area":
            owner = next((m for m in reversed(marks[:flag]) if m.kind in {"room", "home", "comma"}), None)
            if owner is not None and owner.kind == "room":
                made[flag] = replace(marks[flag], kind="fill", value="")
    return made


SIZED = {"mide", "miden", "tiene", "ocupa", "measures", "has", "covers", "is"}


def _sized(marks: list[Mark]) -> list[Mark]:
    """Read "the house has three bedrooms ... and measures 140 to 150 m2" as the area of the house."""
    made = list(marks)
    named = [m.kind for m in marks if m.kind in {"room", "suite", "home"}]
    for k in range(2, len(marks)):
        ends = k + 1 >= len(marks) or marks[k + 1].kind in ENDS
        own = marks[k - 1].text in SIZED and marks[k - 2].kind in {"join", "comma"}
        if marks[k].kind == "amount" and marks[k].value == "area" and ends and own and named[:1] == ["home"] and len(named) > 1:
            made[k] = replace(marks[k], total=True)
    return made
