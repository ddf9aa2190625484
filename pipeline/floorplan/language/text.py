"""Characters and words of a prompt, and how a language makes plurals, tenses, compounds and number words by the rules of its lexicon."""

from __future__ import annotations

import functools
import re
import unicodedata
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from pydantic import BaseModel, ConfigDict

HAN = "\u3400-\u9fff"
WORD = re.compile(
    rf"\d+(?:[.,]\d{{3}})+(?![\d])|\d+(?:[.,]\d+)?|[{HAN}]|m²|ft²|m2(?!\d)|ft2(?!\d)|[^\W\d_{HAN}]+(?:'(?:s|t|ve|d|ll|re|m)\b)?'?|w/o\b|<->|->|=>|→|[<>]=|[<>](?=\s*\d|$)|[≤≥]|1½|½|[%.,;:!?()/&~+=*•|–—\-×。、;:!?()\n\[\]]",
    re.IGNORECASE,
)
ALIKE = str.maketrans(
    "著廳臥衛陽臺臺儲雜書傢廚餐間個樓層門獨開進關從鄰緊連須車庫廊過單雙幾兩無礙廁馬飯遠離總積約達應該寬闊淨幹濕療養孫輪椅機電視課學習遊戲娛樂縫紉圖館玄關採採淺灰歐風簡約與對齊後邊裡裏頭頂層閣點頂傳統較讓給將內別墅還還請號樣當這會幫設計畫面圍繞並須禁毗緊貫穿於",
    "着厅卧卫阳台台储杂书家厨餐间个楼层门独开进关从邻紧连须车库廊过单双几两无碍厕马饭远离总积约达应该宽阔净干湿疗养孙轮椅机电视课学习游戏娱乐缝纫图馆玄关采采浅灰欧风简约与对齐后边里里头顶层阁点顶传统较让给将内别墅还还请号样当这会帮设计画面围绕并须禁毗紧贯穿于",
)
MARKS = {"。": ".", "、": "&", ",": ",", ";": ";", ":": ":", "!": "!", "?": "?", "(": "(", ")": ")", "【": "(", "】": ")", "~": "~", "“": " ", "”": " ", "「": " ", "」": " ", "„": " ", "’": "'", "‘": "'", "´": "'", "`": "'", "㎡": "m²", "×": "x", "−": "-", "‐": "-", "‑": "-", "[": "(", "]": ")"}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Token:
    """A word (lower case) = prompt[start:end] as written; `number` is the value of figures."""

    text: str
    start: int
    end: int
    number: float | None = None


def clean(prompt: str) -> tuple[str, list[int]]:
    """Return the prompt in lower case, compatibility forms resolved, invisible and control characters taken out, and the place of each character.

    Traditional Chinese characters become simplified ones. Invisible characters inside a word leave no gap.
    """
    made: list[str] = []
    places: list[int] = []
    for place, char in enumerate(prompt):
        if char.isascii() and (char.isalnum() or char == " "):
            made.append(char.lower())
            places.append(place)
            continue
        kind = unicodedata.category(char)
        if kind in {"Cf", "Mn"} and char != "\u0301" and unicodedata.combining(char) == 0:
            continue
        if char in "\n\r\u2028\u2029":
            out = "\n"
        elif kind[0] == "C" or kind[0] == "Z":
            out = " "
        elif char in MARKS:
            out = MARKS[char]
        elif char in "²½":
            out = char
        else:
            out = unicodedata.normalize("NFKC", char).lower().translate(ALIKE)
        for piece in out:
            if unicodedata.combining(piece) and made:  # a letter and its accent, written apart
                joined = unicodedata.normalize("NFC", made[-1] + piece)
                if len(joined) == 1:
                    made[-1] = joined
                continue
            made.append(MARKS.get(piece, piece))
            places.append(place)
    return "".join(made), places


def tokenize(prompt: str) -> list[Token]:
    """Split a prompt into words, figures and marks; Chinese into single characters."""
    return list(_tokens(prompt))


@functools.lru_cache(maxsize=16)  # a prompt is read several times: for its language, its furniture, its rooms
def _tokens(prompt: str) -> tuple[Token, ...]:
    text, places = clean(prompt)
    found = []
    for match in WORD.finditer(text):
        raw = match.group()
        if raw[0].isalpha() and raw.endswith("'") and not raw.endswith("s'"):
            raw = raw[:-1]
        found.append(Token(raw, places[match.start()], places[match.end() - 1] + 1, _number(raw)))
    return tuple(found)


def _number(raw: str) -> float | None:
    if raw in {"½", "1½"}:
        return 0.5 if raw == "½" else 1.5
    if not raw[0].isdigit() or raw[-1] == "²":
        return None
    if raw in {"m2", "ft2"}:
        return None
    if re.fullmatch(r"\d+([.,]\d{3})+", raw):  # 1,900 and 1.900 are thousands
        return float(re.sub(r"[.,]", "", raw))
    try:
        return float(raw.replace(",", "."))
    except ValueError:
        return None


def fold(word: str) -> str:
    """Return a word without accents; umlauts and sharp s as two letters."""
    if word.isascii():
        return word
    word = word.replace("ä", "ae").replace("ö", "oe").replace("ü", "ue").replace("ß", "ss")
    return "".join(c for c in unicodedata.normalize("NFD", word) if not unicodedata.combining(c)) if not word.isascii() else word


def bare(word: str) -> str:
    """Return a word without accents and umlauts: how it looks when they are dropped."""
    return "".join(c for c in unicodedata.normalize("NFD", word.replace("ß", "ss")) if not unicodedata.combining(c))


def words(phrase: str) -> tuple[str, ...]:
    """Return the folded words of a phrase of a lexicon."""
    plain, ascii_only = phrase.replace("-", " "), phrase.isascii()
    if not ascii_only and all("\u3400" <= c <= "\u9fff" for c in phrase):
        return tuple(phrase.translate(ALIKE))
    if plain.replace(" ", "").isalpha() and (ascii_only or not any("\u3400" <= c <= "\u9fff" for c in plain)):
        return tuple(fold(w) for w in plain.split())
    return tuple(fold(t.text) for t in tokenize(phrase) if t.text != "-")


def spread(tokens: Sequence[Token]) -> tuple[int, int]:
    """Return the stretch of the prompt that tokens cover, in any order."""
    return min(t.start for t in tokens), max(t.end for t in tokens)


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
