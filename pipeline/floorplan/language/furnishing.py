"""Wishes for furniture in words: how many things, which, in what style, what opens, how much floor stays free.

They are read before the rooms are, in all languages at once, and taken out of the prompt: what is left speaks of rooms alone. Which
room a wish means is settled afterwards (`attach`), when the rooms and their places in the prompt are known.
"""

import bisect
import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from pipeline.errors import RefusedError
from pipeline.floorplan.language.lexicon import STRONG, furniture_phrases, furniture_stems, name_stems, stem
from pipeline.floorplan.language.lexicon import lexicon as spoken
from pipeline.floorplan.language.spelling import detect
from pipeline.floorplan.language.text import fold, has_minus, split_words, words
from pipeline.floorplan.language.tokens import read_words, segment
from pipeline.floorplan.program.furniture import CHAIRS, TABLES, lexicon

STOPS = frozenset(".;!?\n。;!?")
COMMAS = STOPS | {",", "、"}
COMMA = frozenset(",，")  # within a sentence
MOST, MOST_WORDS, MOST_SEATS = 1e6, 6, 16  # of any amount, of a numeral, and at a table
NEAR, FAR, WIDE, OWNED = 5, 7, 16, 14  # words in which "everywhere", a share, "free" and an owner are looked for
LEADS = ("with", "in", "is", "and", "article", "least", "most", "exactly", "between")  # behind these a dash before a number is no list's
Kind = Literal["count", "pieces", "openable", "walkable", "style"]


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
    plural: bool = False  # "armchairs": nobody counted them


@dataclass(frozen=True, slots=True)
class _Word:
    """A word as it is read, without the ends of plurals, cases and genders, and its place in the prompt."""

    text: str
    stem: str
    start: int
    end: int


class Scan:
    """Reads claims from left to right."""

    def __init__(self, prompt: str) -> None:
        self.prompt = prompt
        self.claims: list[Claim] = []
        try:
            self.language = detect(prompt)
        except RefusedError:
            self.language = ""
        read = read_words(prompt, self.language) if self.language else None
        self.traits = read.lexicon.traits if read is not None else frozenset[str]()
        written, tokens = (read.written, segment(read)) if read is not None else (list(split_words(prompt)), [])
        folded = [fold(w.text) for w in written]
        texts = [
            w if stem(w) in furniture_stems() else text for w, text in zip(folded, read.texts if read is not None else folded, strict=True)
        ]
        self.words = [_Word(text, stem(text), t.start, t.end) for t, text in zip(written, texts, strict=True) if text != "-"]
        # names of rooms: whether a word is the first of one
        self.rooms = {written[k].start: k == m.first for m in tokens if m.kind in STRONG for k in range(m.first, m.last)}
        self.numbers = {t.start: (t.end, min(t.number, MOST)) for t in written if t.number is not None}
        alone = ((w, read.lexicon.trie.get(w.text, {}).get("")) for w in self.words) if read is not None else ()  # "for two desks"
        self.numbers |= {w.start: (w.end, min(m.number, MOST)) for w, m in alone if m is not None and m.kind == "num"}
        self.numbers |= {written[m.first].start: (written[m.last - 1].end, min(m.number, MOST)) for m in tokens if m.kind == "num"}
        self.counted = {written[m.first].start for m in tokens if (m.kind, m.value) == ("unit", "rooms")}  # "trois pièces" are rooms
        self.levels = {written[m.first].start for m in tokens if m.kind == "level"}
        stems, storeys = [w.stem for w in self.words], set(lexicon()["storeys"])
        spelt = tuple(w.text for w in self.words)
        found = (
            [
                (len(p), kind, name, owned, spelt[k : k + len(p)] != form)
                for p, kind, name, owned, form in furniture_phrases().get(stem, ())
                if tuple(stems[k : k + len(p)]) == p
                and (len(p) > 1 or self.words[k].text not in storeys)
                and not (kind == "name" and len(p) == 1 and self._other(k, name))
            ]
            for k, stem in enumerate(stems)
        )
        self.there = [[p[:4] for p in sorted(here, key=lambda p: (-p[0], p[4]))] for here in found]  # "sillón" is no "silla"
        self.stops = [-1, *(k for k, w in enumerate(self.words) if w.text in STOPS)]
        self.negated = False  # "no TV or armchairs": the negation goes on

    def _other(self, k: int, name: str) -> bool:
        """Whether word k names a room, or is another word of the prompt's language: "Büro" is no "buró", "never" no "nevera"."""
        word = self.words[k]
        if not self.language or word.stem in name_stems(name, self.language):
            return "characters" not in self.traits and self.rooms.get(word.start) is False  # "a walk-in wardrobe"
        return word.start in self.rooms or word.text in spoken(self.language).vocabulary

    def phrase(self, k: int, *kinds: str) -> tuple[int, str]:
        """Return (length, name) of the longest phrase of those kinds at word k, (0, "") where there is none."""
        here = ((size, name) for size, kind, name, owned in self._here(k) if kind in kinds and (not owned or self._owned(k, name, size)))
        return next(here, (0, ""))

    def length(self, k: int, *kinds: str) -> int:
        """Return the length of the longest phrase of those kinds at word k."""
        return self.phrase(k, *kinds)[0]

    def text(self, k: int) -> str:
        """Return word k, "" beyond the ends."""
        return self.words[k].text if 0 <= k < len(self.words) else ""

    def _here(self, k: int) -> Sequence[tuple[int, str, str, bool]]:
        """Return the phrases that begin at word k, none beyond the ends."""
        return self.there[k] if 0 <= k < len(self.words) else ()

    def _owned(self, k: int, name: str, size: int) -> bool:
        """Whether a room that has such things is named before word k in the same clause, or right after it, or other things beside it."""

        def owner(j: int) -> bool:
            return any(kind == "owner" and of == name for _, kind, of, _ in self._here(j))

        stop = self.stops[bisect.bisect_left(self.stops, k) - 1]
        other, around = lexicon()["beside"].get(name), range(max(stop + 1, k - FAR), k + FAR)
        named = [(j, length) for j in around if other for length, kind, of, _ in self._here(j) if (kind, of) == ("name", other)]
        alone = [j for j, length in named if self.text(j + length) not in lexicon()["words"]["rooms"]]
        if any(self.length(i, "none") for j in alone for i in range(min(j, k) - 4, max(j, k))):
            return True  # "a shower instead of a bathtub"
        at = max((j for j in range(max(stop + 1, k - OWNED), k) if owner(j)), default=None)
        if at is not None and (name not in lexicon()["apart"] or self._past(at + 1) >= k):
            between = self.prompt[self.words[at].end : self.words[k].start]  # "a bedroom, a bathroom and a wardrobe" are three
            led = (
                self.length(at + 1, "none")
                or any(self.length(j, "with") for j in range(at + 1, k))
                or (self.fronted(at) and not self.fronted(k))
            )
            if led or between.rfind("(") > between.rfind(")") or (":" in between.partition(",")[0] and not any(map(str.isdigit, between))):
                return True
        listed = name in lexicon()["listed"] and self._listed(k, size)
        at = self._past(k + size)  # "a desk and a wardrobe in the hall"
        placed = self.length(at, "in") and self.words[at].start not in self.levels  # "un bureau, et en haut trois chambres"
        return listed or (bool(placed) and any(owner(at + d) for d in (1, 2, 3)))

    def fronted(self, k: int) -> bool:  # "in the office a wardrobe"
        """Whether the room at word k stands first in its clause, as a place."""
        k -= self.length(k - 1, "article")
        return any(self.length(k - n, "in") == n and self.text(k - n - 1) in {"", *COMMAS} for n in (1, 2, 3))

    def _past(self, k: int) -> int:
        """Return where the things, and what joins them, end that begin at word k."""
        while step := self.length(k, "with", "and", "one") or next((n for n, kind, *_ in self._here(k) if kind == "name"), 0):
            k += step
        return k

    def _listed(self, k: int, size: int) -> bool:
        """Whether the thing at word k stands behind another in a list, or heads one: "a desk and a wardrobe", "Bed, desk"."""
        small = ("one", "article", "size", "look")
        figures = {j for j in range(max(k - FAR, 0), min(k + FAR, len(self.words))) if self.words[j].start in self.numbers}
        at = next(j for j in range(k - 1, -2, -1) if not self.length(j, *small) and j not in figures)
        if self.length(at, "and"):
            while self.length(at - 1, "and"):
                at -= 1
            return any(self.phrase(j, "name")[0] == at - j for j in range(max(at - 4, 0), at))
        heads = at < k - 1 or self.text(at) in STOPS | {""}
        at = k + size + (self.length(k + size, "and") if heads else 0)
        while at > k + size and (step := self.length(at, *small) or at in figures):
            at += step
        return at > k + size and any(kind == "name" and not owned for _, kind, _, owned in self._here(at))

    def number(self, k: int) -> tuple[int, float | None]:
        """Return (length, value) of a numeral at word k; of "8 to 10" only the first is read here."""
        inside = 0 <= k < len(self.words) and self.length(k, "name") < 2
        end, value = self.numbers.get(self.words[k].start, (0, None)) if inside else (0, None)
        signed = value and has_minus(self.prompt, self.words[k].start)
        led = signed and (self.text(k - 1) == "(" or any(self.length(k - n, *LEADS) == n for n in (1, 2, 3)))  # "a bed -2 chairs" is a list
        return sum(w.start < end for w in self.words[k : k + MOST_WORDS]), -value if value and led else value

    def amount(self, k: int) -> tuple[int, int, int | None] | None:
        """Return (length, least, most) of an amount at word k: bounds, ranges, articles, negations."""
        if pair := self.length(k, "pair"):
            return pair + self._filler(k + pair), 2, 2
        bound = next((b for b in ("least", "most", "exactly", "between") if self.length(k, b)), "")
        at = k + self.length(k, "least", "most", "exactly", "between")
        at += self.length(at, "with", "article") if bound else 0  # 至少放三件
        length, value = self.number(at)
        if value is None:
            none = 0 if bound else self.length(k, "none")
            one = 0 if bound else self.length(k + none, "one")  # "not a shower"
            size = none + one
            return (size + self._filler(k + size), 0 if none else 1, 0 if none else None) if size else None
        at += length
        first = last = int(value)
        joint = self.length(at, "to") if bound == "between" or not self.length(at, "and") else 0
        hyphen = not joint and at < len(self.words) and "-" in self.prompt[self.words[at - 1].end : self.words[at].start]
        further, upper = self.number(at + joint) if joint or hyphen else (0, None)
        if upper is not None:
            last, at, bound = int(upper), at + joint + further, "between"
        at += self._filler(at)
        if not bound and length == 1 and self.length(k, "one"):
            return at - k, 1, None  # "一张书桌" is "a desk"
        least, most = {"least": (first, None), "most": (0, first)}.get(bound, (first, last))
        return at - k, least, most

    def _filler(self, k: int) -> int:
        """Return how many words of measure, size or style stand at word k before a thing's name."""
        length = 0
        while self.length(k + length, "name") < 2 and (step := self.length(k + length, "measure", "size")) and length < 4:
            length += step
        return length + bool(self.length(k + length, "of"))

    def run(self) -> list[Claim]:
        """Return all claims."""
        k = 0
        while k < len(self.words):
            self.negated = self.negated and self.text(k) not in STOPS
            says = bool(self.there[k]) or self.words[k].start in self.numbers
            k += (says and (self.length(k, "small") or self._share(k) or self._things(k) or self._elsewhere(k) or self._look(k))) or 1
        return self.claims

    def _put(self, kind: Kind, first: int, last: int, name: str = "", least: int = 0, most: int | None = None, value: float = 0.0) -> int:
        """Note a claim with the bounds that follow ("four chairs or more"), and the whole home where that stands by it; return its length in words."""
        more, fewer = (self.length(last, side) if kind in {"count", "pieces"} else 0 for side in ("more", "fewer"))
        last, least, most = last + (more or fewer), 0 if fewer and not more else least, None if more else most
        if kind == "count" and (least, most) == (1, None) and (sides := self.length(last, "sides")):
            last, least, most = last + sides, 2, 2
        begin = self.stops[bisect.bisect_left(self.stops, first) - 1] + 1
        left = next((j for j in range(first - 1, max(begin, first - NEAR) - 1, -1) if self.text(j) in COMMAS), max(begin, first - NEAR) - 1)
        right = next((j for j in range(last, last + NEAR - 1) if self.text(j) in COMMAS), last + NEAR - 1)
        home = any(self.length(j, "home") and self.words[j].start not in self.rooms for j in range(left + 1, right))  # "cada habitación"
        inside = range(first + self.length(first, "furnished"), last) if kind == "walkable" else ()
        home = home or any(self.length(j, "dwelling") and self.words[j].start in self.rooms for j in inside)
        span, place = (self.words[first].start, self.words[last - 1].end), last + self.length(last, "is")  # "should be in the bathroom"
        inward = self.length(place, "in") > self.length(place, "none")
        self.claims.append(Claim(kind, *span, name, least, most, value, home, inward))
        return last - first

    def _share(self, k: int) -> int:
        """Read "70 % free", "at least half of the living room's floor must stay free", "空地70%", "free: 70 %", "furniture covers at most 30 %"."""
        if lead := self.length(k, "free", "furnished"):
            step, value, at = next(((*said, j) for j in self._part(k + lead, FAR) if (said := self._fraction(j))[0]), (0, 0.0, k))
            if self.length(k, "furnished"):
                step, value = 0 if any(self.length(j, "free") for j in self._part(k, 2 * FAR)) else step, 1.0 - value
            near = self._part(at + step, NEAR)
            behind = [j + n for j in near if (n := self.length(j, "floor", "home") or self.words[j].start in self.rooms)]
            return self._put("walkable", k, max((at + step, *behind)), value=value) if step else 0
        start, at = k, k + ((most := self.length(k, "most")) or self.length(k, "least", "exactly", "over"))
        at += self.length(at, "article", "with") if at > k else 0
        step, value = self._fraction(at)
        ahead = range(at + step, min(at + step + 2 * WIDE, len(self.words)) if step else 0)
        part = list(itertools.takewhile(lambda j: self.text(j) not in STOPS, ahead))
        last = next((j for j in part if self.length(j, "furnished" if most else "free")), 0)
        joins = (j for j in part if j < last and self.length(j, "and"))
        if other := next((j for j in joins if any(self._fraction(i)[0] for i in range(j + 1, last))), 0):
            return self._put("walkable", k, other, value=value)  # "70 % of the bath's floor and half of the hall's must be free"
        last = last if last in self._part(at + step, WIDE) else 0
        if not last or (last > at + step + NEAR and not any(self.length(j, "floor") for j in range(at + step, last))):
            return 0
        while step := self.length(last, "free", "floor", "furnished"):
            last += step
        while before := next((n for n in (4, 2, 1) if self.length(k - n, "floor", "of", "both") == n), 0):  # "客厅地面至少60%"
            k -= before
        return self._put("walkable", k, last, value=1.0 - value if most else value) - start + k

    def _fraction(self, k: int) -> tuple[int, float]:
        """Return (length, value) of a share at word k: "60 %", "百分之六十", "two thirds"; (0, 0) for none."""
        if (said := self.phrase(k, "fraction"))[0]:
            return said[0], float(said[1])
        lead = self.length(k, "percent_of")
        length, value = self.number(k + lead)
        behind = 0 if value is None or lead else self.length(k + length, "percent")
        return (lead + length + behind, value / 100) if value is not None and (lead or behind) else (0, 0.0)

    def _part(self, k: int, most: int) -> Iterator[int]:
        """Yield the places from k on as far as the next comma, `most` at most."""
        return itertools.takewhile(lambda j: self.text(j) not in COMMAS, range(k, min(k + most, len(self.words))))

    def _things(self, k: int) -> int:
        """Read an amount of pieces, of things that open, or of a category."""
        read = self.amount(k)
        start, least, most = read or (0, 1, None)
        at, counted = k + start, read is not None and most != 0
        looks = self.length(at, "look") if counted else 0
        named = at + self.length(at, "things")
        if counted and (opens := self.length(named, "opens")):  # so many at least: nobody minds one more
            return self._put("openable", k, named + opens + self.length(named + opens, "things", "pieces"), least=least)
        pieces = self.length(at + looks, "pieces") if counted else 0
        if pieces and self.words[at + looks].start not in self.counted:
            self._style(at, looks)
            return self._put("pieces", k, at + looks + pieces, "", least, most)
        name_at, length, name = self._name(at)
        if not length:
            return 0
        if read is None and self.negated and self.length(k - 1, "and"):
            least, most = 0, 0
        elif read is None:
            last = self.text(name_at + length - 1)
            called = (form for some in lexicon()["names"].get(name, {}).values() for form in some)
            shown = any(words(form)[-1] == last for form in called)  # "drawers", "lavavajillas"
            least = 2 if last.endswith(lexicon()["plural"]) and last[0].isascii() and not shown else 1
        self.negated = most == 0
        self._style(at, name_at - at)
        barred = self._barred(name_at + length)
        size = self._put("count", k, name_at + length + barred, name, *((0, 0) if barred else (least, most)))
        claim, place = self.claims[-1], len(self.claims) - 1
        seats = self._seats(k + size) if name in TABLES and most != 0 else 0
        self.claims[place] = replace(claim, plural=read is None and least > 1, inward=claim.inward and not seats)
        return size + seats

    def _barred(self, k: int) -> int:
        """Return how many words at word k say that the thing before them stands elsewhere: "must not be in the bedroom"."""
        kinds, last = set(), k
        while said := next((w for w in ("is", "none") if self.length(last, w)), ""):
            kinds.add(said)
            last += self.length(last, said)
        return last - k if len(kinds) > 1 and self.length(last, "in") else 0

    def _elsewhere(self, k: int) -> int:
        """Read where the last thing shall not stand: "the washing machine goes in the kitchen, not in the bathroom"."""
        none, last = self.length(k, "none"), self.claims[-1] if self.claims else None
        joined = self.text(k - 1) in COMMAS - STOPS or self.length(k - 1, "and") or self.words[k - 1].start in self.rooms
        place = self.length(k + none, "in")
        if last is None or not (none and last.inward and joined and place):
            return 0
        self._put("count", k, k + none, last.name, 0, 0)
        self.claims[-1] = replace(self.claims[-1], end=self.words[k + none + place - 1].end)
        return none + place

    def _seats(self, k: int) -> int:
        """Read for how many a table is, as chairs: "for six people"."""
        lead = self.length(k, "in")
        length, value = self.number(k + lead) if lead else (0, None)
        people = self.length(k + lead + length, "seated")
        ends = self.text(k + lead + length) in {"", *COMMAS} or self.length(k + lead + length, "in", "and")
        if value is None or value > MOST_SEATS or not (people or ends):
            return 0
        return self._put("count", k, k + lead + length + people, CHAIRS, int(value))

    def _name(self, k: int) -> tuple[int, int, str]:
        """Return (place, length, name) of a thing at word k or after a style; none where it names a room: "tv room", "bed 2 11 sqm"."""
        for at in (k, k + self.length(k, "look")):
            length, name = self.phrase(at, "name")
            behind = self.text(at + length)
            room = behind in lexicon()["words"]["rooms"] or (behind.isdigit() and self.length(at, "numbered"))
            if length and not room and self.length(at - 2, "walk_in") < 2 and self.length(at, "small") <= length:
                return at, length, name
        return k, 0, ""

    def _look(self, k: int) -> int:
        """Read a style: "in nordic style", "estilo nórdico", "北欧风格"."""
        lead = self.length(k, "in", "with")
        for at in (k + lead, k):
            before = self.length(at, "style")
            length, name = self.phrase(at + before, "look")
            after = self.length(at + before + length, "style") if length else 0
            if length and (at == k or before or after):
                return self._put("style", k, at + before + length + after, name)
        return 0

    def _style(self, k: int, length: int) -> None:
        """Note the style that stands between an amount and a thing."""
        if length:
            self._put("style", k, k + length, self.phrase(k, "look")[1])
