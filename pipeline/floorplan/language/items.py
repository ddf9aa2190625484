"""From words to items: rooms, homes, cues, amounts, pronouns, separators. The longest phrase wins."""

from __future__ import annotations

import functools
from dataclasses import dataclass, field

from pipeline.floorplan.language import lexicon
from pipeline.floorplan.language.tokens import MARKS, STOPS, Token

LONGEST = 6  # words of the longest phrase
ROOM, SUITE, HOME, CUE, AMOUNT, PRONOUN, EVERY, LEVEL, ENTER, MUTE, COMMA, AND, WORD = (
    "room", "suite", "home", "cue", "amount", "pronoun", "every", "level", "enter", "mute", "comma", "and", "word",
)  # fmt: skip

PRONOUNS = {
    "one of them": "one", "one of these": "one", "one of which": "one", "the other two": "rest", "the other one": "rest", "the others": "rest", "the other three": "rest", "the rest": "rest", "the remaining ones": "rest",
    "both": "both", "both of them": "both", "each": "group", "each of them": "group", "they": "group", "all of them": "group", "these": "group", "them": "group", "both of which": "both", "all of which": "group",
    "it": "it", "which": "it", "that": "it", "one another": "each other", "each other": "each other", "one": "it",
}  # fmt: skip
EVERYTHING = ("everything", "every room", "all rooms", "all the rooms", "the other rooms", "all other rooms", "all the other rooms", "other rooms", "every other room", "the rest of the rooms", "the remaining rooms")  # fmt: skip
ZONES = {"sleeping area": "bedroom", "sleeping zone": "bedroom", "night zone": "bedroom", "sleeping quarters": "bedroom", "bedroom wing": "bedroom", "private zone": "bedroom"}  # fmt: skip
LEVELS = {
    "downstairs": 0, "ground floor": 0, "on the ground floor": 0, "lower floor": 0, "lower level": 0, "upstairs": 1, "first floor": 1, "upper floor": 1, "upper level": 1, "top floor": 1, "second floor": 1, "upper storey": 1, "third floor": 2,
}  # fmt: skip
ENTRANCES = ("come in through", "comes in through", "enter through", "enter via", "enter into", "entrance into", "entrance through", "entrance is in", "front door opens into", "front door leads into", "front door leads to", "enters through",
             "front door in", "enters into", "entrance via", "walk straight into", "come in via", "step into", "enter directly into", "entrance to", "front door opens onto")  # fmt: skip
MUTES = ("closed off", "walled off", "shut off", "front door", "door to the outside", "doors to the outside", "apart from that", "of its own", "of their own", "its own door", "their own door", "for living and sleeping", "for living", "along the wall",
         "in one corner", "work from home", "works from home", "working from home", "at home", "eat in", "big enough to eat in", "for two desks", "bed and breakfast", "no wasted corridor space", "wasted corridor", "window to the outside",
         "windows to the outside", "one and a half", "master planner", "without stairs", "no stairs", "no steps", "no walls in between", "walls in between", "grid of boxes", "under one roof", "on one level", "all on one level", "on one side",
         "on the other side", "on the opposite side", "at the other end", "next door", "no elevator", "home office layout", "office layout", "living in", "two storey living", "on one floor", "at the front", "at the back", "for living and cooking",
         "bedroom wing door", "living together", "living there", "to live in")  # fmt: skip


@dataclass(slots=True)
class Item:
    """A stretch of words: tokens[first:last]. `words` is its text; the rest depends on `kind`."""

    kind: str
    first: int
    last: int
    words: str
    type: str = ""
    role: str = ""
    plural: bool = False
    cue: str = ""
    number: float | None = None
    high: float | None = None
    bound: str = ""  # least, most, about
    unit: str = ""
    level: int = 0
    mods: list[str] = field(default_factory=list)  # plain words in front of a room
    ids: list[str] = field(default_factory=list)  # rooms that it names


@functools.cache
def _phrases() -> dict[str, Item]:
    """Return all phrases with a sample item each."""
    table: dict[str, Item] = {}
    for phrase, (kind, role) in lexicon.ROOMS.items():
        table[lexicon.plural(phrase)] = Item(ROOM, 0, 0, phrase, kind, role, plural=True)
        if phrase.endswith("room"):
            table.setdefault(phrase + "s", Item(ROOM, 0, 0, phrase, kind, role, plural=True))
    for phrase, (kind, role) in lexicon.ROOMS.items():
        table[phrase] = Item(ROOM, 0, 0, phrase, kind, role, plural=phrase == "stairs" and False)
    for phrase, role in lexicon.SUITES.items():
        table[lexicon.plural(phrase)] = Item(SUITE, 0, 0, phrase, "bedroom", role, plural=True)
        table[phrase] = Item(SUITE, 0, 0, phrase, "bedroom", role)
    for phrase in lexicon.HOMES:
        table[phrase] = Item(HOME, 0, 0, phrase)
        table[lexicon.plural(phrase)] = Item(HOME, 0, 0, phrase)
    for phrase, cue in lexicon.CUES.items():
        table[phrase] = Item(CUE, 0, 0, phrase, cue=cue)
    for phrase, what in PRONOUNS.items():
        table[phrase] = Item(PRONOUN, 0, 0, phrase, role=what)
    for phrase in EVERYTHING:
        table[phrase] = Item(EVERY, 0, 0, phrase)
    for phrase, kind in ZONES.items():
        table[phrase] = Item(EVERY, 0, 0, phrase, type=kind)
    for phrase, level in LEVELS.items():
        table[phrase] = Item(LEVEL, 0, 0, phrase, level=level)
    for phrase in ENTRANCES:
        table[phrase] = Item(ENTER, 0, 0, phrase)
    for phrase in MUTES:
        table[phrase] = Item(MUTE, 0, 0, phrase)
    table["studio"] = Item(HOME, 0, 0, "studio", type="studio_room")
    table["studios"] = Item(HOME, 0, 0, "studio", type="studio_room")
    return table


def sentences(tokens: list[Token]) -> list[list[Item]]:
    """Return the items of each sentence (cut at . ; ! ?), hyphens dropped."""
    found: list[list[Item]] = [[]]
    i = 0
    while i < len(tokens):
        word = tokens[i].text
        if word in STOPS:
            if found[-1]:
                found.append([])
            i += 1
            continue
        item = _amount(tokens, i) or _phrase(tokens, i)
        if item is None:
            if word in {",", ":", "(", ")", "/"}:
                item = Item(COMMA, i, i + 1, word)
            elif word in {"and", "&", "plus", "or"}:
                item = Item(AND, i, i + 1, word)
            elif word in MARKS:
                i += 1
                continue
            else:
                item = Item(WORD, i, i + 1, word)
        found[-1].append(item)
        i = item.last
    return [s for s in found if s]


def _join(tokens: list[Token], i: int, count: int) -> tuple[str, int] | None:
    """Return the text of `count` words from i, hyphens between them skipped, and where it ends."""
    words: list[str] = []
    while count and i < len(tokens):
        text = tokens[i].text
        if text in {"-", "–"} and words:
            i += 1
            continue
        if text in MARKS:
            return None
        words.append(text)
        count -= 1
        i += 1
    return (" ".join(words), i) if not count else None


def _phrase(tokens: list[Token], i: int) -> Item | None:
    table = _phrases()
    for count in range(LONGEST, 0, -1):
        joined = _join(tokens, i, count)
        if joined and joined[0] in table:
            sample = table[joined[0]]
            return Item(sample.kind, i, joined[1], sample.words, sample.type, sample.role, sample.plural, sample.cue, level=sample.level)
    return None


def number_at(tokens: list[Token], i: int) -> tuple[float, int] | None:
    """Read a number in figures or words from token i ("1,900", "twenty five", "one hundred and ten"); return it and its end."""
    if i < len(tokens) and tokens[i].number is not None:
        return float(tokens[i].number or 0.0), i + 1
    total, current, k, seen = 0.0, 0.0, i, False
    while k < len(tokens):
        word = tokens[k].text
        value = lexicon.NUMBERS.get(word)
        if word in {"a", "an", "couple", "double", "twin", "dozen", "half"} or value is None:
            joins = word in {"and", "-"} and seen and k + 1 < len(tokens) and tokens[k + 1].text in lexicon.NUMBERS
            if not (joins and (current >= 20 or total >= 100)) or tokens[k + 1].text in {"a", "an", "one"}:
                break
            k += 1
            continue
        if value >= 100:
            current = max(current, 1.0) * value
            total, current = total + current, 0.0
        elif seen and current and (current % 10 or value >= 10):
            break
        else:
            current += value
        seen = True
        k += 1
    return (total + current, k) if seen else None


def _amount(tokens: list[Token], i: int) -> Item | None:
    """Read "at least 18 m²", "10 to 12 m²", "seven square metres or more", "70 %"."""
    bound, k = "", i
    for count in (3, 2, 1):
        joined = _join(tokens, i, count)
        if joined and joined[0] in (lexicon.LEAST | lexicon.MOST | lexicon.ABOUT):
            text = joined[0]
            bound = "least" if text in lexicon.LEAST else ("most" if text in lexicon.MOST else "about")
            k = joined[1]
            break
    if k < len(tokens) and tokens[k].text in {"~", "of", "about", "around", "roughly"}:
        k += 1
    number = number_at(tokens, k)
    if number is None:
        return None
    low, k = number
    high = None
    if k + 1 < len(tokens) and tokens[k].text in {"to", "-", "–", "and", "by"}:
        second = number_at(tokens, k + 1)
        if second is not None and _unit(tokens, second[1]) and second[0] > low and tokens[k].text != "by":
            high, k = second
    if k < len(tokens) and tokens[k].text in {"-", "–"}:
        k += 1
    unit = _unit(tokens, k)
    if unit is None:
        return None
    (name, factor), k = unit
    for count in (3, 2, 1):
        joined = _join(tokens, k, count)
        if joined and joined[0] in (lexicon.OR_MORE | lexicon.OR_LESS):
            bound = "least" if joined[0] in lexicon.OR_MORE else "most"
            k = joined[1]
            break
    text = " ".join(t.text for t in tokens[i:k])
    return Item(AMOUNT, i, k, text, number=low * factor, high=None if high is None else high * factor, bound=bound, unit=name)


def _unit(tokens: list[Token], i: int) -> tuple[tuple[str, float], int] | None:
    for count in (3, 2, 1):
        joined = _join(tokens, i, count)
        if joined and joined[0] in lexicon.UNITS:
            return lexicon.UNITS[joined[0]], joined[1]
    # "sq. ft" and "sq. m" carry a stop
    texts = [t.text for t in tokens[i : i + 3]]
    if len(texts) == 3 and texts[0] == "sq" and texts[1] == ".":
        factor = {"ft": 0.092903, "feet": 0.092903, "m": 1.0, "metres": 1.0, "meters": 1.0}.get(texts[2])
        if factor:
            return ("area", factor), i + 3
    return None
