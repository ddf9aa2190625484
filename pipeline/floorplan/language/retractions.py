"""What Chinese prompts take back or leave open: "原来是三室一厅，现在改成两室两厅", "一个就够", "可有可无", "其中一间改成书房"."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import Mark, Words
from pipeline.floorplan.language.tallies import ENDS, HARD, HEADS, one, plain

MAYBE = {"可有可无", "有没有都行", "有没有都可以", "无所谓", "不强求", "不是必须", "有无均可", "有无都行"}
TURNED = {"改成", "改为", "改作", "改做", "改造成", "改造为", "作为", "用作", "用做", "做成", "当", "当作", "做", "做为", "变成", "当成"}
EARLIER = {"原来", "原先", "以前", "之前", "目前", "现有", "本来", "原本", "最初", "一开始"}


ODD = {"多", "余", "来", "几"}  # "80多平"


def loosened(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Read "80多平" as about 80, and leave out the home as it was: "原来是三室一厅，现在想改成两室两厅"."""
    if heard.lexicon.language != "zh":
        return list(marks)
    kinds = ["num", "unit"]
    made = [
        m
        for k, m in enumerate(marks)
        if not (plain(m) in ODD and 0 < k < len(marks) - 1 and [marks[k - 1].kind, marks[k + 1].kind] == kinds)
    ]
    made = [m for k, m in enumerate(made) if not _bullet(made, k)]
    return _denied(_renewed(_turned(_optional(_fewer(_bathless(_unsized(made)))))))


def _homes(marks: Sequence[Mark]) -> int:
    """Return how many counts of rooms stand one behind the other: two in "三室一厅"."""
    return sum(a.kind == "num" and b.kind in HEADS and b.last - b.first <= 2 for a, b in itertools.pairwise(marks))


def _renewed(marks: list[Mark]) -> list[Mark]:
    start = next((k for k, m in enumerate(marks) if plain(m) in EARLIER), None)
    if start is None:
        return marks
    cut = next((k for k in range(start, len(marks)) if marks[k].kind in {"comma", "stop"} and _homes(marks[start:k])), None)
    if cut is None:
        return marks
    end = next((k for k in range(cut, len(marks)) if marks[k].kind in {"stop", "line"} and k > cut), len(marks))
    fixed = next((k for k in range(cut, end) if marks[k].kind == "fix"), None)
    if fixed is None or not _homes(marks[fixed:end]) or (_homes(marks[start:cut]) < 2 and _homes(marks[fixed:end]) < 2):
        return marks
    kept = [m for m in marks[start:cut] if m.kind not in {"num", "room", "home"}]
    return [*marks[:start], *(replace(m, kind="fill") for m in kept), *marks[cut:fixed], *marks[fixed + 1 :]]


def _denied(marks: list[Mark]) -> list[Mark]:
    """Leave out "不是三居室" beside "四居室": another count of what is wanted."""
    for k in range(len(marks) - 3):
        lead = marks[k].kind == "neg" and plain(marks[k]) in {"不", "不是"}
        j = k + 1 + (lead and plain(marks[k + 1]) == "是")
        counted = lead and j + 1 < len(marks) and marks[j].kind == "num" and marks[j + 1].kind in HEADS
        if counted and (j > k + 1 or plain(marks[k]) == "不是"):
            others = [m for i, m in enumerate(marks) if m.kind in HEADS and m.value == marks[j + 1].value and not k <= i <= j + 1]
            if others:
                return [*marks[:k], *(replace(m, kind="fill") for m in marks[k:j]), *marks[j + 2 :]]
    return marks


def _fewer(marks: list[Mark]) -> list[Mark]:
    """Read "不要两个卫生间了，一个就够" as one bathroom."""
    for k in range(len(marks) - 4):
        if marks[k].kind != "neg" or marks[k + 1].kind != "num":
            continue
        room = next((j for j in range(k + 2, min(k + 4, len(marks))) if marks[j].kind in HEADS), None)
        comma = next((j for j in range(room + 1, min(room + 4, len(marks))) if marks[j].kind in {"comma", "stop"}), None) if room else None
        if room is None or comma is None or any(m.kind not in {"fill", "word"} for m in marks[room + 1 : comma]):
            continue
        few = next((j for j in range(comma + 1, min(comma + 4, len(marks))) if marks[j].kind == "num" or one(marks[j])), None)
        near = marks[comma + 1 : comma + 7]
        if few is not None and any(m.kind == "enough" or plain(m) in {"就行", "就好", "够", "就可以", "足够"} for m in near):
            end = next((j for j in range(few, len(marks)) if marks[j].kind in {"comma", "stop", "line"}), len(marks))
            number = replace(marks[few], kind="num", value="", number=marks[few].number or 1.0)
            return [*marks[:k], number, *marks[k + 2 : room + 1], *_fewer(marks[end:])]
    return marks


def _unsized(marks: list[Mark]) -> list[Mark]:
    """Read "厨房不需要很大" as said of its size, which rules no kitchen out; the words stand as not understood."""
    made = list(marks)
    for k, mark in enumerate(made):
        if mark.kind not in {"neg", "needless"}:
            continue
        j = k + 1
        while j < len(made) and (made[j].kind == "adverb" or plain(made[j]) in {"太", "特别", "那么", "多", "必", "要", "得"}):
            j += 1
        size = j < len(made) and (made[j].kind == "size" or plain(made[j]) in {"大", "小", "宽敞", "豪华"})
        after = j + 1
        while after < len(made) and plain(made[after]) in {"的", "了", "点", "一点", "面积", "就行"}:
            after += 1
        if size and (after >= len(made) or made[after].kind in ENDS):
            made[k : j + 1] = [replace(m, kind="word", value="", number=0.0) for m in made[k : j + 1]]
    return made


def _bathless(marks: list[Mark]) -> list[Mark]:
    """Read "客房不需要卫生间" as said of that room alone, where another bathroom is spoken of."""
    made = list(marks)
    baths = [k for k, m in enumerate(made) if m.kind == "room" and m.value.startswith(("bathroom", "wc"))]
    for k in baths:
        j = k - 1
        while j > 0 and (made[j].kind == "det" or one(made[j])):
            j -= 1
        host = j - 1
        while host > 0 and made[host].kind in {"verb", "adverb", "fill"}:
            host -= 1
        ends = k + 1 >= len(made) or made[k + 1].kind in ENDS
        bed = host >= 0 and made[host].kind == "room" and made[host].value.startswith("bedroom")
        if made[j].kind in {"neg", "needless"} and bed and ends and len(baths) > 1:
            made[j] = replace(made[j], kind="word", value="")
            made[k] = replace(made[k], kind="word", value="")
    return made


def _optional(marks: list[Mark]) -> list[Mark]:
    """Leave out what may be or not: "可以没有阳台", "书房可有可无"; the words stand as not understood."""
    made = list(marks)
    for k, mark in enumerate(made):
        back = k - 1 - (k > 0 and made[k - 1].kind in {"adverb", "verb"} and plain(made[k - 1]) != "可以")
        if (
            mark.kind == "neg"
            and back >= 0
            and plain(made[back]) in {"可以", "可", "也可以", "可以也"}
            and plain(mark) in {"没有", "不要", "不带", "无", "不设", "没"}
        ):
            j = k + 1
            while j < len(made) and made[j].kind not in {"comma", "stop", "line", "but"}:
                made[j] = replace(made[j], kind="word", value="") if made[j].kind in HEADS else made[j]
                j += 1
            made[k] = replace(mark, kind="word", value="")
        elif plain(mark) in MAYBE and k and made[k - 1].kind in HEADS:
            made[k - 1] = replace(made[k - 1], kind="word", value="")
    return made


def _turned(marks: list[Mark]) -> list[Mark]:
    """Read "四室，其中一间改成书房" as three bedrooms and a study."""
    made = list(marks)
    k = 0
    while k < len(made) - 2:
        counted = one(made[k]) or (made[k].kind == "num" and made[k + 1].kind == "clf")
        j = k + 1 + (made[k].kind == "num")
        turns = counted and plain(made[k]) != "一个" and j + 1 < len(made) and (made[j].kind == "fix" or plain(made[j]) in TURNED)
        room = next((i for i in range(j + 1, min(j + 4, len(made))) if made[i].kind in HEADS), None) if turns else None
        beds = next(
            (
                i
                for i in range(k - 1, 0, -1)
                if made[i].kind == "room" and made[i].value.startswith("bedroom") and made[i - 1].kind in {"num", "clf"}
            ),
            None,
        )
        if room is None or beds is None or made[room].value.startswith("bedroom"):
            k += 1
            continue
        place = beds - 1 - (made[beds - 1].kind == "clf")
        count = made[k].number if made[k].kind == "num" else 1.0
        if made[place].number <= count:
            k += 1
            continue
        made[place] = replace(made[place], value="", number=made[place].number - count)
        start = k - ((made[k - 1].kind, made[k - 1].value) == ("pron", "some"))
        made[start:room] = [replace(made[k], kind="num", value="", number=count)]
        k = start + 1
    return made


def _bullet(marks: Sequence[Mark], k: int) -> bool:
    """Whether the mark at k is of a number in front of a line: "1)", "(2)", or "设计" behind what is so designed."""
    if plain(marks[k]) == "设计" and marks[k].kind == "verb":
        return 0 < k < len(marks) - 1 and marks[k - 1].kind in HEADS and marks[k + 1].kind in ENDS
    first = k - (marks[k].kind == "close") - (marks[k].kind == "open" and -1)
    if not 0 < first < len(marks) - 1 and first != 0:
        return False
    number = marks[first].kind == "num" and marks[first].value == "figure" and first + 1 < len(marks) and marks[first + 1].kind == "close"
    before = marks[first - 1].kind if first else "stop"
    return number and before in HARD | {"open"} and (before != "open" or first < 2 or marks[first - 2].kind in HARD)
