"""Writes the table of columns in docs/dataset.md from the schemas.

python .ci/reference.py
"""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "dataset.md"
BEGIN, END = "<!-- columns: written by .ci/reference.py -->\n", "<!-- end of columns -->\n"


def columns() -> str:
    """Return the reference of all tables of a dataset in Markdown."""
    sys.path.insert(0, str(ROOT))
    from pipeline.shards import TABLES

    parts = []
    for table in TABLES.values():
        rows = [
            f"| `{c.name}` | `{kind(str(c.type))}` | {c.unit} | {c.frame} | {c.doc}{', or null' if c.nullable else ''} |"
            for c in table.columns
        ]
        parts.append(
            "\n".join(
                [f"### {table.name}", "", table.doc, "", "| column | type | unit | frame | what |", "|---|---|---|---|---|", *rows, ""]
            )
        )
    return "\n".join(parts)


def kind(arrow: str) -> str:
    """Return an Arrow type as people write it."""
    return arrow.replace("fixed_size_list", "list").replace("item: ", "").replace("double", "float64").replace("float>", "float32>")


def page(text: str) -> str:
    """Return the page with its columns brought up to date."""
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n{columns()}\n{END}{after}"


if __name__ == "__main__":
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
