"""Wishes for furniture in words: how many things, which, in what style, what opens, how much floor stays free.

They are read before the rooms are, in all languages at once, and taken out of the prompt: what is left speaks of rooms alone. Which
room a wish means is settled afterwards (`attaching.py`), when the rooms and their places in the prompt are known.
"""

from __future__ import annotations

import bisect
from dataclasses import dataclass
from typing import Literal

from pipeline.errors import RefusedError
from pipeline.floorplan.language.lexicon import STRONG, Language
from pipeline.floorplan.language.lexicon import lexicon as spoken
from pipeline.floorplan.language.marks import listen, segment
from pipeline.floorplan.language.spelling import detect
from pipeline.floorplan.language.vocabulary import (
    COMMAS,
    FIGURES,
    HAN_DIGITS,
    LEADING,
    MOST,
    ROOMS,
    STOPS,
    mended,
    numbers,
    phrases,
    words,
)
from pipeline.floorplan.program.furniture import lexicon


def named(prompt: str) -> tuple[Language | None, frozenset[int], frozenset[int]]:
    """Return the language of a prompt (None where it is none that is read), where words for rooms and homes begin, and which are not their first."""
    try:
        language = detect(prompt)
    except RefusedError:
        return None, frozenset(), frozenset()
    heard = listen(prompt, language)
    rooms = [m for m in segment(heard) if m.kind in STRONG]
    starts, inner = ([heard.tokens[k].start for m in rooms for k in range(m.first + skip, m.last)] for skip in (0, 1))
    return language, frozenset(starts), frozenset(inner)


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


class Scan:
    """Reads claims from left to right."""

    def __init__(self, prompt: str) -> None:
        self.prompt = prompt
        self.claims: list[Claim] = []
        self.language, self.rooms, self.inner = named(prompt)
        self.words = mended(words(prompt), self.language)
        stems, storeys = [w.stem for w in self.words], set(lexicon()["storeys"])
        self.there = [
            [
                (len(p), kind, name, owned)
                for p, kind, name, owned in phrases().get(stem, ())
                if tuple(stems[k : k + len(p)]) == p
                and (len(p) > 1 or self.words[k].text not in storeys)
                and not (kind == "name" and len(p) == 1 and (self._room(k, name) or self._common(k, name)))
            ]
            for k, stem in enumerate(stems)
        ]
        self.stops = [-1, *(k for k, w in enumerate(self.words) if w.text in STOPS)]
        self.negated = False  # "no TV or armchairs": the negation goes on

    def _room(self, k: int, name: str) -> bool:
        """Whether word k names a room, and the prompt's language does not call that furniture so: "Büro" is no "buró"."""
        if self.language is None or self.words[k].start not in self.rooms:
            return False
        if "characters" not in spoken(self.language).traits and self.words[k].start in self.inner:
            return True  # "a walk-in wardrobe"
        forms = lexicon()["names"][name].get(self.language, ())
        return not any(words(form.removeprefix("@"))[0].stem == self.words[k].stem for form in forms)

    def _common(self, k: int, name: str) -> bool:
        """Whether word k is a word of the prompt's language that only looks like furniture of another: "never" and "nevera"."""
        if self.language is None or self.words[k].text not in spoken(self.language).vocabulary:
            return False
        forms = lexicon()["names"][name].get(self.language, ())
        return not any(words(form.removeprefix("@"))[0].stem == self.words[k].stem for form in forms)

    def phrase(self, k: int, *kinds: str) -> tuple[int, str]:
        """Return (length, name) of the longest phrase of those kinds at word k, (0, "") where there is none."""
        if not 0 <= k < len(self.words):
            return 0, ""
        for length, kind, name, owned in self.there[k]:
            if kind in kinds and (not owned or self._owned(k, name)):
                return length, name
        return 0, ""

    def _owned(self, k: int, name: str) -> bool:
        """Whether a room that has such things is named before word k in the same clause, or right after it."""
        near = range(max(0, k - 14), k)
        stop = max((j for j in near if self.words[j].text in STOPS), default=-1)
        owner = max((j for j in near if j > stop and self._owner(j, name)), default=None)
        # "a bedroom with a wardrobe" has one; "a bedroom, a bathroom and a wardrobe" are three rooms
        if owner is not None:
            between = self.prompt[self.words[owner].end : self.words[k].start]
            bracket = between.rfind("(") > between.rfind(")")
            if bracket or any(self.phrase(j, "with")[0] for j in range(owner + 1, k)):
                return True
        return any(self.phrase(j, "in")[0] and any(self._owner(j + d, name) for d in (1, 2, 3)) for j in (k + 1,))

    def _owner(self, k: int, name: str) -> bool:
        if not 0 <= k < len(self.words):
            return False
        return any(kind == "owner" and of == name for _, kind, of, _ in self.there[k])

    def number(self, k: int) -> tuple[int, float | None]:
        """Return (length, value) of a numeral at word k; of "8 to 10" only the first is read here."""
        if not 0 <= k < len(self.words):
            return 0, None
        text = self.words[k].text
        if FIGURES.fullmatch(text):
            return 1, min(float(text.replace(",", ".")), MOST)
        if text in numbers():
            tens = numbers()[text]
            ones = numbers().get(self.words[k + 1].text, 0) if tens >= 20 and k + 1 < len(self.words) else 0
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
        return len(run), min(float("".join(str(HAN_DIGITS[c]) for c in run)), MOST)

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
        if not bound and length == 1 and self.words[k].text == "一" and upper is None:
            return k2 - k, 1, None  # "一张书桌" is "a desk"
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
            if self._idle(k):
                k += 1
                continue
            k += self.phrase(k, "small")[0] or self._share(k) or self._things(k) or self._look(k) or 1
        return self.claims

    def _idle(self, k: int) -> bool:
        """Whether no wish begins at word k: it is no numeral and begins no phrase."""
        text = self.words[k].text
        return not self.there[k] and text not in numbers() and text not in HAN_DIGITS and text not in "十百" and not text[0].isdigit()

    def _put(self, kind: Kind, first: int, last: int, name: str = "", least: int = 0, most: int | None = None, value: float = 0.0) -> int:
        start, end = self.words[first].start, self.words[last - 1].end
        begin = self.stops[bisect.bisect_left(self.stops, first) - 1] + 1
        near = [*range(max(begin, first - 5), first), *range(last, min(last + 4, len(self.words)))]
        # "eight pieces, everything nordic": what a comma parts is said of something else
        left = max((j for j in near if j < first and self.words[j].text in COMMAS), default=-1)
        right = next((j for j in near if j >= last and self.words[j].text in COMMAS), len(self.words))
        home = any(self.phrase(j, "home")[0] for j in near if left < j < right)
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
            if value is None and (half := self.phrase(k + size, "half")[0]):
                length, value, percent = half, 50.0, 0
            else:
                percent = self.phrase(k + size + length, "percent")[0] if value is not None else 0
                half = 0
            if not (percent or half):
                return self._free_first(k)
            end = k + size + length + percent
        if value is None:
            return 0
        for j in range(end, min(end + 7, len(self.words))):
            if self.words[j].text in COMMAS:
                break
            if free := self.phrase(j, "free")[0]:
                while extra := self.phrase(j + free, "free")[0]:
                    free += extra
                tail = j + free
                for extra_word in ("floor", "space", "area", "boden", "flache", "bodenflache", "suelo"):
                    if tail < len(self.words) and self.words[tail].text == extra_word:
                        tail += 1
                        break
                return self._put("walkable", k, tail, value=value / 100)
        return 0

    def _free_first(self, k: int) -> int:
        free = self.phrase(k, "free")[0]
        if not free:
            return 0
        for j in range(k + free, min(k + free + 5, len(self.words))):
            if self.words[j].text in COMMAS:
                return 0
            length, value = self.number(j)
            if value is not None and (percent := self.phrase(j + length, "percent")[0]):
                return self._put("walkable", k, j + length + percent, value=value / 100)
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
        name_at, length, name = self._name(at)
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

    def _name(self, k: int) -> tuple[int, int, str]:
        """Return (place, length, name) of a thing at word k or after a style."""
        for skip in (0, self.phrase(k, "look")[0]):
            length, name = self.phrase(k + skip, "name")
            if length and not self._part_of_a_room(k + skip, length) and self.phrase(k + skip, "small")[0] <= length:
                return k + skip, length, name
        return k, 0, ""

    def _part_of_a_room(self, k: int, length: int) -> bool:
        """Whether a thing's name is part of a room's: "tv room", "walk-in wardrobe"."""
        after = self.words[k + length].text if k + length < len(self.words) else ""
        before = [w.text for w in self.words[max(0, k - 2) : k]]
        if self.words[k].text in {"bed", "beds"} and FIGURES.fullmatch(after):
            return True  # "bed 2 11 sqm"
        return (
            after in ROOMS | LEADING
            or (after != "" and after in "间房室" and "\u3400" <= self.words[k].text <= "\u9fff")
            or before == ["walk", "in"]
        )

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
