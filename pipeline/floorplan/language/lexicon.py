"""The closed vocabulary of a language: phrases and what they mean, from `manifests/lexicon/*.yaml`.

A phrase is a run of folded words (`text.fold`). Sections give its kind; the longest phrase wins, earlier sections first. Language-free code
reads meanings only: a language is this data and, where word order or inflection differ, one module of rules.
"""

from __future__ import annotations

import functools
import itertools
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, get_args

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError

from pipeline import yaml_text
from pipeline.errors import ContentError
from pipeline.floorplan.language.text import INFINITIVE, Compounds, Plurals, Verbs, bare, fold, forms, words
from pipeline.floorplan.program.floor_program import RoomType, Style
from pipeline.floorplan.program.furniture import lexicon as furniture

FOLDER = Path(__file__).resolve().parents[3] / "manifests" / "lexicon"
Language = str  # the name of a file there
LANGUAGES: tuple[Language, ...] = tuple(sorted(p.stem for p in FOLDER.glob("??.yaml")))
Phrases = Mapping[str | int | float, str]
STRONG = frozenset({"room", "suite", "home"})


@dataclass(frozen=True, slots=True)
class Meaning:
    """What a phrase means: its kind (section of the lexicon), a value within it, a number where there is one."""

    kind: str
    value: str = ""
    number: float = 0.0
    plural: bool = False


class _Look(BaseModel):
    """Words of mood, and the knobs that they turn."""

    model_config = ConfigDict(extra="forbid")
    words: str
    knobs: dict[str, int]
    nonrect: int = 0


class _Entries(BaseModel):
    """One file of `manifests/lexicon`: comma-separated phrases by section and meaning."""

    model_config = ConfigDict(extra="forbid")
    language: Language
    name: str  # in English
    traits: frozenset[str] = frozenset()  # how it is written, where rules differ
    plurals: Plurals = Plurals()
    compounds: Compounds = Compounds()
    verbs_of: Verbs = Verbs()
    spellings: dict[str, str] = {}  # other spellings of words
    sounds: tuple[tuple[str, str], ...] = ()  # what is written, and how it sounds
    homophones: dict[str, str] = {}  # characters that are written for one another
    rooms: dict[str, str]
    suites: dict[str, str] = {}
    homes: dict[str, str]
    kitchen_diner: str = ""
    functions: dict[str, str] = {}
    numerals: dict[float, str]
    ordinals: dict[int, str] = {}
    units: dict[str, str]
    bounds: dict[str, str]
    range: dict[str, str]
    cues: dict[str, str]
    reciprocal: str = ""
    passages: dict[str, str] = {}
    frames: dict[str, str] = {}
    negators: str
    needless: str = ""
    corrections: str = ""
    enough: str = ""
    but: str = ""
    determiners: dict[str, str]
    pronouns: dict[str, str] = {}
    everything: str = ""
    zones: dict[str, str] = {}
    wings: dict[str, str] = {}
    activities: dict[str, str] = {}
    adjectives: dict[str, str] = {}
    sizes: dict[float, str] = {}
    owners: dict[str, str] = {}
    levels: dict[int, str] = {}
    entrances: str = ""
    outside: str = ""
    comparisons: dict[str, str] = {}
    factors: dict[float, str] = {}
    times: str = ""
    lengths: str = ""
    styles: list[_Look] = []
    flags: dict[str, str] = {}
    joiners: dict[str, str]
    verbs: str = ""
    conjugated: dict[str, str] = {}
    relatives: str = ""
    adverbs: str = ""
    classifiers: str = ""
    endings: str = ""
    signs: dict[str, str] = {}
    abbreviations: str = ""
    fillers: str = ""
    ignored: str = ""
    common: str = ""


CHOICES = re.compile(r"\[([^\]]*)\]|([^\[]+)")


def split(text: str) -> Iterator[str]:
    """Return the phrases of a comma-separated entry; "[a b][c d]" stands for ac, ad, bc and bd."""
    for phrase in (p for p in (q.strip() for q in text.split(",")) if p):
        if "[" in phrase:
            parts = [m.group(1).split() if m.group(1) else [m.group(2)] for m in CHOICES.finditer(phrase)]
            yield from map("".join, itertools.product(*parts))
        else:
            yield phrase


@dataclass
class Lexicon:
    """Phrases of one language as a trie over folded words, and the words that typing errors are repaired towards."""

    language: Language
    name: str = ""
    traits: frozenset[str] = frozenset()
    compounds: Compounds = field(default_factory=Compounds)
    sounds: tuple[tuple[str, str], ...] = ()
    trie: dict[str, Any] = field(default_factory=dict)
    vocabulary: set[str] = field(default_factory=set)
    targets: tuple[str, ...] = ()
    others: Mapping[str, float] = field(default_factory=dict)  # all other words of it -> how much farther a typing error is from them
    adverbs: frozenset[str] = frozenset()
    endings: tuple[str, ...] = ()
    abbreviations: frozenset[str] = frozenset()
    frames: Mapping[str, tuple[tuple[tuple[str, ...], tuple[str, ...], str], ...]] = field(default_factory=dict)  # by the first word
    looks: tuple[_Look, ...] = ()
    range_from: frozenset[str] = frozenset()
    range_to: frozenset[str] = frozenset()
    bounds: Mapping[str, str] = field(default_factory=dict)
    joins: frozenset[str] = frozenset()
    signs: Mapping[str, frozenset[str]] = field(default_factory=dict)  # words -> the closed classes that frames know them by
    tenses: Mapping[str, str] = field(default_factory=dict)  # forms of verbs -> the form that the phrases are made of

    def find(self, texts: list[str], start: int) -> tuple[int, Meaning, bool] | None:
        """Return (end, meaning, whether "only" was skipped) of the longest phrase at a word, adverbs inside it skipped."""
        node, best, at, only = self.trie, None, start, False
        while at < len(texts):
            word = texts[at]
            if word in node:
                node = node[word]
                at += 1
                if "" in node:
                    best = (at, node[""], only)
            elif at > start and word in self.adverbs:
                only = only or word in ONLY
                at += 1
            elif word in {"-", "/"} and at > start:
                at += 1
            else:
                break
        return best


ONLY = frozenset({"only", "nur", "solo", "solamente", "只", "仅", "ausschliesslich", "unicamente"})


def _meanings(e: _Entries) -> Iterator[tuple[str, Meaning]]:  # noqa: C901, PLR0912, PLR0915 - one loop per section
    """Return every phrase with its meaning, the sections that win first."""

    def flat(kind: str, entry: str) -> Iterator[tuple[str, Meaning]]:
        return ((p, Meaning(kind)) for p in split(entry))

    def keyed(kind: str, entry: Mapping[Any, str]) -> Iterator[tuple[str, Meaning]]:
        for key, phrases in entry.items():
            number = float(key) if isinstance(key, (int, float)) else 0.0
            for p in split(phrases):
                yield p, Meaning(kind, str(key), number)

    yield from flat("ignored", e.ignored)
    yield from flat("fix", e.corrections)
    yield from flat("enough", e.enough)
    yield from keyed("wing", e.wings)
    yield from keyed("zone", e.zones)
    yield from keyed("activity", e.activities)
    for key, phrases in e.rooms.items():
        for p in split(phrases):
            for form, many in forms(e.plurals, p):
                yield form, Meaning("room", key, plural=many)
    for p in split(e.kitchen_diner):
        yield p, Meaning("room", "kitchen/diner")
    for key, phrases in e.suites.items():
        for p in split(phrases):
            for form, many in forms(e.plurals, p):
                yield form, Meaning("suite", key, plural=many)
    for key, phrases in e.homes.items():
        for p in split(phrases):
            for form, _ in forms(e.plurals, p):
                yield form, Meaning("home", key)
    yield from keyed("flag", e.flags)
    yield from keyed("owner", e.owners)
    yield from flat("enter", e.entrances)
    yield from flat("outside", e.outside)
    yield from flat("needless", e.needless)
    yield from flat("neg", e.negators)
    yield from keyed("pron", e.pronouns)
    yield from flat("every", e.everything)
    yield from keyed("level", e.levels)
    yield from keyed("cmp", e.comparisons)
    yield from keyed("factor", e.factors)
    yield from keyed("via", e.passages)
    yield from keyed("cue", e.cues)
    for key, phrases in e.conjugated.items():
        kind, _, value = key.partition(" ")
        yield from ((form, Meaning(kind, value)) for p in split(phrases) if kind != "known" for form in e.verbs_of.conjugated(p))
    yield from flat("reciprocal", e.reciprocal)
    yield from keyed("num", e.numerals)
    if e.compounds.tens:
        yield from ((w, Meaning("num", str(n), float(n))) for w, n in e.compounds.numbers(e.numerals))
    yield from keyed("ord", e.ordinals)
    for key, phrases in e.units.items():
        quantity, factor = key.split()
        for p in split(phrases):
            yield p, Meaning("unit", quantity, float(factor))
    yield from keyed("det", e.determiners)
    yield from keyed("adj", e.adjectives)
    yield from keyed("size", e.sizes)
    yield from keyed("bound", e.bounds)
    yield from flat("but", e.but)
    yield from keyed("join", e.joiners)
    yield from flat("times", e.times)
    yield from flat("long", e.lengths)
    yield from flat("relative", e.relatives)
    yield from flat("verb", e.verbs)
    yield from flat("clf", e.classifiers)
    for k, look in enumerate(e.styles):
        yield from ((p, Meaning("look", str(k))) for p in split(look.words))
    yield from flat("fill", e.fillers)
    yield from flat("adverb", e.adverbs)


def _spellings(phrase: str, contracted: Mapping[str, str]) -> Iterable[tuple[str, ...]]:
    """Return the words of a phrase, also as they look when umlauts and apostrophes are dropped, or its last word has an article in it."""
    usual = words(phrase)
    plain = usual if phrase.isascii() else words(bare(phrase))
    if "n't" in phrase:
        plain = words(phrase.replace("n't", "nt"))
    made = dict.fromkeys((usual, plain))
    if len(usual) > 1 and usual[-1] in contracted:  # "la mitad de" and "la mitad del"
        made |= dict.fromkeys((*p[:-1], contracted[p[-1]]) for p in (usual, plain))
    return made


def _misheard(e: _Entries) -> Iterator[tuple[str, Meaning]]:
    """Return the names of rooms as they are written when one character is taken for another of the same sound."""
    for phrase, meaning in _meanings(e):
        for k, char in enumerate(phrase if meaning.kind == "room" and 1 < len(phrase) < 4 else ""):
            yield from ((phrase[:k] + wrong + phrase[k + 1 :], meaning) for wrong in e.homophones.get(char, ""))
            if k and len(phrase) == 3:  # two exchanged: "卫间生"
                yield phrase[: k - 1] + char + phrase[k - 1] + phrase[k + 1 :], meaning
            if k + 1 < len(phrase):  # one twice: "客客厅"
                yield phrase[:k] + char + phrase[k:], meaning


REPAIRED = {"room", "suite", "home", "num", "unit", "level", "zone"}  # kinds whose words are worth a repair
CUES = {"door", "leads", "open", "near", "away", "between", "avoid"}
FUNCTION = {
    "cue",
    "neg",
    "det",
    "pron",
    "adj",
    "size",
    "cmp",
    "factor",
    "bound",
    "join",
    "flag",
    "relative",
    "every",
    "owner",
    "via",
    "enter",
    "room",
}
COMMON = 0.15  # words that are only known not to be errors
FARTHER = {True: 0.05, False: 0.1}  # words that build sentences, and those that mean nothing


def _things(language: Language, rule: Plurals) -> set[str]:
    """Return the words for furniture, which a typing error may as well be made in."""
    names: Iterable[Mapping[str, Iterable[str]]] = furniture()["names"].values()
    listed = (phrase.removeprefix("@") for named in names for phrase in named.get(language, ()))
    return {w for phrase in listed for form, _ in forms(rule, phrase) for w in words(form) if len(w) > 3}


@functools.cache
def lexicon(language: Language) -> Lexicon:
    """Return the lexicon of a language. Raises ContentError when its file is not as described."""
    path = FOLDER / f"{language}.yaml"
    try:
        raw = yaml_text.parse(path.read_text(encoding="utf-8"))
        entries = _Entries.model_validate(raw)
        for key in entries.rooms:
            if not {part.split("/")[0] for part in key.split("+")} <= set(get_args(RoomType)):
                raise ContentError(f"{path.name}: no room type is called {key!r}", "use the types of docs/floorplan.md")
        for look in entries.styles:
            Style.model_validate(look.knobs)
    except (OSError, yaml.YAMLError, ValidationError) as error:
        raise ContentError(f"{path.name}: {str(error).splitlines()[0]}", "restore the file from the repository") from error
    verbs = entries.verbs_of
    infinitives = sorted(
        {p.split()[0] for phrases in entries.conjugated.values() for p in split(phrases) if INFINITIVE.fullmatch(p.split()[0])}
    )
    made = Lexicon(language, entries.name, entries.traits, tenses=verbs.canonical(infinitives) | entries.spellings)
    made.compounds, made.sounds = entries.compounds, entries.sounds
    made.vocabulary.update(made.tenses, (fold(w) for verb in infinitives for w in (verb, *verbs.present(verb), *verbs.further(verb))))
    targets: set[str] = set()
    others: dict[str, float] = {}
    for phrase, meaning in _meanings(entries):
        for spelt in _spellings(phrase, verbs.contracted):
            _insert(made.trie, _told(spelt, made), meaning)
            made.vocabulary.update(spelt)
            if meaning.kind in REPAIRED or (meaning.kind == "cue" and meaning.value in CUES):
                targets.update(w for w in spelt if w.isalpha() and len(w) >= 4)
            for w in spelt:
                others[w] = min(FARTHER[meaning.kind in FUNCTION], others.get(w, 1.0))
    for wrong, meaning in _misheard(entries) if entries.homophones else ():
        _insert(made.trie, words(wrong), meaning)
    made.vocabulary.update(w for p in split(entries.common) for w in words(p))
    blocked = {w for p in split(entries.fillers) if " " not in p for w in words(p)}
    named = {w for phrases in entries.rooms.values() for p in split(phrases.replace("|", ",")) for w in words(p)}
    made.targets = tuple(sorted(targets - blocked, key=lambda w: (w not in named, w)))  # names of rooms first
    made.adverbs = frozenset(fold(w) for w in split(entries.adverbs))
    made.endings = tuple(sorted(split(entries.endings), key=len, reverse=True))
    made.abbreviations = frozenset(fold(w) for w in split(entries.abbreviations))
    made.looks = tuple(entries.styles)
    made.range_from = frozenset(fold(w) for w in split(entries.range.get("from", "")))
    made.range_to = frozenset(fold(w) for w in split(entries.range.get("to", "")))
    made.bounds = {" ".join(words(p)): key for key, phrases in entries.bounds.items() for p in split(phrases)}
    made.joins = frozenset((",", *(fold(w) for phrases in entries.joiners.values() for w in split(phrases))))
    made.signs = _signs(entries, made)
    others |= _brackets(entries, made)
    others |= {w: COMMON for w in made.vocabulary if w not in others}
    others = dict.fromkeys(_things(language, entries.plurals), FARTHER[True]) | others
    spared = set(made.targets)
    made.others = {w: far for w, far in others.items() if w not in spared and w.isalpha()}
    return made


@functools.cache
def unread() -> frozenset[str]:
    """Return words of languages that are not read, and that look like none of those that are."""
    return frozenset(split(yaml_text.parse((FOLDER / "others.yaml").read_text(encoding="utf-8"))["others"]))


def _signs(entries: _Entries, lex: Lexicon) -> dict[str, frozenset[str]]:
    """Return the classes that the words of frames belong to."""
    signs: dict[str, set[str]] = {}
    for sign, phrases in entries.signs.items():
        for p in split(phrases):
            for spelt in _spellings(p, entries.verbs_of.contracted):
                signs.setdefault(" ".join(_told(spelt, lex)), set()).add(sign)
    return {text: frozenset(named) for text, named in signs.items()}


def _brackets(entries: _Entries, lex: Lexicon) -> dict[str, float]:
    """Read cues in two parts into a lexicon ("an ... grenzt"); return their words, which build sentences."""
    pairs = []
    for cue, phrases in entries.frames.items():
        for phrase in split(phrases):
            first, second = phrase.split("...")
            for a in _spellings(first.strip(), {}):
                pairs += [(_told(a, lex), _told(b, lex), cue) for b in _spellings(second.strip(), {})]
    pairs.sort(key=lambda f: -len(f[0]) - len(f[1]))
    lex.frames = {word: tuple(f for f in pairs if f[0][0] == word) for word in {f[0][0] for f in pairs}}
    lex.vocabulary.update(w for a, b, _ in pairs for w in (*a, *b))
    return {w: FARTHER[True] for a, b, _ in pairs for w in (*a, *b)}


def _told(phrase: tuple[str, ...], lex: Lexicon) -> tuple[str, ...]:
    """Return a phrase with its verbs in the one form that they are read in."""
    return tuple(lex.tenses.get(w, w) for w in phrase)


def _insert(trie: dict[str, Any], key: tuple[str, ...], meaning: Meaning) -> None:
    node = trie
    for word in key:
        node = node.setdefault(word, {})
    if key:
        node.setdefault("", meaning)
