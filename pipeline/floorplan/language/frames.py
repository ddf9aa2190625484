"""Frames: patterns over concepts that say in one way what languages say in many; `manifests/lexicon/frames.yaml` holds them.

A frame is `pattern => reading`. Atoms of a pattern: `A` ... `D` a noun phrase (`A:bedroom` of that type), `L` a list of two or more, `X`, `Y` a list of one or more,
`^` and `$` the ends of a clause, else a kind of token (`flag`), a kind with its value (`cue/has`), or a sign, a closed class of words that a lexicon lists under
`signs`; `a|b` either, `a?` it or nothing, `n=a` with a name. Words that mean nothing may stand between atoms. A reading is made of the phrases, of what has a name
(`n>kind/value`: as another kind of token, whole where it is a number, `n>flip`: with its bound turned round, `n>less`: one less, `n>total`: as the home's, `n>bedroom`: as the bedroom of those people, `n>@o`: as
the bedroom of `o`, `n>=m`: with the number of `m`) and of tokens to be read in place of the words; what stood
between them is consumed. No frame belongs to a language: word order and words do.
"""

from __future__ import annotations

import functools
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pipeline import yaml_text
from pipeline.errors import ContentError
from pipeline.floorplan.language.lexicon import Lexicon
from pipeline.floorplan.language.tokens import ENDS, HEADS, LEADING, Token, Words, sentences_of

FILE = Path(__file__).resolve().parents[3] / "manifests" / "lexicon" / "frames.yaml"
PHRASES, LISTS = frozenset("ABCD"), frozenset("LXY")
SKIPPED = {"fill", "ignored", "adverb", "word", "look", "hyphen", "wish"}  # between atoms, where no atom names it
CLOSERS = ENDS | {"comma", "close", "but", "open", "colon", "bullet", "dash"}
SEPARATORS = {"comma", "join", "slash"}
TOWARDS = {"into", "single", "det/indefinite", "det/another"}  # in front of each room of a list: "one to the hall, one to the kitchen"
TRAILING = {("num", "figure"), ("amount", "area"), ("det", "own")}  # behind a head
BARE = SKIPPED | {"comma", "verb", "bound", "cue", "fix", "join"}  # between "actually" and the count that it takes back
MOST_SKIPPED = 3
HOMES = {"large": 35.0, "vast": 60.0}  # [m2] from here on an area is no bedroom's, and no living room's
ROOMY = 8.0  # [m2] a figure behind a room that is an area, and no count or name
BREAKS = {"stop", "line", "colon", "comma"}
FARTHEST = 14  # tokens between the two parts of a bracket
Slots = dict[str, tuple[int, int]]


@dataclass(frozen=True, slots=True)
class Frame:
    """A pattern and its reading. `needs`: for each atom that must stand there, what it may be."""

    text: str
    atoms: tuple[Atom, ...]
    reading: tuple[str, ...]
    needs: tuple[frozenset[str], ...]


@dataclass(frozen=True, slots=True)
class Atom:
    """What may stand at one place of a pattern: `names` of tokens, or noun phrases (of `types`, where there are any) that fill `slot`."""

    names: frozenset[str]
    optional: bool
    slot: str
    types: frozenset[str]


@functools.cache
def frames() -> tuple[Frame, ...]:
    """Return all frames in the order in which they are tried. Raises ContentError for one that is none."""
    rows = yaml_text.parse(FILE.read_text(encoding="utf-8"))
    return tuple(_frame(row) for group in rows.values() for row in group)


def _frame(row: str) -> Frame:
    pattern, arrow, reading = row.partition("=>")
    atoms = tuple(map(_atom, pattern.split()))
    slots = {a.slot for a in atoms}
    if not arrow or {w for w in reading.split() if w in PHRASES | LISTS} - slots:
        raise ContentError(f"{FILE.name}: no frame: {row!r}", "write PATTERN => READING with the slots of the pattern")
    needs = tuple(a.names for a in atoms if not (a.optional or a.names & {"^", "$"} or a.slot in PHRASES | LISTS))
    return Frame(row, atoms, tuple(reading.split()), needs)


def _atom(text: str) -> Atom:
    slot, _, names = text.removesuffix("?").rpartition("=")
    head, _, types = names.partition(":")
    slot = head if head in PHRASES | LISTS else slot
    return Atom(frozenset(names.split("|")), text.endswith("?"), slot, frozenset(types.split(",")) if types else frozenset())


def apply_frames(tokens: Sequence[Token], words: Words) -> list[Token]:
    """Return the tokens with every frame that fits read."""
    signs = words.lexicon.signs
    rewritten: list[Token] = []
    for sentence in sentences_of(correct(tokens, words.lexicon.sign("rethought"))):
        said, names = sentence, [_names(m, signs) for m in sentence]
        for frame in frames():
            here = frozenset().union(*names)
            if all(need & here for need in frame.needs):
                said, changed = _apply_frame(frame, said, names)
                names = [_names(m, signs) for m in said] if changed else names
        rewritten += said
    return rewritten


def correct(tokens: Sequence[Token], rethought: Collection[str]) -> list[Token]:
    """Put a count that takes back one of the same rooms in its place: "three bedrooms and two baths. No, wait, four bedrooms"; "One bath won't do, make that two"."""
    said = list(tokens)
    for k, token in enumerate(said):
        joined = k and said[k - 1].kind == "join"
        if token.kind == "fix" or (token.text in rethought and not joined):
            _take_back(said, k)
    return said


def _take_back(said: list[Token], k: int) -> None:
    """Let the counts in the sentence behind the correction at k replace those of the same rooms before it."""
    end = next((j for j in range(k + 1, len(said)) if said[j].kind in ENDS), len(said))
    begin = next((i + 1 for i in range(k - 1, -1, -1) if said[i].kind in ENDS), 0)
    for j in range(k + 1, end):
        if said[j].kind != "num" or (said[j - 1].kind, said[j - 1].value) == ("join", "and"):
            continue
        at_once = all(m.kind in BARE for m in said[k + 1 : j])
        room, named = _counted(said, j), None
        if at_once and not room:  # "make that two": of what this sentence named last
            named = next((i for i in range(k - 1, begin - 1, -1) if _counted(said, i)), None)
            room = "" if named is None else _counted(said, named)
        if not room or not (at_once or said[k].kind == "fix"):
            continue
        before = range((k if named is None else begin) - 1, -1, -1)
        old = next((i for i in before if _counted(said, i) == room and (i < begin or said[i].kind == "num")), None)
        if old is None:
            continue
        said[old] = replace(said[old], kind="num", value="", number=said[j].number)
        said[j] = replace(said[j], kind="det", value="all", number=0.0)
        if named is not None:
            said[named] = replace(said[named], kind="det", value="all", number=0.0)
            said[k : j + 1] = [replace(m, kind="fill", value="", number=0.0) for m in said[k : j + 1]]


def _counted(tokens: Sequence[Token], k: int) -> str:
    """Return which rooms the number or the article at k counts, "" for other tokens."""
    one = (tokens[k].kind, tokens[k].value) == ("pron", "one")
    counts = one or tokens[k].kind == "num" or (tokens[k].kind, tokens[k].value) == ("det", "indefinite")
    return next((m.value for m in tokens[k : phrase(tokens, k + one)] if m.kind in HEADS), "") if counts else ""


def _names(token: Token, signs: Mapping[str, frozenset[str]]) -> frozenset[str]:
    """Return all that an atom may call a token."""
    own = {token.kind, f"{token.kind}/{token.value}"}
    if token.kind == "room":
        own |= set() if token.plural else {"lone"}
        own.add("room/" + token.value.partition("/")[0])
    elif token.kind == "num":
        own |= {"zero"} if not token.number else {"two"} if token.number == 2.0 else set()
        own |= ({"many"} if token.number > 1.0 else set()) | ({"halved"} if token.number % 1.0 else set())
        own |= {"roomy"} if token.value == "figure" and token.number >= ROOMY else set()
    elif token.kind == "size" and token.number < 1.0:
        own.add("small")
    elif token.kind == "pron":
        own |= ({"some"} if token.number > 1.0 else set()) | ({"some_of"} if token.value == "some" else set())
    elif token.kind == "amount":
        own |= {"bounded"} if token.bound in {"least", "most"} else set()
        own |= {"plain_area"} if token.is_size else set()
        own |= {name for name, least in HOMES.items() if token.value == "area" and token.number >= least}
        if token.value == "rooms":
            own |= signs.get(token.text.rsplit(" ", 1)[-1], frozenset()) | ({"one_room"} if token.number == 1.0 else set())  # "3 ZKB"
    if token.number == 1.0 and token.kind in {"num", "pron", "ord"}:
        own.add("single")
    return signs.get(token.text, frozenset()) | own


def _apply_frame(frame: Frame, tokens: list[Token], names: Sequence[frozenset[str]]) -> tuple[list[Token], bool]:
    """Return a sentence with a frame read wherever it fits, and whether it did."""
    rewritten: list[Token] = []
    k = 0
    reader = _Reader(tokens, names, frame.atoms)
    while k < len(tokens):
        match = next(reader.fits(0, k, {}), None)
        if match is None or match[0] <= k:
            rewritten.append(tokens[k])
            k += 1
        else:
            end, slots = match
            rewritten += _read(frame, tokens, k, end, slots)
            k = end
    changed = len(rewritten) != len(tokens) or any(a is not b for a, b in zip(rewritten, tokens, strict=True))
    return (rewritten, True) if changed else (tokens, False)


@dataclass(frozen=True, slots=True)
class _Reader:
    tokens: Sequence[Token]
    names: Sequence[frozenset[str]]
    atoms: Sequence[Atom]

    def fits(self, i: int, k: int, slots: Slots) -> Iterator[tuple[int, Slots]]:
        """Yield where the atoms from i on may end when they begin at token k, with the places of the phrases."""
        if i == len(self.atoms):
            yield k, slots
            return
        atom = self.atoms[i]
        for start in range(k, min(k + (MOST_SKIPPED if i else 0), len(self.tokens)) + 1):
            if start > k and self.tokens[start - 1].kind not in SKIPPED:
                break
            for end in self._one(atom, start):
                yield from self.fits(i + 1, end, {**slots, atom.slot: (start, end)} if atom.slot else slots)
        if atom.optional:
            yield from self.fits(i + 1, k, slots)

    def _one(self, atom: Atom, k: int) -> Iterator[int]:
        """Yield where one atom ends that begins at token k."""
        if "^" in atom.names and (k == 0 or self.tokens[k - 1].kind in CLOSERS):
            yield k
        if "$" in atom.names and (k >= len(self.tokens) or self.tokens[k].kind in CLOSERS):
            yield k
        if k >= len(self.tokens):
            return
        if atom.names & self.names[k]:
            yield k + 1
        if atom.slot in PHRASES and (end := phrase(self.tokens, k)):
            head = next(m for m in self.tokens[k:end] if m.kind in HEADS)
            if not atom.types or ("bedroom" if head.kind == "suite" else head.value.partition("/")[0]) in atom.types:
                yield end
        elif atom.slot in LISTS:
            yield from reversed(list_ends(self.tokens, k, self.names)[atom.slot == "L" :])


def phrase(tokens: Sequence[Token], k: int) -> int:
    """Return where the noun phrase ends that begins at token k; 0 where none does."""
    while k < len(tokens) and (tokens[k].kind in LEADING or (tokens[k].kind == "amount" and tokens[k].value == "area")):
        k += 1
    if k >= len(tokens) or tokens[k].kind not in HEADS:
        return 0
    k += 1
    while k < len(tokens) and (tokens[k].kind in {"post", "clf"} or (tokens[k].kind, tokens[k].value) in TRAILING):
        k += 1
    return k


def list_ends(tokens: Sequence[Token], k: int, names: Sequence[frozenset[str]]) -> list[int]:
    """Return the ends of the lists of one, two, three ... noun phrases that begin at token k."""
    ends: list[int] = []
    while end := phrase(tokens, k):
        ends.append(end)
        k = end
        last = min(end + 4, len(tokens))
        while k < last and (tokens[k].kind in SEPARATORS or (k > end and names[k] & TOWARDS and not phrase(tokens, k))):
            k += 1
        if k == end:
            break
    return ends


def _read(frame: Frame, tokens: Sequence[Token], start: int, end: int, slots: Slots) -> Iterator[Token]:
    """Yield the reading of a frame that fits tokens[start:end]."""
    inside = {i for first, last in slots.values() for i in range(first, last)}
    words = [tokens[i] for i in range(start, end) if i not in inside] or list(tokens[start:end])
    first, last = words[0].first, words[-1].last
    for atom in frame.reading:
        slot, _, change = atom.partition(">")
        if slot in slots:
            a, b = slots[slot]
            kept = list(_items(tokens[a:b])) if slot in LISTS else tokens[a:b]
            other = tokens[slots[change[1:]][0]] if change[:1] in {"@", "="} else None
            if other is None:
                yield from (_change_token(m, change) for m in kept)
            else:
                said = {"number": other.number} if change[0] == "=" else {"value": f"bedroom/{other.value}"}
                yield from (replace(m, **said) for m in kept)
        elif not slot.islower() or "/" in slot or len(slot) > 1:
            what, _, text = atom.partition(":")
            what, _, number = what.partition("=")
            kind, _, value = what.partition("/")
            plain = " ".join(m.text for m in tokens[start:end]) if kind == "pron" else value or kind  # "the other two" keeps its number
            yield Token(kind, value, float(number or 0.0), False, first, last, text.replace("_", " ") or plain)


def _items(tokens: Sequence[Token]) -> Iterator[Token]:
    """Yield the phrases of a list and what parts them; "to" in front of each goes."""
    k = 0
    while k < len(tokens):
        end = phrase(tokens, k)
        if end:
            yield from tokens[k:end]
        elif tokens[k].kind in SEPARATORS and tokens[k].value != "to":
            yield tokens[k]
        k = end or k + 1


def _change_token(token: Token, change: str) -> Token:
    """Return a token read as something else."""
    if change == "bedroom":
        return replace(token, kind="room", value=f"bedroom/{token.value}", number=0.0, text=f"bedroom_{token.text}")
    kind, _, value = change.partition("/")
    number = float(int(max(token.number, 1.0))) if kind == "num" else token.number
    said: dict[str, Any] = {
        "flip": {"bound": "most" if token.bound == "least" else "least"},
        "less": {"number": token.number - 1},
        "total": {"total": True},
        "room": {"kind": "room"},
    }
    return replace(token, **said.get(change, {"kind": kind, "value": value, "number": number})) if change else token


# word order: relations in two parts


def join_brackets(tokens: Sequence[Token], words: Words) -> list[Token]:
    """Make one relation of its two parts: "an ... grenzt" stands where "an" stood."""
    reordered, lex = list(tokens), words.lexicon
    k = 0
    while k < len(reordered) if lex.frames else False:
        bracket = _bracket(reordered, k, lex)
        if bracket is not None:
            cue, start, second, end = bracket
            kind = "cmp" if cue in {"larger", "smaller"} else "cue"
            first = replace(reordered[k], kind=kind, value=cue, last=reordered[start - 1].last, number=0.0, only=reordered[k].only)
            inside = reordered[start:second]
            none = [inside.pop()] if inside and inside[-1].kind == "neg" else []  # "厨房与卧室不相通"
            reordered[k:end] = [*none, first, *inside, *(m for m in reordered[second:end] if m.kind in BREAKS)]
            k += len(none)
        k += 1
    return reordered


def _bracket(tokens: list[Token], k: int, lex: Lexicon) -> tuple[str, int, int, int] | None:
    """Return (relation, end of its first part, place and end of the second) of a bracket that begins at token k."""
    for first, second, cue in lex.frames.get(_bare(tokens[k].text, lex)[0], ()):
        start = _matches(tokens, k, first, lex)
        named = False
        for j in range(start, min(len(tokens), start + FARTHEST)) if start is not None else ():
            token, end = tokens[j], _matches(tokens, j, second, lex)
            comma = token.kind == "comma" and cue.startswith("thru")
            other = token.kind == "cue" and token.value not in {"has", "in", "door"} and end is None
            again = named and end is None and cue == "open" and _matches(tokens, j, first, lex) is not None
            if (token.kind in BREAKS and not comma) or other or again:
                break
            if named and end is not None and not _goes_on(tokens, end, second, lex):
                return cue, start or 0, j, end
            named = named or token.kind in {*HEADS, "pron", "every", "zone"}
    return None


def _goes_on(tokens: list[Token], end: int, second: tuple[str, ...], lex: Lexicon) -> bool:
    """Whether the second part has an object of its own: "ins Bad geht man über den Flur", "卫生间和洗衣房都不能挨着餐厅"."""
    if set(second) <= lex.sign("way_through"):
        return end < len(tokens) and tokens[end].kind not in BREAKS | {"join"}
    named = end < len(tokens) and tokens[end].kind in HEADS | {"num", "zone"}
    return named and "characters" in lex.traits and tokens[end - 1].kind == "cue"


def _matches(tokens: list[Token], k: int, wanted: tuple[str, ...], lex: Lexicon) -> int | None:
    """Return where the tokens go on after the words wanted, where they stand at k; adverbs between them are skipped."""
    need = list(wanted)
    while need and k < len(tokens):
        have = _bare(tokens[k].text, lex)
        if have == need[: len(have)]:
            need = need[len(have) :]
        elif have[: len(need)] == need and set(have[len(need) :]) <= lex.sign("article"):  # "in die Küche übergeht"
            need = []
        elif len(need) == len(wanted) or tokens[k].kind not in {"adverb", "flag", "comma"}:
            return None
        k += 1
    return None if need else k


def _bare(text: str, lex: Lexicon) -> list[str]:
    """Return the words of a token, prepositions without the article in them."""
    return [lex.compounds.melted.get(w, w) for w in text.split() or [""]]
