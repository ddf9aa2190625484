"""Tables of ways to say one thing: each sentence, alone and behind a list of rooms, with every choice of rooms.

`phrasings/LANG.yaml`: `what` is said, what it `gives` (a case of faults.py with a, b, c, d for the rooms of a choice) and the sentences that `say` it.
`python -m tests.floorplan.language.test_phrasings [LANG]` prints the sentences that are read wrongly, and the share that is read.
"""

import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import yaml

from pipeline.floorplan import parse
from tests.floorplan.language.faults import faults

TABLES = Path(__file__).resolve().parent / "phrasings"
LANGUAGES = sorted(p.stem for p in TABLES.glob("*.yaml"))
ROLES = {"primary": "bedroom", "guest": "bedroom", "child": "bedroom"}
LETTERS = "abcd"
LOST = 0.07  # of the ways at most; 0.06 since rules for turns that nobody writes are gone


class Way(NamedTuple):
    """One sentence, the prompts that it makes, and whether it is known to be read wrongly."""

    name: str
    known: bool
    cases: list[dict[str, Any]]
    adjacent: bool


def ways(language: str) -> Iterator[Way]:
    """Yield the ways of a table."""
    table = yaml.safe_load((TABLES / f"{language}.yaml").read_text(encoding="utf-8"))
    for block in table["ways"]:
        rows = [{"say": r} if isinstance(r, str) else r for r in [*block.get("say", ()), *block.get("cases", ())]]
        for row in rows:
            cases = [c for choice in block.get("choices", table["choices"]) for c in _cases(table, block, row, choice)]
            yield Way(f"{language} {block['what']}: {row['say']}", bool(row.get("known")), cases, block.get("adjacent", False))


def _cases(table: dict[str, Any], block: dict[str, Any], row: dict[str, Any], choice: list[str]) -> Iterator[dict[str, Any]]:
    rooms = dict(zip(LETTERS, choice, strict=False))
    said = _filled(table, row["say"], rooms)
    gives = _typed(row.get("gives", block.get("gives")), {k: ROLES.get(t, t) for k, t in rooms.items()})
    used = [rooms[x] for x in LETTERS if "{" + x in row["say"]]
    counts = gives.get("rooms", {ROLES.get(t, t): 1 for t in used})
    case = {"links": [], **gives, "rooms": [t for t, n in counts.items() for _ in range(n)]}
    yield {**case, "prompt": said}
    lead = block.get("lead", table["lead"])
    if lead and used:
        words = [_word(table, t, "") for t in used]
        listed = table.get("comma", ", ").join(words[:-1]) + table.get("and", " und ") * (len(words) > 1) + words[-1]
        yield {**case, "prompt": lead.format(rooms=listed) + table.get("gap", " ") + said}


def _filled(table: dict[str, Any], say: str, rooms: dict[str, str]) -> str:
    """Put the rooms into a sentence, and capitals where sentences begin."""
    made = re.sub(r"\{([a-d])(?:\.(\w+))?\}", lambda m: _word(table, rooms[m[1]], m[2] or ""), say)
    return re.sub(r"(?:^|(?<=[^ ][^ ][.] ))[a-zäöüáéíóúñ]", lambda m: m[0].upper(), made)


def _word(table: dict[str, Any], room: str, form: str) -> str:
    word = table["words"][room]
    return word if isinstance(word, str) else word[form]


def _typed(value: Any, rooms: dict[str, str]) -> Any:
    if isinstance(value, dict):
        return {rooms.get(k, k): _typed(v, rooms) for k, v in value.items()}
    if isinstance(value, list):
        return [_typed(v, rooms) for v in value]
    return rooms.get(value, value) if isinstance(value, str) else value


def wrong(way: Way) -> list[tuple[str, list[str]]]:
    """Return the prompts of a way that are read wrongly, each with its faults."""
    found = []
    for case in way.cases:
        said = faults({k: v for k, v in case.items() if not (way.adjacent and k == "links")})
        if way.adjacent and not said and not parse(case["prompt"]).links:
            said = ["no common wall"]
        if said:
            found.append((case["prompt"], said))
    return found


@pytest.mark.parametrize("language", LANGUAGES)
def test_most_ways_to_say_it_are_read(language):
    table = list(ways(language))
    failed = [w.name for w in table if wrong(w)]
    assert len(failed) <= LOST * len(table), failed


def main(languages: list[str]) -> None:
    """Print what is read wrongly."""
    for language in languages:
        table = list(ways(language))
        failed = [(w, f) for w in table if (f := wrong(w))]
        for way, found in failed:
            sys.stdout.write(
                f"{'known ' if way.known else ''}{way.name}  [{len(found)} of {len(way.cases)}]\n    {found[0][0]}  {found[0][1]}\n"
            )
        sys.stdout.write(f"{language}: {len(table) - len(failed)} of {len(table)} ways\n")


if __name__ == "__main__":
    main(sys.argv[1:] or LANGUAGES)
