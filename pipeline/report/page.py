"""The report page: sections of text, tables and pictures, rendered to self-contained HTML."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

STYLE = """
body{font:16px/1.5 system-ui,sans-serif;max-width:1080px;margin:2rem auto;padding:0 1rem;color:#1d2530;background:#fff}
h1{font-size:1.9rem;margin:0 0 .3rem}h2{margin:2.4rem 0 .6rem;border-bottom:1px solid #d9dee5;padding-bottom:.2rem}
table{border-collapse:collapse;margin:.8rem 0}caption{text-align:left;color:#5a6675;padding:.2rem 0;font-size:.92rem}
th,td{padding:.28rem .8rem;border-bottom:1px solid #e6eaef;text-align:right;font-variant-numeric:tabular-nums}
th:first-child,td:first-child,td.words,th.words{text-align:left}th{background:#f4f6f9}
.pictures{display:grid;grid-template-columns:repeat(auto-fill,minmax(320px,1fr));gap:14px}
.pictures.wide{grid-template-columns:repeat(auto-fill,minmax(480px,1fr))}
figure{margin:0}img{width:100%;border:1px solid #e0e4ea;border-radius:6px}
figcaption{font-size:.86rem;color:#5a6675}p{max-width:50rem}
"""


@dataclass(frozen=True, slots=True)
class TableView:
    """A table as shown: every cell is text already."""

    caption: str
    header: Sequence[str]
    rows: Sequence[Sequence[str]]


@dataclass(frozen=True, slots=True)
class Picture:
    """An image file, its path relative to the page, and a caption; a click opens it, or the page `opens`."""

    path: str
    caption: str
    opens: str = ""


@dataclass(frozen=True, slots=True)
class Section:
    """One chapter of the page."""

    title: str
    text: Sequence[str] = ()
    tables: Sequence[TableView] = ()
    pictures: Sequence[Picture] = ()
    wide: bool = False


def render(title: str, lead: str, sections: Sequence[Section]) -> str:
    """Return the whole page as HTML."""
    body = "\n".join(_section(section) for section in sections)
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f"<style>{STYLE}</style></head><body>\n<h1>{escape(title)}</h1>\n<p>{escape(lead)}</p>\n{body}\n</body></html>\n"
    )


def _section(section: Section) -> str:
    parts = [f"<h2>{escape(section.title)}</h2>", *(f"<p>{escape(text)}</p>" for text in section.text)]
    parts += [_table(table) for table in section.tables]
    if section.pictures:
        figures = "".join(
            f'<figure><a href="{escape(p.opens or p.path)}"><img src="{escape(p.path)}" alt="{escape(p.caption)}" loading="lazy"></a>'
            f"<figcaption>{escape(p.caption)}</figcaption></figure>"
            for p in section.pictures
        )
        parts.append(f'<div class="pictures{" wide" if section.wide else ""}">{figures}</div>')
    return "\n".join(parts)


def _table(table: TableView) -> str:
    # columns of words read from the left, columns of figures stand under each other
    words = [bool(table.rows) and all(row[k][:1].isalpha() for row in table.rows if row[k]) for k in range(len(table.header))]
    kinds = [' class="words"' if w else "" for w in words]
    head = "".join(f"<th{kind}>{escape(cell)}</th>" for kind, cell in zip(kinds, table.header, strict=True))
    rows = "".join(
        "<tr>" + "".join(f"<td{kind}>{escape(cell)}</td>" for kind, cell in zip(kinds, row, strict=True)) + "</tr>" for row in table.rows
    )
    return f"<table><caption>{escape(table.caption)}</caption><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"
