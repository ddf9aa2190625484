"""From marks to the elements of sentences: noun phrases with all that stands in front of and behind a room's name, what lies between them, and what is ruled out."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from pipeline.floorplan.language.lexicon import Lexicon, kinds
from pipeline.floorplan.language.marks import HEADS, LEADING, Mark, Words
from pipeline.floorplan.language.text import has_minus
from pipeline.floorplan.program.consistency import ImpossibleError

DROPPED = kinds("dropped")
BEHIND = {"own", "another"}  # determiners that may stand behind their noun
ROLES = {"primary", "guest", "child", "shared", "elder", "staff", "carer", "ensuite"}  # whose a room is
ENDS = {"comma", "join", "clf", "stop", "open", "close", "slash"}
MOST_INDEX = 12
LONGEST = 150  # marks of a sentence; a longer one is read in parts, cut at commas
LISTED = {*HEADS, *LEADING, "amount", "comma", "join"}  # what a list of rooms alone consists of
SHORT = 48  # characters: a prompt of such lines is a list


def heads(sentence: list[Mark], k: int) -> bool:
    """Whether the level at k opens a new part of a sentence: "living room, kitchen, and upstairs two bedrooms"."""
    after = next((x for x in sentence[k + 1 :] if x.kind not in {"det", "flag", "comma"}), None)
    return k > 0 and sentence[k - 1].kind in {"comma", "and"} and after is not None and after.kind in {"np", "colon"}


def backward(sentence: list[Mark], k: int, level: int | None) -> int | None:
    """Return the storey of a phrase: of the level named before it, or behind it where sentences name levels behind."""
    parted = False
    for j, e in enumerate(sentence[k + 1 :] if level is None else (), k + 1):
        if e.kind == "level":
            return None if heads(sentence, j) else int(e.value)
        parted = parted or e.kind == "comma"
        if e.kind in {"cue", "colon"} or (e.kind == "verb" and parted):  # "four bedrooms, the guest room is downstairs"
            break
    return level


def sentences(marks: Sequence[Mark], words: Words) -> list[list[Mark]]:
    """Return the elements of each sentence."""
    by_sentence: list[list[Mark]] = [[]]
    for k, mark in enumerate(marks):
        here = by_sentence[-1]
        kind = _line(marks, k, words) if mark.kind == "line" else mark.kind
        kind = "comma" if mark.text == ";" and all(m.kind in LISTED for m in here) else kind  # "bedroom; bedroom; bath"
        if kind == "stop" or (mark.kind == "comma" and len(here) > LONGEST):
            by_sentence.append([])
        elif kind:
            here.append(mark if kind == mark.kind else replace(mark, kind=kind, text=","))
    return [e for e in (_elements(s, words.lexicon) for s in by_sentence if s) if e]


def _line(marks: Sequence[Mark], k: int, words: Words) -> str:
    """Tell whether a line break ends a sentence, parts a list, or only wraps a text."""
    before = marks[k - 1].kind if k else "stop"
    after = marks[k + 1] if k + 1 < len(marks) else None
    if after is None or before in {"stop", "comma", "colon", "bullet"}:
        return ""
    if after.kind == "line":
        return "stop"
    initial = words.prompt[words.tokens[after.first].start]
    listed = after.kind in {"bullet", "num"} or max(map(len, words.prompt.splitlines())) < SHORT
    return "comma" if listed or initial.isupper() or initial > "\u2e80" else ""


def _elements(marks: list[Mark], lex: Lexicon) -> list[Mark]:
    """Return the elements of one sentence."""
    elements: list[Mark] = []
    pre: list[Mark] = []
    k = 0
    postposed = [m.kind for m in marks if m.kind in {"room", "num", "clf"}][:3] == ["room", "num", "clf"]  # "卧室两间、卫生间一间"
    while k < len(marks):
        mark = marks[k]
        if mark.kind in HEADS:
            k = _phrases(marks, k, pre, elements, lex, postposed)
            pre = []
            continue
        if mark.kind == "pron" and _heads_phrase(marks, k + 1) and marks[k + 1].value != "bathroom/ensuite":  # "one bath", "the others"
            determines = {"rest": "other", "both": "both", "group": "all"}.get(mark.value, "definite")
            mark = replace(mark, kind="num", value="", number=1.0) if mark.value == "one" else replace(mark, kind="det", value=determines)
        behind = bool(elements) and elements[-1].kind in {"np", "home"} and not pre and mark.kind == "amount"
        if mark.kind == "home":
            elements += [*_loose([p for p in pre if p.kind != "amount"], None, lex), _plain(mark, lex)]
            elements[-1].amounts += [p for p in pre if p.kind == "amount"]
            pre = []
        elif behind and mark.value in {"area", "length"} and not (_heads_phrase(marks, k + 1) and marks[k + 1].kind == "size"):
            elements[-1].amounts.append(mark)
            areas = sum(m.is_size for m in elements[-1].amounts)
            if areas > 1 and elements[-1].number in {0.0, areas - 1}:  # "bedrooms of 14 and 12 m2" are two
                elements[-1].number = areas
        elif mark.kind in LEADING or (mark.kind == "amount" and mark.value == "area"):
            pre.append(mark)
        elif mark.kind in {"fill", "adverb", "look", "hyphen", "dash"} and pre:
            elements += [_plain(mark, lex)] if mark.kind == "look" else []
        else:
            placed = [m.kind for m in marks[k : k + 2] if m.kind != "verb"][:1] == ["level"]  # "one is downstairs, two are upstairs"
            elements += _loose(pre, mark, lex, placed)
            pre = []
            elements += [_plain(mark, lex)] if mark.kind not in DROPPED else []
        k += 1
    return elements + _loose(pre, None, lex)


def _heads_phrase(marks: Sequence[Mark], k: int) -> bool:
    """Whether a room's name follows, with nothing between but what stands in front of one."""
    return next((m.kind in HEADS for m in marks[k:] if m.kind not in {"num", "ord", "adj", "size"}), False)


def _loose(pre: Sequence[Mark], ahead: Mark | None, lex: Lexicon, placed: bool = False) -> list[Mark]:
    """Return what stood in front of no room: "two baths, one en suite", "ein Bad, das vom Flur erreichbar ist"."""
    owned = ahead is not None and ahead.kind == "owner"  # "four bedrooms, two for the kids"
    kept = {"amount", "adj"} if owned else {"amount", "adj", "det"}
    kept |= {"size"} if ahead is None or ahead.kind in {"comma", "join", "but", "close", "verb"} else set()
    elements = [_plain(m, lex) for m in pre if m.kind in kept or (m.kind == "num" and (m.value == "1" or owned or placed))]
    for e in elements:
        if e.kind == "num":
            e.kind, e.value = "pron", "one"
        elif e.kind == "det" and e.text in lex.sign("relates"):
            e.kind = "relative"
    return elements


def _plain(mark: Mark, lex: Lexicon) -> Mark:
    kind = "and" if mark.kind == "slash" else mark.kind
    if mark.kind == "join":
        kind = "comma" if mark.text in lex.sign("also") else mark.value
    removes = mark.kind == "neg" and mark.text in lex.sign("removes")
    return replace(mark, kind=kind, removes=removes)


def _phrases(marks: list[Mark], k: int, pre: list[Mark], elements: list[Mark], lex: Lexicon, postposed: bool) -> int:
    """Append the phrase whose head is at k, one for each room of a double name: "lounge diner"; return where reading goes on."""
    mark, front = marks[k], pre
    compound = k + 1 < len(marks) and marks[k + 1].kind == "home"
    names = mark.value.split("+") if mark.kind == "room" else [mark.value]
    for part in names[:-1]:
        elements += [_phrase(replace(mark, value=part), front, compound, lex), Mark("and", first=mark.first, last=mark.first)]
        elements[-2].adjectives.update({"melted"} if part != "bedroom" else ())
        front = [p for p in front if p.kind != "num"]
    phrase = _phrase(replace(mark, value=names[-1]), front, compound, lex)
    k = _behind(marks, k + 1, phrase, postposed, lex)
    while len(names) > 1 and k < len(marks) and marks[k].kind == "amount":
        elements[-2 * len(names) + 2].amounts.append(marks[k])
        k += 1
    elements.append(phrase)
    return k


def _phrase(mark: Mark, pre: Sequence[Mark], compound: bool, lex: Lexicon) -> Mark:
    """Put a noun phrase together from its head and what stands in front of it."""
    kind, _, role = mark.value.partition("/") if mark.kind == "room" else ("bedroom", "", mark.value)
    own: dict[str, Any] = {"det": set(), "adjectives": set(), "amounts": [], "taken": list(pre)}
    own |= {"suite": mark.kind == "suite", "functions": {"dining"} if role == "diner" else set()}
    phrase = replace(mark, kind="np", type=kind, role=role if role in ROLES else "", number=0.0, compound=compound, **own)
    for part in pre:
        if part.kind == "num":
            phrase.banned = phrase.banned or part.number == 0
            phrase.number = part.number if part.number == int(part.number) and part.number > 0 else phrase.number
        elif part.kind == "det" and part.value == "partitive" and phrase.number:
            phrase.part, phrase.number = int(phrase.number), 0.0
        elif part.kind == "det":
            phrase.det.add("definite" if part.value == "partitive" else part.value)
            if part.value == "other" and not phrase.number:
                phrase.number = 2.0 if lex.sign("pair") & set(part.text.split()) else 0.0
        elif part.kind == "ord":
            phrase.ordinal = int(part.number)
        elif part.kind == "adj":
            phrase.adjectives.add(part.value)
            if part.value in ROLES and not phrase.role and kind in {"bedroom", "bathroom", "kitchen", "office"}:
                phrase.role = part.value
        elif part.kind == "size":
            phrase.size = part.number
        elif part.kind == "amount":
            phrase.amounts.append(part)
    phrase.role = "" if phrase.role == "shared" and kind != "bathroom" else phrase.role
    return phrase


def _behind(marks: Sequence[Mark], k: int, phrase: Mark, postposed: bool, lex: Lexicon) -> int:
    """Read what belongs to a noun phrase behind its head: adjectives, an index, a number, areas; return where reading goes on."""
    adjectives = "adjectives_behind" in lex.traits
    while k < len(marks):
        mark, ahead = marks[k], marks[k + 1] if k + 1 < len(marks) else None
        determines = mark.kind == "det" and mark.value in BEHIND and (adjectives or not _heads_phrase(marks, k + 1))
        if determines or (mark.kind == "adj" and adjectives):
            (phrase.det if mark.kind == "det" else phrase.adjectives).add(mark.value)
            phrase.role = phrase.role or (mark.value if mark.value in ROLES else "")
            phrase.last = mark.last
        elif mark.kind == "size" and adjectives:
            phrase.size = mark.number
        elif mark.kind == "num" and _counts(marks, k, phrase, postposed):
            counted = ahead is not None and ahead.kind == "clf"
            if counted or phrase.plural or marks[k - 1].kind in {"colon", "times"}:
                phrase.number = mark.number
            else:
                phrase.index = int(mark.number)
            k += counted
        elif (
            mark.kind != "clf"
            and mark.text not in lex.sign("very")
            and not (mark.kind in {"colon", "times"} and ahead is not None and ahead.kind == "num")
        ):
            return k
        phrase.taken.append(mark)
        k += 1
    return k


def _counts(marks: Sequence[Mark], k: int, phrase: Mark, postposed: bool) -> bool:
    """Whether the number at k belongs to the phrase in front of it rather than to what follows."""
    number = marks[k].number
    if (phrase.number and not postposed) or number != int(number) or not 0 < number <= MOST_INDEX:
        return False
    after, further = (marks[j].kind if j < len(marks) else "stop" for j in (k + 1, k + 2))
    if after == "clf":
        return postposed or further not in {*HEADS, "adj", "size"}
    return marks[k].value == "figure" and (after in ENDS or after in {"colon", "amount", "verb", "cue", "level", "line"})


def settle(parsed: list[list[Mark]]) -> None:
    """Let the kitchenette of a studio be a function of its one room, not a kitchen of its own."""
    everything = [e for s in parsed for e in s]
    one = any((e.kind == "home" and e.value) or e.type == "studio_room" or (e.value == "rooms" and e.number == 1) for e in everything)
    if one and not any(e.type == "bedroom" and not e.banned for e in everything):
        for k, e in enumerate(everything):
            ahead = everything[k + 1].kind if k + 1 < len(everything) else ""
            little = e.size < 1.0 and ahead not in {"cue", "verb"}  # and nothing is said of it
            if e.kind == "np" and e.type == "kitchen" and (little or e.value == "kitchen/corner"):
                e.kind = "corner"


CONFLICTS = {
    "homes": ("{} homes are asked for", "ask for one home; sfgen shard --prompts FILE --count N makes many"),
    "conflict": ("two counts are asked for: {!r}", "keep one of them"),
}
RELATIONS = {"near", "door", "open", "wall", "away", "apart", "leads", "between"}


def refuse(marks: Sequence[Mark], words: Words) -> None:
    """Refuse several homes, two counts of one thing, and amounts that nothing has: "-3 bedrooms", "0 m2", "no rooms"."""
    named = any(m.kind in HEADS for m in marks)
    for k, mark in enumerate(marks):
        place = words.tokens[mark.first].start if mark.first < len(words.tokens) else 0
        minus = mark.kind in {"num", "amount", "people"} and has_minus(words.prompt, place)
        lead = mark.kind == "people" or (k and marks[k - 1].kind in {"cue", "fill", "bound", "of", "det", "verb"})
        none = mark.kind == "amount" and not mark.number and mark.value in {"area", "rooms"}
        empty = (mark.kind, mark.value) == ("unit", "rooms") and k and marks[k - 1].kind == "neg" and not named
        if mark.kind in CONFLICTS or (minus and lead) or none or empty:
            evidence = words.quote(marks[k - 1 if empty else k].first, max(mark.last, mark.first + 1), "rooms")
            what, advice = CONFLICTS.get(mark.kind, ("no home has {!r}", "ask for numbers above zero"))
            said = f"{mark.number:g}" if mark.kind == "homes" else ("-" if minus else "") + evidence.text
            raise ImpossibleError(what.format(said), advice, [evidence])


def ban(sentence: list[Mark]) -> None:
    """Mark the noun phrases that are ruled out."""
    for k, e in enumerate(sentence):
        j = _target(sentence, k + 1) if e.kind == "neg" else None
        behind = next((x for x in sentence[j + 1 :] if x.kind != "verb"), None) if j is not None else None
        relation = behind is not None and behind.kind == "cue" and behind.value in RELATIONS  # which is what is negated
        if j is not None and not relation and (not sentence[j].definite or e.removes):
            e.kind = "used"
            _list(sentence, j)


def _target(sentence: list[Mark], k: int) -> int | None:
    """Return the noun phrase that a negation in front of k rules out; None where it turns a relation or says nothing of rooms."""
    for j, e in enumerate(sentence[k:], k):
        if e.kind == "np":
            return None if e.number and any(x.kind == "colon" for x in sentence[k:j]) else j
        colon = e.kind == "colon" and all(x.kind in {"verb", "word"} for x in sentence[k:j])  # "not needed: balcony, garage"
        if e.kind not in {"verb", "adj", "det", "owner", "size", "word", "relative"} and not colon and (e.kind, e.value) != ("cue", "has"):
            return None
    return None


def _list(sentence: list[Mark], j: int) -> None:
    """Mark a list under one negation: "no balcony, garage or cellar"."""
    sentence[j].banned = True
    joined = ""
    titled = next((x.kind for x in reversed(sentence[:j]) if x.kind in {"colon", "neg", "used"}), "") == "colon"
    for i in range(j + 1, len(sentence)):
        e = sentence[i]
        if e.kind in {"comma", "and", "or"}:
            joined = e.kind if joined != "or" else joined
            continue
        if e.kind != "np" or not joined or e.number or e.amounts or e.definite or e.det & {"own", "another"}:
            return
        if (joined == "and" and "indefinite" in e.det) or e.adjectives & {"open", "combined"}:
            return  # "no balcony and a garage"
        rest = next((x for x in sentence[i + 1 :] if x.kind not in {"np", "comma", "det"}), None)
        if joined == "comma" and not titled and (rest is None or rest.kind != "or"):
            return
        e.banned, joined = True, ""
