"""Which rooms pronouns stand for: "it", "both", "the other two", "one of them"."""

from __future__ import annotations

from pipeline.floorplan.language.facts import Group, Reading
from pipeline.floorplan.language.phrases import Element


def count_of(state: Reading, text: str) -> int:
    """Return how many "the other two" are; 0 where no number is said."""
    found = (state.heard.lexicon.trie.get(w, {}).get("") for w in text.split())
    return next(
        (int(m.number) for m in found if m is not None and m.kind == "num"),
        2 if state.heard.lexicon.sign("pair") & set(text.split()) else 0,
    )


def point(state: Reading, before: list[Element], e: Element, but: Group) -> Group:  # noqa: PLR0911 - one answer per pronoun
    """Return the rooms that a pronoun stands for after the elements `before`; as an object it does not point at the subject `but`."""
    here = [tuple(x.ids) for x in before if x.kind in {"np", "zone", "owner"} and x.ids]
    heard = [*state.past, *here]
    if e.value == "it":
        if but:
            return next((g for g in reversed(heard if here else state.past) if not set(g) & set(but)), ())
        return here[0] if here else (state.topic or (state.past[-1] if state.past else ()))
    pair: Group = next((g for g in reversed(heard) if len(g) == 2), ())
    single = tuple(dict.fromkeys(i for g in reversed(heard) for i in g if i not in but))
    if e.value == "both":
        return pair if (pair and pair == heard[-1]) or len(single) < 2 else single[:2]
    plural: Group = next((g for g in reversed(heard) if len(g) > 1), heard[-1] if heard else ())
    if not plural or plural[0].startswith("*"):
        return plural
    kind = state.inventory.get(plural[0]).type
    kind = state.parted if e.value == "rest" and any(r.open_slot for r in state.inventory.of(state.parted)) else kind
    if e.value == "group" and len(plural) == 1:
        same = [i for g in heard for i in g if i[0] not in "*<" and state.inventory.get(i).type == kind]
        return tuple(dict.fromkeys(same))
    free = [r for r in state.inventory.of(kind) if r.open_slot]
    if e.value in {"rest", "some"}:
        return tuple(r.id for r in free) or plural
    if e.value == "one":
        state.parted = kind
        for room in free[: int(e.number or 1)]:
            room.open_slot = False
        return tuple(r.id for r in free[: int(e.number or 1)])
    return plural
