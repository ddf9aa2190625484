"""From tokens to the elements of sentences: noun phrases with all that stands in front of and behind a room's name, what lies between them, and what is ruled out."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from pipeline.floorplan.language.lexicon import Lexicon, kinds
from pipeline.floorplan.language.text import has_minus
from pipeline.floorplan.language.tokens import HEADS, LEADING, Token, Words
from pipeline.floorplan.program.consistency import ImpossibleError

DROPPED = kinds("dropped")
BEHIND = {"own", "another"}  # determiners that may stand behind their noun
ROLES = {"primary", "guest", "child", "shared", "elder", "staff", "carer", "ensuite"}  # whose a room is
ENDS = {"comma", "join", "clf", "stop", "open", "close", "slash"}
MOST_INDEX = 12
LONGEST = 150  # tokens of a sentence; a longer one is read in parts, cut at commas
LISTED = {*HEADS, *LEADING, "amount", "comma", "join"}  # what a list of rooms alone consists of
SHORT = 48  # characters: a prompt of such lines is a list


def heads(sentence: list[Token], k: int) -> bool:
    """Whether the level at k opens a new part of a sentence: "living room, kitchen, and upstairs two bedrooms"."""
    after = next((x for x in sentence[k + 1 :] if x.kind not in {"det", "flag", "comma"}), None)
    return k > 0 and sentence[k - 1].kind in {"comma", "and"} and after is not None and after.kind in {"np", "colon"}


def backward(sentence: list[Token], k: int, level: int | None) -> int | None:
    """Return the storey of a phrase: of the level named before it, or behind it where sentences name levels behind."""
    parted = False
    for j, e in enumerate(sentence[k + 1 :] if level is None else (), k + 1):
        if e.kind == "level":
            return None if heads(sentence, j) else int(e.value)
        parted = parted or e.kind == "comma"
        if e.kind in {"cue", "colon"} or (e.kind == "verb" and parted):  # "four bedrooms, the guest room is downstairs"
            break
    return level


def listed_on_level(sentence: list[Token], k: int) -> list[Token]:
    """Return the phrases of the list that the storey at k closes, where the sentence is a row of such lists: "A, B and C downstairs, D and E upstairs"."""
    at = [j for j, e in enumerate(sentence) if e.kind == "level"]
    start = max((j for j, e in enumerate(sentence[:k]) if e.kind in {"level", "colon"}), default=0)
    listed = [j for j in range(start, k) if sentence[j].kind == "np"]
    joined = len(listed) > 1 and any(e.kind == "and" for e in sentence[listed[-2] : listed[-1]])
    closes = at[-1] + 1 == len(sentence) or sentence[at[-1] + 1].kind in {"comma", "stop", "but", "close"}
    return [sentence[j] for j in listed] if len(at) > 1 and joined and closes else []


def sentences(tokens: Sequence[Token], words: Words) -> list[list[Token]]:
    """Return the elements of each sentence."""
    by_sentence: list[list[Token]] = [[]]
    for k, token in enumerate(tokens):
        here = by_sentence[-1]
        kind = _line(tokens, k, words) if token.kind == "line" else token.kind
        kind = "comma" if token.text == ";" and all(m.kind in LISTED for m in here) else kind  # "bedroom; bedroom; bath"
        if kind == "stop" or (token.kind == "comma" and len(here) > LONGEST):
            by_sentence.append([])
        elif kind:
            here.append(token if kind == token.kind else replace(token, kind=kind, text=","))
    return [e for e in (_elements(s, words.lexicon) for s in by_sentence if s) if e]


def _line(tokens: Sequence[Token], k: int, words: Words) -> str:
    """Tell whether a line break ends a sentence, parts a list, or only wraps a text."""
    before = tokens[k - 1].kind if k else "stop"
    after = tokens[k + 1] if k + 1 < len(tokens) else None
    if after is None or before in {"stop", "comma", "colon", "bullet"}:
        return ""
    if after.kind == "line":
        return "stop"
    initial = words.prompt[words.written[after.first].start]
    listed = after.kind in {"bullet", "num"} or max(map(len, words.prompt.splitlines())) < SHORT
    return "comma" if listed or initial.isupper() or initial > "\u2e80" else ""


def _elements(tokens: list[Token], lex: Lexicon) -> list[Token]:
    """Return the elements of one sentence."""
    elements: list[Token] = []
    pre: list[Token] = []
    k = 0
    postposed = [m.kind for m in tokens if m.kind in {"room", "num", "clf"}][:3] == ["room", "num", "clf"]  # "卧室两间、卫生间一间"
    while k < len(tokens):
        token = tokens[k]
        if token.kind in HEADS:
            k = _phrases(tokens, k, pre, elements, lex, postposed)
            pre = []
            continue
        if token.kind == "pron" and _heads_phrase(tokens, k + 1) and tokens[k + 1].value != "bathroom/ensuite":  # "one bath", "the others"
            det = {"rest": "other", "both": "both", "group": "all"}.get(token.value, "definite")
            token = replace(token, kind="num", value="", number=1.0) if token.value == "one" else replace(token, kind="det", value=det)
        behind = bool(elements) and elements[-1].kind in {"np", "home"} and not pre and token.kind == "amount"
        if token.kind == "home":
            elements += [*_loose([p for p in pre if p.kind != "amount"], None, lex), _plain(token, lex)]
            elements[-1].amounts += [p for p in pre if p.kind == "amount"]
            pre = []
        elif behind and token.value in {"area", "length"} and not (_heads_phrase(tokens, k + 1) and tokens[k + 1].kind == "size"):
            elements[-1].amounts.append(token)
            areas = sum(m.is_size for m in elements[-1].amounts)
            if areas > 1 and elements[-1].number in {0.0, areas - 1}:  # "bedrooms of 14 and 12 m2" are two
                elements[-1].number = areas
        elif token.kind in LEADING or (token.kind == "amount" and token.value == "area"):
            pre.append(token)
        elif token.kind in {"fill", "adverb", "look", "hyphen", "dash"} and pre:
            elements += [_plain(token, lex)] if token.kind == "look" else []
        else:
            placed = [m.kind for m in tokens[k : k + 2] if m.kind != "verb"][:1] == ["level"]  # "one is downstairs, two are upstairs"
            elements += _loose(pre, token, lex, placed)
            pre = []
            elements += [_plain(token, lex)] if token.kind not in DROPPED else []
        k += 1
    return elements + _loose(pre, None, lex)


def _heads_phrase(tokens: Sequence[Token], k: int) -> bool:
    """Whether a room's name follows, with nothing between but what stands in front of one."""
    return next((m.kind in HEADS for m in tokens[k:] if m.kind not in {"num", "ord", "adj", "size"}), False)


def _loose(pre: Sequence[Token], ahead: Token | None, lex: Lexicon, placed: bool = False) -> list[Token]:
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


def _plain(token: Token, lex: Lexicon) -> Token:
    kind = "and" if token.kind == "slash" else token.kind
    if token.kind == "join":
        kind = "comma" if token.text in lex.sign("also") else token.value
    removes = token.kind == "neg" and (token.value == "back" or token.text in lex.sign("removes"))
    return replace(token, kind=kind, removes=removes)


def _phrases(tokens: list[Token], k: int, pre: list[Token], elements: list[Token], lex: Lexicon, postposed: bool) -> int:
    """Append the phrase whose head is at k, one for each room of a double name: "lounge diner"; return where reading goes on."""
    token, front = tokens[k], pre
    compound = k + 1 < len(tokens) and tokens[k + 1].kind == "home"
    names = token.value.split("+") if token.kind == "room" else [token.value]
    for part in names[:-1]:
        elements += [_phrase(replace(token, value=part), front, compound, lex), Token("and", first=token.first, last=token.first)]
        elements[-2].adjectives.update({"melted"} if part != "bedroom" else ())
        front = [p for p in front if p.kind != "num"]
    phrase = _phrase(replace(token, value=names[-1]), front, compound, lex)
    k = _behind(tokens, k + 1, phrase, postposed, lex)
    while len(names) > 1 and k < len(tokens) and tokens[k].kind == "amount":
        elements[-2 * len(names) + 2].amounts.append(tokens[k])
        k += 1
    elements.append(phrase)
    return k


def _phrase(token: Token, pre: Sequence[Token], compound: bool, lex: Lexicon) -> Token:
    """Put a noun phrase together from its head and what stands in front of it."""
    kind, _, role = token.value.partition("/") if token.kind == "room" else ("bedroom", "", token.value)
    own: dict[str, Any] = {"det": set(), "adjectives": set(), "amounts": [], "taken": list(pre)}
    own |= {"suite": token.kind == "suite", "functions": {"diner": {"dining"}, "shower": {"shower"}}.get(role, set())}
    phrase = replace(token, kind="np", type=kind, role=role if role in ROLES else "", number=0.0, compound=compound, **own)
    for part in pre:
        if part.kind == "num":
            phrase.banned = phrase.removes = phrase.banned or part.number == 0
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
    phrase.det -= {"other"} if "another" in phrase.det else set()  # "另外再来一间客房"
    return phrase


def _behind(tokens: Sequence[Token], k: int, phrase: Token, postposed: bool, lex: Lexicon) -> int:
    """Read what belongs to a noun phrase behind its head: adjectives, an index, a number, areas; return where reading goes on."""
    adjectives = "adjectives_behind" in lex.traits
    while k < len(tokens):
        token, ahead = tokens[k], tokens[k + 1] if k + 1 < len(tokens) else None
        leads = token.kind in {"colon", "times"} and ahead is not None and ahead.kind == "num"
        determines = token.kind == "det" and token.value in BEHIND and (adjectives or not _heads_phrase(tokens, k + 1))
        if determines or (token.kind == "adj" and adjectives):
            (phrase.det if token.kind == "det" else phrase.adjectives).add(token.value)
            phrase.role = phrase.role or (token.value if token.value in ROLES else "")
            phrase.last = token.last
        elif token.kind == "size" and adjectives:
            phrase.size = token.number
        elif token.kind == "num" and _counts(tokens, k, phrase, postposed):
            counted = ahead is not None and ahead.kind == "clf"
            if counted or phrase.plural or tokens[k - 1].kind in {"colon", "times"}:
                phrase.number = token.number
            else:
                phrase.index = int(token.number)
            k += counted
        elif token.kind != "clf" and token.text not in lex.sign("very") and not leads:
            return k
        phrase.taken.append(token)
        k += 1
    return k


def _counts(tokens: Sequence[Token], k: int, phrase: Token, postposed: bool) -> bool:
    """Whether the number at k belongs to the phrase in front of it rather than to what follows."""
    number = tokens[k].number
    if (phrase.number and not postposed) or number != int(number) or not 0 < number <= MOST_INDEX:
        return False
    after, further = (tokens[j].kind if j < len(tokens) else "stop" for j in (k + 1, k + 2))
    if after == "clf":
        return postposed or further not in {*HEADS, "adj", "size"}
    return tokens[k].value == "figure" and (after in ENDS or after in {"colon", "amount", "verb", "cue", "level", "line"})


def settle(parsed: list[list[Token]]) -> None:
    """Let the kitchenette of a studio be a function of its one room, not a kitchen of its own."""
    everything = [e for s in parsed for e in s]
    one = any((e.kind == "home" and e.value) or e.type == "studio_room" or (e.value == "rooms" and e.number == 1) for e in everything)
    if one and not any(e.type == "bedroom" and not e.banned for e in everything):
        for e in (e for e in everything if (e.kind, e.value) == ("np", "kitchen/corner")):
            e.kind = "corner"


CONFLICTS = {
    "homes": ("{} homes are asked for", "ask for one home; sfgen shard --prompts FILE --count N makes many"),
    "conflict": ("two counts are asked for: {!r}", "keep one of them"),
}
RELATIONS = {"near", "door", "open", "wall", "away", "apart", "leads", "between"}


def refuse(tokens: Sequence[Token], words: Words) -> None:
    """Refuse several homes, two counts of one thing, and amounts that nothing has: "-3 bedrooms", "0 m2", "no rooms"."""
    named = any(m.kind in HEADS for m in tokens)
    for k, token in enumerate(tokens):
        place = words.written[token.first].start if token.first < len(words.written) else 0
        minus = token.kind in {"num", "amount", "people"} and has_minus(words.prompt, place)
        lead = token.kind == "people" or (k and tokens[k - 1].kind in {"cue", "fill", "bound", "of", "det", "verb"})
        none = token.kind == "amount" and not token.number and token.value in {"area", "rooms"}
        empty = (token.kind, token.value) == ("unit", "rooms") and k and tokens[k - 1].kind == "neg" and not named
        if token.kind in CONFLICTS or (minus and lead) or none or empty:
            evidence = words.quote(tokens[k - 1 if empty else k].first, max(token.last, token.first + 1), "rooms")
            what, advice = CONFLICTS.get(token.kind, ("no home has {!r}", "ask for numbers above zero"))
            said = f"{token.number:g}" if token.kind == "homes" else ("-" if minus else "") + evidence.text
            raise ImpossibleError(what.format(said), advice, [evidence])


def ban(sentence: list[Token]) -> None:
    """Token the noun phrases that are ruled out."""
    for k, e in enumerate(sentence):
        j = _target(sentence, k + 1) if e.kind == "neg" else None
        behind = next((x for x in sentence[j + 1 :] if x.kind != "verb"), None) if j is not None else None
        relation = behind is not None and behind.kind == "cue" and behind.value in RELATIONS  # which is what is negated
        if j is not None and not relation and (not sentence[j].definite or e.removes):
            e.kind, sentence[j].removes = "used", e.removes
            _list(sentence, j)


def take_back(sentences: Sequence[list[Token]]) -> None:
    """Rule out where it was asked for what is taken back later: "with a gym. ... Scratch the gym"."""
    phrases = [e for sentence in sentences for e in sentence if e.kind == "np"]
    for k, last in enumerate(phrases):
        if last.banned and last.removes and last.definite:
            for e in phrases[:k]:
                e.banned = e.banned or (e.type, e.role) == (last.type, last.role)


def _target(sentence: list[Token], k: int) -> int | None:
    """Return the noun phrase that a negation in front of k rules out; None where it turns a relation or says nothing of rooms."""
    for j, e in enumerate(sentence[k:], k):
        if e.kind == "np":
            return None if e.number and any(x.kind == "colon" for x in sentence[k:j]) else j
        colon = e.kind == "colon" and all(x.kind in {"verb", "word"} for x in sentence[k:j])  # "not needed: balcony, garage"
        if e.kind not in {"verb", "adj", "det", "owner", "size", "word", "relative"} and not colon and (e.kind, e.value) != ("cue", "has"):
            return None
    return None


def _list(sentence: list[Token], j: int) -> None:
    """Token a list under one negation: "no balcony, garage or cellar"."""
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
