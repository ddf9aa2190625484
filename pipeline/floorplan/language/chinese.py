"""Chinese word order: what stands in front of a head with 的, frames around their object, counts of a home's rooms ("三室两厅")."""

from __future__ import annotations

from dataclasses import replace

from pipeline.floorplan.language.marks import Mark

SECOND = {"次卧", "次卧室", "侧卧"}  # the bedroom beside the main one
HEADS = {"room", "suite"}
CLOSERS = {"comma", "stop", "line", "join", "close"}
PLACED = {"near", "away", "apart", "wall", "open", "door", "between", "leads"}  # what is said of a room in front of it: "远离卧室的书房"
OF = "的"


def rearrange(marks: list[Mark]) -> list[Mark]:
    """Return the marks in the order of head, cue, object."""
    return _times(_possessed(_measured(_between(_counted(_verbs(_besides(marks)))))))


def _besides(marks: list[Mark]) -> list[Mark]:
    """Read "另外一个公共卫生间" as one more; "另外一间有阳台" is the other."""
    made: list[Mark] = []
    marks = _rest(marks)
    for k, mark in enumerate(marks):
        j = k + 1
        while j < len(marks) and (marks[j].kind in {"adj", "size", "shared"} or (marks[j].kind, marks[j].value) == ("det", "own")):
            j += 1
        behind = (
            (mark.kind, mark.value) == ("pron", "one")
            and bool(made)
            and made[-1].kind == "room"
            and (j >= len(marks) or marks[j].kind in CLOSERS)
        )
        if behind:  # "公共卫生间一个"
            made += [replace(mark, kind="num", value="1.0", number=1.0), replace(mark, kind="clf", first=mark.last)]
            continue
        if (mark.kind, mark.value) == ("pron", "one") and j < len(marks) and marks[j].kind in HEADS and marks[j - 1].value == "own":
            made.append(replace(mark, kind="num", value="1.0", number=1.0))  # "一个独立卫生间"
            continue
        if (mark.kind, mark.value) == ("pron", "one") and _described(marks, k + 1):
            made.append(replace(mark, kind="num", value="1.0", number=1.0))  # "一个有窗的卫生间"
            continue
        one = (mark.kind, mark.value) == ("pron", "one") and bool(made) and made[-1].kind == "det" and made[-1].text in BESIDES
        if one and j < len(marks) and marks[j].kind in HEADS:
            made[-1] = replace(made[-1], value="another")
        else:
            made.append(mark)
    return made


def _rest(marks: list[Mark]) -> list[Mark]:
    """Read "另外两间共用一个卫生间" as said of the other two."""
    made = list(marks)
    for k in range(len(made) - 3, -1, -1):
        kinds = [m.kind for m in made[k : k + 4]]
        other = (made[k].kind, made[k].value) == ("det", "other")
        said = kinds[3:] in (["cue"], ["verb"], ["flag"]) or [m.value for m in made[k + 3 : k + 4]] == ["shared"]
        if other and kinds[1:3] == ["num", "clf"] and said:
            text, last = " ".join(m.text for m in made[k : k + 3]), made[k + 2].last
            made[k : k + 3] = [
                replace(made[k], kind="pron", value="rest", text=text, last=last),
                Mark("verb", "", 0.0, False, last, last, ""),
            ]
    return made


def _described(marks: list[Mark], k: int) -> bool:
    """Whether what is said of a head stands at k, in front of 的 and the head."""
    if k + 1 < len(marks) and marks[k].text == OF and marks[k + 1].kind in HEADS:
        return True  # what stood between was furniture
    if k >= len(marks) or marks[k].kind != "cue":
        return False
    of = next((j for j in range(k, min(k + 8, len(marks))) if marks[j].text == OF), 0)
    head = of + 1
    while of and head < len(marks) and marks[head].kind in {"adj", "size"}:
        head += 1
    parted = any(m.kind in CLOSERS - {"join"} for m in marks[k:of])
    return bool(of) and head < len(marks) and marks[head].kind in HEADS and not parted


BESIDES = {"另 外", "另"}
WHOLE = {"房", "卧"}  # behind a number: all bedrooms of the home, "三房"
COPULAS = {"是", "为", "要"}
AMONG = {"里", "中", "里面", "当中", "其中", "之中"}


def _verbs(marks: list[Mark]) -> list[Mark]:
    """Read 是, 为 and 要 as verbs where no number follows, and "三间卧室里主卧最大" as a list of the three."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        ahead = marks[k + 1] if k + 1 < len(marks) else None
        if mark.kind == "bound" and mark.text in COPULAS and (ahead is None or ahead.kind != "num"):
            made.append(replace(mark, kind="verb"))
        elif mark.text in AMONG and k and ahead is not None and ahead.kind == marks[k - 1].kind == "room" and _alike(marks[k - 1], ahead):
            made.append(replace(mark, kind="colon"))
        elif mark.kind == "room" and made and (made[-1].kind, made[-1].value) == ("det", "other"):
            made.append(replace(mark, plural=True))  # "其他卧室"
        elif mark.kind == "room" and ahead is not None and (ahead.kind, ahead.value) == ("det", "all") and _several(marks, k):
            made.append(replace(mark, plural=True))  # "三间卧室 ... 卧室都在楼上"
        else:
            made.append(mark)
    return made


def _several(marks: list[Mark], k: int) -> bool:
    """Whether more rooms than one of the kind at k are counted somewhere, and none stands in front of it in a list."""
    listed = k > 0 and marks[k - 1].kind in {"join", "num", "clf", "fill"}
    rooms = [i for i, m in enumerate(marks) if m.kind == "room" and _alike(m, marks[k])]
    return not listed and any(m.kind == "num" and m.number > 1 for i in rooms for m in marks[max(0, i - 2) : i])


def _alike(a: Mark, b: Mark) -> bool:
    return a.value.partition("/")[0] == b.value.partition("/")[0]


def _counted(marks: list[Mark]) -> list[Mark]:
    """Read "三室两厅一厨两卫": bedrooms, living room (and dining room), kitchens, bathrooms. The count of bedrooms is the whole."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        counted = any(m.kind in {"num", "ord"} for m in made[-3:])
        if (mark.kind, mark.value) == ("room", "bedroom") and mark.text.replace(" ", "") in SECOND and not counted:
            made.append(Mark("ord", "2", 2.0, False, mark.first, mark.first, ""))
        made.append(mark)
        if mark.kind == "room" and mark.value == "living_room/halls":
            number = next((m for m in reversed(made[:-1][-2:]) if m.kind == "num"), None)
            made[-1] = replace(mark, value="living_room")
            if number is not None and number.number >= 2:
                place = made.index(number)
                made[place] = replace(number, number=1.0)
                made += [Mark("join", "and", 0.0, False, mark.first, mark.first, "")]
                made += [
                    replace(number, number=number.number - 1.0),
                    replace(mark, value="dining_room" if number.number == 2 else "family_room"),
                ]
                if number.number > 2:
                    made[-2] = replace(number, number=1.0)
        elif mark.kind == "room" and (mark.value == "bedroom/count" or (mark.text in WHOLE and len(made) > 1 and made[-2].kind == "num")):
            made[-1] = replace(mark, value="bedroom")
            if not (k + 1 < len(marks) and marks[k + 1].kind == "home"):
                made.append(Mark("home", "", 0.0, False, mark.first, mark.first, ""))
        elif mark.kind == "amount" and mark.value == "area" and [m.kind for m in marks[k + 1 : k + 5]] == ["num", "room"] * 2:
            made[-1:] = [Mark("home", "", 0.0, False, mark.first, mark.first, ""), mark]  # "120平三房两厅"
        elif mark.kind == "amount" and mark.value == "area" and _summed(marks, k):
            made[-1:] = [Mark("home", "", 0.0, False, mark.first, mark.first, ""), mark]
    return made


def _summed(marks: list[Mark], k: int) -> bool:
    """Whether counts of rooms run up to the amount at k: "两房一厅 80平", "两房一厅,55平。"."""
    end = k - (k > 0 and marks[k - 1].kind == "comma" and (k + 1 >= len(marks) or marks[k + 1].kind in {"comma", "stop", "line"}))
    kinds = [m.kind for m in marks[max(0, end - 4) : end]]
    return kinds[-4:] == ["num", "room", "num", "room"]


def _between(marks: list[Mark]) -> list[Mark]:
    """Read "在厨房和客厅之间" as "between kitchen and living room"."""
    made = list(marks)
    k = -1
    while (k := k + 1) < len(made):
        mark = made[k]
        if mark.kind == "cue" and mark.value == "between" and not (k and made[k - 1].kind == "relative"):
            clause = max((j for j in range(k) if made[j].kind in {"comma", "stop", "line", "colon"}), default=-1) + 1
            names = [j for j in range(max(clause, k - 6), k) if made[j].kind in HEADS]
            several = bool(names) and any(m.kind == "num" and m.number > 1 for m in made[max(0, names[-1] - 2) : names[-1]])
            if len(names) >= 2 or several:
                start = names[-1] if several else names[-2]
                while start and made[start - 1].kind in {"num", "clf", "adj", "size", "det"}:
                    start -= 1
                rest = made[k + 1 :]
                if rest and (rest[0].kind == "verb" or (rest[0].kind == "cue" and rest[0].value == "has")):
                    rest = rest[1:]
                made = [*made[:start], mark, *made[start:k], *rest]
    return made


def _times(marks: list[Mark]) -> list[Mark]:
    """Read "客厅是厨房的两倍": the factor stands in front of what it is measured by."""
    made = list(marks)
    for k, mark in enumerate(made):
        back = k - 2 if k > 1 and made[k - 1].text == OF else k - 1
        compared = any(m.kind == "cmp" for m in made[max(0, k - 4) : k])
        if mark.kind == "factor" and back >= 0 and made[back].kind in HEADS and not compared:
            while back and made[back - 1].kind in {"adj", "size", "det", "ord"}:
                back -= 1
            made.insert(back, made.pop(k))
    return made


def _measured(marks: list[Mark]) -> list[Mark]:
    """Drop 的 between an amount or an adjective and its head: "20平米的客厅"."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        before = made[-1] if made else None
        after = marks[k + 1] if k + 1 < len(marks) else None
        had = before is not None and before.value == "daylight" and any(m.value == "has" for m in made[-3:])
        if (
            mark.text == OF
            and before is not None
            and after is not None
            and not had
            and (before.kind in {"amount", "adj", "size", "bound", "flag", "look"} or (before.kind == "room" and after.kind == "home"))
        ):
            continue
        if mark.text in {"上", "里", "内"} and before is not None and before.kind in HEADS and after is not None and after.text == OF:
            continue  # "走廊上的卫生间"
        made.append(mark)
    return made


def _possessed(marks: list[Mark]) -> list[Mark]:
    """Read "主卧的卫生间" as "bathroom off the main bedroom" and "带阳台的客厅" as "living room with balcony"."""
    made = list(marks)
    k = 0
    while k < len(made):
        mark = made[k]
        attribute = k and (made[k - 1].kind in HEADS or (made[k - 1].kind, made[k - 1].value) == ("flag", "daylight"))
        if mark.text == OF and mark.kind in {"fill", "of"} and attribute:
            head = k + 1
            while head < len(made) and made[head].kind in {"num", "clf", "adj", "size", "det"}:
                head += 1
            if head < len(made) and made[head].kind in HEADS:
                has = next((j for j in range(k - 1, max(-1, k - 6), -1) if made[j].kind == "cue" and made[j].value == "has"), None)
                clause = [m for m in made[max(0, (has or 0)) : k] if m.kind in {"comma", "stop"}]
                said = _placed(made, k) if has is None else None
                if said is not None:
                    relative = Mark("relative", "", 0.0, False, mark.first, mark.first, OF)
                    made[said : head + 1] = [*made[k + 1 : head + 1], relative, *made[said:k]]
                    k = head
                    continue
                starts = has is not None and (has == 0 or made[has - 1].kind not in {"room", "suite", "pron", "home"}) and not clause
                if has is not None and starts:
                    made[has : head + 1] = [*made[k + 1 : head + 1], *made[has:k]]
                    k = head
                    continue
                cue = replace(mark, kind="cue", value="door")
                shared = [m for m in made[max(0, k - 2) : k - 1] if (m.kind, m.value) == ("adj", "shared")]  # "共用走廊上的卫生间"
                made[k - 1 - len(shared) : head + 1] = [*shared, *made[k + 1 : head + 1], cue, made[k - 1]]
                k = head
                continue
        k += 1
    return made


LEADS = CLOSERS | {"num", "clf", "det", "adj", "verb", "bound", "cue", "pron", "fill", "colon"}


def _placed(marks: list[Mark], k: int) -> int | None:
    """Return where what is said of a head begins that stands behind the 的 at k: "(远离卧室)的书房"."""
    for j in range(k - 1, max(-1, k - 6), -1):
        if marks[j].kind == "cue" and marks[j].value in PLACED:
            return j if not j or marks[j - 1].kind in LEADS else None
        if marks[j].kind not in HEADS | {"join", "num", "clf", "adj", "det"}:
            return None
    return None
