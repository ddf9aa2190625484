"""Amounts put together from numbers, units and limits: "at least 18 m²", "10 to 12 m²", "4 x 5 m"; and figures whose unit or meaning stands elsewhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.lexicon import Lexicon, kinds
from pipeline.floorplan.language.marks import Mark, Words

FEET, SQUARE_FEET = 0.3048, 0.092903
USUAL_HEIGHT = 15.0  # a length from here on, said of a room or a home, is an area ("60 metros")
ALIKE = 3.0  # rooms of a kind differ by less in area
LEADS = kinds("leads")
BOUNDS = {"least": "least", "or_more": "least", "most": "most", "or_less": "most"}


def _kind(marks: Sequence[Mark], k: int) -> str:
    return marks[k].kind if 0 <= k < len(marks) else "stop"


def amounts(marks: Sequence[Mark], words: Words) -> list[Mark]:
    """Return the marks with amounts put together."""
    return _dealt(combine_amounts(_share_units(marks), words))


def _is_separator(mark: Mark) -> bool:
    return mark.kind in {"comma", "slash"} or (mark.kind == "join" and mark.value == "and")


def _share_units(marks: Sequence[Mark]) -> list[Mark]:
    """Give each of "14, 12 and 10 m2" its unit."""
    with_units = list(marks)
    for k in range(len(with_units) - 1, 2, -1):
        before, number = with_units[k - 3], with_units[k - 1]
        row = (
            (with_units[k].kind, with_units[k].value) == ("unit", "area")
            and _is_separator(with_units[k - 2])
            and before.kind == number.kind == "num"
        )
        if row and max(before.number, number.number) < ALIKE * min(before.number, number.number):
            with_units.insert(k - 2, replace(with_units[k], first=before.last, last=before.last))
    return with_units


def _dealt(marks: Sequence[Mark]) -> list[Mark]:
    """Make one amount of those that several rooms share out: "two bedrooms (14 m2 and 12 m2)"; rooms nobody counted are so many."""
    merged: list[Mark] = []
    k = 0
    while k < len(marks):
        end = k
        while (
            end + 2 < len(marks)
            and _is_separator(marks[end + 1])
            and all((m.kind, m.value) == ("amount", "area") for m in marks[end : end + 3 : 2])
        ):
            end += 2
        row, after = marks[k : end + 1 : 2], marks[end + 1] if end + 1 < len(marks) else None
        sizes = [m.number for m in row]
        total = any(m.total or m.bound in {"least", "most"} for m in row) or (after is not None and "home" in {after.kind, after.value})
        place = _in_front(merged) if len(row) > 1 and not total and max(sizes) < ALIKE * min(sizes) else None
        merged.append(marks[k])
        if place is not None:
            merged[-1] = replace(marks[k], last=row[-1].last, parts=tuple(sizes))
            if not any(m.kind == "num" for m in (*merged[max(0, place - 3) : place], *merged[place + 1 : place + 2])):
                merged.insert(place, Mark("num", "", float(len(row)), False, merged[place].first, merged[place].first, ""))
            k = end
        k += 1
    return merged


def _in_front(marks: Sequence[Mark]) -> int | None:
    """Return the place of the room that the amounts behind the marks are said of."""
    j = next((j for j in range(len(marks) - 1, -1, -1) if marks[j].kind not in LEADS), None)
    if j and marks[j].kind == "num":
        j -= 1  # "卧室三间"
    return j if j is not None and marks[j].kind == "room" else None


def combine_amounts(marks: Sequence[Mark], words: Words) -> list[Mark]:
    """Put amounts together: "at least 18 m²", "10 to 12 m²", "4 x 5 m", "seven square metres or more"."""
    merged: list[Mark] = []
    k = 0
    while k < len(marks):
        amount = _Amount(marks, words.lexicon).read(k)
        if amount is None:
            merged.append(marks[k])
            k += 1
        else:
            mark, end = amount
            mark.first, mark.last = marks[k].first, marks[end - 1].last
            mark.text = " ".join(words.texts[mark.first : mark.last])
            if mark.value == "share" and _kind(marks, end) == "cmp":  # "30 % larger than"
                times = 1.0 + mark.number if marks[end].value == "larger" else 1.0 / max(1.0 - mark.number, 0.1)
                mark = replace(mark, kind="factor", value="", number=times)
            merged.append(mark)
            k = end
    return merged


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
            light = i > k and mark.kind in {"fill", "det"} and mark.value in {"", "unbuilt", "indefinite"}
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
        crossed = i < len(marks) and (marks[i].kind == "times" or marks[i].text in {"x", *self.lex.sign("crossing")})
        if crossed and unit is None and _kind(marks, i + 1) == "num" and _kind(marks, i + 2) in {"comma", "stop", "line", "join"}:
            return low * marks[i + 1].number, None, min(low, marks[i + 1].number), Mark("unit", "length", 1.0), i + 2  # "4x5"
        if _kind(marks, i + 1) == "num" and _kind(marks, i + 2) == "unit" and marks[i].kind != "comma":
            second, after = marks[i + 1].number, marks[i + 2]
            joins = marks[i].kind == "dash" or marks[i].text in self.lex.range_to
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
