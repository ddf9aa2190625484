"""Wishes for furniture in words: how many things, which, in what style, what opens, how much floor stays free.

They are read before the rooms are, in all four languages at once, and taken out of the prompt: what is left speaks of rooms alone. Which
room a wish means is settled afterwards (`attaching.py`), when the rooms and their places in the prompt are known.
"""

from __future__ import annotations

import functools
import re
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from pipeline.floorplan.furniture import lexicon

Kind = Literal["count", "pieces", "openable", "walkable", "style"]
HAN = "\u3400-\u9fff"
WORD = re.compile(rf"\d+(?:[.,]\d+)?|[{HAN}]|[^\W\d_{HAN}]+(?:'[^\W\d_]+)?|[%.,;:!?()\n+&、。;,!?]")
STOPS = frozenset(".;!?\n。;!?")
ENDINGS = ("en", "es", "as", "os", "em", "e", "n", "s", "a", "o")
NUMBERS = {
    "zero": 0, "one": 1, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "seven": 7, "eight": 8, "nine": 9, "ten": 10, "eleven": 11, "twelve": 12,
    "thirteen": 13, "fourteen": 14, "fifteen": 15, "sixteen": 16, "seventeen": 17, "eighteen": 18, "nineteen": 19, "twenty": 20, "thirty": 30,
    "forty": 40, "fifty": 50, "sixty": 60, "seventy": 70, "eighty": 80, "ninety": 90, "pair": 2, "couple": 2, "dozen": 12,
    "eins": 1, "zwei": 2, "drei": 3, "vier": 4, "funf": 5, "sechs": 6, "sieben": 7, "acht": 8, "neun": 9, "zehn": 10, "elf": 11, "zwolf": 12,
    "dreizehn": 13, "vierzehn": 14, "funfzehn": 15, "sechzehn": 16, "zwanzig": 20, "dreissig": 30, "vierzig": 40, "funfzig": 50, "sechzig": 60,
    "siebzig": 70, "achtzig": 80, "neunzig": 90,
    "dos": 2, "tres": 3, "cuatro": 4, "cinco": 5, "seis": 6, "siete": 7, "ocho": 8, "nueve": 9, "diez": 10, "once": 11, "doce": 12, "trece": 13,
    "catorce": 14, "quince": 15, "dieciseis": 16, "veinte": 20, "treinta": 30, "cuarenta": 40, "cincuenta": 50, "sesenta": 60, "setenta": 70,
    "ochenta": 80, "noventa": 90,
}  # fmt: skip
HAN_DIGITS = {c: k for k, c in enumerate("零一二三四五六七八九")} | {"两": 2, "俩": 2}
ROOMS = frozenset({"room", "rooms", "area", "corner", "niche", "nook", "zone", "space", "raum", "ecke", "bereich"})
LEAST_TYPO = 6  # letters of a word that may hold a typing error


@dataclass(frozen=True, slots=True)
class Word:
    """A word, folded (no accents, lower case), its stem, and its place in the prompt."""

    text: str
    stem: str
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Claim:
    """One wish: prompt[start:end] asks for `least` to `most` of `name`, a style `name`, or a share `value` of free floor.

    `home`: for the whole home. `inward`: what follows says where ("two chairs in the kitchen").
    """

    kind: Kind
    start: int
    end: int
    name: str = ""
    least: int = 0
    most: int | None = None
    value: float = 0.0
    home: bool = False
    inward: bool = False


def fold(text: str) -> str:
    """Return lower case without accents; sharp s as ss."""
    lower = unicodedata.normalize("NFKC", text).lower().replace("ß", "ss")
    return "".join(c for c in unicodedata.normalize("NFD", lower) if not unicodedata.combining(c))


def stem(word: str) -> str:
    """Return a folded word without the endings of plurals, cases and genders of English, German and Spanish."""
    for _ in range(2):
        cut = next((e for e in ENDINGS if word.endswith(e) and len(word) - len(e) >= 3), "")
        word = word.removesuffix(cut) if cut else word
    return word


def words(text: str) -> list[Word]:
    """Split a text; Chinese into single characters. Hyphens part words."""
    found = []
    for match in WORD.finditer(text):
        folded = fold(match.group())
        found.append(Word(folded, stem(folded) if folded.isalpha() else folded, match.start(), match.end()))
    return found


@functools.cache
def phrases() -> Mapping[str, tuple[tuple[tuple[str, ...], str, str, bool], ...]]:
    """Return by first stem: (stems, kind, name, whether an owner is needed), the longest first."""
    table: dict[str, list[tuple[tuple[str, ...], str, str, bool]]] = {}

    def add(form: str, kind: str, name: str) -> None:
        owned = form.startswith("@")
        stems = tuple(w.stem for w in words(form.removeprefix("@")))
        table.setdefault(stems[0], []).append((stems, kind, name, owned))

    data = lexicon()
    for name, forms in data["names"].items():
        for listed in forms.values():
            for form in listed:
                add(form, "name", name)
    for name, listed in data["styles"].items():
        for form in listed:
            add(form, "look", name)
    for name, listed in data["words"].items():
        for form in listed:
            if form != "-":
                add(str(form), name, form)
    for name, listed in data["owners"].items():
        for form in listed:
            add(form, "owner", name)
    return {k: tuple(sorted(v, key=lambda p: -len(p[0]))) for k, v in table.items()}


class Scan:
    """Reads claims from left to right."""

    def __init__(self, prompt: str) -> None:
        self.prompt = prompt
        self.words = words(prompt)
        self.claims: list[Claim] = []
        self.negated = False  # "no TV or armchairs": the negation goes on

    def phrase(self, k: int, *kinds: str) -> tuple[int, str]:
        """Return (length, name) of the longest phrase of those kinds at word k, (0, "") where there is none."""
        if not 0 <= k < len(self.words):
            return 0, ""
        for stems, kind, name, owned in phrases().get(self.words[k].stem, ()):
            if kind in kinds and tuple(w.stem for w in self.words[k : k + len(stems)]) == stems and (not owned or self._owned(k, name)):
                return len(stems), name
        return 0, ""

    def _owned(self, k: int, name: str) -> bool:
        """Whether a room that has such things is named before word k in the same clause, or right after it."""
        near = range(max(0, k - 14), k)
        stop = max((j for j in near if self.words[j].text in STOPS), default=-1)
        if any(self._owner(j, name) for j in near if j > stop):
            return True
        return any(self.phrase(j, "in")[0] and any(self._owner(j + d, name) for d in (1, 2, 3)) for j in (k + 1,))

    def _owner(self, k: int, name: str) -> bool:
        if not 0 <= k < len(self.words):
            return False
        for stems, kind, of, _ in phrases().get(self.words[k].stem, ()):
            if kind == "owner" and of == name and tuple(w.stem for w in self.words[k : k + len(stems)]) == stems:
                return True
        return False

    def number(self, k: int) -> tuple[int, float | None]:
        """Return (length, value) of a numeral at word k; of "8 to 10" only the first is read here."""
        if not 0 <= k < len(self.words):
            return 0, None
        text = self.words[k].text
        if text[0].isdigit():
            return 1, float(text.replace(",", "."))
        if text in NUMBERS:
            tens = NUMBERS[text]
            ones = NUMBERS.get(self.words[k + 1].text, 0) if tens >= 20 and k + 1 < len(self.words) else 0
            return (2, float(tens + ones)) if 0 < ones < 10 else (1, float(tens))
        return self._han(k)

    def _han(self, k: int) -> tuple[int, float | None]:
        run = ""
        while k + len(run) < len(self.words) and self.words[k + len(run)].text in {*HAN_DIGITS, "十"}:
            run += self.words[k + len(run)].text
        if not run:
            return 0, None
        if "十" in run:
            tens, _, ones = run.partition("十")
            return len(run), float(10 * HAN_DIGITS.get(tens, 1) + HAN_DIGITS.get(ones, 0))
        return len(run), float("".join(str(HAN_DIGITS[c]) for c in run))

    def amount(self, k: int) -> tuple[int, int, int | None] | None:
        """Return (length, least, most) of an amount at word k: bounds, ranges, articles, negations."""
        size, _ = self.phrase(k, "least", "most", "exactly", "between")
        bound = next((b for b in ("least", "most", "exactly", "between") if self.phrase(k, b)[0]), "")
        if bound:  # 至少放三件
            size += self.phrase(k + size, "with", "article")[0]
        length, value = self.number(k + size)
        if value is None:
            if not bound and (none := self.phrase(k, "none")[0]):
                return none + self._filler(k + none), 0, 0
            if not bound and (one := self.phrase(k, "one")[0]):
                return one + self._filler(k + one), 1, None
            return None
        k2 = k + size + length
        first, last = int(value), int(value)
        joint, _ = self.phrase(k2, "to")
        further, upper = (
            self.number(k2 + joint) if joint and (bound == "between" or self.words[k2].text not in {"and", "und", "y", "a"}) else (0, None)
        )
        hyphen = not joint and k2 < len(self.words) and "-" in self.prompt[self.words[k2 - 1].end : self.words[k2].start]
        if hyphen:
            further, upper = self.number(k2)
        if upper is not None:
            last, k2, bound = int(upper), k2 + joint + further, "between"
        k2 += self._filler(k2)
        least, most = {"least": (first, None), "most": (0, first)}.get(bound, (first, last))
        return k2 - k, least, most

    def _filler(self, k: int) -> int:
        """Return how many words of measure, size or style stand at word k before a thing's name."""
        length = 0
        while (step := self.phrase(k + length, "measure", "size", "of")[0]) and length < 4:
            length += step
        if k + length < len(self.words) and self.words[k + length].text in {"of", "de"}:
            length += 1
        return length

    def run(self) -> list[Claim]:
        """Return all claims."""
        k = 0
        while k < len(self.words):
            if self.words[k].text in STOPS:
                self.negated = False
            k += self._share(k) or self._things(k) or self._look(k) or 1
        return self.claims

    def _put(self, kind: Kind, first: int, last: int, name: str = "", least: int = 0, most: int | None = None, value: float = 0.0) -> int:
        start, end = self.words[first].start, self.words[last - 1].end
        begin = max((j + 1 for j in range(first) if self.words[j].text in STOPS), default=0)
        near = [*range(max(begin, first - 5), first), *range(last, min(last + 4, len(self.words)))]
        stop = next((j for j in near if j >= last and self.words[j].text in STOPS), len(self.words))
        home = any(self.phrase(j, "home")[0] for j in near if j < stop)
        self.claims.append(Claim(kind, start, end, name, least, most, value, home, bool(self.phrase(last, "in")[0])))
        return last - first

    def _share(self, k: int) -> int:
        """Read "70 % free", "at least seventy per cent of the floor free", "空地70%"."""
        size = self.phrase(k, "least", "exactly")[0]
        if self.prompt.startswith("百分之", self.words[k].start):
            length, value = self.number(k + 3)
            end = k + 3 + length
        else:
            size += self.phrase(k + size, "article")[0] if size else 0
            length, value = self.number(k + size)
            percent = self.phrase(k + size + length, "percent")[0] if value is not None else 0
            if not percent:
                return self._free_first(k)
            end = k + size + length + percent
        if value is None:
            return 0
        for j in range(end, min(end + 7, len(self.words))):
            if self.words[j].text in STOPS or self.words[j].text in {",", "、"}:
                break
            if free := self.phrase(j, "free")[0]:
                while extra := self.phrase(j + free, "free")[0]:
                    free += extra
                tail = j + free
                for extra_word in ("floor", "space", "area", "boden", "flache", "bodenflache", "suelo"):
                    if tail < len(self.words) and self.words[tail].text == extra_word:
                        tail += 1
                        break
                return self._put("walkable", k, tail, value=min(value / 100, 1.0))
        return 0

    def _free_first(self, k: int) -> int:
        free = self.phrase(k, "free")[0]
        if not free:
            return 0
        for j in range(k + free, min(k + free + 5, len(self.words))):
            if self.words[j].text in STOPS or self.words[j].text in {",", "、"}:
                return 0
            length, value = self.number(j)
            if value is not None and (percent := self.phrase(j + length, "percent")[0]):
                return self._put("walkable", k, j + length + percent, value=min(value / 100, 1.0))
        return 0

    def _things(self, k: int) -> int:
        """Read an amount of pieces, of things that open, or of a category."""
        read = self.amount(k)
        start, least, most = read or (0, 1, None)
        negative = read is not None and most == 0 and least == 0
        at = k + start
        looks = 0
        if read and not negative:
            looks = self.phrase(at, "look")[0]
        opening = self._opening(at)
        if read and opening and not negative:
            # so many at least: nobody minds one more
            return self._put("openable", k, at + opening, least=least)
        pieces = self.phrase(at + looks, "pieces")[0]
        if read and pieces and not negative and self.words[at + looks].text != "a":
            if looks:
                self._style_at(at, looks)
            return self._after("pieces", k, at + looks + pieces, "", least, most)
        name_at, length, name = self._name(at, read is not None)
        if not length:
            return 0
        if read is None:
            if self.negated and self.phrase(k - 1, "and")[0]:
                least, most = 0, 0
            else:
                plural = self.words[name_at + length - 1].text.endswith("s") and self.words[name_at + length - 1].text[0].isascii()
                least = 2 if plural and not self._shown_with_s(name, name_at + length - 1) else 1
        self.negated = most == 0
        if name_at > at:
            self._style_at(at, name_at - at)
        return self._after("count", k, name_at + length, name, least, most)

    def _shown_with_s(self, name: str, k: int) -> bool:
        """Whether a name ends with s in its plain form ("chaise longues" does not, "drawers" and "lavavajillas" do)."""
        text = self.words[k].text
        forms = lexicon()["names"].get(name, {})
        return any(words(f)[-1].text == text for listed in forms.values() for f in listed)

    def _after(self, kind: Kind, first: int, last: int, name: str, least: int, most: int | None) -> int:
        """Add bounds that follow: "four chairs or more"."""
        if more := self.phrase(last, "more")[0]:
            return self._put(kind, first, last + more, name, least, None)
        if fewer := self.phrase(last, "fewer")[0]:
            return self._put(kind, first, last + fewer, name, 0, most)
        return self._put(kind, first, last, name, least, most)

    def _opening(self, k: int) -> int:
        things = self.phrase(k, "things")[0]
        opens = self.phrase(k + things, "opens")[0]
        if opens:
            tail = k + things + opens
            return things + opens + (self.phrase(tail, "things")[0] or self.phrase(tail, "pieces")[0])
        return 0

    def _name(self, k: int, counted: bool) -> tuple[int, int, str]:
        """Return (place, length, name) of a thing at word k or after a style; typing errors are mended after an amount."""
        for skip in (0, self.phrase(k, "look")[0]):
            length, name = self.phrase(k + skip, "name")
            if length and not self._part_of_a_room(k + skip, length, counted=counted):
                return k + skip, length, name
        if counted and k < len(self.words):
            return k, *self._mended(k)
        return k, 0, ""

    def _part_of_a_room(self, k: int, length: int, *, counted: bool) -> bool:
        """Whether a thing's name is part of another: "tv room", "walk-in wardrobe", "a range of"."""
        after = self.words[k + length].text if k + length < len(self.words) else ""
        before = [w.text for w in self.words[max(0, k - 2) : k]]
        return after in ROOMS or before == ["walk", "in"] or (self.words[k].text == "range" and not counted)

    def _mended(self, k: int) -> tuple[int, str]:
        word = self.words[k].stem
        if len(word) < LEAST_TYPO - 1 or not word.isalpha() or not word.isascii():
            return 0, ""
        if self.phrase(k, "owner", "dwelling")[0]:
            return 0, ""
        for first, entries in phrases().items():
            for stems, kind, name, owned in entries:
                if (
                    kind == "name"
                    and len(stems) == 1
                    and not owned
                    and first[0] == word[0]
                    and len(first) >= LEAST_TYPO - 1
                    and near(word, first)
                ):
                    return 1, name
        return 0, ""

    def _look(self, k: int) -> int:
        """Read a style: "in nordic style", "estilo nórdico", "北欧风格"."""
        lead = self.phrase(k, "in", "with")[0]
        for skip in (lead, 0):
            j = k + skip
            before = self.phrase(j, "style")[0]
            length, name = self.phrase(j + before, "look")
            after = self.phrase(j + before + length, "style")[0] if length else 0
            if not length or (skip and not (before or after)):
                continue
            return self._put("style", k if skip else j, j + before + length + after, name)
        return 0

    def _style_at(self, k: int, length: int) -> None:
        found, name = self.phrase(k, "look")
        if found == length:
            self.claims.append(Claim("style", self.words[k].start, self.words[k + length - 1].end, name))


def near(a: str, b: str) -> bool:
    """Whether two words differ by one letter: changed, missing, added, or exchanged with its neighbour."""
    if a == b or abs(len(a) - len(b)) > 1:
        return a == b
    k = next((i for i, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), min(len(a), len(b)))
    if len(a) == len(b):
        return a[k + 1 :] == b[k + 1 :] or (a[k : k + 2] == b[k : k + 2][::-1] and a[k + 2 :] == b[k + 2 :])
    longer, shorter = (a, b) if len(a) > len(b) else (b, a)
    return longer[k + 1 :] == shorter[k:]


def read_furniture(prompt: str) -> tuple[str, list[Claim]]:
    """Return the prompt without its wishes for furniture (blanks in their place, so that places hold), and the wishes."""
    scan = Scan(prompt)
    claims = scan.run()
    return (masked(scan, claims) if claims else prompt), claims


def masked(scan: Scan, claims: Sequence[Claim]) -> str:
    """Blank the wishes, what joins them, and what leads to them."""
    covered = _covered(scan, claims)
    blank = list(covered)
    k = 0
    while k < len(scan.words):
        if not covered[k]:
            k += 1
            continue
        last = k
        while True:  # go on over what joins two wishes
            j = last + 1
            while j < len(scan.words) and not covered[j] and (step := scan.phrase(j, "and", "with", "article")[0]):
                j += step
            if j < len(scan.words) and covered[j]:
                blank[last : j + 1] = [True] * (j + 1 - last)
                last = j
            else:
                break
        _lead(scan, blank, k, last)
        k = last + 1
    text = list(scan.prompt)
    for w, gone in zip(scan.words, blank, strict=True):
        if gone:
            text[w.start : w.end] = " " * (w.end - w.start)
    return "".join(text)


def _covered(scan: Scan, claims: Sequence[Claim]) -> list[bool]:
    """Tell which words belong to a wish; "everywhere" belongs to the wish for the whole home that it stands by."""
    spans = sorted((c.start, c.end) for c in claims)
    covered = [False] * len(scan.words)
    k = 0
    for start, end in spans:
        while k < len(scan.words) and scan.words[k].start < start:
            k += 1
        j = k
        while j < len(scan.words) and scan.words[j].start < end:
            covered[j] = True
            j += 1
    for c in (c for c in claims if c.home):
        for j, w in enumerate(scan.words):
            if c.start - 40 < w.start < c.end + 40 and (step := scan.phrase(j, "home")[0]):
                covered[j : j + step] = [True] * step
    return covered


def _lead(scan: Scan, blank: list[bool], first: int, last: int) -> None:
    """Blank the "with" before a run of wishes, or, where a room of the same owner follows, the "and" after it."""
    lead = next((n for n in (3, 2, 1) if first - n >= 0 and scan.phrase(first - n, "with")[0] == n), 0)
    join = scan.phrase(last + 1, "and")[0]
    follows = range(last + 1 + join, min(last + 4 + join, len(scan.words)))
    shared = bool(join) and scan.words[last + 1].text not in STOPS and any(scan.phrase(j, "own_rooms")[0] for j in follows)
    if lead and shared:
        blank[last + 1 : last + 1 + join] = [True] * join
    elif lead:
        blank[first - lead : first] = [True] * lead
