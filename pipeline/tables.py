"""Parquet tables on disk: written atomically with the schema's metadata, read with the schema checked."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from pipeline.errors import ContentError
from pipeline.manifest import write_with
from schemas.table import Table


def write(path: Path, table: Table, rows: Iterable[Mapping[str, Any]]) -> pa.Table:
    """Write rows as zstd Parquet (whole or not at all) and return them as an Arrow table."""
    data = table.from_rows(rows)
    write_with(path, lambda temporary: pq.write_table(data, temporary, compression="zstd", store_schema=True))
    return data


def read(path: Path, table: Table) -> list[dict[str, Any]]:
    """Read a table as dict rows.

    Raises ContentError when the file is missing, truncated, or lacks one of the schema's columns.
    """
    rows: list[dict[str, Any]] = read_arrow(path, table).to_pylist()
    return rows


def read_arrow(path: Path, table: Table) -> pa.Table:
    """Read a table as Arrow, columns in the schema's order. Raises ContentError as `read` does."""
    if not path.is_file():
        raise ContentError(f"{path} is missing", "run `make run`, or `dvc repro`, which makes it")
    try:
        data = pq.ParquetFile(path).read()
    except (OSError, pa.ArrowException) as error:
        msg = f"{path} is not a readable Parquet file ({str(error).splitlines()[0]})"
        raise ContentError(msg, "delete it and run `dvc repro` again") from error
    missing = [c.name for c in table.columns if c.name not in data.column_names]
    if missing:
        raise ContentError(f"{path} lacks the columns {', '.join(missing)}", "delete it and run `dvc repro` again")
    return data.select([c.name for c in table.columns])
