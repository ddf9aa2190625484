"""Typing errors made on purpose: what a prompt with one error still says, beside what it says without.

`python -m benchmarks.language --typos` prints the share of programs that stay the same, by language and by kind of error.
"""

from __future__ import annotations

import random
import re
import unicodedata
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from pipeline.errors import SfgenError
from pipeline.floorplan import parse

ROWS = {"de": ("qwertzuiop", "asdfghjkl", "yxcvbnm"), "": ("qwertyuiop", "asdfghjkl", "zxcvbnm")}
SHORTEST = 4  # letters of a word that is mistyped: shorter ones become other words
WORD = re.compile(rf"[^\W\d_]{{{SHORTEST},}}")
WRITTEN = ("en", "de", "es")  # with letters; Chinese is typed by sound


def swapped(word: str, k: int, _: random.Random, __: str) -> str:
    """Swap two letters."""
    k = min(k, len(word) - 2)
    return word[:k] + word[k + 1] + word[k] + word[k + 2 :]


def dropped(word: str, k: int, _: random.Random, __: str) -> str:
    """Leave a letter out."""
    return word[:k] + word[k + 1 :]


def doubled(word: str, k: int, _: random.Random, __: str) -> str:
    """Double a letter."""
    return word[:k] + word[k] + word[k:]


def missed(word: str, k: int, rng: random.Random, language: str) -> str:
    """Hit the key beside."""
    for row in ROWS.get(language, ROWS[""]):
        place = row.find(word[k].lower())
        if place >= 0:
            return word[:k] + rng.choice([row[i] for i in (place - 1, place + 1) if 0 <= i < len(row)]) + word[k + 1 :]
    return word


def plain(word: str, _: int, __: random.Random, ___: str) -> str:
    """Leave accents and umlauts out."""
    return "".join(c for c in unicodedata.normalize("NFD", word) if not unicodedata.combining(c))


LETTERS: Mapping[str, Callable[[str, int, random.Random, str], str]] = {
    "swapped": swapped,
    "dropped": dropped,
    "doubled": doubled,
    "missed": missed,
    "accents": plain,
}


def slip(prompt: str, kind: str, rng: random.Random, language: str) -> tuple[str, str]:
    """Return a prompt with one typing error and the word that it was made in; the prompt itself where no word takes such an error."""
    if kind == "joined":
        gaps = list(re.finditer(r"(?<=[^\W\d_]{3}) (?=[^\W\d_]{3})", prompt))
        if not gaps:
            return prompt, ""
        gap = rng.choice(gaps)
        return prompt[: gap.start()] + prompt[gap.end() :], re.split(r"[\W\d]", prompt[: gap.start()])[-1] + "_" + re.split(
            r"[\W\d]", prompt[gap.end() :]
        )[0]
    found = [m for m in WORD.finditer(prompt) if kind != "accents" or plain(m[0], 0, rng, language) != m[0]]
    if not found:
        return prompt, ""
    word = rng.choice(found)
    wrong = LETTERS[kind](word[0], rng.randrange(1, len(word[0])), rng, language)
    return prompt[: word.start()] + wrong + prompt[word.end() :], f"{word[0]} -> {wrong}"


def said(prompt: str) -> dict[str, Any] | str:
    """Return the program of a prompt without the places of its words, or the class of its refusal."""
    try:
        return parse(prompt).model_dump(mode="json", exclude={"evidence", "unparsed"})
    except SfgenError as error:
        return type(error).__name__


def tried(cases: Iterable[Mapping[str, Any]], seeds: int = 1) -> Iterator[tuple[str, str, str, bool]]:
    """Yield (language, kind of error, words concerned, whether the program stayed) for each case, kind and seed."""
    for case in cases:
        language = case["id"][:2]
        if language not in WRITTEN:
            continue
        right = said(case["prompt"])
        for seed in range(seeds):
            for kind in (*LETTERS, "joined"):
                wrong, words = slip(case["prompt"], kind, random.Random(f"{case['id']} {kind} {seed}"), language)
                if wrong != case["prompt"]:
                    yield language, kind, words, said(wrong) == right


def main(cases: Iterable[Mapping[str, Any]], show: bool) -> int:
    """Print the shares; with `show` also each error that changed a program."""
    same: Counter[tuple[str, str]] = Counter()
    count: Counter[tuple[str, str]] = Counter()
    for language, kind, words, stayed in tried(cases):
        for key in ((language, kind), (language, "all")):
            count[key] += 1
            same[key] += stayed
        if show and not stayed:
            print(f"{language} {kind}: {words}")
    for key in sorted(count):
        print(f"{' '.join(key)}: {same[key]} of {count[key]} programs unchanged ({100 * same[key] / count[key]:.1f} %)")
    return 0
