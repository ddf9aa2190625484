"""Wishes for furniture taken out of a prompt: what is left speaks of rooms alone, every character in its place."""

from __future__ import annotations

from collections.abc import Sequence

from pipeline.floorplan.language.furnishing import Claim, Scan
from pipeline.floorplan.language.vocabulary import STOPS


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
    marks = [(j, step) for j in range(len(scan.words)) if (step := scan.phrase(j, "home")[0])]
    for c in (c for c in claims if c.home):
        for j, step in marks:
            if c.start - 40 < scan.words[j].start < c.end + 40:
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
