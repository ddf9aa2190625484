"""The forms of a phrase of a lexicon: plurals, and the names of rooms by who they are for."""

from __future__ import annotations

from collections.abc import Iterator

OWNED = {  # how the bedroom of somebody is called: patterns, and what stands in front of the people
    "en": (("room|rooms", "bedroom|bedrooms"), ("", "the ", "a ", "an ", "my ", "our ", "his ", "her ", "their ")),
    "es": (
        ("habitación|habitaciones", "dormitorio|dormitorios", "cuarto|cuartos", "recámara|recámaras", "alcoba|alcobas"),
        ("", "la ", "el ", "los ", "las ", "mi ", "mis ", "su ", "sus ", "un ", "una ", "nuestra ", "nuestro "),
    ),
}


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


def owned(language: str, owner: str) -> Iterator[tuple[str, bool]]:
    """Return (phrase, whether it is a plural) of the bedrooms of somebody: "nanny's room", "room for the nanny"; "habitación de la niñera"."""
    heads, articles = OWNED.get(language, ((), ()))
    for head in heads:
        for form, many in zip(head.split("|"), (False, True), strict=True):
            for article in articles:
                if language == "en":
                    yield f"{form} for {article}{owner}", many
                else:
                    yield from ((f"{form} {link} {article}{owner}".replace(" de el ", " del "), many) for link in ("de", "para"))
            if language == "en":
                bare = owner.removeprefix("the ")
                yield from ((f"{bare}{end} {form}", many) for end in ("", "'s", "'"))
    for article in ("la", "el") if language == "es" else ():  # "junto a la de los niños"
        yield from ((f"{article} de {whose}{owner}".replace(" de el ", " del "), False) for whose in articles[:5])
