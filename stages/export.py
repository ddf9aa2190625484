"""`sfgen export`: homes of a dataset as MJCF, URDF or GLB."""

import sys
from collections.abc import Sequence
from pathlib import Path

from pipeline.errors import ContentError, UsageError
from pipeline.execution import track
from pipeline.export import ExportFolder, export_home
from pipeline.manifest import digest
from pipeline.shards import TABLES, read_header
from pipeline.shards.layout import commit_path, shard_name, table_path
from pipeline.tables import read


def main(_root: Path, *, dataset: Path, to: str, out: Path, homes: Sequence[str] = ()) -> None:
    """Write `homes` (all, where none is named) of the dataset in folder `dataset` to `out`, in format `to`."""
    header = read_header(dataset)
    stages = {
        row["scene_id"]: dataset / row["usd"]
        for number in range(header.shards)
        if (dataset / commit_path(shard_name(number))).is_file()
        for row in read(dataset / table_path("scenes", number), TABLES["scenes"])
        if row["usd"]
    }
    missing = [name for name in homes if name not in stages]
    if missing:
        known = f"it has {len(stages)}, {min(stages)} to {max(stages)}" if stages else "it has none"
        raise UsageError(f"{dataset} has no home {missing[0]}", f"name one of its homes: {known}")
    if not stages:
        raise ContentError(f"{dataset} has no homes", "make it again, or wait for its first shard")
    folder = ExportFolder(out, to, digest(header.to_json()), header.licence)
    chosen = list(dict.fromkeys(homes)) or list(stages)
    for name in track(chosen, len(chosen), f"export to {to}"):
        export_home(folder, stages[name], name)
    sys.stdout.write(f"{out}: {len(chosen)} homes as {to}, such as {folder.home_file(chosen[0])}\n")
