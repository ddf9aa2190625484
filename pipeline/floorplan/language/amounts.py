"""Amounts put together from numbers, units and limits: "at least 18 m²", "10 to 12 m²", "4 x 5 m"; and figures whose unit or meaning stands elsewhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.lexicon import Lexicon
from pipeline.floorplan.language.tokens import Mark, Words

FEET, SQUARE_FEET, INCHES = 0.3048, 0.092903, 0.0254
USUAL_HEIGHT = 15.0  # a length from here on, said of a room or a home, is an area ("60 metros")
LARGEST = 80.0  # a product of sides above this is no room in square metres: then the figures are feet
ALIKE = 3.0  # rooms of a kind differ by less in area
SMALLEST = 3.0  # [m2] a figure behind a room that may be its area
MOST_NAMES = 5.0  # "bedroom 2" is a name, from here on it is an area
INDEXED = {"bedroom", "bathroom"}
CLOSERS = {"comma", "stop", "line", "join", "close", "open", "slash", "bullet"}
LEADS = {
    "open",
    "colon",
    "fill",
    "bound",
    "adverb",
    "det",
    "verb",
    "cue",
    "hyphen",
    "dash",
    "bullet",
    "clf",
    "word",
}  # between rooms and their areas
BOUNDS = {"least": "least", "or_more": "least", "most": "most", "or_less": "most"}


def _unit(mark: Mark, value: str = "area") -> bool:
    return (mark.kind, mark.value) == ("unit", value)


def _kind(marks: Sequence[Mark], k: int) -> str:
    return marks[k].kind if 0 <= k < len(marks) else "stop"


def _copied(unit: Mark, behind: Mark) -> Mark:
    """Return a unit once more, behind a figure that shares it."""
    return replace(unit, first=behind.last, last=behind.last)


def amounts(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks with amounts put together."""
    made = list(marks)
    for step in (_shared, _crossed, _plain):
        made = step(made, heard)
    return _sides(_dealt(measured(made, heard)))


def _parted(mark: Mark) -> bool:
    return mark.kind in {"comma", "slash"} or (mark.kind == "join" and mark.value == "and")


def _shared(marks: list[Mark], heard: Words) -> list[Mark]:
    """Give each of "14, 12 and 10 m2" its unit, and each room of "kitchen and bath with 12 and 6 m²" its area."""
    made = list(marks)
    for k in range(len(made) - 1, 0, -1):
        if not _unit(made[k]) or made[k - 1].kind != "num":
            continue
        j, places = k - 1, [k - 1]
        while j >= 2 and _parted(made[j - 1]) and made[j - 2].kind == "num":
            j -= 2
            places.append(j)
        limit = j > 2 and heard.lexicon.bounds.get(made[j - 1].text) in {"least", "most"}
        while limit and j > 2 and made[j - 2].kind in {"comma", "but", "join"}:  # "at least 12, but no more than 16 m²"
            j -= 1
        if limit and made[j - 2].kind == "num":
            places, j = [k - 1, j - 2], j - 2
        elif len(places) > 1:
            rooms = _in_front(made, j)
            if len(rooms) == len(places) == 2 and not any(m.kind == "num" or m.plural for m in made[rooms[-1] : j]):
                first = [made[j], _copied(made[k], made[j])]
                made[rooms[-1] + 1 : k + 1] = [*first, *made[rooms[-1] + 1 : rooms[0] + 1], *made[k - 1 : k + 1]]
                continue
        for place in places[1:]:
            made.insert(place + 1, _copied(made[k], made[place]))
            k += 1  # noqa: PLW2901 - the unit moves on
    return made


def _in_front(marks: Sequence[Mark], k: int) -> list[int]:
    """Return the places of the one or two rooms that the amounts at k are said of, the last first."""
    j = k - 1
    while j >= 0 and marks[j].kind in LEADS:
        j -= 1
    j -= j > 0 and marks[j].kind == "num" and marks[j - 1].kind == "room"  # "卧室三间"
    if j < 0 or marks[j].kind != "room":
        return []
    pair = j > 1 and marks[j - 1].kind == "join" and marks[j - 2].kind == "room" and j < k - 1
    articled = j > 2 and marks[j - 1].kind == "det" and marks[j - 2].kind == "join" and marks[j - 3].kind == "room" and j < k - 1
    return [j, j - 2] if pair else [j, j - 3] if articled else [j]


def _crossed(marks: list[Mark], heard: Words) -> list[Mark]:
    """Give "4x5" without unit one: that of the other lengths, else feet where metres would make a hall of it."""
    lengths = [m.number for m in marks if _unit(m) or _unit(m, "length")]
    imperial = bool(lengths) and all(f in {FEET, SQUARE_FEET, INCHES} for f in lengths)
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        made.append(mark)
        by = k > 1 and (marks[k - 1].kind == "times" or marks[k - 1].text in heard.lexicon.sign("crossing")) and marks[k - 2].kind == "num"
        if by and (mark.kind, mark.value) == ("num", "figure") and _kind(marks, k + 1) != "unit":
            product = mark.number * marks[k - 2].number
            feet = imperial or (not lengths and "feet" in heard.lexicon.traits and LARGEST < product < 1000)
            made.append(Mark("unit", "length", FEET if feet else 1.0, False, mark.last, mark.last, ""))
    return made


def _plain(marks: list[Mark], heard: Words) -> list[Mark]:
    """Read "bedrooms 14 and 11 m2, living room 22, kitchen 9" and "dormitorios de 12 metros, un salón de 25": areas all of them."""
    made = list(marks)
    for k, mark in enumerate(marks):
        across = k + 1 < len(marks) and (
            marks[k + 1].kind in {"long", "times"} or marks[k + 1].value in {"wide", "ceiling"} or marks[k + 1].text == "x"
        )
        metres = mark.text in heard.lexicon.sign("metres") and _unit(mark, "length") and not across and _kind(marks, k - 1) == "num"
        if metres and marks[k - 1].number >= MOST_NAMES and _of_room(marks, k - 1, heard) is not None:
            made[k] = replace(mark, value="area")
    units = [k for k, m in enumerate(made) if k and _unit(m) and made[k - 1].kind == "num"]
    told = any(_of_room(made, k - 1, heard) for k in units)
    unit = made[units[0]] if units else None
    for k in range(len(made) - 1, 0, -1) if unit is not None else ():
        figure = (made[k].kind, made[k].value) == ("num", "figure") and made[k].number >= SMALLEST and _kind(made, k + 1) in CLOSERS
        room = _of_room(made, k, heard) if figure and (told or made[k - 1].text in heard.lexicon.sign("of")) else None
        indexed = (
            room is not None and room.value.partition("/")[0] in INDEXED and made[k].number < MOST_NAMES and made[k - 1].kind == "room"
        )
        if room is not None and unit is not None and not indexed:
            made.insert(k + 1, _copied(unit, made[k]))
    return made


def _of_room(marks: Sequence[Mark], k: int, heard: Words) -> Mark | None:
    """Return the room that the figure at k measures: right in front of it, or of figures in a row."""
    j = k - 1
    while j > 0 and (
        marks[j].kind in {"num", "bound", "post", "size"} or (marks[j].kind in {"join", "comma"} and marks[j - 1].kind == "num")
    ):
        j -= 1
    j -= j > 0 and marks[j].kind == "open"
    j -= j > 0 and (marks[j].value == "has" or marks[j].text in heard.lexicon.sign("of") or marks[j].kind == "colon")
    return marks[j] if j >= 0 and marks[j].kind == "room" else None


def _dealt(marks: Sequence[Mark]) -> list[Mark]:
    """Make one amount of those that several rooms share out: "two bedrooms (14 m2 and 12 m2)"; rooms nobody counted are so many."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        run = [k]
        while marks[k].kind == "amount" and run[-1] + 2 < len(marks) and _parted(marks[run[-1] + 1]):
            ahead = marks[run[-1] + 2]
            if (ahead.kind, ahead.value, marks[k].value) != ("amount", "area", "area"):
                break
            run.append(run[-1] + 2)
        sizes = [marks[i].number for i in run]
        after = marks[run[-1] + 1] if run[-1] + 1 < len(marks) else None
        total = any(marks[i].total or marks[i].bound in {"least", "most"} for i in run) or (
            after is not None and (after.kind == "home" or after.value == "total")
        )
        rooms = _in_front(made, len(made)) if len(run) > 1 and not total and max(sizes) < ALIKE * min(sizes) else []
        if rooms:
            place = rooms[0]
            if not any(m.kind == "num" for m in (*made[max(0, place - 3) : place], *made[place + 1 : place + 2])):
                made.insert(place, Mark("num", "", float(len(run)), False, made[place].first, made[place].first, ""))
            made.append(replace(marks[k], last=marks[run[-1]].last, parts=tuple(sizes)))
            k = run[-1]
        else:
            made.append(marks[k])
        k += 1
    return made


def _sides(marks: list[Mark]) -> list[Mark]:
    """Read "12 m long and 9 m wide" as an area, and "30 % larger than" as 1.3 times as large as."""
    made = list(marks)
    k = 0
    while k < len(made):
        mark = made[k]
        if mark.kind == "amount" and mark.value == "share" and _kind(made, k + 1) == "cmp" and made[k + 1].value in {"larger", "smaller"}:
            number = 1.0 + mark.number if made[k + 1].value == "larger" else 1.0 / max(1.0 - mark.number, 0.1)
            made[k] = replace(mark, kind="factor", value="", number=number)
        part = [m for m in made[k : k + 7] if m.kind not in {"comma", "join", "fill", "det"}][:4]
        what = ["side" if (m.kind, m.value) == ("amount", "length") else m.kind if m.kind == "long" else m.value for m in part]
        if sorted(what) == ["long", "side", "side", "wide"]:
            a, b = (m for m, w in zip(part, what, strict=True) if w == "side")
            area = replace(a, value="area", number=a.number * b.number, last=part[-1].last, side=min(a.number, b.number), total=False)
            made[k : next(i for i in range(k, len(made)) if made[i] is part[-1]) + 1] = [area]
        k += 1
    return made


def measured(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Put amounts together: "at least 18 m²", "10 to 12 m²", "4 x 5 m", "seven square metres or more"."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        found = _Amount(marks, heard.lexicon).read(k)
        if found is None:
            made.append(marks[k])
            k += 1
        else:
            mark, end = found
            mark.first, mark.last = marks[k].first, marks[end - 1].last
            mark.text = " ".join(heard.texts[mark.first : mark.last])
            made.append(mark)
            k = end
    return made


class _Amount:
    """Reads one amount: limits in front, a number or a range or sides, a unit, limits behind."""

    def __init__(self, marks: Sequence[Mark], lex: Lexicon) -> None:
        self.marks, self.lex = marks, lex
        self.bound, self.ranged, self.total = "", False, False

    def read(self, k: int) -> tuple[Mark, int] | None:
        """Return the amount that begins at mark k, and where it ends."""
        i = self._lead(k)
        if _kind(self.marks, i) != "num" or i - k > 4:
            return None
        low, high, side, unit, i = self._numbers(i)
        if unit is None:
            return None
        i = self._limits(i, unit)
        factor, value = unit.number, unit.value
        if side is not None and value == "length":
            return Mark("amount", "area", low * factor * factor, bound=self.bound, side=side * factor), i
        if value == "length" and factor >= FEET - 0.01 and low * factor >= USUAL_HEIGHT:
            value, factor = "area", (1.0 if factor == 1.0 else SQUARE_FEET)
        top = None if high is None else high * factor
        return Mark("amount", value, low * factor, high=top, bound=self.bound, total=self.total), i

    def _lead(self, k: int) -> int:
        i = k
        while i < len(self.marks):
            mark = self.marks[i]
            limit, start = self.lex.bounds.get(mark.text), mark.text in self.lex.range_from
            light = i > k and mark.kind in {"fill", "det"} and mark.value in {"", "indefinite"}
            if limit is None and not start and not light:
                break
            self.bound = BOUNDS.get(limit, self.bound or "about") if limit else self.bound
            self.ranged = self.ranged or start
            self.total = self.total or (mark.kind, mark.value) == ("flag", "total")
            i += 1
        return i

    def _numbers(self, i: int) -> tuple[float, float | None, float | None, Mark | None, int]:
        marks, low, i = self.marks, self.marks[i].number, i + 1
        high = side = unit = None
        i += _kind(marks, i) in {"hyphen", "dash"} and _kind(marks, i + 1) == "unit"
        if _kind(marks, i) == "unit":
            unit, i = marks[i], i + 1
        if _kind(marks, i + 1) == "num" and _kind(marks, i + 2) == "unit" and marks[i].kind != "comma":
            second, after = marks[i + 1].number, marks[i + 2]
            joins = marks[i].kind == "dash" or marks[i].text in self.lex.range_to
            crossed = marks[i].kind == "times" or marks[i].text in {"x", *self.lex.sign("crossing")}
            if (unit is None or after.value == unit.value) and crossed:
                return low * second, None, min(low, second), after, i + 3
            if (unit is None or after.value == unit.value) and joins and (second > low or (self.ranged and low > 0)):
                low, high = sorted((low, second))
                unit, i = after, i + 3
        return low, high, side, unit, i

    def _limits(self, i: int, unit: Mark) -> int:
        marks = self.marks
        if i + 1 < len(marks) and marks[i].value == "total" and self.lex.bounds.get(marks[i + 1].text, "about") != "about":
            self.total, i = True, i + 1  # "50 m2 in total at most"
        compared = unit.value == "share" and _kind(marks, i) in {"cmp", "adj", "size"}  # "30 % larger than"
        behind = self.lex.bounds.get(marks[i].text, "about") if i < len(marks) and not compared else "about"
        added = i < len(marks) and marks[i].text == "+" and _kind(marks, i + 1) in {"room", "suite", "det", "adj", "size", "pron"}
        if behind != "about" and not added and _kind(marks, i + 1) != "num":
            self.bound, i = BOUNDS[behind], i + 1
        return i
