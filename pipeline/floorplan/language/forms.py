"""The forms of a phrase of a lexicon: its plurals."""

from __future__ import annotations

from collections.abc import Iterator


def _plurals(language: str, phrase: str) -> Iterator[str]:
    head, _, last = phrase.rpartition(" ")
    made = []
    if language == "en":
        if last.endswith("y") and last[-2:-1] not in "aeiou":
            made = [last[:-1] + "ies"]
        elif last.endswith(("s", "ch", "sh", "x")):
            made = [last + "es"]
        else:
            made = [last + "s"]
    elif language == "es":
        parts = [
            p if p in {"de", "del", "la", "el", "los", "las", "en", "a", "y", "para", "estar"} else _spanish(p) for p in phrase.split()
        ]
        first = phrase.split()
        yield " ".join(parts)
        if len(first) > 2 and first[1] in {"de", "del", "para", "en"}:
            yield " ".join([_spanish(first[0]), *first[1:]])
        return
    for form in made:
        yield f"{head} {form}".strip()


def _spanish(word: str) -> str:
    if word.endswith("ón"):
        return word[:-2] + "ones"
    if word.endswith("z"):
        return word[:-1] + "ces"
    return word + ("s" if word[-1] in "aeiouáéó" else "es")


def forms(language: str, phrase: str) -> Iterator[tuple[str, bool]]:
    """Return (form, whether it is a plural) of an entry "singular|plural|plural"."""
    single, *many = phrase.split("|")
    yield single, False
    for form in many or _plurals(language, single):
        yield form, form != single
