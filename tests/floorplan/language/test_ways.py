"""Ways to say the same, as tables (`ways/*.yaml`): each phrasing with each choice of rooms, and what its program must state."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
import yaml

from pipeline.floorplan import parse
from tests.floorplan.language.faults import faults

FOLDER = Path(__file__).parent / "ways"
LANGUAGES = sorted(p.stem for p in FOLDER.glob("*.yaml"))
LOST = 0.05  # of the ways at most; 0.01 (English) and 0.03 (Spanish) when it was written
CONTRACTED = {" a el ": " al ", " de el ": " del "}  # Spanish


def _typed(value: Any, types: Mapping[str, str]) -> Any:
    """Put the types of rooms for the letters of a table."""
    if isinstance(value, str):
        return types.get(value, value)
    if isinstance(value, Mapping):
        return {types.get(k, k): _typed(v, types) for k, v in value.items()}
    return [_typed(v, types) for v in value] if isinstance(value, list) else value


def cases(language: str) -> Iterator[tuple[str, dict[str, Any], str]]:
    """Return (meaning, case for `tests.floorplan.language.faults`, reason why it is known to fail) for every way and choice."""
    table = yaml.safe_load((FOLDER / f"{language}.yaml").read_text(encoding="utf-8"))
    for entry in table["meanings"]:
        for way in entry["ways"]:
            row = way if isinstance(way, Mapping) else {"way": way}
            for chosen in entry["choices"]:
                types = dict(zip("abcde", chosen, strict=False))
                bare = entry.get("fill", {})
                names = {k: bare.get(t, table["rooms"].get(t, t)) for k, t in types.items()}
                names |= {k.upper(): f"{table.get('article', '')}{n}" for k, n in names.items()}
                prompt = row["way"].format(**names) if types else row["way"]
                for apart, joined in CONTRACTED.items() if language == "es" else ():
                    prompt = prompt.replace(apart, joined)
                wanted = _typed(row.get("gives", entry["gives"]), types)
                wanted.setdefault("rooms", {t: 1 for k, t in types.items() if "{" + k in row["way"] or "{" + k.upper() in row["way"]})
                yield entry["meaning"], {"prompt": prompt[0].upper() + prompt[1:], **wanted}, row.get("known", "")


def wrong(case: Mapping[str, Any]) -> list[str]:
    """Return what the program of a case states wrongly, common walls and distances among it."""
    found = faults(case)
    if found or not (case.get("walls") or case.get("away")):
        return found
    program = parse(case["prompt"])
    kinds = {r.id: r.type for r in program.rooms}
    walls = [{kinds[k.a], kinds[k.b]} for k in program.links if k.kind == "wall"]
    far = [{kinds.get(r.a, r.a), kinds.get(r.b or "", r.b)} for r in program.relations if r.kind == "separation"]
    found += [f"no wall {pair}" for pair in case.get("walls", ()) if set(pair) not in walls]
    return found + [f"not far {pair}" for pair in case.get("away", ()) if set(pair) not in far]


def share(language: str) -> tuple[list[tuple[str, str, list[str]]], int]:
    """Return what is read wrongly, and how many cases there are."""
    found = [(meaning, case["prompt"], wrong(case)) for meaning, case, _ in cases(language)]
    return [f for f in found if f[2]], len(found)


@pytest.mark.parametrize("language", LANGUAGES)
def test_most_ways_give_what_their_table_says(language: str) -> None:
    failed, count = share(language)
    assert len(failed) <= LOST * count, "\n".join(f"{m}: {p}: {w}" for m, p, w in failed)
