"""Words that stand for rooms: "one" and "another" by themselves, "in between", a room that serves as another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import Mark, Words
from pipeline.floorplan.language.people import PARTS, settled

ALONE = {"eine", "einen", "eines", "einer", "uno", "una", "another", "otra", "otro"}
ENDS = {"stop", "line", "comma", "close", "join", "colon"}
FUNCTIONS = {
    "office": "working",
    "library": "working",
    "dining_room": "dining",
    "living_room": "living",
    "bedroom": "sleeping",
    "kitchen": "cooking",
}
ENTRIES = {"windfang", "vorraum", "vestibuel", "garderobe"}  # in front of a "Diele", which then is the hall behind
BESIDE = {"room", "suite"}
SOCIAL = {"living_room", "dining_room", "kitchen", "family_room"}


def resolved(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks with the rooms that are meant put in."""
    made = list(marks)
    for k in range(len(made) - 2):  # "in addition to the two bedrooms": they are counted there
        beyond = made[k].text.startswith("zusaetzlich zu") and (made[k + 1].kind, made[k + 1].value) == ("det", "both")
        made[k + 1] = replace(made[k + 1], kind="num", value="", number=2.0) if beyond else made[k + 1]
    if heard.lexicon.language == "de":
        made = _vestibule(_room_of(_besides(made)))
    elif heard.lexicon.language == "zh":
        made = _room_with(made)
    made = _standing(_doubling(settled(_neither(made), heard)))
    return _between(_storeyed(_windowed(_sized(_superlative(_parted(made))))))


def _neither(marks: list[Mark]) -> list[Mark]:
    """Read "weder Bad noch WC", "ni el baño ni el aseo" as one negation of both."""
    made = list(marks)
    first: int | None = None
    for k, mark in enumerate(made):
        if mark.kind in {"stop", "line"}:
            first = None
        elif mark.kind == "neg" and first is None and mark.text.split()[0] in {"weder", "ni", "neither"}:
            first = k
        elif mark.kind == "neg" and first is not None and mark.text.split()[0] in {"noch", "ni", "nor"}:
            ahead = next((m.kind for m in made[k + 1 :] if m.kind not in {"adverb", "flag", "det"}), "")
            named = ahead != "cue" and any(m.kind == "room" for m in made[max(first, k - 4) : k])
            made[k] = replace(mark, kind="join", value="or") if named else mark
    return made


def _windowed(marks: list[Mark]) -> list[Mark]:
    """Read "不要没有窗户的卫生间" as "the bathroom has a window"."""
    made = list(marks)
    for k in range(len(made) - 4):
        twice = made[k].kind == made[k + 1].kind == "neg" and made[k + 2].value == "daylight" and made[k + 3].text == "的"
        if twice and made[k + 4].kind == "room":
            has = replace(made[k + 1], kind="cue", value="has", text="有")
            return [*made[:k], made[k + 4], has, made[k + 2], *_windowed(made[k + 5 :])]
    return made


def _storeyed(marks: list[Mark]) -> list[Mark]:
    """Read "ein Bad pro Etage" as one on each storey."""
    place = next((k for k, m in enumerate(marks) if (m.kind, m.value) == ("flag", "per_level")), None)
    if place is None:
        return marks
    made = [m for k, m in enumerate(marks) if k != place]
    near = [*range(place - 1, max(-1, place - 5), -1), *range(place, min(place + 4, len(made)))]
    room = next((k for k in near if made[k].kind == "room"), None)
    if room is None:
        return marks
    start = room
    while start and made[start - 1].kind in {"num", "det", "adj", "size", "clf", "pron"}:
        start -= 1
    count = next((m.number for m in made[start:room] if m.kind == "num"), 1.0)
    flag = marks[place]
    end = replace(flag, kind="stop", value="")
    each: list[Mark] = []
    for storey in range(_storeys(marks)):
        number = Mark("num", "", count, False, made[room].first, made[room].first, "")
        each += [replace(flag, kind="level", value=str(storey)), number, replace(made[room], plural=count > 1), end]
    return [*made[:start], *([end] if start else []), *each, *made[room + 1 :]]


def _storeys(marks: Sequence[Mark]) -> int:
    """Return how many storeys are spoken of, two at least."""
    said = max([int(m.number) for m in marks if m.kind == "amount" and m.value == "storeys"], default=0)
    return min(max(said, len({m.value for m in marks if m.kind == "level"}), 2), 3)


def _superlative(marks: list[Mark]) -> list[Mark]:
    """Read "the largest bedroom is twice the size of the smallest" with the room that is left unsaid."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        made.append(mark)
        ahead = marks[k + 1].kind if k + 1 < len(marks) else "stop"
        if mark.kind != "adj" or mark.value not in {"largest", "smallest"} or ahead not in ENDS | {"verb"}:
            continue
        start = max((i for i in range(k) if marks[i].kind in {"stop", "line"}), default=-1) + 1
        said = [
            i
            for i in range(start, k)
            if marks[i].kind == "adj" and marks[i].value in {"largest", "smallest"} and marks[i].value != mark.value
        ]
        room = next((m for i in said for m in marks[i + 1 : i + 3] if m.kind == "room"), None)
        if room is not None:
            made.append(replace(room, first=mark.last, last=mark.last))
    return made


def _sized(marks: list[Mark]) -> list[Mark]:
    """Read "two bedrooms: the larger of 16, the smaller of 10 m2" as an area for each."""
    said = [
        (k, j)
        for k, m in enumerate(marks)
        if m.kind == "size" or (m.kind == "adj" and m.value in {"largest", "smaller", "smallest"})
        for j in (k + 1 + (k + 1 < len(marks) and marks[k + 1].kind in {"fill", "bound", "cue", "verb"}),)
        if j < len(marks) and marks[j].kind == "amount" and marks[j].value == "area"
    ]
    if len(said) != 2:
        return marks
    (a, first), (_, second) = said
    place = next((i for i in range(a - 1, -1, -1) if marks[i].kind == "room"), None)
    counted = place is not None and any(m.kind == "num" and m.number == 2 for m in marks[max(0, place - 3) : place])
    if place is None or not counted or any(m.kind == "room" for m in marks[place + 1 : second]):
        return marks
    amount = replace(marks[first], parts=(marks[first].number, marks[second].number), last=marks[second].last)
    return [*marks[: place + 1], amount, *marks[second + 1 :]]


SLIDING = {"flag", "adj", "det", "word", "size"}


def _parted(marks: list[Mark]) -> list[Mark]:
    """Read "joined by a sliding door" and "instead of a bathtub" without the words that name no room."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        j = k + 1
        if mark.kind == "bound" and mark.text == "nicht ueber":  # no amount follows: "not by way of the kitchen"
            middle = mark.first + 1
            made += [
                replace(mark, kind="neg", value="", last=middle, text="nicht"),
                replace(mark, kind="cue", value="door", first=middle, text="ueber"),
            ]
            continue
        while j < len(marks) and marks[j].kind in SLIDING - {"flag"}:
            j += 1
        door = j < len(marks) and (marks[j].kind, marks[j].value) == ("flag", "doors")
        ends = door and (j + 1 >= len(marks) or marks[j + 1].kind in ENDS | {"verb"})
        shared = (
            (mark.kind, mark.value) == ("cue", "has")
            and ends
            and [m.kind for m in made[-4:] if m.kind != "det"][-3:] == ["room", "join", "room"]
        )
        if shared:  # "office and kitchen have a connecting door"
            made.append(replace(mark, value="door", text="verbunden"))
            continue
        entry = j < len(marks) and marks[j].kind == "cue" and marks[j].value == "door" and marks[j].text.split()[0] not in PREPOSITIONS
        if (mark.kind, mark.value) == ("cue", "has") and entry and j > k + 1:
            made.append(replace(mark, kind="fill"))  # "with a direct way to the kitchen"
            continue
        subject = mark.kind == "cue" and mark.value == "door" and mark.text.split()[0] in WAYS
        if (
            subject
            and not any(m.kind in BESIDE for m in _clause(made))
            and any(m.kind == "cue" for m in _clause(marks[k + 1 :], after=True))
        ):
            made.append(replace(mark, kind="fill"))  # "the way into the office is through the kitchen"
            continue
        instead = mark.kind == "neg" and mark.text.split()[0] in INSTEAD and (j >= len(marks) or marks[j].kind not in BESIDE)
        by = mark.kind == "cue" and mark.value == "door" and mark.text in BY and door
        made.append(replace(mark, kind="fill") if instead or by else mark)
    return made


WAYS = {"zugang", "zutritt", "tuer", "tuere", "durchgang", "access", "acceso", "entrada"}
PREPOSITIONS = {"durch", "ueber", "am", "an", "hinter", "off", "through", "via", "por", "en"}


def _clause(marks: Sequence[Mark], *, after: bool = False) -> list[Mark]:
    """Return the marks up to the nearest end of a clause: the last ones, or the first."""
    made: list[Mark] = []
    for mark in marks if after else reversed(marks):
        if mark.kind in ENDS - {"join"}:
            break
        made.append(mark)
    return made


WANTED = {"brauchen", "brauche", "moechten", "wuenschen", "benoetigen", "haetten", "gibt es", "brauchen wir", "wir brauchen", "brauche ich"}


def _besides(marks: list[Mark]) -> list[Mark]:
    """Read "neben Küche und Bad brauchen wir zwei Schlafzimmer" as a list: nothing is said to lie beside anything."""
    made = list(marks)
    for k, mark in enumerate(marks):
        if mark.text != "neben" or mark.kind != "cue" or (k and marks[k - 1].kind not in {"stop", "line"}):
            continue
        j = k + 1
        while j < len(marks) and marks[j].kind in {"room", "comma", "join", "num", "adj", "size"}:
            j += 1
        rooms = sum(m.kind == "room" for m in marks[k:j])
        if rooms > 1 and j < len(marks) and marks[j].text in WANTED:
            made[k], made[j] = replace(mark, kind="fill"), replace(marks[j], kind="comma", value="")
    return made


INSTEAD = {"statt", "anstatt", "anstelle"}
BY = {"durch", "ueber", "mit", "by", "through", "via", "por", "用"}


def _vestibule(marks: list[Mark]) -> list[Mark]:
    """Read "Diele" beside a "Windfang" as the hall that lies behind it."""
    if not any(m.kind == "room" and m.text.split()[-1] in ENTRIES for m in marks):
        return marks
    return [replace(m, value="hallway") if m.kind == "room" and m.text.startswith("diele") else m for m in marks]


def _room_of(marks: list[Mark]) -> list[Mark]:
    """Read German "ein Zimmer" as a bedroom, unless it is all that the home has ("eine Wohnung mit einem Zimmer")."""
    made = list(marks)
    for k in range(1, len(made)):
        j = k - 1
        own = False
        while j and made[j].kind in {"adj", "size", "adverb"} | ({"det"} if made[j].value in {"own", "another"} else set()):
            own = own or made[j].value in {"own", "another"}
            j -= 1
        own = own or made[j].value == "own"
        single = made[k].kind == "unit" and made[k].value == "rooms" and made[k].text == "zimmer" and made[j].kind == "det"
        whole = j > 1 and made[j - 1].kind == "cue" and made[j - 2].kind == "home"
        if single and made[j].value in {"indefinite", "own", "another"} and (own or not whole) and made[k - 1].value != "largest":
            made[k] = replace(made[k], kind="room", value="bedroom", number=0.0)
    return made


def _room_with(marks: list[Mark]) -> list[Mark]:
    """Read Chinese "一个带卫生间的房间" as a bedroom with a bathroom, "客厅和餐厅是一个大开间" as open, "在它们中间" as in between."""
    made = list(marks)
    for k in range(1, len(made)):
        clause = max((j for j in range(k) if made[j].kind in ENDS - {"join"}), default=-1) + 1
        social = sum(m.kind == "room" and m.value in SOCIAL for m in made[clause:k])
        if made[k].kind == "home" and made[k].value and social > 1:
            made[k] = replace(made[k], kind="flag", value="open_plan")
        if (made[k].kind, made[k].value) == ("cue", "between") and made[k - 1].kind == "pron" and made[k - 1].value in {"group", "both"}:
            made[k - 1 : k + 1] = [made[k], replace(made[k - 1], value="pair")]
    for k in range(3, len(made)):
        room = made[k].kind == "unit" and made[k].value == "rooms" and made[k - 1].text == "的"
        start = (
            next((j for j in range(k - 2, max(-1, k - 8), -1) if (made[j].kind, made[j].value) == ("cue", "has")), None) if room else None
        )
        if start is not None and not any(m.kind in ENDS for m in made[start:k]):
            made[k] = replace(made[k], kind="room", value="bedroom", number=0.0)
            if start and (made[start - 1].kind, made[start - 1].value) == ("pron", "one"):
                made[start - 1] = replace(made[start - 1], kind="num", value="1.0", number=1.0)
    return made


def _doubling(marks: list[Mark]) -> list[Mark]:
    """Read "a guest room that doubles as a study" as one room with two functions."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        mark = marks[k]
        place = _next(marks, k + 1) if (mark.kind, mark.value) == ("flag", "doubling") else None
        host = next((i for i in range(len(made) - 1, max(-1, len(made) - 6), -1) if made[i].kind == "room"), None)
        if place is None or host is None or any(m.kind in {"stop", "line", "join"} for m in made[host:]):
            made.append(mark)
            k += 1
            continue
        kind, other = (m.value.partition("/")[0] for m in (made[host], marks[place]))
        gained = FUNCTIONS.get(other)
        if {kind, other} == {"living_room", "dining_room"}:
            made[host] = replace(made[host], value="living_room+dining_room", last=marks[place].last)
        elif gained:
            made[host] = replace(made[host], functions=(*made[host].functions, gained))
        del made[host + 1 :]
        made += [] if gained else [replace(marks[place], kind="word")]
        k = place + 1 + (place + 1 < len(marks) and marks[place + 1].kind == "verb")
    return made


def _next(marks: Sequence[Mark], k: int) -> int | None:
    """Return the place of the room that follows at k, articles and adjectives skipped."""
    while k < len(marks) and marks[k].kind in PARTS:
        k += 1
    return k if k < len(marks) and marks[k].kind == "room" else None


def _standing(marks: list[Mark]) -> list[Mark]:
    """Read "three bedrooms, two on the hall and one only off the living room": an article without a noun is one of them."""
    made = list(marks)
    for k in range(1, len(made) - 1):
        mark = made[k]
        article = (mark.kind, mark.value) == ("det", "indefinite") and mark.text in ALONE
        further = (mark.kind, mark.value) in {("det", "another"), ("det", "other")}
        j = k + 1
        while j < len(made) and (made[j].kind in {"adverb", "clf", "fill"} or (made[j].kind, made[j].value) == ("flag", "only")):
            j += 1
        said = j < len(made) and made[j].kind in {"cue", "verb", "level"} and (made[j].kind != "cue" or article or made[j].value != "has")
        counts = (m for i, m in enumerate(made[:k]) if m.kind == "num" and m.number > 1 and _next(made, i + 1) is not None)
        counted = next(counts, None) if said else None
        several = mark.kind == "num" and counted is not None and 0 < mark.number < counted.number and mark.number == int(mark.number)
        if several and made[k - 1].kind in ENDS - {"colon"}:
            made[k] = replace(mark, kind="pron", value="one")
        elif (article or further) and counted is not None and made[k - 1].kind in ENDS and (article or made[j].kind != "verb"):
            made[k] = replace(mark, kind="pron", value="one", number=1.0)
    return made


def _between(marks: list[Mark]) -> list[Mark]:
    """Read "two bedrooms with a bathroom in between" and "dazwischen liegt das Bad" as between the two."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        made.append(mark)
        if (mark.kind, mark.value) != ("cue", "between"):
            continue
        ahead = marks[k + 1].kind if k + 1 < len(marks) else "stop"
        behind = k > 0 and marks[k - 1].kind in BESIDE and ahead in ENDS and mark.text != "之 间"
        first = (ahead == "verb" or (ahead == "bound" and marks[k + 1].text in {"是", "为"})) and (k == 0 or marks[k - 1].kind in ENDS)
        if not (mark.text in IN_BETWEEN and (behind or first)):
            continue
        made.append(Mark("pron", "pair", 0.0, False, mark.last, mark.last, "pair"))
        start = len(made) - 3
        while behind and start > 0 and made[start].kind in {"room", "det", "adj", "size", "num"}:
            start -= 1
        if behind and start > 0 and (made[start].kind, made[start].value) == ("cue", "has"):
            made[start] = replace(made[start], kind="comma", value="")
    return made


IN_BETWEEN = {"in between", "dazwischen", "中 间"}
