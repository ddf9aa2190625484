"""What is left unsaid between words: "one for the parents and another for the boy", "..., not with the living room", "from the hall starts a corridor"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.gapping import regained
from pipeline.floorplan.language.marks import ENDS, Mark, Words

CLOSERS = {"stop", "line", "comma", "join", "close", "but"}
ONES = {"uno", "una", "otro", "otra", "one", "another", "otro mas", "otra mas"}
FOR = {"para", "de", "del", "for"}
LIGHT = {"det", "fill", "adverb"}
TOWARDS = {"a", "al", "con", "hacia", "to", "with", "from", "por", "en", "onto", "into"}
ROLES = {"guest", "child", "primary"}
LEAVING = {"sale", "salen", "parte", "parten", "arranca", "arrancan", "nace", "nacen", "cuelga", "cuelgan", "surge"}
WAYS = {"door", "leads", "open", "near"}
SIDES = {"al otro", "al otro lado"}


def unsaid(marks: Sequence[Mark], heard: Words) -> list[Mark]:
    """Return the marks with what is understood put in."""
    made = [
        replace(m, kind="verb", value="")
        if m.value == "ensuite" and m.text == "es de" and marks[k + 1 : k + 2] and marks[k + 1].kind == "amount"
        else m
        for k, m in enumerate(marks)
    ]
    made = _denied_again(_persons(_floors(made)))
    if heard.lexicon.language == "es":
        made = _premises(_corridor(_leaving(_of_which(_phrases(made)))))
    return regained(_heads(made), heard)


def _floors(marks: list[Mark]) -> list[Mark]:
    """Read "planta 1", "1ª planta:", "planta baja y 2ª" as storeys."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        trio = marks[k : k + 3]
        texts = [m.text for m in trio]
        figure = next((m for m in trio if m.kind == "num" and m.value == "figure" and m.number in {0.0, 1.0, 2.0}), None)
        step = 0
        if figure is not None and texts[:1] == ["planta"] and trio[1:2] == [figure]:
            step = 3 if texts[2:] in (["a"], ["o"]) else 2
        elif (
            figure is not None and trio[:1] == [figure] and texts[1:] in (["a", "planta"], ["a", "altura"], ["o", "piso"], ["a", "planta:"])
        ):
            step = 3
        ahead = marks[k + step].kind if k + step < len(marks) else "stop"
        if step and figure is not None and ahead not in {"unit", "amount"}:
            made.append(Mark("level", str(int(figure.number)), first=marks[k].first, last=marks[k + step - 1].last, text=texts[0]))
            k += step
        else:
            made.append(marks[k])
            k += 1
    return made


def _said_of(marks: Sequence[Mark], k: int) -> tuple[str, float, int] | None:
    """Return (role, number, end) of "for the parents", "for each of the three boys", "de matrimonio" at k."""
    if k < len(marks) and marks[k].kind == "adj" and marks[k].value in ROLES:
        return marks[k].value, 1.0, k + 1
    if k >= len(marks) or marks[k].text not in FOR:
        return None
    number, each, j = 1.0, False, k + 1
    while j < len(marks) and (marks[j].kind in LIGHT | {"num", "pron"}):
        each = each or marks[j].value == "each"
        number = marks[j].number if marks[j].kind == "num" and marks[j].number > 1 else number
        j += 1
    if j < len(marks) and (marks[j].kind == "owner" or (marks[j].kind == "adj" and marks[j].value in ROLES)):
        return marks[j].value, number if each else 1.0, j + 1
    return None


def _persons(marks: list[Mark]) -> list[Mark]:
    """Read "two bedrooms, one for the parents and another for the boy", "a room for us, another for each of the three boys and one more for guests"."""
    made: list[Mark] = []
    counted = False  # whether rooms were counted that "one" and "another" are of
    k = 0
    while k < len(marks):
        mark = marks[k]
        if mark.kind in {"room", *ENDS}:
            counted = mark.plural and mark.kind == "room"
        more = mark.text in ONES and k + 1 < len(marks) and marks[k + 1].text in {"mas", "more"}
        said = _said_of(marks, k + 1 + more) if mark.text in ONES and mark.kind in {"det", "fill", "pron", "num", "join"} else None
        room = next((m for m in reversed(made) if m.kind in {"room", *ENDS}), None) if said is not None else None
        before = made[-1].kind if made else "stop"
        bed = room is not None and room.value.partition("/")[0] == "bedroom"
        if said is None or room is None or not bed or before not in {"comma", "join", "open", "colon", "stop"}:
            made.append(mark)
            k += 1
            continue
        role, number, end = said
        if number > 1:
            made.append(Mark("num", "", number, False, mark.first, mark.last, mark.text))
        else:
            made.append(Mark("det", "definite" if counted and not more else "indefinite", 0.0, False, mark.first, mark.last, mark.text))
        made.append(replace(room, value=f"bedroom/{role}", plural=number > 1, first=mark.last, last=marks[end - 1].last, number=0.0))
        k = end
    return made


def _denied_again(marks: list[Mark]) -> list[Mark]:
    """Read "the kitchen is open to the dining room, not to the living room": the way before it is what is denied."""
    made = list(marks)
    way: Mark | None = None
    for k, mark in enumerate(marks):
        if mark.kind in ENDS:
            way = None
        elif mark.kind == "cue" and mark.value in WAYS:
            way = mark
        if mark.kind != "neg" or way is None or not k or marks[k - 1].kind not in {"comma", "but", "join"}:
            continue
        j = k + 1
        while j < len(marks) and marks[j].kind == "adverb":
            j += 1
        room = next((i for i in range(j + 1, min(j + 4, len(marks))) if marks[i].kind == "room"), None)
        light = room is not None and all(m.kind in {"det", "adj"} for m in marks[j + 1 : room])
        ends = room is not None and (room + 1 >= len(marks) or marks[room + 1].kind in CLOSERS)
        if light and ends and marks[j].text in TOWARDS:
            made[j] = replace(way, first=marks[j].first, last=marks[j].last, only=False)
    return made


def _of_which(marks: list[Mark]) -> list[Mark]:
    """Read "cinco habitaciones, de las que dos tienen baño" as two of them; "mitad de ellas" stays."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        trio = marks[k : k + 3]
        if (
            len(trio) == 3
            and trio[0].value == "partitive"
            and trio[1].text == "que"
            and (trio[2].kind == "num" or trio[2].text in {"uno", "una"})
        ):
            number = trio[2].number or 1.0
            made.append(Mark("pron", "one", number, False, trio[0].first, trio[2].last, "de las que"))
            k += 3
        else:
            made.append(marks[k])
            k += 1
    return made


def _phrases(marks: list[Mark]) -> list[Mark]:  # noqa: PLR0912 - one branch per turn of speech
    """Read "uno dentro del dormitorio" as one of them, "el nuestro" as our bedroom, "también" in front of a verb as nothing, a door that parts two rooms as a way."""
    made: list[Mark] = []
    for k, mark in enumerate(marks):
        ahead = marks[k + 1] if k + 1 < len(marks) else Mark("stop")
        if mark.text in {"uno", "una"} and mark.kind == "fill" and ahead.kind in {"cue", "verb", "level"}:
            made.append(replace(mark, kind="det", value="indefinite"))
        elif mark.text in OURS and made and made[-1].kind in {"det", "pron"} and ahead.kind not in {"room", "adj", "size"}:
            made.append(replace(mark, kind="room", value="bedroom/primary"))
        elif mark.kind == "join" and mark.text == "ni" and ahead.kind == "cue":
            made.append(replace(mark, kind="neg", value=""))
        elif mark.kind == "join" and mark.text == "tambien" and ahead.kind in ENDS | {"comma"} and made and made[-1].kind == "room":
            made.append(replace(mark, kind="flag", value="too"))
        elif mark.kind == "join" and mark.value == "and" and ahead.kind == "relative" and ahead.text == "que":
            made.append(replace(mark, kind="but", value=""))  # "..., y que la cocina ...": a new statement
        elif (
            mark.text in {"de", "del"}
            and ahead.value in {"hallway", "entry", "definite"}
            and made
            and made[-1].value in {"bathroom", "wc"}
            and _hall(marks, k)
        ):
            if made[-1].value == "bathroom" and not made[-1].plural:
                made[-1] = replace(made[-1], value="bathroom/shared")
            made.append(replace(mark, kind="cue", value="door", text="en el"))
        elif (
            mark.kind == "join"
            and mark.text in {"tambien", "ademas"}
            and ahead.kind in {"cue", "verb"}
            and made
            and made[-1].kind in {"room", "post", "adj"}
        ):
            continue
        elif ahead.kind == "cue" and ahead.value == "by" and mark.kind == "home" and _to_home(made):
            while made[-1].kind != "cue":
                made.pop()
            made.pop()  # "communicates with the house by way of": the way is what follows
        elif mark.value == "by" and len(made) > 0 and k and marks[k - 1].kind == "home":
            made.append(replace(mark, value="door"))
        else:
            made.append(mark)
    return _parted(made)


OURS = {"nuestro", "nuestra", "mio", "mia"}
PARTED = {"separan", "separa", "separados", "separadas", "separado", "separada", "dividen", "divididos"}


def _hall(marks: Sequence[Mark], k: int) -> bool:
    """Whether a hall follows "el baño del" at k."""
    j = k + 1 + (k + 1 < len(marks) and marks[k + 1].kind == "det")
    return j < len(marks) and marks[j].value == "hallway"


def _to_home(made: Sequence[Mark]) -> bool:
    j = len(made) - 1
    while j >= 0 and made[j].kind == "det":
        j -= 1
    return j >= 0 and made[j].kind == "cue" and made[j].value in WAYS


def _parted(marks: list[Mark]) -> list[Mark]:
    """Read "salón y comedor se separan con una puerta corredera" as joined by a door, "..., and the other room at the other" as beside the same room."""
    made = list(marks)
    for k, mark in enumerate(marks):
        end = next((i for i in range(k + 1, min(k + 5, len(marks))) if (marks[i].kind, marks[i].value) == ("flag", "doors")), None)
        if mark.text in PARTED and mark.kind in {"word", "adj", "post", "verb"} and end is not None:
            return _parted([*made[:k], Mark("cue", "door", 0.0, False, mark.first, marks[end].last, "comunicados"), *made[end + 1 :]])
        one = next((i for i in range(k) if marks[i].text.startswith(("a un lado de", "a uno de los lados"))), None)
        other = mark.text in SIDES or (mark.text == "otro" and k > 0 and marks[k - 1].text == "al")
        if (
            other
            and one is not None
            and not any(m.kind in ENDS for m in marks[one:k])
            and (k + 1 >= len(marks) or marks[k + 1].kind in CLOSERS)
        ):
            room = next((m for m in marks[one:k] if m.kind == "room"), None)
            if room is not None:
                start = k - (mark.text == "otro")
                cue = replace(marks[one], first=marks[start].first, last=mark.last)
                place = replace(room, first=mark.last, last=mark.last)
                return [*made[:start], cue, Mark("det", "definite", 0.0, False, mark.last, mark.last, "el"), place, *made[k + 1 :]]
    return made


def _leaving(marks: list[Mark]) -> list[Mark]:
    """Read "del salón parte un pasillo": from the living room one comes to a corridor."""
    made = list(marks)
    for k, mark in enumerate(marks):
        of_which = k + 3 < len(marks) and mark.text in {"del", "de la", "desde el", "desde la"} and marks[k + 1].text == "que"
        if of_which and set(marks[k + 2].text.split()) & LEAVING:  # "un salón del que cuelgan la cocina y el baño"
            made[k] = replace(mark, kind="fill", value="")
            made[k + 2] = replace(marks[k + 2], kind="cue", value="leads", text="da a")
            continue
        begins = k == 0 or marks[k - 1].kind in {"stop", "line", "comma", "join", "colon"}
        start = k + 1 + (mark.text == "de" and k + 1 < len(marks) and marks[k + 1].kind == "det")
        if not begins or mark.text not in {"de", "del"} or start + 1 >= len(marks) or marks[start].kind != "room":
            continue
        verb = marks[start + 1]
        if set(verb.text.split()) & LEAVING:
            made[k] = replace(mark, kind="cue", value="from", text="desde")
            made[start + 1] = replace(verb, kind="fill", value="")
    return made


def _corridor(marks: list[Mark]) -> list[Mark]:
    """Read "el pasillo de los dormitorios" as the corridor that leads to them."""
    made = list(marks)
    for k in range(1, len(marks) - 2):
        of = marks[k].value == "partitive" or (marks[k].text == "de" and marks[k + 1].kind in {"det", "room"})
        room = k + 1 + (marks[k + 1].kind == "det")
        if of and marks[k - 1].value == "hallway" and room < len(marks) and marks[room].value.startswith("bedroom") and marks[room].plural:
            made[k] = replace(marks[k], kind="cue", value="leads", text="que lleva a")
    return made


def _premises(marks: list[Mark]) -> list[Mark]:
    """Read "Oficina de 120 m²: dos salas de reuniones, cuatro despachos" as premises, not as one more office."""
    made = list(marks)
    work = sum(m.kind == "room" and m.value in {"office", "meeting_room"} for m in marks) > 1
    if (
        work
        and marks[0].text in {"oficina", "oficinas"}
        and marks[0].kind == "room"
        and len(marks) > 1
        and marks[1].kind in {"amount", "colon", "cue"}
    ):
        made[0] = replace(marks[0], kind="home", value="")
    return made


def _heads(marks: list[Mark]) -> list[Mark]:
    """Read "los dormitorios de los padres y de los niños" as one of each."""
    made = list(marks)
    for k in range(len(marks) - 2, 0, -1):
        head = marks[k]
        if (
            head.kind != "room"
            or not head.plural
            or not head.value.startswith("bedroom/")
            or marks[k + 1].kind != "join"
            or (k and marks[k - 1].kind == "num")
        ):
            continue
        said = _said_of(marks, k + 2)
        if said is not None and marks[k + 2].kind in {"fill", "adj", "bound", "det", "word"}:
            role, _, end = said
            made[k : k + 2] = [replace(head, plural=False), marks[k + 1]]
            made[k + 2 : end] = [replace(head, value=f"bedroom/{role}", plural=False, first=marks[k + 2].first, last=marks[end - 1].last)]
    return made
