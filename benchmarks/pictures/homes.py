"""Lays out the top views of docs/images/homes.png: `python benchmarks/pictures/homes.py DATASET docs/images SCENE SCENE SCENE SCENE`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from PIL import Image

from pipeline.preview.sheet import PAPER

COLUMNS, CELL, GAP = 2, 480, 20  # homes a row; the side of each and what is between them [px]


def main(dataset: Path, folder: Path, scenes: Sequence[str]) -> None:
    """Write homes.png: previews of a dataset, two a row."""
    rows = -(-len(scenes) // COLUMNS)
    sheet = Image.new("RGB", (COLUMNS * (CELL + GAP) + GAP, rows * (CELL + GAP) + GAP), PAPER)
    for k, scene in enumerate(scenes):
        (found,) = (dataset / "previews").rglob(f"{scene}.png")
        view = Image.open(found).convert("RGB")
        view.thumbnail((CELL, CELL), Image.Resampling.LANCZOS)
        x, y = GAP + k % COLUMNS * (CELL + GAP), GAP + k // COLUMNS * (CELL + GAP)
        sheet.paste(view, (x + (CELL - view.width) // 2, y + (CELL - view.height) // 2))
    sheet.quantize(192).save(folder / "homes.png", optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:])
