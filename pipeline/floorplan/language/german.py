"""German compounds: numbers in one word, and nouns put together."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from pipeline.floorplan.language.meaning import Meaning

JOINTS = ("", "s", "n", "en", "es")
SHORTEST = 3


def numerals(simple: Mapping[float, str]) -> Iterator[tuple[str, Meaning]]:
    """Return the number words from 21 to 199 that are written together, e.g. "fünfundsiebzig", "hundertzwanzig"."""
    words = {int(n): entry.split(",")[0].strip() for n, entry in simple.items()}
    units = {n: "ein" if n == 1 else words[n] for n in range(1, 10)}
    below = {n: w for n, w in words.items() if 1 < n < 100} | {1: "eins"}
    below |= {t + u: f"{units[u]}und{words[t]}" for t in range(20, 100, 10) for u in units}
    yield from ((w, Meaning("num", str(n), float(n))) for n, w in below.items() if n > 20)
    for start in ("hundert", "einhundert", "hundertund"):
        yield from ((start + w, Meaning("num", str(100 + n), 100.0 + n)) for n, w in below.items())


SHORT = {"durchs": "durch", "uebers": "ueber", "ans": "an", "hinters": "hinter"}  # with the article in one word
TAILS = ("schlafzimmer", "zimmer", "raum", "bereich", "bad", "kueche")


def completed(texts: list[str], known: Collection[str]) -> list[str]:
    """Return the words with "Arbeits- oder Gästezimmer" written out; the hyphen stays where it is."""
    made = [SHORT.get(t, t) for t in texts]
    for k in range(len(texts) - 3):
        if texts[k + 1] == "-" and texts[k + 2] in {"oder", "und", ","} and texts[k].isalpha():
            last = next((t for t in texts[k + 3 :] if t.endswith(TAILS)), texts[k + 3])  # "Koch-, Ess- und Wohnbereich"
            tail = next((t for t in TAILS if last.endswith(t) and texts[k] + t in known), None)
            made[k] = texts[k] + tail if tail else texts[k]
    return made


def split(word: str, known: Collection[str], wanted: Collection[str]) -> tuple[str, ...]:
    """Split a compound into known words, one of them wanted; empty where it is none: "dreizimmerwohnung" is three words."""
    for cut in range(len(word) - SHORTEST, SHORTEST - 1, -1):
        head, rest = word[:cut], word[cut:]
        stem = next((head[: len(head) - len(j)] for j in JOINTS if head.endswith(j) and head[: len(head) - len(j)] in known), None)
        if stem is None or len(stem) < SHORTEST:
            continue
        tail = (rest,) if rest in known else split(rest, known, wanted)
        if tail and (stem in wanted or any(t in wanted for t in tail)):
            return (stem, *tail)
    return ()
