"""Bedrooms named by whose they are: "the nanny, whose room ...", "a room for the baby", "la de los niños", "das Zimmer der Großmutter", "奶奶的房间"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pipeline.floorplan.language.marks import Mark

FOR = {"para", "for", "fuer", "de", "del", "von"}
OF = FOR | {"der", "des"}
POSSESSIVE = {
    "el", "mi", "mis", "su", "sus", "my", "our", "his", "her", "their", "nuestro", "nuestra", "nuestros", "mein", "meine", "unser", "unsere",
}  # fmt: skip
WHOSE = {"whose", "cuya", "cuyo", "cuyas", "cuyos", "dessen", "deren"}


def bedroom_of(mark: Mark, role: str) -> Mark:
    """Return a mark as the bedroom of people of a role."""
    return replace(mark, kind="room", value=f"bedroom/{role}", number=0.0)


def nobodys(mark: Mark, role: str = "") -> bool:
    """Whether a mark names just a room, or a bedroom that people of a role may have."""
    return (mark.kind == "room" and mark.value in {"bedroom", f"bedroom/{role}"}) or (mark.kind == "unit" and mark.value == "rooms")


def joined(mark: Mark, owner: Mark) -> Mark:
    """Return a room as the bedroom of people beside it, over the words of both."""
    return replace(bedroom_of(mark, owner.value), first=min(mark.first, owner.first), last=max(mark.last, owner.last))


def heads(marks: Sequence[Mark], k: int) -> float:
    """Return how many people stand at k: "the two kids"; 0 where nobody says."""
    place = heads_at(marks, k)
    return 0.0 if place is None else marks[place].number or 2.0


def heads_at(marks: Sequence[Mark], k: int) -> int | None:
    """Return the place of the number, or of "both", in front of the people at k."""
    for i in range(k - 1, max(-1, k - 4), -1):
        if (marks[i].kind == "num" and marks[i].number > 1) or (marks[i].kind, marks[i].value) == ("det", "both"):
            return i
        if marks[i].kind not in {"det", "clf", "fill"}:
            break
    return None


def whose(marks: list[Mark]) -> list[Mark]:
    """Read "the nanny, whose room is next to the nursery, has her own bath" as "the nanny's room is ..., has ..."."""
    made = list(marks)
    for k in range(len(made) - 3, -1, -1):
        if made[k].kind != "owner":
            continue
        j = k + 1 + (made[k + 1].kind == "comma")
        if j + 1 < len(made) and made[j].text in WHOSE and nobodys(made[j + 1]):
            made[k : j + 2] = [joined(made[j + 1], made[k])]
    return made


def meant_for(marks: list[Mark]) -> list[Mark]:
    """Read "a small room for the baby" as the baby's."""
    made = list(marks)
    for k in range(len(made) - 1, -1, -1):
        if k >= len(made) or made[k].kind != "owner":
            continue
        link = _link(made, k)
        j = link - 1
        while j > 0 and made[j].kind in {"post", "size", "adj", "amount"}:
            j -= 1
        if link > 0 and made[j].kind == "room" and made[j].value == "bedroom":
            made[j : k + 1] = [joined(made[j], made[k]), *made[j + 1 : link]]
        elif link > 0 and made[j].kind == "amount" and made[j].value == "rooms":  # "two rooms for the boys"
            made[j : k + 1] = [replace(made[j], kind="num", value=""), replace(joined(made[j], made[k]), plural=True)]
    return made


def _link(marks: Sequence[Mark], k: int) -> int:
    """Return the place of the "for" in front of the people at k; -1 where there is none."""
    j = k - 1
    while j > 0 and (marks[j].kind in {"det", "adj"} or marks[j].text in POSSESSIVE) and marks[j].text.split()[0] not in FOR:
        j -= 1
    return j if j >= 0 and marks[j].text and marks[j].text.split()[0] in FOR else -1


def theirs(marks: list[Mark]) -> list[Mark]:
    """Read "the nanny's room", and in Spanish "la de los niños" by itself."""
    made = list(marks)
    for k in range(len(made) - 1, -1, -1):
        article = k > 0 and made[k - 1].text.split(" ")[-1] in {"la", "el", "al"} and not (k > 1 and made[k - 2].kind in {"room", "post"})
        if k < len(made) and made[k].kind == "adj" and made[k].text.startswith(("de ", "para ")) and article:
            made[k] = joined(made[k], made[k])  # "menos el de invitados"
        if k >= len(made) or made[k].kind != "owner":
            continue
        link = _link(made, k)
        if k + 1 < len(made) and nobodys(made[k + 1]) and (made[k + 1].kind == "room" or made[k + 1].text == "room"):
            made[k : k + 2] = [joined(made[k + 1], made[k])]
        elif link > 0 and made[link - 1].text in {"la", "el", "al"} and not (link > 1 and made[link - 2].kind in {"room", "post"}):
            made[link : k + 1] = [joined(replace(made[k], first=made[link].first), made[k])]
    return made


def named(marks: list[Mark]) -> list[Mark]:
    """Read "奶奶的房间" and "das Zimmer der Großmutter" as one room."""
    made: list[Mark] = []
    k = 0
    while k < len(marks):
        mark = marks[k]
        of = k + 2 < len(marks) and mark.kind == "owner" and marks[k + 1].text in {"的", "'s"} and nobodys(marks[k + 2], mark.value)
        if of or (k + 1 < len(marks) and mark.kind == "owner" and marks[k + 1].kind == "unit" and nobodys(marks[k + 1], mark.value)):
            end = k + (2 if of else 1)
            made.append(replace(bedroom_of(mark, mark.value), last=marks[end].last, text=f"{mark.text} {marks[end].text}"))
            k = end + 1
        elif mark.kind == "unit" and mark.value == "rooms" and (j := _person(marks, k + 1)) and not (made and made[-1].kind == "num"):
            made.append(replace(bedroom_of(mark, marks[j].value), last=marks[j].last, text=f"{mark.text} {marks[j].text}"))
            k = j + 1
        else:
            made.append(mark)
            k += 1
    return made


def _person(marks: Sequence[Mark], k: int) -> int:
    """Return the place of the people whose room stands in front of k: "of the grandmother"; 0 for none."""
    start = k
    while k < len(marks) and k - start < 3 and (marks[k].text in OF or marks[k].kind in {"det", "fill"}):
        k += 1
    return k if start < k < len(marks) and marks[k].kind == "owner" and marks[start].text in OF else 0


def spoken_of(marks: list[Mark]) -> list[Mark]:
    """Read "zwischen ihren Zimmern" as the bedrooms of those who were spoken of last."""
    made = list(marks)
    for k in range(1, len(made)):
        room = made[k].kind == "unit" and made[k].value == "rooms" and (made[k - 1].kind, made[k - 1].value) == ("det", "own")
        place = next((i for i in range(k - 1, -1, -1) if made[i].kind == "owner"), None) if room else None
        if place is not None:
            count = heads(made, place)
            made[k] = replace(bedroom_of(made[k], made[place].value), plural=True)
            made[k - 1] = replace(made[k - 1], kind="num", value="", number=count) if count else replace(made[k - 1], value="all")
    return made
