"""Reads a prompt from left to right: which rooms there are, and what is said about them."""

from __future__ import annotations

from dataclasses import replace

from pipeline.floorplan.language.clauses import Sentence
from pipeline.floorplan.language.facts import Reading
from pipeline.floorplan.language.introductions import introduce
from pipeline.floorplan.language.marks import Words
from pipeline.floorplan.language.negation import ban
from pipeline.floorplan.language.phrases import Element


def read(heard: Words, sentences: list[list[Element]]) -> Reading:
    """Read all sentences: what is ruled out, what is introduced, then what is said of it."""
    state = Reading(heard)
    for sentence in sentences:
        ban(sentence)
    _studio(state, sentences)
    sentences = [_parted(sentence) for sentence in sentences]
    for sentence in sentences:
        _compared(sentence)
    introduce(state, sentences)
    for sentence in sentences:
        Sentence(state, sentence).read()
    return state


def _compared(sentence: list[Element]) -> None:
    """Let "twice a bedroom" and "as large as a bedroom" mean one that is there, not a new one."""
    for k, e in enumerate(sentence):
        before = next((x for x in reversed(sentence[:k]) if x.kind not in {"relative", "det", "word"}), None)
        if e.kind == "np" and "indefinite" in e.det and e.number is None and before is not None and before.kind in {"factor", "cmp"}:
            e.det = (e.det - {"indefinite"}) | {"definite"}


def _parted(sentence: list[Element]) -> list[Element]:
    """Read "three bathrooms, two en suite" as "three bathrooms, two of them en suite"."""
    made: list[Element] = []
    for k, e in enumerate(sentence):
        counted = sentence[k - 2] if k > 1 and sentence[k - 1].kind in {"comma", "open"} else None
        several = counted is not None and counted.kind == "np" and counted.type == e.type == "bathroom" and (counted.number or 1) > 1
        fewer = counted is not None and (e.number or 1) < (counted.number or 1)
        if several and fewer and e.role == "ensuite" and not e.det:
            made += [Element("pron", "one", e.first, e.first, e.text, number=e.number), replace(e, number=None)]
        else:
            made.append(e)
    return made


def _studio(state: Reading, sentences: list[list[Element]]) -> None:
    """Let the kitchenette of a studio be a function of its one room, not a kitchen of its own."""
    everything = [e for s in sentences for e in s]
    one = any(e.kind == "home" and e.value for e in everything) or any(e.kind == "np" and e.type == "studio_room" for e in everything)
    one = one or any(e.kind == "amount" and e.value == "rooms" and e.number == 1 for e in everything)
    if not one or any(e.kind == "np" and e.type == "bedroom" and not e.banned for e in everything):
        return
    for k, e in enumerate(everything):
        held = e.text == "小 厨 房" and k > 1 and everything[k - 1].value == "has" and everything[k - 2].kind == "home"  # "开间带小厨房"
        if e.kind == "np" and e.type == "kitchen" and e.mark is not None and (held or e.mark.value == "kitchen/corner"):
            e.kind = "corner"
            state.understood(e.first, e.last)
