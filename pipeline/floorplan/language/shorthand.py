"""Short ways to say rooms and sizes: "2LDK", "dos baños y medio", "4x5", "12 m long and 9 m wide", "cooking, dining, living in one"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.amounts import summed, titled
from pipeline.floorplan.language.marks import Mark, Words

FEET, METRES = 0.3048, 1.0
LARGEST = 80.0  # a side-by-side product above this is no room in square metres: then the figures are feet
LETTERS = {"b"}
HALVES = {"medio", "half", "halbes", "半"}
JOINS = {"comma", "join", "slash", "fill", "det", "bullet", "hyphen"}
TOGETHER = {"living_room", "dining_room", "kitchen"}
GROUND = {"ground", "groundfloor", "street"}
SHIFTED = {"first floor": "1", "first storey": "1", "second floor": "2", "second storey": "2"}


def widen(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks with shorthand written out."""
    marks = _premises(_percent(summed(marks)))
    made = _studies(_floors(_paired(_activities(list(marks))), heard), heard)
    return _bedrooms(titled(_summed(_both(_partial(_half_baths(_counts(made))), heard), heard)))


EVERY = ("habitaciones", "cuartos", "recamaras", "piezas")


def _bedrooms(marks: list[Mark]) -> list[Mark]:
    """Read "todas las habitaciones" as the bedrooms where so many of them were counted by that word."""
    made = list(marks)
    for k, mark in enumerate(marks):
        word = mark.text.rsplit(" ", 1)[-1]
        if mark.kind != "every" or word not in EVERY:
            continue
        counted = any(
            m.kind == "room" and m.value == "bedroom" and m.text == word and i and marks[i - 1].kind == "num"
            for i, m in enumerate(marks[:k])
        )
        if counted:
            made[k : k + 1] = [replace(mark, kind="room", value="bedroom", plural=True)]
            made.insert(k, Mark("det", "all", 0.0, True, mark.first, mark.first, "todas las"))
            return _bedrooms(made)
    return made


def _percent(marks: Sequence[Mark]) -> list[Mark]:
    """Read "30 % larger than" as 1.3 times as large as."""
    made = list(marks)
    for k in range(len(marks) - 1):
        share, ahead = marks[k], marks[k + 1]
        if share.kind == "amount" and share.value == "share" and ahead.kind == "cmp" and ahead.value in {"larger", "smaller"}:
            number = 1.0 + share.number if ahead.value == "larger" else 1.0 / max(1.0 - share.number, 0.1)
            made[k] = Mark("factor", "", number, False, share.first, share.last, share.text)
    return made


def _premises(marks: list[Mark]) -> list[Mark]:
    """Read "Small office: reception, two meeting rooms" as premises, not as one of the rooms."""
    k = next((i for i, m in enumerate(marks) if m.kind in {"room", "home"}), -1)
    if k < 0 or marks[k].value != "office" or k + 1 >= len(marks) or marks[k].plural or any(m.kind == "home" for m in marks):
        return marks
    listed = marks[k + 1].kind == "colon" or (
        (marks[k + 1].kind, marks[k + 1].value) == ("cue", "has") and any(m.value == "meeting_room" for m in marks[k:])
    )
    several = sum(m.kind == "room" for m in marks) > 2
    return [*marks[:k], replace(marks[k], kind="home", value=""), *marks[k + 1 :]] if listed and several else marks


def _summed(marks: list[Mark], heard: Words) -> list[Mark]:
    """Read Spanish "cinco habitaciones en total: salón, cocina, ..." as five rooms where the list has so many."""
    if "rooms_are_bedrooms" not in heard.lexicon.traits:
        return marks
    for k in range(1, len(marks)):
        j = k + 1
        while j < len(marks) and marks[j].kind == "flag" and marks[j].value == "total":
            j += 1
        if (
            marks[k].kind != "room"
            or marks[k].value != "bedroom"
            or marks[k - 1].kind != "num"
            or j >= len(marks)
            or marks[j].kind != "colon"
        ):
            continue
        last = next((i for i in range(j, len(marks)) if marks[i].kind in {"stop", "line"}), len(marks))
        part = marks[j:last]
        rooms = [(m, part[i - 1].number if part[i - 1].kind == "num" else 1.0) for i, m in enumerate(part) if m.kind == "room"]
        if sum(n for _, n in rooms) == marks[k - 1].number and any(m.value != "bedroom" for m, _ in rooms):
            amount = replace(marks[k - 1], kind="amount", value="rooms", last=marks[k].last, text="estancias")
            return [*marks[: k - 1], amount, *marks[k + 1 :]]
    return marks


def _partial(marks: list[Mark]) -> list[Mark]:
    """Read "two of them", "davon zwei", "其中两间" as so many of those that were named."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        pair = marks[k : k + 2]
        kinds = [m.kind for m in pair]
        after = next((marks[i] for i in range(k + 2, len(marks)) if marks[i].kind != "clf"), None)
        alone = after is None or after.kind not in {"room", "suite", "unit", "adj", "size"}
        some = [m for m in pair if m.kind == "pron" and m.value == "some"]
        if sorted(kinds) == ["num", "pron"] and some and (kinds[0] == "num" or alone):
            number = next(m.number for m in pair if m.kind == "num")
            made.append(replace(some[0], value="one", number=number, first=pair[0].first, last=pair[1].last))
            k += 2
            while k < len(marks) and marks[k].kind == "clf":
                k += 1
        else:
            made.append(marks[k])
            k += 1
    return made


def _both(marks: list[Mark], heard: Words) -> list[Mark]:
    """Tell "both bedrooms" from "both the bedroom and the hall" and "dan los dos a la cocina"."""
    made = list(marks)
    if not heard.lexicon.traits & {"both_and", "both_alone"}:
        return made
    for k, mark in enumerate(made):
        j = k + 1
        while j < len(made) and made[j].kind in {"det", "adj", "fill"}:
            j += 1
        if mark.kind == "det" and mark.value == "both" and j < len(made) and made[j].kind == "room" and not made[j].plural:
            pair = replace(mark, value="definite") if mark.text.endswith("the") else replace(mark, kind="fill")
            made[k] = pair if "both_and" in heard.lexicon.traits else replace(mark, kind="pron")
    return made


def crossed(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Give "4x5" without unit one: that of the other lengths, else feet where metres would make a hall of it."""
    made: list[Mark] = []
    lengths = [m.number for m in marks if m.kind == "unit" and m.value in {"length", "area"}]
    imperial = bool(lengths) and all(f in {FEET, 0.092903, 0.0254} for f in lengths)
    for k, mark in enumerate(marks):
        made.append(mark)
        pair = (
            k > 1
            and mark.kind == "num"
            and marks[k - 2].kind == "num"
            and (marks[k - 1].kind == "times" or marks[k - 1].text in {"x", "by", "por"})
        )
        if not pair or (k + 1 < len(marks) and marks[k + 1].kind == "unit") or mark.value != "figure":
            continue
        product = mark.number * marks[k - 2].number
        feet = imperial or (not lengths and "feet" in heard.lexicon.traits and product > LARGEST and product < 1000)
        made.append(Mark("unit", "length", FEET if feet else METRES, False, mark.last, mark.last, ""))
    return made


def shared_unit(marks: Sequence[Mark]) -> list[Mark]:
    """Write "14, 12 and 10 m2" with a unit each, where more than one room of a kind stands in front."""
    made = list(marks)
    for k in range(len(made) - 1, 0, -1):
        if made[k].kind != "unit" or made[k].value != "area" or made[k - 1].kind != "num":
            continue
        j, places = k - 1, [k - 1]
        while j >= 2 and _parted(made[j - 1]) and made[j - 2].kind == "num":
            j -= 2
            places.append(j)
        if len(places) > 1 and _several(made, j):
            unit = made[k]
            for place in places[1:]:
                made.insert(place + 1, replace(unit, first=made[place].last, last=made[place].last))
    return made


def _parted(mark: Mark) -> bool:
    return mark.kind in {"comma", "slash"} or (mark.kind == "join" and mark.value == "and")


def _several(marks: Sequence[Mark], k: int) -> bool:
    """Whether rooms of one kind stand in front of the amounts at k."""
    j = k - 1
    while j >= 0 and marks[j].kind in LEADS:
        j -= 1
    if j > 0 and marks[j].kind == "num" and marks[j - 1].kind == "room":  # "卧室三间"
        return marks[j].number > 1
    if j < 0 or marks[j].kind != "room":
        return False
    counted = any(m.kind == "num" and m.number > 1 for m in marks[max(0, j - 3) : j])
    return marks[j].plural or counted


LEADS = {"open", "colon", "fill", "bound", "adverb", "det", "verb", "cue", "hyphen", "dash", "bullet", "clf"}


def dealt(marks: Sequence[Mark]) -> list[Mark]:
    """Make one amount of those that several rooms share out: "two bedrooms (14 m2 and 12 m2)"; rooms nobody counted are so many."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        run, j = [k], k + 1
        while (
            marks[k].kind == "amount"
            and marks[k].value == "area"
            and j + 1 < len(marks)
            and _parted(marks[j])
            and marks[j + 1].kind == "amount"
        ):
            if marks[j + 1].value != "area":
                break
            run.append(j + 1)
            j += 2
        if len(run) > 1 and _shared_out(marks, run):
            amounts = [marks[i] for i in run]
            made.append(replace(marks[k], last=amounts[-1].last, parts=tuple(m.number for m in amounts)))
            place = next(i for i in range(len(made) - 2, -1, -1) if made[i].kind == "room")
            if not any(m.kind == "num" for m in (*made[max(0, place - 3) : place], *made[place + 1 : place + 2])):
                room = made[place]
                made.insert(place, Mark("num", "", float(len(run)), False, room.first, room.first, ""))
            k = j
        else:
            made.append(marks[k])
            k += 1
    return made


def _shared_out(marks: Sequence[Mark], run: Sequence[int]) -> bool:
    """Whether amounts in a row are those of rooms in front of them, and none is the home's."""
    sizes = [marks[i].number for i in run]
    after = marks[run[-1] + 1] if run[-1] + 1 < len(marks) else None
    bounds = {marks[i].bound for i in run} & {"least", "most"}
    total = bool(bounds) or any(marks[i].total for i in run) or (after is not None and (after.kind == "home" or after.value == "total"))
    j = run[0] - 1
    while j >= 0 and marks[j].kind in LEADS:
        j -= 1
    j -= j > 0 and marks[j].kind == "num"
    return j >= 0 and marks[j].kind == "room" and not total and max(sizes) < ALIKE * min(sizes)


ALIKE = 3.0  # rooms of a kind differ by less in area


def _paired(marks: list[Mark]) -> list[Mark]:
    """Read "12 m long and 9 m wide" as an area."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        found = _sides(marks, k)
        if found:
            mark, k = found
            made.append(mark)
        else:
            made.append(marks[k])
            k += 1
    return made


def _sides(marks: Sequence[Mark], k: int) -> tuple[Mark, int] | None:
    sides: list[Mark] = []
    words: set[str] = set()
    j = k
    while j < len(marks) and len(sides) < 3:
        mark = marks[j]
        if mark.kind == "amount" and mark.value == "length":
            sides.append(mark)
        elif mark.kind == "long":
            words.add("long")
        elif mark.kind == "flag" and mark.value == "wide":
            words.add("wide")
        elif not (sides and mark.kind in {"comma", "join", "fill", "det"}):
            break
        j += 1
        if len(sides) == 2 and words == {"long", "wide"}:
            break
    if len(sides) != 2 or words != {"long", "wide"}:
        return None
    if j < len(marks) and (marks[j].kind == "long" or (marks[j].kind == "flag" and marks[j].value == "wide")):
        j += 1
    a, b = sides
    side = min(a.number, b.number)
    return replace(a, value="area", number=a.number * b.number, first=marks[k].first, last=marks[j - 1].last, side=side, total=False), j


def _activities(marks: list[Mark]) -> list[Mark]:
    """Read "cooking, dining and living in one room" as the three rooms; one word alone, or with sleeping, is none."""
    made = list(marks)
    k = 0
    while k < len(made):
        if made[k].kind != "activity":
            k += 1
            continue
        found, j = [k], k + 1
        while j < len(made) and (made[j].kind in JOINS or made[j].kind == "activity"):
            found += [j] if made[j].kind == "activity" else []
            j += 1
        kinds = {made[i].value for i in found}
        near = [m for m in (made[j] if j < len(made) else None, *reversed(made[max(0, k - 3) : k])) if m is not None]
        rooms = {m.value for m in near if m.kind == "room"} & TOGETHER
        listed = any(m.kind in {"comma", "join", "slash"} for m in made[found[0] : found[-1]])
        whole = (
            len(kinds) > 2
            or (len(kinds) > 1 and any(m.kind == "flag" and m.value == "open_plan" for m in near))
            or (bool(rooms - kinds) and len(kinds | rooms) > 1 and k > 0 and made[k - 1].kind in {"comma", "join", "slash"})
        )
        for i in found:
            named = whole and (listed or len(found) == 1)
            made[i] = replace(made[i], kind="room" if named else "fill")
        k = j
    return made


def _floors(marks: list[Mark], heard: Words) -> list[Mark]:
    """Count floors as in Europe where a prompt knows a ground floor: then the first floor is the one above."""
    if "floors_from_one" not in heard.lexicon.traits or not any(m.kind == "level" and GROUND & set(m.text.split()) for m in marks):
        return marks
    return [
        replace(m, value=next((v for s, v in SHIFTED.items() if m.text.endswith(s)), m.value)) if m.kind == "level" else m for m in marks
    ]


def _studies(marks: list[Mark], heard: Words) -> list[Mark]:
    """Read Spanish "estudio" as a study where the home has bedrooms."""
    if "rooms_are_bedrooms" not in heard.lexicon.traits or not any(m.kind == "room" and m.value.startswith("bedroom") for m in marks):
        return marks
    marks = _pisos(marks)
    study = [k for k, m in enumerate(marks) if m.kind == "home" and m.text == "estudio" and k]
    return [replace(m, kind="room", value="office") if k in study else m for k, m in enumerate(marks)]


def _pisos(marks: list[Mark]) -> list[Mark]:
    """Read Spanish "dos pisos", "dos plantas" as storeys; "un piso" is a flat."""
    made: list[Mark] = []
    for mark in marks:
        if mark.kind == "home" and mark.text in {"pisos", "plantas"} and made and made[-1].kind == "num":
            number = made.pop()
            made.append(replace(number, kind="amount", value="storeys", last=mark.last))
        else:
            made.append(mark)
    return made


def _counts(marks: list[Mark]) -> list[Mark]:
    """Read "2LDK" as two bedrooms, living, dining and kitchen in one, without a number as these three; "3b2b" as bedrooms and bathrooms."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        if mark.text in LETTERS and mark.kind == "word" and made and made[-1].kind == "num":
            baths = any(m.kind == "room" and m.value == "bedroom" and m.last - m.first == 1 and k - i < 5 for i, m in enumerate(made))
            ahead = next((m for m in marks[k + 1 : k + 4] if m.kind not in {"slash", "comma", "hyphen", "times"}), None)
            beds = ahead is not None and ahead.kind == "num"
            kind = "bathroom" if baths else ("bedroom" if beds else "")
            made.append(replace(mark, kind="room", value=kind, plural=True) if kind else mark)
        elif mark.kind == "room" and mark.value.endswith("/count") and "+" in mark.value:
            counted = bool(made) and made[-1].kind == "num"
            made.append(replace(mark, value=("bedroom+" if counted else "") + mark.value.removesuffix("/count")))
        else:
            made.append(mark)
    return made


def _half_baths(marks: list[Mark]) -> list[Mark]:
    """Read "dos baños y medio" as two bathrooms and a WC, as agents count."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        ahead = marks[k - 1] if k else None
        halved = mark.text in HALVES and ahead is not None and ahead.kind == "join" and k > 1 and marks[k - 2].value == "bathroom"
        ends = k + 1 >= len(marks) or marks[k + 1].kind in {"comma", "stop", "line", "join", "close"}
        if halved and ends:
            made += [
                Mark("num", "", 1.0, False, mark.first, mark.last, mark.text),
                Mark("room", "wc", 0.0, False, mark.first, mark.last, mark.text),
            ]
        else:
            made.append(mark)
    return made
