"""Characters and words of a prompt."""

from __future__ import annotations

import functools
import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass

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
