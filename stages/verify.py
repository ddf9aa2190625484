"""`sfgen verify`: is a dataset whole, do its stages open as they should."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

from pipeline.execution import Progress, Voice, track
from pipeline.shards import TABLES, check, read_header
from pipeline.shards.layout import table_path
from pipeline.tables import read


def main(_root: Path, *, folder: Path, quick: bool = False, voice: Voice = "plain") -> None:
    """Check every digest, row and reference, then (unless `quick`) open every stage with USD."""
    files = Progress(0, "files", unit="shard", voice=voice)
    summary = check(folder, files.at)
    files.close()
    if not quick:
        from pipeline.usd.check import check_stage

        for path in track(stages(folder), summary.homes, "stages", unit="stage", voice=voice):
            check_stage(path)
    if voice == "json":
        files.summary(dataset=str(folder), **asdict(summary))
        return
    rows = ", ".join(f"{count} {table}" for table, count in summary.rows.items() if table != "scenes")
    size = f"{summary.files} files, {summary.bytes / 1e6:.1f} MB"
    empty = f", {summary.empty} stay empty (see rejects)" if summary.empty else ""
    sys.stdout.write(f"{folder} is whole: {summary.homes} homes in {summary.shards} shards{empty} ({rows}; {size})\n")


def stages(folder: Path) -> Iterator[Path]:
    """Yield the path of each home's stage."""
    for number in range(read_header(folder).shards):
        for row in read(folder / table_path("scenes", number), TABLES["scenes"]):
            if row["usd"]:
                yield folder / row["usd"]
