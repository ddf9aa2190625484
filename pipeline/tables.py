"""Parquet tables on disk: written atomically with the schema's metadata, read with the schema checked."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from pipeline.errors import ContentError
from pipeline.manifest import replacing, write_with
from schemas.table import Table

GROUP = 8192  # rows that a stream holds before it writes them


def write(path: Path, table: Table, rows: Iterable[Mapping[str, Any]]) -> pa.Table:
    """Write rows as zstd Parquet (whole or not at all) and return them as an Arrow table."""
    data = table.from_rows(rows)
    write_with(path, lambda temporary: pq.write_table(data, temporary, compression="zstd", store_schema=True))
    return data


class Stream:
    """A table that is written while its rows are made, in groups of GROUP rows; `rows` counts them."""

    def __init__(self, writer: pq.ParquetWriter, table: Table) -> None:
        self._writer, self._table = writer, table
        self._waiting: list[Mapping[str, Any]] = []
        self.rows = 0

    def add(self, rows: Iterable[Mapping[str, Any]]) -> None:
        """Append rows."""
        self._waiting += rows
        while len(self._waiting) >= GROUP:
            self._put(self._waiting[:GROUP])
            del self._waiting[:GROUP]

    def finish(self) -> None:
        """Write what waits; a table without rows is a table as well."""
        if self._waiting or not self.rows:
            self._put(self._waiting)
        self._waiting = []

    def _put(self, rows: list[Mapping[str, Any]]) -> None:
        self._writer.write_table(self._table.from_rows(rows))
        self.rows += len(rows)


@contextmanager
def stream(path: Path, table: Table) -> Iterator[Stream]:
    """Open a zstd Parquet file to append rows to; it is there, whole, when the block ends without an error."""
    with replacing(path) as temporary, pq.ParquetWriter(temporary, table.schema(), compression="zstd", store_schema=True) as writer:
        row_stream = Stream(writer, table)
        yield row_stream
        row_stream.finish()


def read(path: Path, table: Table, scenes: Collection[str] | None = None) -> list[dict[str, Any]]:
    """Read a table as dict rows, of these scenes where some are given.

    Raises ContentError when the file is missing, truncated, or lacks one of the schema's columns.
    """
    rows: list[dict[str, Any]] = read_arrow(path, table, scenes).to_pylist()
    return rows


def parquet(path: Path, columns: list[str] | None = None) -> pa.Table:
    """Read a Parquet file, or some of its columns. Raises OSError and ArrowException.

    In this thread alone: Arrow's own threads now and then abort a process that ends while they do (apache/arrow 34314, 50482).
    """
    return pq.ParquetFile(path, pre_buffer=False).read(columns, use_threads=False)


def read_arrow(path: Path, table: Table, scenes: Collection[str] | None = None) -> pa.Table:
    """Read a table as Arrow, columns in the schema's order. Raises ContentError as `read` does."""
    if not path.is_file():
        raise ContentError(f"{path} is missing", "run `make run`, or `dvc repro`, which makes it")
    try:
        if scenes is None:
            data = parquet(path)
        else:
            wanted = pc.field("scene_id").isin(pa.array(sorted(scenes), pa.string()))
            data = pq.read_table(path, filters=wanted, partitioning=None, use_threads=False, pre_buffer=False)
    except (OSError, pa.ArrowException) as error:
        msg = f"{path} is not a readable Parquet file ({str(error).splitlines()[0]})"
        raise ContentError(msg, "delete it and run `dvc repro` again") from error
    missing = [c.name for c in table.columns if c.name not in data.column_names]
    if missing:
        raise ContentError(f"{path} lacks the columns {', '.join(missing)}", "delete it and run `dvc repro` again")
    return data.select([c.name for c in table.columns])
