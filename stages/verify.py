"""`sfgen verify`: is a dataset whole, do its stages open as they should."""

import sys
from collections.abc import Iterator
from dataclasses import asdict, replace
from pathlib import Path

from pipeline.execution import Progress, Voice, track
from pipeline.shards import TABLES, read_header
from pipeline.shards.layout import table_path
from pipeline.tables import read
from sfgen.check import check


def main(root: Path, *, folder: Path, quick: bool = False, reproduce: int = 0, prompts: Path | None = None, voice: Voice = "plain") -> int:
    """Check every digest, row and reference, then (unless `quick`) open every stage with USD; make `reproduce` homes again."""
    files = Progress(0, "files", unit="shard", voice=voice)
    summary = check(folder, files.at, {name: table.schema() for name, table in TABLES.items()})
    files.close()
    if not quick:
        from pipeline.usd.check import check_stage

        for path in track(stages(folder), summary.homes, "stages", unit="stage", voice=voice):
            check_stage(path)
    if voice == "json":
        files.summary(dataset=str(folder), **asdict(summary))
    else:
        sys.stdout.write(f"{summary.line(str(folder))}\n")
    return again(root, folder, reproduce, prompts, files)


def again(root: Path, folder: Path, count: int, prompts: Path | None, progress: Progress) -> int:
    """Make homes of a dataset again, say on stderr what comes out otherwise here, and why that may be; returns the exit code."""
    if not count:
        return 0
    from pipeline.homes.factory import open_factory
    from pipeline.homes.prompt_mix import asked_of
    from pipeline.homes.reproduction import differing, made_with, spread_indices

    header = read_header(folder)
    factory = open_factory(root, header.seed, preview=header.preview)
    asked = asked_of(root, header, prompts)
    here = replace(header, digests={**header.digests, **factory.digests}, versions=made_with())
    for difference in header.differences(here):
        sys.stderr.write(f"sfgen: it was made with {difference}\n")
    indices = spread_indices(header, count)
    differences = differing(folder, header, factory, asked, indices)
    for line in differences:
        sys.stderr.write(f"sfgen: {line}\n")
    progress.say(f"{len(indices) - len(differences)} of {len(indices)} homes come out the same, byte for byte")
    return 1 if differences else 0


def stages(folder: Path) -> Iterator[Path]:
    """Yield the path of each home's stage."""
    for number in range(read_header(folder).shards):
        for row in read(folder / table_path("scenes", number), TABLES["scenes"]):
            if row["usd"]:
                yield folder / row["usd"]
