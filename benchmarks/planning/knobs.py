"""Each knob against its own term, and the picture of it (docs/images/knobs.png)."""

from __future__ import annotations

from pathlib import Path

from pipeline.experiments.knobs import VALUES, knob_picture, knob_table, monotone

PICTURE = Path(__file__).resolve().parents[2] / "docs" / "images" / "knobs.png"


def main(seeds: int) -> None:
    """Print the means of each term over its knob's values, and draw them."""
    table = knob_table(seeds)
    print(f"means over {seeds} seeds of each knob's own term\n{'knob':14s}" + "".join(f"{f'2^{v}':>9s}" for v in VALUES) + "  monotone")
    for name, means in table["terms"].items():
        print(f"{name:14s}" + "".join(f"{m:9.4f}" for m in means) + f"  {'yes' if monotone(means) else 'NO'}")
    PICTURE.write_bytes(knob_picture(table))
