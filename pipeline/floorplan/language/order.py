"""Word order: marks of a language are brought into the order that the reader reads (head, relation, object)."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from dataclasses import replace

from pipeline.floorplan.language.lexicon import Lexicon, lexicon
from pipeline.floorplan.language.tokens import Mark, Words

Bracket = tuple[tuple[str, ...], tuple[str, ...], str]  # "an ... grenzt": two parts and what they mean
ENDS = {"stop", "line", "colon", "comma"}
HEADS = {"room", "suite"}
LISTED = {"room", "det", "adj", "size", "num", "clf", "comma", "join"}
FARTHEST = 14  # marks between the two parts of a bracket


def reorder(marks: list[Mark], heard: Words) -> list[Mark]:
    """Return the marks in the order that the reader reads."""
    made, traits = _bracketed(marks, heard), heard.lexicon.traits
    if "verb_last" in traits:
        return list(_verbs_last(made, heard))
    return _behind(made, heard.lexicon) if "adjectives_behind" in traits else made


def _bracketed(marks: list[Mark], heard: Words) -> list[Mark]:
    """Make one relation of its two parts: "an ... grenzt" stands where "an" stood."""
    made, lex = list(marks), heard.lexicon
    k = 0
    while k < len(made) if lex.frames else False:
        found = _bracket(made, k, lex)
        if found is not None:
            cue, start, second, end = found
            only = any(m.text in lex.sign("only") for m in made[max(0, k - 2) : k])
            kind = "cmp" if cue in {"larger", "smaller"} else "cue"
            first = replace(made[k], kind=kind, value=cue, last=made[start - 1].last, number=0.0, only=made[k].only or only)
            inside = made[start:second]
            none = [inside.pop()] if inside and inside[-1].kind == "neg" else []  # "厨房与卧室不相通"
            made[k:end] = [*none, first, *inside, *(m for m in made[second:end] if m.kind in ENDS)]
            k += len(none)
        k += 1
    return made


def _bracket(marks: list[Mark], k: int, lex: Lexicon) -> tuple[str, int, int, int] | None:
    """Return (relation, end of its first part, place and end of the second) of a bracket that begins at mark k."""
    for first, second, cue in _brackets(lex.language).get(_plain(marks[k].text.split(" ", 1)[0], lex), ()):
        start = _matches(marks, k, first, lex)
        named = False
        for j in range(start, min(len(marks), start + FARTHEST)) if start is not None else ():
            mark, end = marks[j], _matches(marks, j, second, lex)
            comma = mark.kind == "comma" and cue.startswith("thru")
            article = first[0] in lex.sign("article_first") and mark.text.split(" ", 1)[0] in lex.sign("otherwise")
            other = mark.kind == "cue" and mark.value not in {"has", "in", "door"} and end is None
            again = (
                named
                and end is None
                and (
                    _begins(marks, j, second, cue, lex)
                    if first[0] in lex.sign("also_and")
                    else cue == "open" and _matches(marks, j, first, lex) is not None
                )
            )
            if (mark.kind in ENDS and not comma) or article or other or again:
                break
            if named and end is not None and not _goes_on(marks, end, second, lex):
                return cue, start or 0, j, end
            named = named or mark.kind in {*HEADS, "pron", "every", "zone"}
    return None


def _begins(marks: list[Mark], k: int, second: tuple[str, ...], cue: str, lex: Lexicon) -> bool:
    """Whether a bracket with the same second part begins anew at k: "A和B与C相连" is a list and then a bracket."""
    known = _brackets(lex.language).get(_plain(marks[k].text.split(" ", 1)[0], lex), ())
    return any(b == second and c == cue and _matches(marks, k, a, lex) is not None for a, b, c in known)


def _goes_on(marks: list[Mark], end: int, second: tuple[str, ...], lex: Lexicon) -> bool:
    """Whether the second part has an object of its own: "ins Bad geht man über den Flur", "卫生间和洗衣房都不能挨着餐厅"."""
    if end >= len(marks):
        return False
    if set(second) <= lex.sign("way_through"):
        return marks[end].kind not in ENDS | {"join"}
    return "characters" in lex.traits and marks[end - 1].kind == "cue" and marks[end].kind in HEADS | {"num", "zone"}


@functools.cache
def _brackets(language: str) -> dict[str, tuple[Bracket, ...]]:
    """Return the brackets of a language by their first word, prepositions without the article that melted into them."""
    made: dict[str, dict[Bracket, None]] = {}
    lex = lexicon(language)
    for first, second, cue in (b for some in lex.frames.values() for b in some):
        plain = tuple(_plain(w, lex) for w in first), tuple(_plain(w, lex) for w in second), cue
        made.setdefault(plain[0][0], {})[plain] = None
    return {word: tuple(sorted(found, key=lambda f: -len(f[0]) - len(f[1]))) for word, found in made.items()}


def _plain(word: str, lex: Lexicon) -> str:
    return lex.compounds.melted.get(word, word)


def _matches(marks: list[Mark], k: int, wanted: tuple[str, ...], lex: Lexicon) -> int | None:
    """Return where the marks go on after the words wanted, where they stand at k; adverbs between them are skipped."""
    need = list(wanted)
    while need and k < len(marks):
        have = [_plain(w, lex) for w in marks[k].text.split()]
        if have == need[: len(have)]:
            need = need[len(have) :]
        elif have[: len(need)] == need and set(have[len(need) :]) <= lex.sign("article"):  # "in die Küche übergeht"
            need = []
        elif len(need) == len(wanted) or marks[k].kind not in {"adverb", "flag", "comma"}:
            return None
        k += 1
    return None if need else k


def _verbs_last(marks: list[Mark], heard: Words) -> Iterator[Mark]:
    """Yield the marks with plurals that only articles tell, with "hat" in front of what is had, and articles out of prepositions."""
    made, lex = list(marks), heard.lexicon
    for k in range(len(made)):
        mark, ahead = made[k], made[k + 1] if k + 1 < len(made) else None
        if mark.kind == "room" and any(heard.tokens[mark.last - 1].text.lower().endswith(t) for t in lex.sign("dative")):
            made[k] = replace(mark, plural=True)
        described = k > 1 and made[k - 1].kind in {"adj", "size"} and any(m.kind == "num" for m in made[max(0, k - 4) : k])
        if (mark.kind, mark.value) == ("unit", "rooms") and described:
            made[k] = replace(mark, kind="room", value="bedroom", plural=True)  # "vier gleich große Zimmer"
        uncounted = mark.text in lex.sign("plural_article") | lex.sign("plural_dative") and ahead is not None and ahead.kind == "room"
        if uncounted and ahead is not None and any(ahead.text.endswith(t) for t in lex.sign("uncounted")):
            made[k + 1] = replace(ahead, plural=mark.text in lex.sign("plural_article"))
        if mark.kind == "det" and mark.text in lex.sign("to_be") and (ahead is None or ahead.kind in ENDS | {"join"}):
            made[k] = replace(mark, kind="verb", value="")  # "sollen verbunden sein"
        _final(made, k, lex)
    for k, mark in enumerate(made):
        if mark.kind in HEADS and k and made[k - 1].kind == "cue" and made[k - 1].text.rsplit(" ", 1)[-1] in lex.sign("with_article"):
            yield Mark("det", "definite", 0.0, False, mark.first, mark.first, "")  # "ins Bad" means a bathroom that is known
        yield mark


def _final(made: list[Mark], k: int, lex: Lexicon) -> None:
    """Put a "hat" at the end of a clause in front of what is had: "eines, das ein eigenes Bad hat"."""
    ahead = made[k + 1].kind if k + 1 < len(made) else "stop"
    if (
        made[k].text not in lex.sign("having_last")
        or ahead not in {"comma", "stop", "join", "line"}
        or not k
        or made[k - 1].kind not in HEADS
    ):
        return
    start = k - 1
    while start and made[start - 1].kind in {"det", "num", "adj", "size", "ord", "clf"}:
        start -= 1
    if not start or made[start - 1].kind != "cue" or made[start - 1].value == "has":  # not "eine Wand mit dem Wohnzimmer haben"
        made.insert(start, made.pop(k))


def _behind(marks: Sequence[Mark], lex: Lexicon) -> list[Mark]:
    """Read adjectives behind their noun: "dormitorio principal", "cocina abierta", "baño propio"."""
    made: list[Mark] = []
    for mark in marks:
        before = made[-1] if made else None
        behind = before is not None and (before.kind in {*HEADS, "post"} or (before.kind, before.value) == ("size", "post"))
        if behind and (mark.kind == "adj" or (mark.kind == "det" and mark.value in {"own", "another"})):
            made.append(replace(mark, kind="post"))
        elif behind and mark.text in lex.sign("single_bed") and before is not None and before.value.startswith("bedroom"):
            made.append(replace(mark, kind="post", value="plain"))
        elif behind and mark.text in lex.sign("more") and before is not None and before.kind == "room":
            made.append(replace(mark, kind="post", value="another"))
        elif behind and mark.kind == "size":
            made.append(replace(mark, value="post"))
        elif not (behind and mark.kind == "adverb" and mark.text in lex.sign("very")):
            made.append(mark)
    return made
