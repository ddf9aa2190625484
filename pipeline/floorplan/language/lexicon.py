"""The closed vocabulary of a language: phrases and what they mean, from `manifests/lexicon/*.yaml`.

A phrase is a run of folded words (`text.fold`). Sections give its kind; the longest phrase wins, earlier sections first. Code reads meanings
only: a language is this data. Where word order or inflection differ, its `traits` say so.
"""

from __future__ import annotations

import functools
import itertools
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError, model_validator

from pipeline import yaml_text
from pipeline.errors import ContentError
from pipeline.floorplan.language.text import Compounds, Plurals, Verbs, bare, characters, fold, forms, words
from pipeline.floorplan.program.floor_program import RoomType, Style
from pipeline.floorplan.program.furniture import lexicon as furniture

FOLDER = Path(__file__).resolve().parents[3] / "manifests" / "lexicon"
Language = str  # the name of a file there
LANGUAGES: tuple[Language, ...] = tuple(sorted(p.stem for p in FOLDER.glob("??.yaml")))
STRONG = frozenset({"room", "suite", "home"})


@functools.cache
def _classes() -> Mapping[str, frozenset[str]]:
    return {name: frozenset(some) for name, some in yaml_text.parse((FOLDER / "classes.yaml").read_text(encoding="utf-8")).items()}


def kinds(name: str) -> frozenset[str]:
    """Return a class of kinds of tokens, or of types of rooms."""
    return _classes()[name]


SECTIONS = {  # section of a file -> kind of token, the sections that win first
    "ignored": "ignored", "corrections": "fix", "enough": "enough", "wings": "wing", "zones": "zone", "activities": "activity", "rooms": "room",
    "suites": "suite", "homes": "home", "flags": "flag", "owners": "owner", "entrances": "enter", "outside": "outside", "needless": "needless",
    "negators": "neg", "pronouns": "pron", "everything": "every", "levels": "level", "comparisons": "cmp", "factors": "factor", "passages": "via",
    "cues": "cue", "conjugated": "", "reciprocal": "reciprocal", "numerals": "num", "ordinals": "ord", "units": "unit", "determiners": "det",
    "adjectives": "adj", "sizes": "size", "bounds": "bound", "but": "but", "joiners": "join", "times": "times", "lengths": "long",
    "relatives": "relative", "verbs": "verb", "classifiers": "clf", "styles": "look", "fillers": "fill", "adverbs": "adverb",
}  # fmt: skip
REPAIRED = {"room", "suite", "home", "num", "unit", "level", "zone"}  # kinds whose words are worth a repair
CUES = {"door", "leads", "open", "near", "away", "between", "avoid"}
FUNCTION = kinds("function")
COMMON = 0.15  # how much farther words are that are only known not to be errors
FARTHER = {True: 0.05, False: 0.1}  # words that build sentences, and those that mean nothing
CHOICES = re.compile(r"\[([^\]]*)\]|([^\[]+)")


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

    @model_validator(mode="after")
    def _known(self) -> _Look:
        Style.model_validate(self.knobs)
        return self


class _Entries(BaseModel):
    """One file of `manifests/lexicon`: how the language is written, and comma-separated phrases by section and meaning."""

    model_config = ConfigDict(extra="forbid")
    language: Language
    name: str  # in English
    traits: frozenset[str] = frozenset()  # how it is written, where rules differ
    plurals: Plurals = Plurals()
    compounds: Compounds = Compounds()
    verbs_of: Verbs = Verbs()
    spellings: dict[str, str] = {}  # other spellings of words
    behind: dict[str, dict[str, str]] = {}  # behind a word, how others are read that alone mean something else
    endings: str = ""
    abbreviations: str = ""
    range: dict[str, str] = {}
    frames: dict[str, str] = {}
    signs: dict[str, str] = {}  # closed classes of words that frames and readers know
    common: str = ""
    looks: tuple[_Look, ...] = ()
    phrases: dict[str, dict[Any, str]]  # by section and meaning

    @model_validator(mode="before")
    @classmethod
    def _sorted(cls, raw: dict[str, Any]) -> dict[str, Any]:
        """Put the sections of phrases in the order in which they win."""
        looks = raw.get("styles", [])
        entries = raw | {"styles": {k: look.get("words", "") for k, look in enumerate(looks)}}
        sections = {s: entries[s] if isinstance(entries[s], dict) else {"": entries[s]} for s in SECTIONS if s in entries}
        types = {part.split("/")[0] for key in sections["rooms"] for part in key.split("+")} - set(get_args(RoomType))
        if types:
            raise ValueError(f"no room type is called {', '.join(sorted(types))}: use the types of docs/floorplan.md")
        return {k: v for k, v in raw.items() if k not in SECTIONS} | {"phrases": sections, "looks": looks}


def split(text: str) -> Iterator[str]:
    """Return the phrases of an entry, parted by commas and ends of lines; "[a b][c d]" stands for ac, ad, bc and bd."""
    for phrase in (p for p in (q.strip() for q in re.split("[,\n]", text)) if p):
        if "[" in phrase:
            parts = [m.group(1).split() if m.group(1) else [m.group(2)] for m in CHOICES.finditer(phrase)]
            yield from map("".join, itertools.product(*parts))
        else:
            yield phrase


def _fold_words(text: str) -> frozenset[str]:
    return frozenset(fold(w) for w in split(text))


class Lexicon:
    """Phrases of one language as a trie over folded words, and the words that typing errors are repaired towards."""

    def __init__(self, entries: _Entries) -> None:
        verbs, phrases = entries.verbs_of, entries.phrases
        self.language, self.name, self.traits = entries.language, entries.name, entries.traits
        self.compounds, self.looks, self.behind = entries.compounds, entries.looks, entries.behind
        self.adverbs, self.abbreviations = _fold_words(phrases.get("adverbs", {}).get("", "")), _fold_words(entries.abbreviations)
        self.endings = tuple(sorted(split(entries.endings), key=len, reverse=True))
        self.range_from, self.range_to = (_fold_words(entries.range.get(side, "")) for side in ("from", "to"))
        self.bounds = {" ".join(words(p)): key for key, entry in phrases["bounds"].items() for p in split(entry)}
        self.joins = frozenset((",", *(w for entry in phrases["joiners"].values() for w in _fold_words(entry))))
        self.tenses = verbs.canonical() | entries.spellings  # forms of verbs -> the form that the phrases are made of
        self.vocabulary = {*self.tenses, *map(fold, verbs.further())}
        spelt = {sign: [s for p in split(entry) for s in _spellings(p, verbs.contracted)] for sign, entry in entries.signs.items()}
        self.classes = {sign: frozenset(" ".join(self._tense(s)) for s in some) for sign, some in spelt.items()}
        listed = {text for texts in self.classes.values() for text in texts}
        self.signs = {text: frozenset(sign for sign, texts in self.classes.items() if text in texts) for text in listed}
        self.trie: dict[str, Any] = {}
        self.frames = self._brackets(entries)  # relations in two parts, by the first word
        self._learn(entries)

    def sign(self, name: str) -> frozenset[str]:
        """Return the words of a closed class."""
        return self.classes.get(name, frozenset())

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
                only = only or word in self.sign("only")
                at += 1
            elif at > start and (word in {"-", "/"} or (word == "." and texts[at - 1] in self.abbreviations)):
                at += 1
            else:
                break
        return best

    def _tense(self, phrase: tuple[str, ...]) -> tuple[str, ...]:
        """Return a phrase with its verbs in the one form that they are read in."""
        return tuple(self.tenses.get(w, w) for w in phrase)

    def _insert(self, key: tuple[str, ...], meaning: Meaning) -> None:
        node = self.trie
        for word in key:
            node = node.setdefault(word, {})
        if key:
            node.setdefault("", meaning)

    def _brackets(self, entries: _Entries) -> dict[str, tuple[tuple[tuple[str, ...], tuple[str, ...], str], ...]]:
        """Return relations in two parts ("an ... grenzt") by their first word, the longest first."""
        pairs: dict[tuple[tuple[str, ...], ...], str] = {}
        for cue, phrases in entries.frames.items():
            for sides in (phrase.split("...") for phrase in split(phrases)):
                spelt = ([self._tense(w) for w in _spellings(side.strip(), {})] for side in sides)
                for pair in itertools.product(*spelt):
                    self.vocabulary.update(*pair)
                    pairs[tuple(tuple(self.compounds.melted.get(w, w) for w in side) for side in pair)] = cue
        longest = sorted(pairs.items(), key=lambda p: -len(p[0][0]) - len(p[0][1]))
        return {word: tuple((a, b, cue) for (a, b), cue in longest if a[0] == word) for word in {first[0] for first, _ in pairs}}

    def _learn(self, entries: _Entries) -> None:
        """Put all phrases into the trie, and sort words by how near a typing error must be to them."""
        targets: set[str] = set()
        others = dict.fromkeys((w for some in self.frames.values() for a, b, _ in some for w in (*a, *b)), FARTHER[True])
        for phrase, meaning in _meanings(entries):
            for spelt in _spellings(phrase, entries.verbs_of.contracted):
                self._insert(self._tense(spelt), meaning)
                self.vocabulary.update(spelt)
                if meaning.kind in REPAIRED or (meaning.kind == "cue" and meaning.value in CUES):
                    targets.update(w for w in spelt if w.isalpha() and len(w) >= 4)
                for w in spelt:
                    others[w] = min(FARTHER[meaning.kind in FUNCTION], others.get(w, 1.0))
        self.vocabulary.update(w for p in split(entries.common) for w in words(p))
        blocked = {w for entry in entries.phrases.get("fillers", {}).values() for p in split(entry) if " " not in p for w in words(p)}
        named = {w for entry in entries.phrases["rooms"].values() for p in split(entry.replace("|", ",")) for w in words(p)}
        self.targets = tuple(sorted(targets - blocked, key=lambda w: (w not in named, w)))  # names of rooms first
        others = dict.fromkeys(self.vocabulary, COMMON) | others
        others = dict.fromkeys(_things(self.language, entries.plurals), FARTHER[True]) | others
        self.strong = frozenset(self.targets)
        # how much farther an error is from these
        self.others = {w: far for w, far in others.items() if w not in self.strong and w.isalpha()}


def _meanings(e: _Entries) -> Iterator[tuple[str, Meaning]]:
    """Return every phrase with its meaning, the sections that win first."""
    for section, entry in e.phrases.items():
        for key, phrases in entry.items():
            kind, value, number = SECTIONS[section], str(key), float(key) if isinstance(key, (int, float)) else 0.0
            if section == "conjugated":
                kind, _, value = value.partition(" ")
            elif section == "units":
                value, factor = value.split()
                number = float(factor)
            for p in split(phrases):
                if kind in STRONG:
                    yield from ((form, Meaning(kind, value, plural=many and kind != "home")) for form, many in forms(e.plurals, p))
                else:
                    yield p, Meaning(kind, value, number)


def _spellings(phrase: str, contracted: Mapping[str, str]) -> Iterable[tuple[str, ...]]:
    """Return the words of a phrase, also as they look when umlauts and apostrophes are dropped, or its last word has an article in it."""
    usual = words(phrase)
    plain = usual if phrase.isascii() else words(bare(phrase))
    for short in (s for s in characters()["dropped"] if s in phrase):
        plain = words(phrase.replace(short, short.replace("'", "")))
    spellings = dict.fromkeys((usual, plain))
    if len(usual) > 1 and usual[-1] in contracted:  # "la mitad de" and "la mitad del"
        spellings |= dict.fromkeys((*p[:-1], contracted[p[-1]]) for p in (usual, plain))
    return spellings


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
        entries = _Entries.model_validate(yaml_text.parse(path.read_text(encoding="utf-8")))
    except (OSError, yaml.YAMLError, ValidationError, KeyError, AttributeError, TypeError) as error:
        raise ContentError(f"{path.name}: {' '.join(str(error).splitlines()[:3])}", "restore the file from the repository") from error
    return Lexicon(entries)


@functools.cache
def unread() -> frozenset[str]:
    """Return words of languages that are not read, and that look like none of those that are."""
    return frozenset(split(yaml_text.parse((FOLDER / "others.yaml").read_text(encoding="utf-8"))["others"]))


# furniture


@functools.lru_cache(maxsize=8192)
def stem(word: str) -> str:
    """Return a word without the endings that any of the languages may put to it."""
    endings = furniture()["endings"]
    for _ in range(2 if word.isalpha() else 0):
        word = word.removesuffix(next((e for e in endings if word.endswith(e) and len(word) - len(e) >= 3), ""))
    return word


def stemmed(form: str) -> tuple[str, ...]:
    """Return the stems of the words of a form; what stands before it tells that it needs an owner."""
    return tuple(map(stem, words(form.removeprefix("@"))))


@functools.cache
def furniture_phrases() -> Mapping[str, tuple[tuple[tuple[str, ...], str, str, bool, tuple[str, ...]], ...]]:
    """Return the phrases of wishes for furniture by first stem: (stems, kind, name, whether an owner is needed, words), the longest first."""
    data = furniture()
    listed = [("name", name, form) for name, forms in data["names"].items() for some in forms.values() for form in some]
    listed += [("small", form, form) for form in data["small"]]
    listed += [("look", name, form) for name, some in data["styles"].items() for form in some]
    listed += [(kind, str(form), str(form)) for kind, some in data["words"].items() for form in some if form != "-"]
    listed += [(kind, str(name), form) for kind in ("owner", "fraction") for name, some in data[f"{kind}s"].items() for form in some]
    table: dict[str, list[tuple[tuple[str, ...], str, str, bool, tuple[str, ...]]]] = {}
    for kind, name, form in listed:
        stems = stemmed(form)
        table.setdefault(stems[0], []).append((stems, kind, name, form.startswith("@"), words(form.removeprefix("@"))))
    return {k: tuple(sorted(v, key=lambda p: -len(p[0]))) for k, v in table.items()}


@functools.cache
def furniture_stems() -> frozenset[str]:
    """Return the stems of all words of wishes for furniture."""
    return frozenset(s for entries in furniture_phrases().values() for entry in entries for s in entry[0])


@functools.cache
def name_stems(name: str, language: str) -> frozenset[str]:
    """Return the first stems of what a language calls a thing."""
    return frozenset(stemmed(form)[0] for form in furniture()["names"].get(name, {}).get(language, ()))
