"""Whose room is whose in Chinese: "父母一间，姐弟俩一人一间", "给女儿准备一间卧室", "留一间给客人", "她的房间"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import Mark, Words
from pipeline.floorplan.language.owners import bedroom_of, nobodys
from pipeline.floorplan.language.tallies import ENDS, plain

JOINED = {"和", "与", "跟", "&", "及"}
TWO = ("俩", "双胞胎", "双胞胎儿子", "双胞胎女儿", "龙凤胎", "两姐妹", "两兄弟", "姐妹花")
APIECE = {"各", "各自", "每人", "一人", "每个人", "人手", "分别", "各有", "各住", "各要", "各睡", "每位"}
GETS = {
    "住", "睡", "用", "要", "需要", "有", "准备", "留", "安排", "设", "设置", "做", "配", "给", "分", "占", "得", "也", "都", "就", "单独", "住着", "想要", "要有", "还要",
    "应该", "希望", "预留", "布置", "弄", "留出", "人", "独住", "想", "必须", "可以", "能",
}  # fmt: skip
FOR = {"给", "归", "让", "供", "为", "由", "留给", "分给", "归属"}
LIVES = {"住", "睡", "用", "使用", "住的", "居住", "来住", "用的"}
KEPT = {"留", "预留", "留出", "腾", "准备", "安排", "要", "再", "另", "还", "外加", "其中"}
HIS = {"他", "她", "他们", "她们", "他俩", "她俩"}
PARENTS = {"爸妈", "父母", "爸爸妈妈"}  # of who speaks, where they have a bedroom of their own
ROOM = {"bedroom", "bedroom/count"}


def homed(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks with the bedrooms of people named as theirs."""
    if heard.lexicon.language != "zh" or not any(m.kind == "owner" or m.value.startswith("bedroom/") for m in marks):
        return list(marks)
    mine = any(m.kind == "room" and m.value == "bedroom/primary" and plain(m).startswith("我") for m in marks)
    named = [replace(m, value="elder") if mine and m.kind == "owner" and plain(m) in PARENTS else m for m in marks]
    return _pronoun(_living(_kept(_given(_sole(named)))))


def _one(mark: Mark) -> bool:
    return (mark.kind, mark.value) == ("pron", "one") and plain(mark) in {"一间", "一个", "一套"}


def _sole(marks: list[Mark]) -> list[Mark]:
    """Read "一个房间" as one: in Chinese the unit of a count that says no more than a room."""
    made: list[Mark] = []
    for mark in marks:
        if mark.kind == "amount" and mark.value == "rooms" and mark.number == 1.0:
            made.append(replace(mark, kind="pron", value="one", text="一 间"))
        else:
            made.append(mark)
    return made


def _group(marks: Sequence[Mark], k: int) -> int:
    """Return where people that stand in a row from k on end."""
    j = k + 1
    while j + 1 < len(marks) and marks[j].kind == "join" and plain(marks[j]) in JOINED and marks[j + 1].kind == "owner":
        j += 2
    return j


def _given(marks: list[Mark]) -> list[Mark]:
    """Read "父母一间", "姐弟俩一人一间", "给儿子和女儿各准备一间卧室"."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        mark = marks[k]
        if mark.kind != "owner":
            made.append(mark)
            k += 1
            continue
        end = j = _group(marks, k)
        said = ""
        while (
            j < len(marks)
            and j - end < 6
            and (
                plain(marks[j]) in GETS | APIECE
                or (marks[j].kind == "num" and plain(marks[j + 1 : j + 2][0] if marks[j + 1 : j + 2] else marks[j]) == "人")
            )
        ):
            said += plain(marks[j])
            j += 1
        each = any(word in said for word in APIECE)
        number = (
            marks[j]
            if j < len(marks) and (_one(marks[j]) or (marks[j].kind == "num" and marks[j + 1 : j + 2] and marks[j + 1].kind == "clf"))
            else None
        )
        if number is None:
            made += marks[k:end]
            k = end
            continue
        after = j + 1 + (number.kind == "num")
        of = next((i for i in range(after, min(after + 7, len(marks))) if marks[i].text == "的"), 0)
        described = bool(of) and of > after and marks[after].kind == "cue" and not any(m.kind in ENDS - {"join"} for m in marks[after:of])
        room = of + 1 if described else after
        while room < len(marks) and marks[room].kind in {"adj", "size", "amount", "look"} and not described:
            room += 1
        named = room < len(marks) and nobodys(marks[room], "count")
        bare = plain(number) != "一个" and (room >= len(marks) or marks[room].kind in ENDS or plain(marks[room]) in {"的", "吧"})
        if not (named or (bare and not described)):
            made += marks[k:end]
            k = end
            continue
        owners = [m for m in marks[k:end] if m.kind == "owner"]
        lead = _lead(made)
        count = number.number if number.kind == "num" else 1.0
        people: dict[str, float] = {}
        for owner in owners if each else owners[:1]:
            two = plain(owner).endswith(TWO) or plain(owner).startswith(TWO)
            people[owner.value] = people.get(owner.value, 0.0) + (lead or (2.0 if two else 1.0))
        for i, (role, heads) in enumerate(people.items()):
            owner = next(m for m in owners if m.value == role)
            made += [Mark("join", "and", 0.0, False, owner.first, owner.first, "&")] if i else []
            told = {plain(m) for m in made if m.value == f"bedroom/{role}"}
            made += [Mark("det", "another", 0.0, False, owner.first, owner.first, "")] if told and plain(owner) not in told else []
            made.append(Mark("num", "", heads * count if each else count, False, owner.first, owner.first, ""))
            made += [*marks[after : room if named else after]] if i == 0 and (described or named) else []
            made.append(bedroom_of(owner, owner.value))
        k = room + 1 if named else room
    return made


def _lead(made: list[Mark]) -> float:
    """Take off the number in front of people, and the "for" in front of it; return it, 0 where none is said."""
    lead = 0.0
    if made and made[-1].kind == "clf" and len(made) > 1 and made[-2].kind == "num":
        lead = made[-2].number
        del made[-2:]
    elif made and made[-1].kind == "num":
        lead = made.pop().number
    if made and plain(made[-1]) in FOR | {"位", "个"}:
        made.pop()
    return lead


def _kept(marks: list[Mark]) -> list[Mark]:
    """Read "留一间给客人(住)", "次卧给孩子", "两间归孩子用" as rooms of theirs."""
    made = list(marks)
    for k in range(len(made) - 1, 0, -1):
        if made[k].kind != "owner" or plain(made[k - 1]) not in FOR:
            continue
        end = k + 1
        while end < len(made) and plain(made[end]) in LIVES:
            end += 1
        if end < len(made) and made[end].kind not in ENDS:
            continue
        j = k - 2
        while j >= 0 and (plain(made[j]) in KEPT | LIVES or made[j].kind in {"adverb", "verb"}):
            j -= 1
        if j < 0:
            continue
        counted = made[j].kind == "clf" and j > 0 and made[j - 1].kind == "num"
        if _one(made[j]) or (made[j].kind, made[j].value) == ("det", "another"):
            made[j:end] = [replace(made[j], kind="num", value="", number=1.0), bedroom_of(made[k], made[k].value)]
        elif counted:
            made[j:end] = [made[j], bedroom_of(made[k], made[k].value)]
        elif made[j].kind == "room" and made[j].value == "bedroom":
            made[j:end] = [replace(made[j], value=f"bedroom/{made[k].value}")]
    return made


def _living(marks: list[Mark]) -> list[Mark]:
    """Read "老人住一楼的卧室" as their room; of "孩子睡儿童房" and "主卧我们俩住" the room says enough."""
    made = list(marks)
    for k, mark in enumerate(marks):
        if mark.kind != "owner" or k + 1 >= len(marks) or plain(marks[k + 1]) not in LIVES:
            continue
        j = k + 2
        while j < len(marks) and j - k < 7 and (marks[j].kind in {"level", "det", "size", "adj", "ord"} or plain(marks[j]) in {"的", "在"}):
            j += 1
        if j < len(marks) and marks[j].kind == "room" and marks[j].value.startswith("bedroom"):
            plainly = marks[j].value in ROOM
            made[j] = replace(marks[j], value=f"bedroom/{mark.value}") if plainly else marks[j]
            made[k] = replace(mark, kind="fill", value="")
        elif k and marks[k - 1].kind == "room" and marks[k - 1].value.startswith("bedroom") and (j >= len(marks) or marks[j].kind in ENDS):
            made[k] = replace(mark, kind="fill", value="")
    return made


def _pronoun(marks: list[Mark]) -> list[Mark]:
    """Read "她的房间" as the bedroom of who was spoken of last."""
    made = list(marks)
    role = ""
    k = 0
    while k < len(made):
        mark = made[k]
        if mark.kind == "owner":
            role = mark.value
        elif mark.kind == "room" and mark.value.startswith("bedroom/"):
            role = mark.value.partition("/")[2]
        of = k + 1 < len(made) and plain(made[k + 1]) == "的"
        if plain(mark) in HIS and role and k + 1 + of < len(made) and nobodys(made[k + 1 + of], "count"):
            made[k : k + 2 + of] = [replace(made[k + 1 + of], kind="room", value=f"bedroom/{role}", number=0.0, first=mark.first)]
        k += 1
    return made
