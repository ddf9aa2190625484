"""Sizes against each other in Chinese: "比厨房大一倍", "不能比主卧小", "没有客厅大", "大于厨房", "客厅最大，其次是主卧"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import Mark, Words
from pipeline.floorplan.language.tallies import ENDS, HEADS, plain

PHRASE = {"num", "clf", "adj", "size", "det", "ord"}
LIGHT = {"adverb", "verb", "det", "fill", "bound"}
BEFORE = {
    "的",
    "面积",
    "更",
    "要",
    "还",
    "都",
    "还要",
    "稍",
    "略",
    "稍微",
    "略微",
    "至少",
    "起码",
    "应",
    "明显",
    "要更",
    "得",
    "来得",
    "来",
}
LARGER = {"大", "宽敞", "大得多", "宽", "更大", "宽大", "大的", "大些", "要大", "大一些", "大一点", "还大", "大上"}
SMALLER = {"小", "小些", "更小", "要小", "小得多", "窄", "小的", "小一些", "小一点", "还小"}
BEHIND = {
    "一些",
    "一点",
    "些",
    "点",
    "得多",
    "很多",
    "不少",
    "许多",
    "一圈",
    "一",
    "出",
    "上",
    "的",
    "得",
    "多",
    "才行",
    "就行",
    "吧",
    "至少",
}
LACKING = {"没有", "不如", "不及", "没", "比不上"}
OVER = {"大于", "超过", "多于", "高于", "不小于", "不低于", "不少于", "大过", "大于等于", "不得小于", "不能小于", "不应小于", "要大于", ">"}
UNDER = {
    "小于",
    "少于",
    "低于",
    "不大于",
    "不超过",
    "不高于",
    "小过",
    "小于等于",
    "不得大于",
    "不能大于",
    "不能超过",
    "不得超过",
    "不应超过",
    "不应大于",
    "<",
}
NEXT = ({"其次", "第二", "次之", "然后", "再次", "接着", "接下来", "之后", "最后", "再者", "第三"}, {"是", "为"})


def compared(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks with every comparison as: room, "larger" or "smaller", factor, room."""
    if heard.lexicon.language != "zh":
        return list(marks)
    made = _ranked(list(marks))
    for k in range(len(made) - 1, 0, -1):
        found = _than(made, k) or _bounded(made, k)
        if found is not None:
            start, value, factor, rooms, end = found
            cue = replace(made[k], kind="cmp", value=value, number=0.0)
            times = (
                [Mark("factor", "", factor, False, made[end - 1].first, made[end - 1].last, made[end - 1].text)] if factor != 1.0 else []
            )
            made[start:end] = [cue, *rooms, *times]
    return made


def _rooms(marks: Sequence[Mark], k: int) -> int:
    """Return where the rooms that begin at k end; k where none stands there."""
    end = j = k
    while j < len(marks) and (
        marks[j].kind in PHRASE | HEADS or (marks[j].kind == "join" and plain(marks[j]) in {"和", "与", "&", "跟", "及"})
    ):
        if marks[j].kind == "size" and end > k:
            break
        j += 1
        end = j if marks[j - 1].kind in HEADS else end
    return end


Found = tuple[int, str, float, list[Mark], int]


def _than(marks: Sequence[Mark], k: int) -> Found | None:
    """Read "比厨房大一倍" and "没有客厅大" at k."""
    lacking = plain(marks[k]) in LACKING and marks[k].kind == "neg"
    if not lacking and not (plain(marks[k]) == "比" and marks[k].kind == "cmp"):
        return None
    end = _rooms(marks, k + 1)
    j = end
    while end > k + 1 and j < len(marks) and marks[j].kind in LIGHT and plain(marks[j]) in BEFORE:
        j += 1
    if end == k + 1 or j >= len(marks):
        return None
    word = plain(marks[j])
    value = "larger" if word in LARGER else "smaller" if word in SMALLER else ""
    factor = 1.0
    if marks[j].kind == "factor" and word.startswith(("大", "小")):
        value, factor = ("larger" if word[0] == "大" else "smaller"), marks[j].number
    if not value:
        return None
    tail = j + 1
    while tail < len(marks) and (plain(marks[tail]) in BEHIND or marks[tail].kind == "size"):
        tail += 1
    if tail < len(marks) and marks[tail].kind == "factor" and factor == 1.0:
        number = marks[tail].number
        factor = {0.5: 1.5 if value == "larger" else 2.0}.get(number, number + (plain(marks[tail]) != "一倍" and number > 2.0))
        tail += 1
    elif tail < len(marks) and marks[tail].kind == "amount" and marks[tail].value == "share":
        share = marks[tail].number
        factor = 1.0 + share if value == "larger" else 1.0 / max(1.0 - share, 0.1)
        tail += 1
    rest: list[Mark] = []
    if tail < len(marks) and marks[tail].kind == "amount" and marks[tail].value == "area":
        rest, tail = [replace(marks[tail], kind="word")], tail + 1  # by how much: no relation holds that
    start = k
    back = k - 1
    while back >= 0 and marks[back].kind in {"verb", "adverb", "det", "bound", "fill", "flag"}:
        back -= 1
    turned = back >= 0 and marks[back].kind == "neg" and not lacking
    if lacking or turned:
        value = "smaller" if value == "larger" else "larger"
        start = back if turned else k
    return start, value, factor, [*marks[k + 1 : end], *rest], tail


def _bounded(marks: Sequence[Mark], k: int) -> Found | None:
    """Read "大于厨房", "不能小于书房的面积" at k."""
    word = plain(marks[k])
    if word not in OVER | UNDER or marks[k].kind not in {"bound", "cmp", "word"}:
        return None
    end = _rooms(marks, k + 1)
    if end == k + 1:
        return None
    tail = end
    while tail < len(marks) and plain(marks[tail]) in {"的", "面积", "大小"}:
        tail += 1
    if tail < len(marks) and marks[tail].kind not in ENDS:
        return None
    return k, "larger" if word in OVER else "smaller", 1.0, list(marks[k + 1 : end]), tail


def _ranked(marks: list[Mark]) -> list[Mark]:
    """Read "客厅最大，其次是主卧，再次是厨房" as a row of rooms, each smaller than the one before."""
    made = list(marks)
    last: Mark | None = None
    sign = ""
    k = 0
    while k < len(made):
        mark = made[k]
        if mark.kind in {"stop", "line"}:
            last = None
        if mark.kind == "adj" and mark.value in {"largest", "smallest"}:
            sign = "smaller" if mark.value == "largest" else "larger"
            near = [m for m in [*reversed(made[max(0, k - 3) : k]), *made[k + 1 : k + 5]] if m.kind in HEADS]
            last = near[0] if near else None
        j, word = k, ""
        while j < len(made) and j - k < 4 and word not in NEXT[0] and made[j].kind not in ENDS | HEADS:
            word, j = word + plain(made[j]), j + 1
        if last is None or not sign or word not in NEXT[0] or not k or made[k - 1].kind != "comma":
            k += 1
            continue
        while j < len(made) and (plain(made[j]) in NEXT[1] or made[j].kind == "adverb"):
            j += 1
        end = _rooms(made, j)
        if end > j and (end >= len(made) or made[end].kind in ENDS):
            room = made[end - 1]
            cue = replace(made[k], kind="cmp", value=sign, number=0.0)
            made[k:end] = [*made[j:end], cue, replace(last, first=last.first, number=0.0)]
            last = room
        k += 1
    return made
