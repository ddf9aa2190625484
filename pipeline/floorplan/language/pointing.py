"""Which rooms a pronoun stands for."""

from __future__ import annotations

from pipeline.floorplan.language.facts import SOCIAL, Group, Reading
from pipeline.floorplan.language.phrases import Element


def point(state: Reading, before: list[Element], e: Element, but: Group) -> Group:  # noqa: PLR0911 - one answer per pronoun
    """Return the rooms that a pronoun stands for after the elements `before`; as an object it does not point at the subject `but`."""
    here = [tuple(x.ids) for x in before if x.kind in {"np", "zone", "owner"} and x.ids]
    heard = [*state.past, *here]
    if e.value == "it":
        if here and but:
            return next((g for g in reversed(heard) if not set(g) & set(but)), ())
        if but:
            return next((g for g in reversed(state.past) if not set(g) & set(but)), ())
        return here[0] if here else (state.topic or (state.past[-1] if state.past else ()))
    if e.value == "pair":  # "in between"
        if not here and len(state.topic) == 2:
            return state.topic
        twins: Group = next((g for g in reversed(heard) if len(g) == 2 and not all(map(state.inventory.owned, g))), ())
        if any(x.kind == "zone" for x in before) or (not twins and sum(not set(g) <= set(but) for g in here) > 2):
            return ()
        return twins or tuple(dict.fromkeys(i for g in reversed(heard) for i in g if i not in but))[:2]
    if e.value == "both":
        pair: Group = next((g for g in reversed(heard) if len(g) == 2), ())
        single = dict.fromkeys(i for g in reversed(heard) for i in g if i not in but)
        return pair if pair and pair == heard[-1] else (tuple(single)[:2] if len(single) > 1 else pair)
    plural: Group = next((g for g in reversed(heard) if len(g) > 1), heard[-1] if heard else ())
    if e.value == "group" and len(plural) == 1 and not plural[0].startswith("*"):
        kind = state.inventory.get(plural[0]).type
        same = [i for g in heard for i in g if not i.startswith("*") and state.inventory.get(i).type == kind]
        plural = tuple(dict.fromkeys(same))
    if e.value in {"one", "rest", "some"} and plural and not plural[0].startswith("*"):
        return _part(state, e, plural)
    return plural


def _part(state: Reading, e: Element, plural: Group) -> Group:
    """Return one of a group, or those of it that nothing was said of yet."""
    kind = state.inventory.get(plural[0]).type
    free = [r for r in state.inventory.of(kind) if r.open_slot]
    if e.value != "one":
        return tuple(r.id for r in free) or plural
    count = int(e.number or 1)
    for room in free[:count]:
        room.open_slot = False
    return tuple(r.id for r in free[:count])


def and_follows(sentence: list[Element], comma: Element) -> bool:
    """Whether a comma parts a list of social rooms that an "and" closes: "open-plan living, dining and kitchen area"."""
    k = next(i for i, x in enumerate(sentence) if x is comma)
    for x in sentence[k + 1 :]:
        if x.kind == "and":
            return True
        if x.kind != "comma" and not (x.kind == "np" and x.type in SOCIAL):
            return False
    return False
