"""`sfgen export`: homes of a dataset as MJCF, URDF or GLB."""

import sys
from collections.abc import Sequence
from pathlib import Path

from pipeline.errors import ContentError, UsageError
from pipeline.execution import track
from pipeline.export import ExportFolder, export_home, home_stages
from pipeline.shards import read_header


def main(_root: Path, *, dataset: Path, to: str, out: Path, homes: Sequence[str] = ()) -> None:
    """Write `homes` (all, where none is named) of the dataset in folder `dataset` to `out`, in format `to`."""
    header = read_header(dataset)
    stages = home_stages(dataset, header)
    missing = [name for name in homes if name not in stages]
    if missing:
        known = f"it has {len(stages)}, {min(stages)} to {max(stages)}" if stages else "it has none"
        raise UsageError(f"{dataset} has no home {missing[0]}", f"name one of its homes: {known}")
    if not stages:
        raise ContentError(f"{dataset} has no homes", "make it again, or wait for its first shard")
    folder = ExportFolder.of_dataset(out, to, header)
    chosen = list(dict.fromkeys(homes)) or list(stages)
    for name in track(chosen, len(chosen), f"export to {to}"):
        export_home(folder, stages[name], name)
    sys.stdout.write(f"{out}: {len(chosen)} homes as {to}, such as {folder.home_file(chosen[0])}\n")
