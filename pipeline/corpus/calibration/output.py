"""Writes the calibration: metrics/calibration.json, plots/classes.csv, a line on the terminal."""

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pipeline.corpus.calibration.figures import table
from pipeline.manifest import write_bytes, write_json


def write(root: Path, calibration: Mapping[str, Any]) -> None:
    """Write a calibration table under `root` and say how much of it is met."""
    write_json(root / "metrics" / "calibration.json", calibration)
    rows = [f"{kind}: {c},{v['ours']},{v['reference']}" for kind, shares in calibration["frequencies"].items() for c, v in shares.items()]
    write_bytes(root / "plots" / "classes.csv", "\n".join(["class,ours,reference", *rows, ""]).encode())
    verdicts = [line["ok"] for _, _, line in table(calibration)]
    sys.stdout.write(f"calibration: {sum(verdicts)} of {len(verdicts)} figures as in 3D-FRONT (metrics/calibration.json)\n")
