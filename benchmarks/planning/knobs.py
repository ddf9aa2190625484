"""Each knob against its own term: a table, its record (benchmarks/records/knobs.json) and the picture of it (docs/images/knobs.png)."""

import json
import os

from benchmarks.planning.record import RECORDS, ROOT, commit
from pipeline.experiments.knobs import VALUES, knob_picture, knob_table, monotone

MOST_JOBS = 8
LEAST = 100  # seeds of a table that is kept


def main(seeds: int, first: int = 0) -> None:
    """Print the means of each term over its knob's values; those over LEAST seeds and more are kept and drawn."""
    command = f"python -m benchmarks.plan knobs --count {seeds}" + (f" --start {first}" if first else "")
    table = {"command": command, "commit": commit()} | knob_table(seeds, min(os.cpu_count() or 1, MOST_JOBS), first=first)
    print(
        f"means over {seeds} seeds of each knob's own term\n{'knob':14s}"
        + "".join(f"{f'2^{v}':>9s}" for v in VALUES)
        + "    ends / error  monotone"
    )
    for name, term in table["terms"].items():
        row = "".join(f"{m:9.4f}" for m in term["mean"])
        print(f"{name:14s}{row} {term['ends'][0] / max(term['ends'][1], 1e-12):15.1f}  {'yes' if monotone(term) else 'NO'}")
    if seeds < LEAST:
        return
    (RECORDS / "knobs.json").write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")
    (ROOT / "docs" / "images" / "knobs.png").write_bytes(knob_picture(table))
