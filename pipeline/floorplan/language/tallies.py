"""How Chinese counts: "卧室x3", "卧室数量为2", "卧室要三间", "客厅、厨房各一间", "有两间带卫生间", "大的15平，小的9平", "顶层"."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import Mark, Words

ENDS = {"comma", "stop", "line", "close", "join", "open", "but"}
HARD = {"comma", "stop", "line", "open", "colon", "but"}  # where a clause begins
SOFT = {"verb", "adverb", "bound", "fill", "det", "colon", "times", "flag"}  # between a room and how many there are
HEADS = {"room", "suite"}
DETAIL = {"adj", "size", "amount", "clf"}
QUANTITY = {"数量", "个数", "间数", "数"}
WISHED = {"要", "需要", "想要", "得有", "要有", "有", "共", "共有", "一共", "一共有", "总共", "总共有", "是", "为", "就", "只要", "只有", "只", "设", "设有", "安排", "x", "*", "都", "的", "至少", "最少", "起码", "最多", "还是", "仍是", "还", "保留", "得", "必须", "必须有", "至少要", "至少有", "至少需要"}  # fmt: skip
BECOMES = {"做成", "设计成", "采用", "做", "改成", "弄成", "设计为", "用"}
TOPS = {"顶层", "顶楼", "最上层", "最高层", "最上面一层", "最上面", "最顶层"}


def plain(mark: Mark) -> str:
    """Return the characters of a mark."""
    return mark.text.replace(" ", "")


def tallied(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks with every number in front of what it counts."""
    if heard.lexicon.language != "zh":
        return list(marks)
    made = _storeys(
        _bedrooms(_sizes(_bracketed(_besides([replace(m, kind="adj", value="plain") if m.kind == "long" else m for m in marks]))))
    )
    made = [m for k, m in enumerate(made) if not _alone(made, k)]
    return _headless(_partly(_apiece(_behind(_summed(_figures(made))))))


def _summed(marks: list[Mark]) -> list[Mark]:
    """Read "所有卧室都带卫生间，一共三间" as three bedrooms with a bathroom."""
    for k in range(1, len(marks) - 2):
        total = marks[k].kind == "flag" and marks[k].value == "total" and marks[k - 1].kind in {"comma", "stop", "open"}
        if (
            not total
            or marks[k + 1].kind != "num"
            or marks[k + 2].kind != "clf"
            or not (k + 3 >= len(marks) or marks[k + 3].kind in ENDS | {"close"})
        ):
            continue
        start = max((i for i in range(k - 1) if marks[i].kind in {"stop", "line"}), default=-1) + 1
        head = next((i for i in range(start, k) if marks[i].kind in HEADS), None)
        if head is None or any(m.kind == "num" for m in marks[max(start, head - 2) : head]):
            continue
        lead = [m for m in marks[start:head] if (m.kind, m.value) not in {("det", "all"), ("det", "each")} and plain(m) != "的"]
        counted = [replace(marks[k + 1], value=""), marks[k + 2], marks[head]]
        every = [replace(marks[head], kind="det", value="all", text="都")] if any(m.kind == "cue" for m in marks[head + 1 : k]) else []
        return [*marks[:start], *lead, *counted, *every, *marks[head + 1 : k - 1], *marks[k + 3 :]]
    return marks


def _alone(marks: Sequence[Mark], k: int) -> bool:
    """Whether the mark at k is of "单独一间" behind a room: it is one by itself."""
    said = [plain(m) for m in marks[max(0, k - 1) : k + 2]]
    first = k if (marks[k].kind, marks[k].value) == ("det", "own") else k - 1
    pair = 0 < first < len(marks) - 1 and plain(marks[first]) in {"单独", "独立", "另外", "自成"} and one(marks[first + 1]) and bool(said)
    return pair and marks[first - 1].kind in HEADS and (first + 2 >= len(marks) or marks[first + 2].kind in ENDS)


def _headless(marks: list[Mark]) -> list[Mark]:
    """Read "主卧有自己的卫生间，另外再来一个公用的" as one more bathroom."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        made.append(mark)
        end = k + 1 + (k + 1 < len(marks) and plain(marks[k + 1]) == "的")
        alone = end >= len(marks) or marks[end].kind in ENDS
        single = any(one(m) or m.kind == "num" for m in marks[max(0, k - 2) : k])
        bath = next((m for m in reversed(marks[:k]) if m.kind == "room" and m.value.startswith("bathroom")), None)
        owner = next((m for m in reversed(marks[max(0, k - 2) : k]) if m.kind not in {"det", "verb"} and m.value != "has"), None)
        has = any(m.value in {"has", "another"} or plain(m) == "有" for m in marks[max(0, k - 2) : k])
        bedroom = owner is not None and owner.kind == "room" and owner.value.startswith("bedroom")
        if one(mark) and alone and has and bedroom and bath is not None:  # "孩子们共用一个卫生间，主卧另有一个"
            made.pop()
            while made[-1] is not owner:
                made.pop()
            made += [
                replace(mark, kind="cue", value="has"),
                replace(mark, kind="det", value="own"),
                replace(bath, value="bathroom", first=mark.last, last=mark.last),
            ]
        elif (mark.kind, mark.value) == ("adj", "shared") and alone and single and bath is not None:
            made.append(replace(bath, value="bathroom/shared", first=mark.last, last=mark.last))
    return made


def _besides(marks: list[Mark]) -> list[Mark]:
    """Read "另外再来一间书房" as one more."""
    made = list(marks)
    for k, mark in enumerate(marks):
        if (mark.kind, mark.value) != ("det", "other") or plain(mark) not in {"另外", "另", "此外"}:
            continue
        if k + 1 < len(marks) and (marks[k + 1].kind, marks[k + 1].value) == ("det", "another"):
            made[k] = replace(mark, kind="fill", value="")
            continue
        j = k + 1
        while (
            j < len(marks)
            and j - k < 5
            and (marks[j].kind in {"adverb", "verb"} or plain(marks[j]) in {"来", "要", "加", "有", "配", "设", "给"})
        ):
            j += 1
        if j > k + 1 and j < len(marks) and (one(marks[j]) or marks[j].kind == "num"):
            made[k] = replace(mark, kind="fill", value="")
            number = marks[j] if marks[j].kind == "num" else replace(marks[j], kind="num", value="", number=1.0)
            made[j] = replace(number, value="")
            made[j - 1] = replace(made[j - 1], kind="det", value="another")
    return made


def _bracketed(marks: list[Mark]) -> list[Mark]:
    """Read "厨房（封闭式）" and "厨房做成开放式的" as "封闭式厨房" and "开放式厨房"."""
    made = list(marks)
    for k in range(len(made) - 1, -1, -1):
        if made[k].value != "kitchen" or made[k].kind != "room" or (k and plain(made[k - 1]) in {"和", "与", "跟", "&", "+", "对", "向"}):
            continue
        j = k + 1
        while j < len(made) and j - k < 4 and (made[j].kind in {"verb", "adverb", "bound", "det"} or plain(made[j]) in BECOMES):
            j += 1
        after = j + 1 + (j + 1 < len(made) and plain(made[j + 1]) == "的")
        ends = after >= len(made) or made[after].kind in ENDS - {"join", "open"}
        if j < len(made) and (made[j].kind, made[j].value) in {("adj", "open"), ("adj", "closed")} and ends:
            made[k:after] = [made[j], made[k]]
    for k in range(len(made) - 3, 0, -1):
        kinds = [m.kind for m in made[k : k + 3]]
        alone = k < 3 or made[k - 2].kind != "join" or plain(made[k - 2]) in {"&", ","}
        if kinds == ["open", "adj", "close"] and made[k - 1].kind == "room" and alone:
            made[k - 1 : k + 3] = [made[k + 1], made[k - 1]]
    return made


def _figures(marks: list[Mark]) -> list[Mark]:
    """Read "卧室x3", "卧室数量2" and a bare "卧室3、卫生间2" as counts."""
    rooms = [m.value for m in marks if m.kind in HEADS]
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        mark = marks[k]
        if mark.kind != "room":
            made.append(mark)
            k += 1
            continue
        j, said = k + 1, False
        while j < len(marks) and (
            plain(marks[j]) in {"x", "*", "的", "为", "是"} or marks[j].kind in {"times", "word", "colon"} or plain(marks[j]) in QUANTITY
        ):
            said = (
                said
                or marks[j].kind == "times"
                or plain(marks[j]) in {"x", "*"}
                or "".join(plain(m) for m in marks[k + 1 : j + 1]).strip("的为是:") in QUANTITY
            )
            j += 1
        number = marks[j] if j < len(marks) and marks[j].kind == "num" and marks[j].number == int(marks[j].number) else None
        after = j + 1 + (j + 1 < len(marks) and marks[j + 1].kind == "clf")
        ends = after >= len(marks) or marks[after].kind in ENDS
        bare = number is not None and j == k + 1 and number.value == "figure" and rooms.count(mark.value) == 1 and 1 < number.number <= 9
        free = not made or made[-1].kind not in {"num", "clf", "ord"}
        if number is not None and ends and free and (said or (bare and _figured(marks))):
            made += [replace(number, value=""), mark]
            k = after
        else:
            made.append(mark)
            k += 1
    return made


def _figured(marks: Sequence[Mark]) -> bool:
    """Whether figures stand behind two rooms and more: "卧室3，卫生间2"."""
    return sum(a.kind == "room" and b.kind == "num" and b.value == "figure" for a, b in itertools.pairwise(marks)) > 1


def one(mark: Mark) -> bool:
    """Whether a mark is "一间" or its like."""
    return (mark.kind, mark.value) == ("pron", "one") and plain(mark) in {"一个", "一间", "一套", "一处", "其中一间", "其中一个"}


def _behind(marks: list[Mark]) -> list[Mark]:
    """Read "卧室要三间", "卫生间一共两个", "卧室两间" with the number in front."""
    made = list(marks)
    k = 0
    while k < len(made):
        if made[k].kind not in HEADS or (k and made[k - 1].kind in {"num", "clf", "ord"}) or (k and one(made[k - 1])):
            k += 1
            continue
        j = k + 1
        while j < len(made) and j - k < 5 and (plain(made[j]) in WISHED or (j > k + 1 and made[j].kind == "adverb")):
            j += 1
        number = made[j] if j < len(made) and (made[j].kind == "num" or one(made[j])) else None
        counted = number is not None and (one(number) or (j + 1 < len(made) and made[j + 1].kind == "clf"))
        after = j + 1 + (number is not None and number.kind == "num" and counted)
        parted = after >= len(made) or made[after].kind in ENDS or made[after].kind == "amount" or plain(made[after]) in {"就", "吧"}
        whole = j == k + 1 or number is None or number.number != 1.0 or one(number) or plain(made[j - 1]) not in {"是", "为"}
        has = any(m.kind == "cue" and m.value == "has" for m in made[k + 1 : j]) and k and made[k - 1].kind not in HARD | {"join"}
        if counted and parted and whole and not has and number is not None:
            moved = replace(number, kind="num", value="", number=number.number if number.kind == "num" else 1.0)
            tail = made[j + 1 : after]
            rest = [m for m in made[k + 1 : j] if m.kind == "flag"]
            start = k
            while start and made[start - 1].kind in {"adj", "size"}:
                start -= 1
            made[start:after] = [moved, *tail, *made[start:k], made[k], *rest]
            k += 1
        k += 1
    return made


def _apiece(marks: list[Mark]) -> list[Mark]:
    """Read "客厅、厨房各一个" as one of each, "卧室、书房各两间" as two of each."""
    made = list(marks)
    for k, mark in enumerate(made):
        if (mark.kind, mark.value) != ("det", "each") or plain(mark) not in {"各", "各要", "各有", "各需"} or k + 1 >= len(made):
            continue
        j = k + 1 + (made[k + 1].kind in {"verb", "bound"})
        number = made[j] if j < len(made) and (made[j].kind == "num" or one(made[j])) else None
        after = j + 1 + (j + 1 < len(made) and made[j + 1].kind == "clf")
        if number is None or not (after >= len(made) or made[after].kind in ENDS) or not k or made[k - 1].kind not in HEADS | {"amount"}:
            continue
        count = number.number if number.kind == "num" else 1.0
        front = made[:k]
        i = k - 1
        while i >= 0 and front[i].kind in HEADS | DETAIL | {"join", "num"}:
            i -= 1
        if count > 1:
            for p in range(k - 1, i, -1):
                if front[p].kind in HEADS and not any(m.kind == "num" for m in front[max(i + 1, p - 2) : p]):
                    front.insert(p, replace(number, kind="num", value="", number=count))
        return [*front, *_apiece(made[after:])]
    return made


def _partly(marks: list[Mark]) -> list[Mark]:
    """Read "有两间带卫生间" and "剩下两间共用" as some of the rooms that were counted."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        mark = marks[k]
        pair = mark.kind == "num" and k + 1 < len(marks) and marks[k + 1].kind == "clf" and marks[k + 1].value != "one"
        ahead = marks[k + 2] if k + 2 < len(marks) else None
        goes = ahead is not None and (
            ahead.kind in {"cue", "verb", "adverb"}
            or (ahead.kind, ahead.value) == ("det", "all")
            or (ahead.kind, ahead.value) == ("adj", "shared")
        )
        back = next((m for m in reversed(made) if m.kind not in {"adverb", "verb", "fill"} and m.value != "has"), None)
        told = any(m.kind == "num" and m.number >= mark.number and n.kind in {"clf", "room"} for m, n in itertools.pairwise(made))
        if pair and goes and told and back is not None and mark.number > 1:
            rest = bool(made) and (made[-1].kind, made[-1].value) == ("det", "other")
            while made and made[-1].value == "has" and made[-1].kind == "cue":
                made.pop()
            if rest:
                made.pop()
            made.append(replace(mark, kind="pron", value="rest" if rest else "one", last=marks[k + 1].last))
            k += 2
        else:
            made.append(mark)
            k += 1
    return made


def _sizes(marks: list[Mark]) -> list[Mark]:
    """Read "其中大的15平，小的9平" as one of them and another."""
    made = list(marks)
    for k in range(1, len(made) - 1):
        nominal = (
            made[k].kind == "size" and plain(made[k]).endswith("的") and made[k - 1].kind in {"comma", "pron", "colon", "open", "join"}
        )
        verb = made[k + 1].kind in {"verb", "bound"} and k + 2 < len(made)
        if nominal and (made[k + 1 + verb].kind == "amount"):
            made[k] = replace(made[k], kind="pron", value="one", number=1.0)
            if (made[k - 1].kind, made[k - 1].value) == ("pron", "some"):
                made[k - 1] = replace(made[k - 1], kind="fill", value="")
    return made


def _bedrooms(marks: list[Mark]) -> list[Mark]:
    """Read "三个房间、一个客厅" as bedrooms: rooms in a list with the one where one lives."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        made.append(mark)
        if (
            mark.kind != "amount"
            or mark.value != "rooms"
            or (k + 1 < len(marks) and marks[k + 1].kind not in {"join", "comma", "cue", "colon"})
        ):
            continue
        end = next((j for j in range(k + 2, len(marks)) if marks[j].kind in {"stop", "line", "colon"}), len(marks))
        counted = any(
            a.kind in {"num", "clf"} and b.value.startswith("living_room") for a, b in zip(marks[k:end], marks[k + 1 : end], strict=False)
        )
        if k + 1 < len(marks) and marks[k + 1].kind == "colon" and _people(marks[k + 2 : end]):
            made[-1:] = [replace(mark, kind="num", value="", number=mark.number), replace(mark, kind="room", value="bedroom", number=0.0)]
            continue
        counted = counted or any(
            one(a) and b.value.startswith("living_room") for a, b in zip(marks[k:end], marks[k + 1 : end], strict=False)
        )
        listed = any(plain(m) in {"分别", "包括"} for m in marks[k + 1 : k + 4])
        beds = any(m.kind in HEADS and m.value.startswith("bedroom") for m in marks)
        if counted and not listed and not beds:
            made[-1:] = [replace(mark, kind="num", value="", number=mark.number), replace(mark, kind="room", value="bedroom", number=0.0)]
    return made


def _people(marks: Sequence[Mark]) -> bool:
    """Whether all rooms named first are bedrooms: "五间房：爷爷奶奶一间，爸爸妈妈一间"."""
    rooms = [m.value.partition("/")[0] for m in marks if m.kind in HEADS]
    return len(rooms) > 1 and set(rooms[:2]) == {"bedroom"}


def _storeys(marks: list[Mark]) -> list[Mark]:
    """Read "顶层" as the highest storey of the home, and "三层：" in a row of storeys as the third."""
    whole = next((int(m.number) for m in marks if m.kind == "amount" and m.value == "storeys" and m.number > 1), 0)
    named = [int(m.value) for m in marks if m.kind == "level" and plain(m) not in TOPS]
    top = max(whole - 1, 1, *(n + (n == max(named)) for n in named)) if named and not whole else max(whole - 1, 1)
    made = list(marks)
    for k, mark in enumerate(marks):
        if mark.kind == "level" and plain(mark) in TOPS:
            made[k] = replace(mark, value=str(min(top, 2)))
        elif mark.kind == "amount" and mark.value == "storeys" and 1 < mark.number <= 3 and plain(mark) in {"三层", "3层", "三楼", "3楼"}:
            begins = not k or marks[k - 1].kind in HARD
            goes = k + 1 < len(marks) and (
                marks[k + 1].kind in {"colon", "verb", "fill", "room", "bound", "num"} or marks[k + 1].value == "has"
            )
            if named and begins and goes and not (k + 1 < len(marks) and marks[k + 1].kind == "home"):
                made[k] = replace(mark, kind="level", value=str(int(mark.number) - 1), number=0.0)
    return made
