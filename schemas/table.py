"""What a table is: ordered columns, each with Arrow type, unit, frame and doc, kept in the Parquet metadata; read from a file a table."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa
import yaml

SCHEMA_VERSION = "2"  # 2: joints say which others they wait for; furniture is counted apart from small things

TYPES = {
    "bool": pa.bool_(),
    "float32": pa.float32(),
    "float64": pa.float64(),
    "int32": pa.int32(),
    "int64": pa.int64(),
    "string": pa.string(),
}


@dataclass(frozen=True, slots=True)
class Column:
    """One column: `unit` and `frame` are empty where they do not apply."""

    name: str
    type: pa.DataType
    doc: str
    unit: str = ""
    frame: str = ""
    nullable: bool = False

    def field(self) -> pa.Field:
        """Return the Arrow field with doc, unit and frame as metadata."""
        described = {"doc": self.doc, "unit": self.unit, "frame": self.frame}
        return pa.field(self.name, self.type, self.nullable, {k: v for k, v in described.items() if v})


@dataclass(frozen=True, slots=True)
class Table:
    """One table: a name, what a row is, and the columns."""

    name: str
    doc: str
    columns: tuple[Column, ...]

    def schema(self) -> pa.Schema:
        """Return the Arrow schema, its version in the metadata."""
        meta = {"doc": self.doc, "sfgen.table": self.name, "sfgen.schema_version": SCHEMA_VERSION}
        return pa.schema([c.field() for c in self.columns], meta)

    def from_rows(self, rows: Iterable[Mapping[str, Any]]) -> pa.Table:
        """Build the Arrow table from dict rows. Raises ValueError for a missing or an unknown column."""
        names = [c.name for c in self.columns]
        listed = list(rows)
        for row in listed:
            if row.keys() != set(names):
                odd = sorted(row.keys() ^ set(names))
                msg = f"table {self.name}: columns {odd} are missing or unknown"
                raise ValueError(msg)
        return pa.Table.from_pydict({n: [row[n] for row in listed] for n in names}, schema=self.schema())


def arrow_type(text: str) -> pa.DataType:
    """Return the Arrow type of `float64`, `float64[3]` (three of them), `string[]` (any number of them), `float64[2][]`."""
    inner, bracket, size = text.removesuffix("]").rpartition("[")
    if not bracket:
        return TYPES[text]
    return pa.list_(arrow_type(inner), int(size)) if size else pa.list_(arrow_type(inner))


def read_table(name: str) -> Table:
    """Read a table's file, `<name>.yaml` beside this one."""
    text = Path(__file__).with_name(f"{name}.yaml").read_text(encoding="utf-8")
    entries = getattr(yaml, "CSafeLoader", yaml.SafeLoader)(text).get_single_data()  # in C, where PyYAML has it
    columns = (Column(column, **{**about, "type": arrow_type(about["type"])}) for column, about in entries["columns"].items())
    return Table(name, entries["doc"], tuple(columns))
