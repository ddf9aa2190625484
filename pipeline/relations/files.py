"""Relations as JSON: small, stable, readable."""

import json
from pathlib import Path
from typing import Any

from pipeline.errors import ContentError
from pipeline.manifest import write_bytes
from pipeline.relations.model import PairRelation, Relations, WallRelation, relations
from pipeline.relations.modes import Mode, Span

VERSION = 2
DIGITS = 4


def to_json(known: Relations) -> dict[str, Any]:
    """Return relations as plain lists and numbers."""
    pairs = [
        [p.anchor, p.member, p.cases, round(p.share, DIGITS), round(p.chance, DIGITS), [_mode_json(m) for m in p.modes]]
        for p in known.pairs.values()
    ]
    walls = [
        [w.category, w.side, w.cases, round(w.share, DIGITS), round(w.chance, DIGITS), list(w.gap), list(w.turn)]
        for sides in known.walls.values()
        for w in sides
    ]
    distances = [[*names, distance] for names, distance in known.distances.items()]
    return {"version": VERSION, "pairs": pairs, "walls": walls, "distances": distances}


def of_json(tree: Any) -> Relations:
    """Return the relations that `to_json` wrote. Raises ContentError for anything else."""
    try:
        if tree["version"] != VERSION:
            raise ContentError(f"relations of version {tree['version']}, not {VERSION}", "run `dvc repro preprocess`")
        pairs = [PairRelation(a, m, tuple(_mode(r) for r in modes), n, share, chance) for a, m, n, share, chance, modes in tree["pairs"]]
        walls = [WallRelation(c, s, Span(*gap), Span(*turn), n, share, chance) for c, s, n, share, chance, gap, turn in tree["walls"]]
        distances = {(str(a), str(b)): float(distance) for a, b, distance in tree["distances"]}
    except (KeyError, TypeError, ValueError) as error:
        raise ContentError(f"no relations ({type(error).__name__}: {error})", "run `dvc repro preprocess`") from error
    return relations(pairs, walls, distances)


def save(path: Path, known: Relations) -> None:
    """Write relations, a line for each pair, wall and distance."""
    tree = to_json(known)
    lines = {key: ",\n".join(f"  {json.dumps(row)}" for row in tree[key]) for key in ("pairs", "walls", "distances")}
    parts = [f'"version": {VERSION}', *(f'"{key}": [\n{text}\n]' for key, text in lines.items())]
    write_bytes(path, ("{" + ",\n".join(parts) + "}\n").encode())


def load(path: Path) -> Relations:
    """Read relations. Raises ContentError when the file is missing or holds something else."""
    try:
        return of_json(json.loads(path.read_text(encoding="utf-8")))
    except FileNotFoundError as error:
        raise ContentError(f"{path} is missing", "run `dvc repro preprocess`, which learns it from the tables") from error
    except ValueError as error:
        raise ContentError(f"{path} is not JSON ({error})", "delete it and run `dvc repro preprocess`") from error


def _mode_json(mode: Mode) -> list[Any]:
    return [mode.side, round(mode.weight, DIGITS), list(mode.outwards), list(mode.along), list(mode.turn)]


def _mode(row: list[Any]) -> Mode:
    side, weight, outwards, along, turn = row
    return Mode(side, Span(*outwards), Span(*along), Span(*turn), weight)
