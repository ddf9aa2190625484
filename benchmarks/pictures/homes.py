"""Lays out the top views of docs/images/homes.png: `python benchmarks/pictures/homes.py DATASET docs/images SCENE SCENE SCENE SCENE`."""

import sys
from collections.abc import Sequence
from pathlib import Path

from PIL import Image

from pipeline.preview.sheet import PAPER

COLUMNS, CELL, GAP = 2, (480, 410), 20  # homes a row; the size of each and what is between them [px]


def main(dataset: Path, folder: Path, scenes: Sequence[str]) -> None:
    """Write homes.png: previews of a dataset, two a row."""
    rows = -(-len(scenes) // COLUMNS)
    sheet = Image.new("RGB", (COLUMNS * (CELL[0] + GAP) + GAP, rows * (CELL[1] + GAP) + GAP), PAPER)
    for k, scene in enumerate(scenes):
        (path,) = (dataset / "previews").rglob(f"{scene}.png")
        view = Image.open(path).convert("RGB")
        view.thumbnail(CELL, Image.Resampling.LANCZOS)
        x, y = GAP + k % COLUMNS * (CELL[0] + GAP), GAP + k // COLUMNS * (CELL[1] + GAP)
        sheet.paste(view, (x + (CELL[0] - view.width) // 2, y + (CELL[1] - view.height) // 2))
    sheet.save(folder / "homes.png", optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:])
