"""How a language makes plurals, compounds, number words and tenses, by the rules that its lexicon states."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping

from pydantic import BaseModel, ConfigDict

from pipeline.floorplan.language.text import fold

SHORTEST = 3  # letters of a part of a compound
INFINITIVE = re.compile(r"\w+[aeií]r(se)?")


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
    """The forms of Romance verbs that a description uses, told from their infinitives; each is read as the present of the third person."""

    model_config = ConfigDict(extra="forbid")
    irregular: dict[str, tuple[str, str, str, str]] = {}  # stem of the present, of the subjunctive, of the future, of the preterite
    odd: dict[str, tuple[str, str]] = {}  # of the third persons: present, other tenses
    soft: dict[str, str] = {}  # the last letter of a stem in front of an e
    twofold: str = ""  # forms that are other words too
    contracted: dict[str, str] = {}  # prepositions with their article in one word

    def present(self, infinitive: str) -> tuple[str, str]:
        """Return the third persons of the present: "abre", "abren"."""
        if infinitive in self.odd:
            one, many = self.odd[infinitive][0].split()
            return one, many
        stem = self.irregular.get(infinitive, ("",) * 4)[0] or infinitive[:-2]
        vowel = "a" if infinitive.endswith("ar") else "e"
        return stem + vowel, stem + vowel + "n"

    def _tenses(self, infinitive: str) -> Iterator[tuple[str, str]]:
        """Yield (form, form of the present) of the third persons: "abrirán", "abren"."""
        one, many = self.present(infinitive)
        if infinitive in self.odd:
            yield from ((form, many if form.endswith("n") else one) for form in self.odd[infinitive][1].split())
            return
        kind, stem = infinitive[-2:], infinitive[:-2]
        _, wish, future, past = self.irregular.get(infinitive, ("",) * 4)
        wish = wish or one[:-1]
        last = wish[-1]
        regular = {"g": "j"}.get(last, last) if infinitive not in self.irregular else last
        made = [wish[:-1] + (self.soft.get(last, last) if kind == "ar" else regular) + ("e" if kind == "ar" else "a")]
        made += [(future or infinitive) + end for end in ("á", "ía")]
        made += [stem + end for end in (("aba", "ara", "ase") if kind == "ar" else ("ía",))]
        made += [] if kind == "ar" else [(past or stem) + end.removeprefix("i" if past.endswith("j") else "-") for end in ("iera", "iese")]
        for form in made:
            yield form, one
            yield form + "n", many

    def canonical(self, infinitives: Iterable[str]) -> dict[str, str]:
        """Return folded form -> folded form of the present, for every tense of these verbs; words that mean something else besides are left out."""
        made: dict[str, str] = {}
        twofold = set(self.twofold.split())
        for form, shown in (pair for verb in infinitives for pair in self._tenses(verb)):
            word = fold(form)
            if word not in twofold and word != fold(shown):
                made.setdefault(word, fold(shown))
        return made

    def further(self, infinitive: str) -> Iterator[str]:
        """Yield the gerund, the participles and the forms of "we" and "I", which are only known not to be errors."""
        stem, kind = infinitive[:-2], infinitive[-2:]
        yield stem + ("ando" if kind == "ar" else "iendo")
        yield from (stem + ("ad" if kind == "ar" else "id") + end for end in ("o", "a", "os", "as"))
        yield from (self.present(infinitive)[0][:-1] + "o", stem + {"ar": "amos", "er": "emos"}.get(kind, "imos"))
        yield from (infinitive + end for end in ("emos", "íamos", "se", "lo", "la", "los", "las"))
        yield stem + ("ábamos" if kind == "ar" else "íamos")

    def conjugated(self, phrase: str) -> Iterator[str]:
        """Yield "dar a" as "dar a", "da a", "da al", "se da a", "dan al" ...: the forms that are left, prepositions with their article too."""
        verb, _, rest = phrase.partition(" ")
        if not verb.endswith(("ar", "er", "ir", "ír")):  # "conectado con": of one or many, of both genders
            head = next((w for w in phrase.split() if w.endswith("o") and len(w) > 4), "")
            for end in ("o", "a", "os", "as") if head else ("",):
                yield from self._joined(phrase.replace(head, head[:-1] + end, 1) if head else phrase)
            if head == "" and verb.endswith("e"):
                yield from self.conjugated(phrase.replace(verb, verb + "s", 1))
            return
        for form in (verb, *self.present(verb)):
            for end in self._joined(rest):
                yield f"{form} {end}".strip()
                yield (f"{form}se {end}" if form == verb else f"se {form} {end}").strip()

    def _joined(self, phrase: str) -> tuple[str, ...]:
        head, _, last = phrase.rpartition(" ")
        return (phrase, f"{head} {self.contracted[last]}".strip()) if last in self.contracted else (phrase,)
