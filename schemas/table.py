"""What a table is: ordered columns, each with Arrow type, unit, frame and doc, kept in the Parquet metadata."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import pyarrow as pa

SCHEMA_VERSION = "2"  # 2: joints say which others they wait for; furniture is counted apart from small things

VEC2 = pa.list_(pa.float64(), 2)
VEC3 = pa.list_(pa.float64(), 3)
NAMES = pa.list_(pa.string())
LATENT = pa.list_(pa.float32(), 32)
POLYGON = pa.list_(VEC2)


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
