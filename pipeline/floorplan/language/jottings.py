"""Ways and baths as one jots them down: "kitchen -> living: open", "bedroom (own bath)", "3 bedrooms, 2 with a bath", "bedrooms (2)"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import Mark, Words

CLOSERS = {"comma", "stop", "line", "close", "join", "open"}
PERSONAL = {"bathroom", "wc", "closet", "balcony"}
LIGHT = {"det", "adj", "size", "num", "fill", "adverb"}


def jotted(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks with such notes written out."""
    made = _another(_onto_open(_counted(_roman(_arrows(list(marks))))))
    if heard.lexicon.language == "de":
        made = _beside(_above(_amid(_open_between(_leading(_belonging(_of_the(made)))))))
    if heard.lexicon.language == "zh":
        made = _wide(_each(_numbered(made)))
    return _with(_but_one(_bathless(_all_ensuite(made))))


def _head(mark: Mark) -> str:
    """Return the first word of a mark."""
    return (mark.text.split() or [""])[0]


def _arrows(marks: list[Mark]) -> list[Mark]:
    """Read "kitchen -> living open", "kitchen -> hall: door", "kitchen → hall (door)" as a way of that kind, "kitchen - hall: no door" as none."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        mark = marks[k]
        made.append(mark)
        k += 1
        arrow = (mark.kind, mark.value) == ("cue", "chain") and not mark.text[0].isalpha()
        dash = mark.kind == "comma" and mark.text in {"-", "–", "—"}
        if not (arrow or dash) or len(made) < 2 or made[-2].kind != "room" or k >= len(marks) or marks[k].kind != "room":
            continue
        j = k + 1
        opened = j < len(marks) and marks[j].kind in {"colon", "open"}
        bracket = opened and marks[j].kind == "open"
        j += opened
        none = j < len(marks) and marks[j].kind == "neg"
        j += none
        if j >= len(marks) or (marks[j].kind, marks[j].value) not in {("flag", "doors"), ("adj", "open"), ("adj", "closed")}:
            continue
        end = j + 1 + (bracket and j + 1 < len(marks) and marks[j + 1].kind == "close")
        if not (arrow or none or opened) or (end < len(marks) and marks[end].kind not in CLOSERS | {"dash"}):
            continue
        kind = "open" if marks[j].value == "open" else "door"
        made[-1] = replace(mark, kind="cue", value=kind)
        if none:
            made.insert(len(made) - 1, replace(marks[j - 1], kind="neg"))
        made.append(marks[k])
        k = end
    return made


def _counted(marks: list[Mark]) -> list[Mark]:
    """Read "bedrooms (2)", "bedroom (2x)", "bedrooms = 2" as two of them."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        mark, ahead = marks[k], marks[k + 1 : k + 5]
        kinds = [m.kind for m in ahead]
        bracket = kinds[:3] == ["open", "num", "close"] or (kinds[:2] == ["open", "factor"] and kinds[2:3] == ["close"])
        bracket = bracket or kinds[:4] in (["open", "num", "times", "close"], ["open", "num", "clf", "close"])
        equal = kinds[:2] in (["comma", "num"], ["hyphen", "num"], ["dash", "num"]) and ahead[0].text == "="
        told = k > 1 and marks[k - 1].kind == "det" and marks[k - 2].text in {"anzahl", "zahl"} and kinds[:2] == ["colon", "num"]
        equal = equal or told
        equal = equal and (len(kinds) < 3 or kinds[2] in CLOSERS)
        bare = k == 0 or told or marks[k - 1].kind not in {"num", "det"}
        if mark.kind == "room" and bare and (bracket or equal) and 1 < ahead[1].number < 10 and ahead[1].number % 1 == 0:
            number = Mark("num", "figure", ahead[1].number, False, mark.first, mark.first, ahead[1].text)
            made += [number, replace(mark, plural=True)]
            k += 1 + (kinds.index("close") + 1 if bracket else 2)
        else:
            made.append(mark)
            k += 1
    return made


ROMAN = {"i": 1.0, "ii": 2.0, "iii": 3.0, "iv": 4.0}
HAN = {"一": 1.0, "二": 2.0, "三": 3.0, "四": 4.0, "五": 5.0, "甲": 1.0, "乙": 2.0, "丙": 3.0}
BEHIND = CLOSERS | {"amount", "colon"}  # behind "卧室一"


def _roman(marks: list[Mark]) -> list[Mark]:
    """Read "bedroom I ..., bedroom II ..." as the first and the second."""
    places = [k for k in range(1, len(marks)) if marks[k - 1].kind == "room" and marks[k].text in ROMAN and marks[k].kind != "num"]
    if not {"i", "ii"} <= {marks[k].text for k in places}:
        return marks
    return [replace(m, kind="num", value="figure", number=ROMAN[m.text]) if k in places else m for k, m in enumerate(marks)]


def _numbered(marks: list[Mark]) -> list[Mark]:
    """Read "卧室一14㎡，卧室二11㎡" as the first and the second."""
    places = [
        k
        for k in range(1, len(marks))
        if marks[k - 1].kind == "room" and marks[k].text in HAN and (k + 1 == len(marks) or marks[k + 1].kind in BEHIND)
    ]
    if not {1.0, 2.0} <= {HAN[marks[k].text] for k in places}:
        return marks
    return [replace(m, kind="num", value="figure", number=HAN[m.text]) if k in places else m for k, m in enumerate(marks)]


def _each(marks: list[Mark]) -> list[Mark]:
    """Read "三间卧室，各有一个卫生间" and "每间一个卫生间" as said of those in front."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        has = (mark.kind, mark.value) == ("cue", "has") and _head(mark) in {"各", "均", "都", "皆"}
        if has and len(made) > 1 and made[-1].kind == "comma" and made[-2].kind == "room" and made[-2].value == "bedroom":
            made.pop()
        made.append(mark)
        every = mark.value in {"each", "group"} and mark.kind in {"det", "pron"} and k + 2 < len(marks) and marks[k + 1].number == 1
        thing = next((m for m in marks[k + 2 : k + 4] if m.kind != "clf"), None) if every else None
        if thing is not None and thing.kind == "room" and thing.value == "bathroom":
            made.append(Mark("cue", "has", 0.0, False, mark.last, mark.last, "带"))
    return made


def _wide(marks: list[Mark]) -> list[Mark]:
    """Read "厨房和客厅之间是敞开的" as one open room."""
    made = list(marks)
    for k, mark in enumerate(marks):
        j = k + 1
        while j < len(marks) and marks[j].kind in {"verb", "adverb"}:
            j += 1
        if (mark.kind, mark.value) == ("cue", "between") and j < len(marks) and (marks[j].kind, marks[j].value) == ("adj", "open"):
            behind = marks[j + 1].kind if j + 1 < len(marks) and marks[j + 1].text != "的" else "stop"
            if behind in CLOSERS:
                made[k], made[j] = replace(mark, kind="fill", value=""), replace(marks[j], kind="flag", value="open_plan")
    return made


def _thing(marks: Sequence[Mark], k: int) -> int:
    """Return where "its own bath" that begins at k ends, k where none does."""
    j = k
    while j < len(marks) and marks[j].kind in LIGHT and j - k < 4:
        j += 1
    own = any((m.kind, m.value) == ("det", "own") for m in marks[k:j]) and not any(m.kind == "num" and m.number > 1 for m in marks[k:j])
    return j + 1 if own and j < len(marks) and marks[j].kind == "room" and marks[j].value.split("/")[0] in PERSONAL else k


def _with(marks: list[Mark]) -> list[Mark]:
    """Read "bedroom (own bath)", "bedroom: own bath", "bedroom + own bath" and "a bedroom, besides its own bath" as "with"."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        before = made[-1] if made else None
        bedroom = before is not None and before.kind in {"room", "suite"} and (before.kind == "suite" or before.value.startswith("bedroom"))
        plus = mark.kind == "join" and mark.text in {"+", "dazu"}
        beside = mark.kind == "comma" and k + 1 < len(marks) and marks[k + 1].text == "dazu"
        made.append(mark)
        if bedroom and (mark.kind in {"open", "colon"} or plus) and _thing(marks, k + 1) > k + 1:
            has = Mark("cue", "has", 0.0, False, mark.last, mark.last, "mit")
            made[-1:] = [mark, has] if mark.kind == "open" else [has]
        elif bedroom and beside and _thing(marks, k + 2) > k + 2:
            made[-1] = Mark("cue", "has", 0.0, False, mark.last, mark.last, "mit")
    return [m for k, m in enumerate(made) if not (m.text == "dazu" and m.kind == "join" and k and made[k - 1].kind == "cue")]


def _several(marks: Sequence[Mark], k: int) -> float:
    """Return how many bedrooms were counted last in front of k, 0 for one or none."""
    for j in range(k - 1, 0, -1):
        if marks[j].kind == "room" and marks[j].value.startswith("bedroom"):
            number = next((m for m in reversed(marks[max(0, j - 3) : j]) if m.kind in {"num", "room", "stop"}), None)
            return number.number if number is not None and number.kind == "num" else 0.0
    return 0.0


def _but_one(marks: list[Mark]) -> list[Mark]:
    """Read "three bedrooms, two with a bath" and "alle bis auf eines mit Bad" as "two of them"."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        made.append(mark)
        has = k + 1 < len(marks) and (marks[k + 1].kind, marks[k + 1].value) == ("cue", "has")
        if not has or k < 2:
            continue
        several = _several(marks, k)
        if mark.kind == "num" and marks[k - 1].kind in {"comma", "open", "colon"} and 1 < mark.number < several:
            made[-1] = replace(mark, kind="pron", value="one")
            continue
        j = k
        while j and marks[j].kind in {"det", "cue", "num", "pron", "every"}:
            j -= 1
        left_out = marks[j + 1 : k + 1]
        out = any((m.kind, m.value) == ("cue", "except") for m in left_out)
        one = any(m.number == 1 or (m.kind, m.value) == ("det", "indefinite") for m in left_out)
        every = any(m.value in {"all", "each"} or m.kind == "every" for m in left_out)
        if several > 1 and out and one and every and marks[j].kind == "comma":
            made[len(made) - len(left_out) :] = [replace(mark, kind="pron", value="one", number=several - 1, first=left_out[0].first)]
    return made


def _all_ensuite(marks: list[Mark]) -> list[Mark]:
    """Read "drei Schlafzimmer, alle en suite" as all with a bath of their own."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        every = made[-1] if made and made[-1].value in {"all", "each", "both"} and made[-1].kind in {"det", "pron", "every"} else None
        if mark.kind == "room" and mark.text in {"en suite", "ensuite"} and every is not None and k > 1:
            has = Mark("cue", "has", 0.0, False, mark.first, mark.first, "mit")
            made += [has, Mark("det", "own", 0.0, False, mark.first, mark.first, "eigenem"), replace(mark, value="bathroom")]
        else:
            made.append(mark)
    return made


def _bathless(marks: list[Mark]) -> list[Mark]:
    """Read "a bedroom without a bath" as one that has none of its own: it rules no bathroom out."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        before = made[-1] if made else None
        one = before is not None and (
            (before.kind == "room" and before.value.startswith("bedroom"))
            or (before.kind == "pron" and before.value == "one")
            or ((before.kind, before.value) == ("det", "indefinite") and len(made) > 1 and made[-2].kind in {"comma", "open"})
        )
        j = k + 1
        while j < len(marks) and marks[j].kind == "det":
            j += 1
        without = marks[k].kind == "neg" and (_head(marks[k]) in {"ohne", "without", "sin"} or marks[k].text == "不 带")
        if one and without and j < len(marks) and marks[j].kind == "room" and marks[j].value == "bathroom":
            k = j + 1
        else:
            made.append(marks[k])
            k += 1
    return made


def _of_the(marks: list[Mark]) -> list[Mark]:
    """Read "zwei der drei Schlafzimmer" as two of them."""
    made = list(marks)
    for k in range(1, len(made) - 2):
        if made[k].text == "der" and made[k - 1].kind == made[k + 1].kind == "num" and made[k + 2].kind == "room":
            made[k] = replace(made[k], kind="det", value="partitive")
    return made


def _belonging(marks: list[Mark]) -> list[Mark]:
    """Read "zum Schlafzimmer gehört ein eigenes Bad" as "das Schlafzimmer hat ..."."""
    made = list(marks)
    for k, mark in enumerate(made):
        if _head(mark) not in {"gehoert", "gehoeren"}:
            continue
        start = next((j for j in range(k - 1, max(-1, k - 5), -1) if made[j].kind in {"stop", "line", "comma"}), -1) + 1
        if start < k and _head(made[start]) in {"zu", "zum", "zur"} and all(m.kind in LIGHT | {"room"} for m in made[start:k]):
            made[k] = replace(mark, kind="cue", value="has", text="hat")
            made[start] = replace(made[start], kind="fill") if made[start].kind != "det" else replace(made[start], value="definite")
    return made


def _another(marks: list[Mark]) -> list[Mark]:
    """Read "ein Schlafzimmer und noch eins", "one large and one small bedroom" as two rooms."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        made.append(mark)
        one = (mark.number == 1 and mark.kind in {"num", "ord"}) or (mark.kind, mark.value) in {("det", "indefinite"), ("det", "another")}
        ahead = marks[k + 1].kind if k + 1 < len(marks) else "stop"
        sized = mark.kind in {"size", "ord"} and k > 0 and ((marks[k - 1].kind, marks[k - 1].value) == ("det", "indefinite"))
        j = k
        while j and (marks[j].kind in {"det", "num", "size", "ord", "adverb"} or marks[j].text == "noch"):
            j -= 1
        joined = marks[j].kind == "join" and j < k and j and marks[j - 1].kind == "room" and marks[j - 1].value.startswith("bedroom")
        said = joined and not marks[j - 1].plural and ahead in CLOSERS and (one or sized)
        if said:
            made.insert(len(made) - (k - j), replace(mark, kind="det", value="another"))
            made[len(made) - (k - j) :] = [m for m in made[len(made) - (k - j) :] if m.kind == "size"]
            made.append(replace(marks[j - 1], first=mark.last, last=mark.last))
        elif mark.kind == "size" and k and marks[k - 1].kind in {"det", "num"} and _both_sized(marks, k):
            room = next(m for m in marks[k + 1 :] if m.kind == "room")
            made.append(replace(room, first=mark.last, last=mark.last, plural=False))
        elif mark.kind == "factor" and mark.text in TIMES and ahead == "room":
            made[-1] = replace(mark, kind="num", value="")
    return made


TIMES = {"zweimal", "dreimal"}


def _both_sized(marks: Sequence[Mark], k: int) -> bool:
    """Whether "a large and a small bedroom" begins with the size at k."""
    rest = marks[k + 1 : k + 5]
    article = marks[k - 1].value == "indefinite" or marks[k - 1].number == 1
    same = len(rest) > 3 and rest[1].kind == marks[k - 1].kind and rest[1].value == marks[k - 1].value
    return article and same and [m.kind for m in rest] == ["join", rest[1].kind, "size", "room"] and not rest[3].plural


LEADING = {"fuehrt", "fuehren", "oeffnet", "oeffnen", "oeffnet sich", "oeffnen sich"}


def _leading(marks: list[Mark]) -> list[Mark]:
    """Read "der Flur führt nicht ins Bad", "öffnet sich nicht zum Bad" as no way there."""
    made: list[Mark] = []
    for mark in marks:
        made.append(mark)
        verb = next((j for j in range(len(made) - 2, max(-1, len(made) - 6), -1) if made[j].text in LEADING), None)
        there = _head(mark) in {"in", "ins", "zu", "zum", "zur", "auf"} and mark.kind in {"cue", "det", "fill", "word"}
        rest = made[verb + 1 : -1] if verb is not None else []
        if there and rest and any(m.kind == "neg" for m in rest) and all(m.kind in {"neg", "adverb", "flag", "word", "pron"} for m in rest):
            made[verb:] = [next(m for m in rest if m.kind == "neg"), replace(mark, kind="cue", value="leads")]
    return made


def _open_between(marks: list[Mark]) -> list[Mark]:
    """Read "zwischen Küche und Wohnzimmer ist es offen" as one open room."""
    made = list(marks)
    for k, mark in enumerate(made):
        if (mark.kind, mark.value) != ("cue", "between"):
            continue
        end = next((j for j in range(k + 1, len(made)) if made[j].kind in {"stop", "line", "comma"}), len(made))
        wide = next((j for j in range(k + 1, end) if (made[j].kind, made[j].value) == ("adj", "open")), None)
        if wide is not None and wide == end - 1 and not any(m.kind in {"neg", "flag", "num"} for m in made[k:end]):
            made[wide] = replace(made[wide], kind="flag", value="open_plan")
            made[k] = replace(mark, kind="fill", value="")
    return made


def _amid(marks: list[Mark]) -> list[Mark]:
    """Read "Küche und Bad, dazwischen der Flur" as "zwischen Küche und Bad liegt der Flur"."""
    made = list(marks)
    for k in range(3, len(made) - 1):
        start = next((j for j in range(k - 1, -1, -1) if made[j].kind in {"stop", "line", "colon"}), -1) + 1
        rooms = [j for j in range(start, k) if made[j].kind == "room"]
        plain = all(m.kind in {"room", "det", "join", "size", "adj"} for m in made[start : k - 1])
        if made[k].text == "dazwischen" and made[k - 1].kind in {"comma", "join"} and len(rooms) == 2 and plain:
            behind = next((m for m in made[k + 1 :] if m.kind not in LIGHT | {"verb"}), None)
            if behind is not None and behind.kind == "room":
                verb = replace(made[k], kind="verb", value="", text="liegt")
                return [*made[:start], replace(made[k], text="zwischen"), *made[start : k - 1], verb, *made[k + 1 :]]
    return made


def _above(marks: list[Mark]) -> list[Mark]:
    """Read "im Erdgeschoss Küche und Bad, darüber zwei Zimmer" as the storey above."""
    made = list(marks)
    for k, mark in enumerate(made):
        last = next((m for m in reversed(made[:k]) if m.kind == "level"), None)
        step = {"darueber": 1, "darunter": -1}.get(mark.text, 0)
        begins = k > 0 and made[k - 1].kind in {"comma", "stop", "join", "line"}
        if step and begins and last is not None and 0 <= int(last.value) + step <= 2 and k + 1 < len(made):
            ahead = next((m for m in made[k + 1 :] if m.kind not in LIGHT | {"verb"}), None)
            if ahead is not None and ahead.kind == "room":
                made[k] = replace(
                    last, value=str(int(last.value) + step), first=mark.first, last=mark.last, text="oben" if step > 0 else "unten"
                )
    return made


SOCIAL = {"living_room", "dining_room", "kitchen", "family_room"}


def _onto_open(marks: list[Mark]) -> list[Mark]:
    """Read "the living room connects to an open kitchen", "客厅连开放厨房" as open to it."""
    made = list(marks)
    for k in range(1, len(made) - 2):
        j = k + 1 + (made[k + 1].kind == "det")
        way = made[k].kind == "cue" and made[k].value in {"door", "leads"} and made[k - 1].kind == "room"
        wide = j + 1 < len(made) and (made[j].kind, made[j].value) == ("adj", "open") and made[j + 1].kind == "room"
        if way and wide and {made[k - 1].value, made[j + 1].value} <= SOCIAL:
            made[k] = replace(made[k], value="open")
    return made


def _beside(marks: list[Mark]) -> list[Mark]:
    """Read "ein Besprechungsraum, ein Büro daneben" as an office next to the meeting room."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        rooms = [m for m in made if m.kind == "room"]
        ends = k + 1 >= len(marks) or marks[k + 1].kind in CLOSERS
        if mark.text == "daneben" and ends and len(rooms) > 1 and made[-1].kind == "room" and not rooms[-2].plural:
            host = replace(rooms[-2], first=mark.last, last=mark.last)
            definite = Mark("det", "definite", 0.0, False, mark.last, mark.last, "dem")
            made += [replace(mark, kind="cue", value="near"), definite, host]
        else:
            made.append(mark)
    return made
