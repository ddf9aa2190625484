"""How a language makes plurals, compounds, number words and tenses, by the rules that its lexicon states."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping

from pydantic import BaseModel, ConfigDict

from pipeline.floorplan.language.text import fold

SHORTEST = 3  # letters of a part of a compound


class Plurals(BaseModel):
    """How a language makes plurals: `ends` tries patterns in turn on the last word, or (`every`) on every word but those of `fixed`."""

    model_config = ConfigDict(extra="forbid")
    ends: dict[str, str] = {}
    every: bool = False
    fixed: str = ""  # words that stay, e.g. prepositions
    heads: str = ""  # behind these the first word alone may change as well

    def of(self, phrase: str) -> Iterator[str]:
        """Yield the plurals of a phrase."""
        if not self.ends:
            return
        head, _, last = phrase.rpartition(" ")
        if not self.every:
            yield f"{head} {self._word(last)}".strip()
            return
        parts, fixed, heads = phrase.split(), set(self.fixed.split()), set(self.heads.split())
        yield " ".join(p if p in fixed else self._word(p) for p in parts)
        if len(parts) > 2 and parts[1] in heads:
            yield " ".join([self._word(parts[0]), *parts[1:]])

    def _word(self, word: str) -> str:
        return next((re.sub(end, made, word) for end, made in self.ends.items() if re.search(end, word)), word)


def forms(rule: Plurals, phrase: str) -> Iterator[tuple[str, bool]]:
    """Return (form, whether it is a plural) of an entry "singular|plural|plural"."""
    single, *many = phrase.split("|")
    yield single, False
    for form in many or rule.of(single):
        yield form, form != single


class Compounds(BaseModel):
    """How words are put together: what may stand at the joint, tails that a list shares, and the parts of numbers."""

    model_config = ConfigDict(extra="forbid")
    joints: tuple[str, ...] = ()
    tails: tuple[str, ...] = ()
    melted: dict[str, str] = {}  # prepositions with their article in one word
    ones: str = ""  # 1 within a number
    tens: str = ""  # of ones and tens: "{}und{}"
    hundreds: tuple[str, ...] = ()

    def numbers(self, simple: Mapping[float, str]) -> Iterator[tuple[str, int]]:
        """Yield the number words from 21 to 199 that are written together, e.g. "fünfundsiebzig", "hundertzwanzig"."""
        words = {int(n): entry.split(",")[0].strip() for n, entry in simple.items()}
        units = {n: self.ones if n == 1 else words[n] for n in range(1, 10)}
        below = {n: w for n, w in words.items() if 0 < n < 100}
        below |= {t + u: self.tens.format(units[u], words[t]) for t in range(20, 100, 10) for u in units}
        yield from ((w, n) for n, w in below.items() if n > 20)
        yield from ((start + w, 100 + n) for start in self.hundreds for n, w in below.items())

    def completed(self, texts: list[str], known: Collection[str], joins: Collection[str]) -> list[str]:
        """Return the words with "Arbeits- oder Gästezimmer" written out; the hyphen stays where it is."""
        made = list(texts)
        for k in range(len(texts) - 3 if self.tails else 0):
            if texts[k + 1] == "-" and texts[k + 2] in joins and texts[k].isalpha():
                last = next((t for t in texts[k + 3 :] if t.endswith(self.tails)), texts[k + 3])  # "Koch-, Ess- und Wohnbereich"
                tail = next((t for t in self.tails if last.endswith(t) and texts[k] + t in known), "")
                made[k] = texts[k] + tail
        return made

    def split(self, word: str, known: Collection[str], wanted: Collection[str]) -> tuple[str, ...]:
        """Split a compound into known words, one of them wanted; empty where it is none: "dreizimmerwohnung" is three words."""
        for cut in range(len(word) - SHORTEST, SHORTEST - 1, -1) if self.joints else ():
            head, rest = word[:cut], word[cut:]
            stem = next((head[: len(head) - len(j)] for j in self.joints if head.endswith(j) and head[: len(head) - len(j)] in known), None)
            if stem is None or len(stem) < SHORTEST:
                continue
            tail = (rest,) if rest in known else self.split(rest, known, wanted)
            if tail and (stem in wanted or any(t in wanted for t in tail)):
                return (stem, *tail)
        return ()


class Verbs(BaseModel):
    """The forms of verbs that a description uses, told from their infinitives; each is read as the present of the third person."""

    model_config = ConfigDict(extra="forbid")
    ends: dict[str, str] = {}  # of an infinitive -> of the third person of one, the present first; the longest that fits
    plural: str = ""  # what the forms of many have besides
    known: dict[str, str] = {}  # of an infinitive -> of forms that are only known not to be errors
    irregular: dict[str, str] = {}  # infinitive -> all its forms, "one|many" where the plural is another
    genders: str = ""  # of a participle, the one that is listed first
    reflexive: str = ""
    twofold: str = ""  # forms that are other words too
    contracted: dict[str, str] = {}  # prepositions with their article in one word

    def infinitive(self, word: str) -> bool:
        """Whether a word is an infinitive."""
        return word.endswith(tuple(self.ends))

    def forms(self, infinitive: str) -> list[tuple[str, str]]:
        """Return (of one, of many) for each tense of the third person, the present first: ("abre", "abren"), ("abrirá", "abrirán")."""
        told = self.irregular.get(infinitive)
        parted = (form.partition("|") for form in (told.split() if told else _with_ends(infinitive, self.ends)))
        return [(one, many or one + self.plural) for one, _, many in parted]

    def canonical(self, infinitives: Iterable[str]) -> dict[str, str]:
        """Return folded form -> folded form of the present, for every tense of these verbs; words that mean something else besides are left out."""
        made: dict[str, str] = {}
        twofold = set(self.twofold.split())
        for present, *others in map(self.forms, infinitives):
            for form, shown in ((fold(f), fold(s)) for pair in others for f, s in zip(pair, present, strict=True)):
                if form not in twofold and form != shown:
                    made.setdefault(form, shown)
        return made

    def further(self, infinitive: str) -> list[str]:
        """Return the present, gerunds, participles and forms of "we" and "I", which are only known not to be errors."""
        return [*self.forms(infinitive)[0], *_with_ends(infinitive, self.known)]

    def conjugated(self, phrase: str) -> Iterator[str]:
        """Yield "dar a" as "dar a", "da a", "da al", "se da a", "dan al" ...: the forms that are left, prepositions with their article too."""
        verb, _, rest = phrase.partition(" ")
        if not self.infinitive(verb):  # "conectado con": of one or many, of both genders
            first, *others = self.genders.split()
            head = next((w for w in phrase.split() if w.endswith(first) and len(w) > 4), "")
            for end in (first, *others) if head else ("",):
                yield from self._joined(phrase.replace(head, head.removesuffix(first) + end, 1) if head else phrase)
            return
        for form in (verb, *self.forms(verb)[0]):
            for end in self._joined(rest):
                yield f"{form} {end}".strip()
                yield (f"{form}{self.reflexive} {end}" if form == verb else f"{self.reflexive} {form} {end}").strip()

    def _joined(self, phrase: str) -> tuple[str, ...]:
        head, _, last = phrase.rpartition(" ")
        return (phrase, f"{head} {self.contracted[last]}".strip()) if last in self.contracted else (phrase,)


def _with_ends(infinitive: str, table: Mapping[str, str]) -> list[str]:
    """Return the forms of a verb that a table of ends gives: those of the longest end that it has."""
    last = max((end for end in table if infinitive.endswith(end)), key=len, default="")
    return [infinitive.removesuffix(last) + end for end in table[last].split()] if last else []
