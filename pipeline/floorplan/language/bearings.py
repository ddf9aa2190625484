"""Ways that Chinese says by sides, doors and going: "走廊左边是厨房，右边是卧室", "卫生间的门朝走廊", "从走廊进出", "彼此相连"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import Mark, Words
from pipeline.floorplan.language.tallies import plain

HEADS = {"room", "suite"}
ENDS = {"comma", "stop", "line", "close", "but"}
PHRASE = {"num", "clf", "adj", "size", "det", "ord"}
HALLS = {"hallway", "entry"}
FACING = {"朝", "朝向", "朝着", "向", "开向", "面向", "对", "对着", "正对", "正对着", "通向", "通往", "通", "开在", "在", "开到", "冲着", "直通", "连着", "通到", "开往", "设在", "位于"}  # fmt: skip
BETWEEN = {"adverb", "det", "verb"}
VIA = {"从", "由", "经", "经过", "通过", "穿过", "经由", "自"}
GOING = {"进", "进入", "到达", "进出", "出入", "可达", "进去", "到", "走", "过去", "抵达", "可到", "可以到达", "能进入", "可以进入", "可进入", "进到", "走到", "去", "进得去", "出去", "通行", "到得了", "达到", "入"}  # fmt: skip
MODAL = ("可以直接", "可以", "直接", "可", "能够", "能", "才能", "才")
MUTUAL = {
    "相连": "door", "相通": "door", "连通": "door", "连接": "door", "相接": "door", "互通": "door", "贯通": "open", "连在一起": "door", "直接相连": "door",
    "相邻": "near", "挨着": "near", "紧挨着": "near", "挨在一起": "near", "紧邻": "near", "毗邻": "near", "靠在一起": "near", "挨": "near", "紧挨": "near",
}  # fmt: skip
TOGETHER = {"和", "与", "跟", "同", "及", "以及", "&"}
PARTED = {"无", "没有", "不设", "不要", "不做", "不砌", "取消", "不用", "没", "去掉", "省去"}


def located(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks of a Chinese prompt with ways put plainly: room, cue, room."""
    if heard.lexicon.language != "zh":
        return [replace(m, kind="verb") if (m.kind, m.value) == ("cue", "side") else m for m in marks]
    return _mutual(_entered(_added(_parted(_unwalled(_doors(_sided(_owned(_joining(_listed(_between(list(marks))))))))))))


def _added(marks: list[Mark]) -> list[Mark]:
    """Read "除了客厅之外，还有一间客房" as both; without a "besides" 除了 leaves out."""
    made = list(marks)
    for k, mark in enumerate(made):
        if (mark.kind, mark.value) != ("cue", "except"):
            continue
        comma = next((j for j in range(k + 1, len(made)) if made[j].kind in {"comma", "stop"}), None)
        if comma is None or made[comma].kind == "stop":
            continue
        near = [m for m in made[comma + 1 : comma + 4] if m.kind not in HEADS]
        if any(plain(m).startswith(("还", "另", "再")) or (m.kind, m.value) == ("det", "another") for m in near):
            made[k] = replace(mark, kind="fill", value="")
    return made


def _parted(marks: list[Mark]) -> list[Mark]:
    """Read "餐厅和客厅用一扇双开门隔开" as a door between the two."""
    made = list(marks)
    for k in range(len(made) - 1, 0, -1):
        if plain(made[k]) not in {"隔开", "分隔", "分开", "隔断", "相隔", "隔"}:
            continue
        start = max((i for i in range(k) if made[i].kind in ENDS), default=-1) + 1
        door = any(m.kind == "flag" and m.value == "doors" for m in made[start:k])
        rooms = [i for i in range(start, k) if made[i].kind in HEADS]
        if door and len(rooms) == 2 and not any(m.kind == "neg" for m in made[start:k]):
            tail = made[k + 1 :]
            made = [*made[: rooms[0] + 1], replace(made[k], kind="cue", value="door"), made[rooms[1]], *tail]
            return _parted(made)
    return made


def _between(marks: list[Mark]) -> list[Mark]:
    """Read "两个卧室之间的过道" as "a hall between two bedrooms"."""
    made = list(marks)
    for k in range(2, len(made) - 1):
        joined = plain(made[k]) in {"之间的", "中间的"}
        parted = plain(made[k]) in {"之间", "中间"} and plain(made[k + 1]) == "的"
        head = k + 1 + parted
        while head < len(made) and made[head].kind in PHRASE:
            head += 1
        if not (joined or parted) or head >= len(made) or made[head].kind not in HEADS or made[k - 1].kind not in HEADS:
            continue
        start = k - 1
        while start and (made[start - 1].kind in PHRASE or (made[start - 1].kind == "join" and plain(made[start - 1]) in TOGETHER)):
            start -= 1 + (made[start - 1].kind == "join")
        relative = Mark("relative", "", 0.0, False, made[k].first, made[k].first, "的")
        cue = replace(made[k], kind="cue", value="between")
        made[start : head + 1] = [*made[k + 1 + parted : head + 1], relative, cue, *made[start:k]]
    return made


def _owned(marks: list[Mark]) -> list[Mark]:
    """Read "其中一个归主卧专用" as the bathroom of the main bedroom."""
    made = list(marks)
    for k in range(len(made) - 2, 0, -1):
        lead = (
            plain(made[k]) in {"归", "供", "给", "留给", "由", "为", "是"}
            and made[k + 1].kind == "room"
            and made[k + 1].value.startswith("bedroom")
        )
        end = k + 2
        while end < len(made) and (
            plain(made[end]) in {"专用", "使用", "用", "独用", "独享", "所有", "自用", "的", "单独", "专属", "独立"}
        ):
            end += 1
        if lead and end > k + 2 and (end >= len(made) or made[end].kind in ENDS):
            made[k:end] = [replace(made[k], kind="cue", value="ensuite"), made[k + 1]]
    return made


def _topic(marks: Sequence[Mark], k: int) -> Mark | None:
    """Return the room that the clause in front of the comma at k - 1 begins with."""
    start = max((i for i in range(k - 1) if marks[i].kind in ENDS), default=-1) + 1
    return next((m for m in marks[start : k - 1] if m.kind in HEADS), None)


def _joining(marks: list[Mark]) -> list[Mark]:
    """Read "走廊连着三间卧室和卫生间" as leading to all of them."""
    spoken = [_topic(marks, k) if k and marks[k - 1].kind == "comma" else marks[k - 1] if k else None for k in range(len(marks))]
    hall = [m is not None and m.kind == "room" and _kind(m) in HALLS for m in spoken]
    return [
        replace(m, value="leads") if h and (m.kind, m.value) == ("cue", "door") and plain(m).startswith(("连", "接", "衔")) else m
        for m, h in zip(marks, hall, strict=True)
    ]


def _listed(marks: list[Mark]) -> list[Mark]:
    """Read "书房、客厅连阳台、厨房" as a living room with balcony in a list; put an "and" between "三个卧室两个卫生间"."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        after = next((j for j in range(k + 1, min(k + 5, len(marks))) if marks[j].kind in HEADS), 0)
        before = (
            k - 2
            if k > 1 and marks[k - 2].kind not in PHRASE
            else next((j for j in range(k - 2, -1, -1) if marks[j].kind not in PHRASE), -1)
        )
        inner = before >= 0 and (plain(marks[before]) == "&" or marks[before].kind == "comma") and marks[k - 1].kind in HEADS
        listed = after and after + 1 < len(marks) and plain(marks[after + 1]) == "&" and plain(marks[before]) == "&"
        if plain(mark) in {"连", "连着"} and mark.kind == "cue" and inner and listed:
            made.append(replace(mark, value="has"))
            continue
        counted = mark.kind == "num" and k + 2 < len(marks) and marks[k + 1].kind == "clf" and marks[k + 2].kind in HEADS
        run = len(made) > 2 and made[-1].kind in HEADS and any(m.kind == "clf" for m in made[-3:-1])
        if counted and run:
            made.append(Mark("join", "and", 0.0, False, mark.first, mark.first, "&"))
        made.append(mark)
    return made


def _back(marks: Sequence[Mark], k: int) -> int | None:
    """Return the place of the room that ends in front of k, a 的 between."""
    k -= 1
    if k >= 0 and plain(marks[k]) == "的":
        k -= 1
    return k if k >= 0 and marks[k].kind in HEADS else None


def _kind(room: Mark) -> str:
    return room.value.partition("/")[0]


def _sided(marks: list[Mark]) -> list[Mark]:
    """Read "走廊左边是厨房，右边是卧室": both hang on the hall; beside any other room they lie near it."""
    made: list[Mark] = []
    topic: Mark | None = None
    spoken = False  # a room whose sides are told in this sentence
    for k, mark in enumerate(marks):
        spoken = spoken and mark.kind not in {"stop", "line"}
        if (mark.kind, mark.value) != ("cue", "side"):
            topic = mark if mark.kind == "room" and _kind(mark) in HALLS else topic
            made.append(mark)
            continue
        if k + 1 >= len(marks) or not any(m.kind in HEADS for m in marks[k + 1 : k + 6]):
            made.append(replace(mark, kind="fill", value=""))
            continue
        place = _back(made, len(made))
        if place is not None and len(made) - place == 2:
            made.pop()
        if place is not None:
            topic, spoken = made[place], True
        elif made and made[-1].kind == "enter":
            made[-1] = replace(made[-1], kind="fill", value="")
            made.append(replace(mark, kind="verb", value=""))
            continue
        hall = topic is not None and _kind(topic) in HALLS
        wing = plain(mark)[0] in "一另" and place is None and not hall and not spoken
        if wing:
            made.append(replace(mark, kind="wing", value="other" if plain(mark)[0] == "另" else "one"))
        elif topic is None:
            made.append(replace(mark, kind="verb", value=""))
        else:
            if place is None:
                made.append(replace(topic, first=mark.first, last=mark.first, number=0.0))
            made.append(replace(mark, value="leads" if hall or _leading(mark) else "near"))
    return made


def _leading(mark: Mark) -> bool:
    return plain(mark).endswith(("通", "向", "往", "连着", "连接", "接", "连"))


def _doors(marks: list[Mark]) -> list[Mark]:
    """Read "卫生间(的)门都朝走廊(开)" as a door between the two."""
    made = list(marks)
    k = 0
    while k < len(made):
        door = made[k].kind == "flag" and made[k].value == "doors" and plain(made[k]) in {"门", "房门", "的门"}
        topic = _topic(made, k) if door and k and made[k - 1].kind == "comma" and plain(made[k]) == "门" else None
        if topic is not None and k + 1 < len(made) and plain(made[k + 1]) in FACING:  # "厨房要有门，门朝餐厅"
            made.insert(k, replace(topic, first=made[k].first, last=made[k].first, number=0.0))
            k += 1
        place = _back(made, k) if door else None
        j = k + 1
        while place is not None and j < len(made) and j - k < 4 and made[j].kind in BETWEEN and plain(made[j]) not in FACING:
            j += 1
        if place is None or j + 1 >= len(made) or plain(made[j]) not in FACING:
            k += 1
            continue
        end = j + 1
        while end < len(made) and made[end].kind in PHRASE | {"join"} | HEADS:
            end += 1
        head = next((i for i in range(j + 1, end) if made[i].kind in HEADS), None)
        if head is None:
            k += 1
            continue
        opens = 1 if end < len(made) and plain(made[end]) in {"开", "方向", "打开", "那边", "一侧", "里", "上"} else 0
        inner = [m for m in made[k + 1 : j] if m.kind == "det"]
        made[place + 1 : end + opens] = [*inner, replace(made[j], kind="cue", value="door"), *made[j + 1 : end]]
        k = place + 1
    return made


def _unwalled(marks: list[Mark]) -> list[Mark]:
    """Read "与餐厅(之间)无隔断" as open to it, of the room that is spoken of."""
    made = list(marks)
    for k in range(1, len(made) - 3):
        lead = plain(made[k]) in TOGETHER - {"&"} and made[k - 1].kind in {"comma", "verb", "adverb"}
        if not lead or made[k + 1].kind not in HEADS:
            continue
        j = k + 2
        while j < len(made) and ((made[j].kind, made[j].value) == ("cue", "between") or plain(made[j]) in {"之间", "中间", "间"}):
            j += 1
        if j + 1 < len(made) and (made[j].kind == "neg" or plain(made[j]) in PARTED):
            end = j + 1
            while end < len(made) and (made[end].kind in {"word", "det", "adj", "verb"}):
                end += 1
            if end < len(made) and (made[end].kind, made[end].value) == ("flag", "partition"):
                made[k : end + 1] = [replace(made[k], kind="cue", value="open", last=made[k].last), made[k + 1]]
                return _unwalled(made)
    return made


def _entered(marks: list[Mark]) -> list[Mark]:
    """Read "所有卧室都从走廊进出", "只有经过走廊才能到达" and "浴室得穿过衣帽间才能到" as doors to what was named first."""
    made = list(marks)
    k = 0
    while k < len(made):
        width = next((n for n in (2, 1) if k + n <= len(made) and "".join(plain(m) for m in made[k : k + n]) in VIA), 0)
        if not width or (width == 2 and made[k].kind == "cue"):
            k += 1
            continue
        j = k + width
        rooms = 0
        while j < len(made) and made[j].kind in PHRASE | HEADS | {"join"}:
            rooms += made[j].kind in HEADS
            j += 1
        tail = j
        while (
            tail < len(made)
            and plain(made[tail]) not in GOING
            and (made[tail].kind in {"adverb", "verb", "flag"} or plain(made[tail]) in {"里", "内", "才", "那边", "处"})
        ):
            tail += 1
        goes = rooms > 0 and tail < len(made) and _goes(made[tail]) and (tail + 1 >= len(made) or made[tail + 1].kind in ENDS)
        if not goes or not _spoken(made, k):
            k += 1
            continue
        must = {"得", "要", "必须", "需要", "需"} if any(w in plain(made[k]) for w in ("穿", "经过")) else {"必须"}
        only = any(plain(m) in {"只", "只能", "仅", "只有", "仅能"} | must for m in made[max(0, k - 2) : k])
        cue = replace(made[k], kind="cue", value="door", last=made[k + width - 1].last, only=only or made[k].only, text="从")
        made[k : tail + 1] = [cue, *made[k + width : j]]
        k += 1
    return made


def _goes(mark: Mark) -> bool:
    """Whether a mark is a verb of going, "can" in front of it or not."""
    word = plain(mark)
    return word in GOING or any(word.startswith(m) and word.removeprefix(m) in GOING for m in MODAL)


def _spoken(marks: Sequence[Mark], k: int) -> bool:
    """Whether a room stands in front in the sentence, of which no negation turns the way."""
    start = max((i for i in range(k) if marks[i].kind in {"stop", "line"}), default=-1) + 1
    near = max((i for i in range(k) if marks[i].kind in {"stop", "line", "comma"}), default=-1) + 1
    if any(m.kind == "neg" for m in marks[near:k]):
        return False
    return any(m.kind in HEADS or m.kind in {"every", "pron"} for m in marks[start:k])


def _mutual(marks: list[Mark]) -> list[Mark]:
    """Read "客厅、厨房和餐厅彼此相连" as joined one to the next."""
    made = list(marks)
    for k, mark in enumerate(made):
        value = MUTUAL.get(plain(mark))
        if value is None or (k + 1 < len(made) and made[k + 1].kind not in ENDS):
            continue
        j, told = k - 1, False
        while j >= 0 and (
            made[j].kind in {"reciprocal", "adverb", "verb", "det"}
            or plain(made[j]) in {"之间", "直接", "间"}
            or (made[j].kind, made[j].value) == ("cue", "between")
        ):
            told = told or made[j].kind == "reciprocal"
            j -= 1
        end, count, joins = j + 1, 0, []
        while j >= 0 and made[j].kind in HEADS | PHRASE | {"join"} and (made[j].kind != "join" or plain(made[j]) in TOGETHER):
            count += made[j].kind in HEADS
            joins += [j] if made[j].kind == "join" else []
            j -= 1
        if count < 2 or not joins or any(m.kind == "neg" for m in made[max(0, j) : k]):
            continue
        if count > 2 or told or all(plain(made[i]) == "&" for i in joins):
            for i in joins:
                made[i] = replace(made[i], text="&")
            said = Mark("reciprocal", "", 0.0, False, mark.last, mark.last, "彼此")
            made[end : k + 1] = [*[m for m in made[end:k] if m.kind == "det"], replace(mark, kind="cue", value=value), said]
            return _mutual(made)
    return made
