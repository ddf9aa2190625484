"""The furniture library in pictures: contact sheets of assets, drawn as their thumbnails are.

    python benchmarks/pictures/library.py FOLDER [--count 24] [--columns 6] [--cell 150]

One sheet per group of categories goes to FOLDER/images; of what opens, two pictures stand side by side, closed and open. Needs what `make run` leaves: data/.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PIL import Image

from pipeline import tables
from pipeline.entities.files import load_asset
from pipeline.preview.sheet import contact_sheet
from pipeline.rendering.thumbnail import thumbnail
from schemas import ASSETS

ROOT = Path(__file__).resolve().parents[2]
SHEETS = {
    "chairs": ("dining_chair", "lounge_chair", "dressing_chair", "chinese_chair", "barstool", "stool"),
    "sofas": ("multi_seat_sofa", "loveseat_sofa", "armchair", "l_shaped_sofa", "lazy_sofa", "chaise_longue_sofa"),
    "cabinets": ("bookshelf", "shelf", "sideboard", "tv_stand", "wardrobe", "nightstand", "cabinet", "wine_cabinet", "shoe_cabinet"),
}
OPEN_SHEETS = {
    "open_furniture": ("wardrobe", "nightstand", "cabinet", "sideboard", "desk", "tv_stand", "wine_cabinet", "shoe_cabinet"),
    "open_kitchen_bath": ("kitchen_cabinet", "sink_cabinet", "refrigerator", "oven", "dishwasher", "washing_machine", "toilet", "vanity"),
}
OPEN = 0.7  # of the range of every joint


def picked(categories: Sequence[str], count: int, *, opens: bool) -> list[dict[str, str]]:
    """Return `count` rows of assets that open, or that do not: as many of each category as can be, spread over its assets."""
    rows = [row for row in tables.read(ROOT / "data" / "tables" / "assets.parquet", ASSETS) if row["openable"] == opens]
    each = -(-count // len(categories))
    chosen = []
    for category in categories:
        mine = [row for row in rows if row["category"] == category]
        chosen += [mine[k] for k in np.unique(np.linspace(0, len(mine) - 1, min(each, len(mine))).astype(int))]
    return chosen[:count]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--count", type=int, default=24)
    parser.add_argument("--columns", type=int, default=6)
    parser.add_argument("--cell", type=int, default=150)
    given = parser.parse_args()
    (given.folder / "images").mkdir(parents=True, exist_ok=True)
    for name, categories in (SHEETS | OPEN_SHEETS).items():
        positions = (0.0, OPEN) if name in OPEN_SHEETS else (0.0,)
        portraits = []
        for row in picked(categories, given.count // len(positions), opens=name in OPEN_SHEETS):
            asset = load_asset(ROOT / "data" / "assets" / row["file"])
            words = f"{row['category']}, {row['style']}".replace("_", " ").rstrip(", ")
            portraits += [(words if at == 0.0 else "open", thumbnail(asset, 2 * given.cell, at)) for at in positions]
        sheet = contact_sheet(portraits, given.columns, given.cell)
        sheet.quantize(256, dither=Image.Dither.NONE).save(given.folder / "images" / f"library_{name}.png", optimize=True)


if __name__ == "__main__":
    main()
