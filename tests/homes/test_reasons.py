from pathlib import Path

import pytest

from pipeline.homes.rows import REASONS, reject_row

DOCS = Path(__file__).resolve().parents[2] / "docs" / "reasons.md"


def test_every_code_stands_in_the_docs_word_for_word():
    table = DOCS.read_text(encoding="utf-8").split("## Making homes")[1]
    rows = [line for line in table.splitlines() if line.startswith("| `")]
    assert rows == [f"| `{code}` | {r.what} | {r.effect} | {r.doc} |" for code, r in REASONS.items()]


def test_an_unknown_code_never_reaches_the_table():
    with pytest.raises(KeyError):
        reject_row("s0", "r", 0, ("object", "no_such_reason", ""))
